"""Messages of reports and their catalogues: ``messages.py`` renews them from the sources, ``messages.py check`` tells what lacks."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.pofile import read_po, write_po

from stylobate.models.registry import MODELS, model_class
from stylobate_report.language import LANGUAGES, file_of, has_words

ROOT = Path(__file__).parents[1]


def found() -> Iterator[tuple[str, str]]:
    """Every message with the file that says it: templates of ``say``, and what models say of themselves."""
    for path in sorted((*ROOT.glob("src/**/*.py"), *ROOT.glob("packages/*/src/**/*.py"))):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "say":
                text = node.args[0]
                if isinstance(text, ast.Constant) and has_words(text.value):
                    yield text.value, path.relative_to(ROOT).as_posix()
    for name in MODELS:
        model = model_class(name)
        for text in (model.title, *model.assumptions, *model.limits):
            yield text, "models"


def renewed(tag: str, messages: dict[str, str]) -> Catalog:
    """The catalogue of a language with these messages and no others, and their translations as far as it has them."""
    with file_of(tag).open("rb") as file:
        known = read_po(file, locale=tag)
    catalog = Catalog(locale=tag, header_comment=known.header_comment, fuzzy=False)
    catalog.mime_headers = known.mime_headers
    for text, place in sorted(messages.items(), key=lambda one: (one[1], one[0])):
        mine = known.get(text)
        catalog.add(text, mine.string if mine else "", locations=[(place, None)])
    return catalog


def main() -> int:
    """Renew the catalogues, or check that they are whole."""
    messages: dict[str, str] = {}
    for text, place in found():
        messages.setdefault(text, place)
    lacks = 0
    for tag in LANGUAGES:
        catalog = renewed(tag, messages)
        if sys.argv[1:] == ["check"]:
            known = {message.id for message in read_po(file_of(tag).open("rb"))}
            empty = [one.id for one in catalog if one.id and not one.string]
            for what, texts in (
                ("without a translation", empty),
                ("said nowhere", known - {one.id for one in catalog}),
            ):
                for text in texts:
                    print(f"{tag}.po: {what}: {text!r}; run make messages, and translate what is new.", file=sys.stderr)
                    lacks += 1
        else:
            with file_of(tag).open("wb") as file:
                write_po(file, catalog, width=120, sort_output=False, include_lineno=False, omit_header=False)
    return int(bool(lacks))


if __name__ == "__main__":
    sys.exit(main())
