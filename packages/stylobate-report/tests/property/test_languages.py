"""Catalogues of reports: every message has its translation with its fields, and numbers are as readers write them."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

from stylobate.errors import InputError
from stylobate.messages import digits, joined, say
from stylobate.models.registry import MODELS, model_class
from stylobate_report import language as spoken
from stylobate_report.language import (
    FIELD,
    LANGUAGES,
    Language,
    catalogue_of,
    file_of,
    has_words,
    language_of,
    write_template,
)
from stylobate_report.numbers import WORDS, plain
from stylobate_report.page import Exact

REPORT = Path(spoken.__file__).parent


@cache
def _messages():
    """Templates of this package and of the core, words of tables and prose of models."""
    core, result = Path(__import__("stylobate").__file__).parent, []
    for path in (*REPORT.rglob("*.py"), *core.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "say":
                text = node.args[0]
                if isinstance(text, ast.Constant) and has_words(text.value):
                    result.append(text.value)
    for model in map(model_class, MODELS):
        result += (model.title, *model.assumptions, *model.limits)
    return [*result, *WORDS.split("|")]


@pytest.mark.parametrize("tag", LANGUAGES)
def test_every_message_has_its_translation_with_its_fields(tag):
    catalogue = catalogue_of(file_of(tag))
    assert len(catalogue) > 1000
    assert [message for message in _messages() if message not in catalogue] == []
    for english, translation in catalogue.items():
        if english:
            assert sorted(set(FIELD.findall(translation))) == sorted(set(FIELD.findall(english))), english


@pytest.mark.parametrize("tag", LANGUAGES)
def test_formats_of_numbers_are_those_of_the_message(tag):
    """Digits after the point belong to the number, not to the language."""
    for english, translation in catalogue_of(file_of(tag)).items():
        if english:
            assert set(re.findall(r"\{[^{}]*\}", translation)) <= set(re.findall(r"\{[^{}]*\}", english)), english


@pytest.mark.parametrize(
    ("message", "italian"),
    [
        (digits(2300.0, ",.0f"), "2.300"),
        (digits(0.45, ".2f"), "0,45"),
        (digits(1234567.8, ",.1f"), "1.234.567,8"),
        (digits(-2.5e-4, ".2e"), "-2,50e-04"),
        (Exact("1.500"), "1.500"),
        (joined(" / ", [digits(1.5, "g"), Exact("file 0.3.csv"), digits(2, "d")]), "1,5 / file 0.3.csv / 2"),
        (say("{name}: {value:.1f} m", name="Record 0.3", value=1000.5), "Record 0.3: 1000,5 m"),
    ],
)
def test_numbers_are_as_readers_write_them_and_names_as_they_are(message, italian):
    """A thousand is no decimal sign: what is no number of a message is left alone."""
    assert language_of("it", ["Record 0.3"]).say(message) == italian
    assert language_of("en").say(message) == message


def test_a_message_in_a_message_and_a_text_of_several_are_in_one_language():
    italian = language_of("it")
    inner = say("{low} to {high} %", low="30", high="99")
    assert italian.say(joined(" ", [say("The column collapsed."), inner])) == "La colonna è crollata. 30–99 %"
    outer = say("{title:capital} ({name}) assumes:", title=say("rigid beam model"), name=Exact("beam"))
    assert italian.say(outer).startswith("Modello di travi rigide (beam)")
    assert not italian.missing


def test_what_has_no_translation_is_told_and_names_are_not():
    language = Language("it", catalogue_of(file_of("it")), {"the column of my uncle"})
    language.say("the column of my uncle")
    language.say("north_column-2.csv")
    assert language.say("column 1, drum 7") == "colonna 1, rocco 7"
    assert [language.say(text) for text in ("ground – drum 1", "dowel in joint 5, 1", "layer in joint 1")] == [
        "suolo – rocco 1", "perno nel giunto 5, 1", "strato nel giunto 1",
    ]  # fmt: skip
    assert [language.say(plain(text)) for text in ("as built", "dowel in joint 2")] == [
        "come costruita",
        "perno nel giunto 2",
    ]
    assert language.say("r.csv at 75° reversed, scaled to 0.5 g") == "r.csv a 75° invertito, scalato a 0.5 g"
    assert language.say("scan at 1.2.3°") == "scan at 1.2.3°"
    assert language.say("clamp between west and column 3, drum 5") == "grappa tra west e colonna 3, rocco 5"
    assert language.say(say("“{state}” stands", state="as built")) == "“come costruita” stands"
    language.missing.clear()
    language.say(say("The column wore a hat of stone."))
    assert list(language.missing) == ["The column wore a hat of stone."]


def test_a_catalogue_of_a_reader(tmp_path):
    file = write_template(tmp_path / "de.po")
    text = file.read_text(encoding="utf-8").replace("Language: ", "Language: de")
    collapsed = 'msgid "The column collapsed."\nmsgstr ""'
    assert text.count(collapsed) == 1
    file.write_text(text.replace(collapsed, collapsed[:-1] + 'Die Säule ist eingestürzt."'), encoding="utf-8")
    german = language_of(str(file))
    assert german.tag == "de"
    assert german.say(say("The column collapsed.")) == "Die Säule ist eingestürzt."
    assert german.say(say("Signature")) == "Signature"
    certain = 'msgid "That was certain at {time:.2f} s."\nmsgstr ""'
    for number, (changed, words) in enumerate(
        (
            (text.replace(certain, certain[:-1] + 'Sicher."'), "time"),
            (text + "\nnonsense\n", "is no catalogue"),
            (text.replace("Language: de", ""), "Language"),
        )
    ):
        other = tmp_path / f"{number}.po"
        other.write_text(changed, encoding="utf-8")
        with pytest.raises(InputError, match=words):
            language_of(str(other))
    with pytest.raises(InputError, match="writes a template"):
        language_of("klingon")
