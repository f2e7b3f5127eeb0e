"""Catalogues of the messages of reports: renewed from the sources, or with the word ``check`` only looked at."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.pofile import read_po, write_po

from stylobate.models.registry import MODELS, model_class
from stylobate_report.language import LANGUAGES, catalogue_of, file_of, has_words
from stylobate_report.numbers import WORDS

ROOT = Path(__file__).parents[1]


def messages_of_tree() -> Iterator[tuple[str, str]]:
    """Every message with the file that says it: templates of ``say``, words of tables, and prose of models."""
    for path in sorted((*ROOT.glob("src/**/*.py"), *ROOT.glob("packages/*/src/**/*.py"))):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "say":
                text = node.args[0]
                if isinstance(text, ast.Constant) and has_words(text.value):
                    yield text.value, path.relative_to(ROOT).as_posix()
    yield from ((word, "words") for word in WORDS.split("|"))
    for name in MODELS:
        model = model_class(name)
        for text in (model.title, *model.assumptions, *model.limits):
            yield text, "models"


def renewed(tag: str, messages: dict[str, str]) -> Catalog:
    """The catalogue of a language with these messages and no others, and their translations as far as it has them."""
    with file_of(tag).open("rb") as file:
        known = read_po(file, locale=tag)
    catalog = Catalog(locale=tag)
    for text, _ in sorted(messages.items(), key=lambda entry: (entry[1], entry[0])):
        mine = known.get(text)
        catalog.add(text, mine.string if mine else "")
    return catalog


def main() -> int:
    """Renew the catalogues, or check that they are whole."""
    messages: dict[str, str] = {}
    for text, place in messages_of_tree():
        messages.setdefault(text, place)
    lacks = []
    for tag in LANGUAGES:
        catalog, head = renewed(tag, messages), file_of(tag).read_bytes().partition(b"\n\n")[0]
        known = catalogue_of(file_of(tag))
        lacks += [f"{tag}.po has no translation of {text!r}" for text in messages if text not in known]
        lacks += [
            f"{tag}.po translates {text!r}, which is said nowhere" for text in known if text and text not in messages
        ]
        if sys.argv[1:] != ["check"]:
            with file_of(tag).open("wb") as file:
                file.write(head + b"\n\n")
                write_po(file, catalog, width=0, no_location=True, omit_header=True)
    if lacks and sys.argv[1:] == ["check"]:
        print("\n".join([*lacks, "run make messages, and translate what is new."]), file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
