"""Tables of sentences of reports: every language has every sentence with its placeholders, and no sentence is without."""

import ast
import re
from pathlib import Path

import pytest

from stylobate.errors import InputError
from stylobate_report import language as spoken
from stylobate_report.language import HOLE, LANGUAGES, NUMBERS, Language, language_of, sentences_of, write_template

TABLES = {tag: sentences_of(tag) for tag in LANGUAGES}
REPORT = Path(spoken.__file__).parent

#: Files of the room that say nothing in a report: who prints it, and the languages themselves.
SILENT = ("pdf.py", "language.py", "sheets.py")


@pytest.mark.parametrize("tag", LANGUAGES)
def test_every_language_has_every_sentence_with_its_placeholders(tag):
    assert list(TABLES[tag]) == list(TABLES[LANGUAGES[0]])
    for english, said in TABLES[tag].items():
        assert said.strip(), english
        assert sorted(HOLE.findall(said)) == sorted(HOLE.findall(english)), english
        assert HOLE.sub("", said).count("{") == 0, english


@pytest.mark.parametrize("tag", LANGUAGES)
def test_every_sentence_finds_its_own_translation(tag):
    """No other entry stands before it: placeholders are filled with what no entry translates."""
    language = Language(tag, TABLES[tag])
    for english, said in TABLES[tag].items():
        holes = enumerate(dict.fromkeys(HOLE.findall(english)), start=7)
        values = {name: str(k) if name in NUMBERS else f"α{k}" for k, name in holes}
        text = english.format(**values)
        if re.search("[A-Za-z]{2}", text):
            assert language.say(text) == said.format(**values), english


def _pieces():
    """Literal pieces of three words and more of the room's modules, but those of documentation and errors."""
    for path in sorted(REPORT.glob("*.py")):
        if path.name in SILENT:
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        docs = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        errors = {id(node) for one in ast.walk(tree) if isinstance(one, ast.Raise) for node in ast.walk(one)}
        for node in ast.walk(tree):
            if not isinstance(node, ast.Constant) or not isinstance(node.value, str) or id(node) in docs | errors:
                continue
            if not re.fullmatch(r"[a-z0-9_]*|.*\(\?.*", node.value):  # keys, and patterns of texts
                plain = re.sub(r" \[[^\]]*\]?$", "", node.value)  # what comes before a unit
                yield from ((path.name, one) for one in re.split(r"\.(?: |$)|\{[a-z]*\}", plain))


def test_no_sentence_of_the_report_lacks_an_entry():
    """Every literal piece of three words is part of a sentence of the table; assumptions and limits of models too."""
    known = "\n".join(HOLE.sub("\N{REPLACEMENT CHARACTER}", one) for one in TABLES[LANGUAGES[0]])
    missing = [
        (name, piece)
        for name, piece in _pieces()
        if len(re.findall(r"[A-Za-z]{2,}", piece)) >= 3 and piece.strip(" .:;,()“”") not in known
    ]
    assert missing == []


def test_a_part_without_an_entry_is_told_and_names_are_not():
    table = TABLES["it"]
    language = Language("it", table, {"the column of my uncle"})
    assert not language.is_english("the column of my uncle")
    assert not language.is_english(language.say("The column collapsed."))
    assert language.is_english(language.say("The column stood on its head."), 1)
    said = language.say("The column collapsed. It wore a hat of stone.")
    assert said.startswith(table["The column collapsed."])
    assert language.is_english(said, 1)


@pytest.mark.parametrize("tag", LANGUAGES)
def test_what_a_run_and_a_record_say_of_themselves_has_entries(tag):
    """Words of other rooms that stand on the first page or in a table: no English is left but in names."""
    language = Language(tag, TABLES[tag], {"a.V2", "architrave", "column 1, drum 7", "column 1, drum 10"})
    for text in (
        "Reason: drums 3 to 10 overturned about joint 3, towards azimuth 151° (from x towards y).",
        "Reason: the whole column left the support at joint 1.",
        "All 21 blocks are in place, but shifted: column 1, drum 7 by 25.8 mm, the others by less; the joint of column 1, "
        "drum 10 and architrave opened most, by 24.2 mm, and it slid most, by 28.8 mm.",
        "Under steady horizontal forces the assembly becomes a mechanism at 0.1636 times its weight, pushed towards 90°.",
        "The assembly in space",
        "realisation",
        "on 2026-11-25, version 0.2.0",
        "a.V2: cut to the common length of 3250 samples (x: 3251, y: 3250).",
        "x: resampled linearly from unequal steps (0.001 to 0.006 s, median 0.005 s) to 0.001 s; departs by up to 0.00% of "
        "the peak at the original times",
        "acausal Butterworth filter of order 4, 0.1 Hz up; zeros of 60 s at each end kept",
        "it holds the motion of 'a.V2' once more; a record counts once",
        "diameter 0.03, embedment 0.12, material titanium, clearance 0.001",
        "collapse 124.47 s",
        "along y: x to the right",
    ):
        assert language.say(text) != text
        assert not language.is_english(language.say(text), 1), language.say(text)


def test_a_number_is_no_name():
    assert "count" in NUMBERS
    assert Language("it", TABLES["it"]).say("12 stand and 3 are undecided") == "in piedi: 12, indecise: 3"
    assert Language("it", TABLES["it"]).say("K7 stands") == "K7: in piedi"


def test_a_file_of_translations(tmp_path):
    file = write_template(tmp_path / "de.toml")
    text = file.read_text(encoding="utf-8").replace('language = ""', 'language = "de"')
    file.write_text(
        text.replace('"The column collapsed." = ""', '"The column collapsed." = "Die Säule ist eingestürzt."')
    )
    german = language_of(str(file))
    assert german.tag == "de"
    assert german.say("The column collapsed.") == "Die Säule ist eingestürzt."
    assert german.say("Signature") == "Signature"
    for changed, words in (
        (text.replace('"That was certain at {time} s." = ""', '"That was certain at {time} s." = "Sicher."'), "time"),
        (text + '"No such sentence." = "Nein."\n', "no sentence of a report"),
        (text.replace('language = "de"', ""), "language"),
    ):
        file.write_text(changed)
        with pytest.raises(InputError, match=words):
            language_of(str(file))
    with pytest.raises(InputError, match="writes a template"):
        language_of("klingon")
