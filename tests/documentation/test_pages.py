"""The pages against the code, without building the site: equations, names of files and pages, links, commands, models."""

import importlib.util
import re
from pathlib import Path

import pytest

from stylobate.models.registry import MODELS, model_class

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = {
    path.relative_to(DOCS).as_posix(): path.read_text(encoding="utf-8")
    for path in sorted(DOCS.rglob("*.md"))
    if not {"_build", "gallery", "generated"} & set(path.relative_to(DOCS).parts)
}
SOURCES = {
    path: path.read_text(encoding="utf-8")
    for folder in (ROOT / "src", *sorted(ROOT.glob("packages/*/src")), ROOT / "studies")
    for path in sorted(folder.rglob("*.py"))
}

READMES = [f"../{path.relative_to(ROOT).as_posix()}" for path in sorted(ROOT.glob("packages/*/README.md"))]

TAG = re.compile(r"\\tag\{(\w+)\}")


def tags() -> list[str]:
    return [tag for text in PAGES.values() for tag in TAG.findall(without_code(text, inline=True))]


def without_code(text: str, inline: bool = False) -> str:
    text = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
    return re.sub(r"`[^`\n]*`", "", text) if inline else text


# -- equations ---------------------------------------------------------------------------------------------------------


def test_equations_have_numbers_of_their_own():
    numbers = tags()
    assert len(numbers) > 30
    assert len(set(numbers)) == len(numbers)


@pytest.mark.parametrize(
    "page", [page for page in PAGES if page.startswith("theory/") or page == "how_to/synthesis.md"]
)
def test_every_displayed_equation_is_numbered(page):
    shown = re.findall(r"\$\$(.+?)\$\$", without_code(PAGES[page]), re.DOTALL)
    assert [formula for formula in shown if not TAG.search(formula)] == []


def test_every_letter_has_its_page():
    letters = dict(
        re.findall(r"^\| ([A-Z](?:, [A-Z])*) \| \[[^]]+\]\(([^)]+)\) \|$", PAGES["theory/index.md"], re.MULTILINE)
    )
    pages = {letter: page for group, page in letters.items() for letter in group.split(", ")}
    for name, text in PAGES.items():
        for tag in TAG.findall(without_code(text, inline=True)):
            assert (DOCS / "theory" / pages[tag[0]]).resolve() == (DOCS / name).resolve(), tag


def test_equations_cited_in_the_code_and_on_the_pages_exist():
    known, cited = set(tags()), set()
    for path, text in SOURCES.items():
        for group in re.findall(r"Eqs?\. (\([A-Z]\d+\)(?:(?:,| and| to) \([A-Z]\d+\))*)", text):
            numbers = set(re.findall(r"[A-Z]\d+", group))
            assert numbers <= known, path
            cited |= numbers
    for text in PAGES.values():
        cited |= set(re.findall(r"\{eq\}`(\w+)`", text))
    assert {"F3", "R6", "B2", "H1"} <= cited <= known


def test_the_code_cites_nothing_that_readers_do_not_have():
    assert [path for path, text in SOURCES.items() if "formulation" in text.lower()] == []


def test_equations_of_the_paper_cited_in_the_code_are_explained():
    rows = set(re.findall(r"^\| ((?:Eq|Fig)\. \d+) \|", PAGES["theory/index.md"], re.MULTILINE))
    cited = {
        reference
        for text in SOURCES.values()
        for reference in re.findall(r"(?:Baraldi et al\.,|[Tt]he paper's|paper) ((?:Eq|Fig)\. \d+)", text)
        if not re.search(rf"Figs?\. {reference.split()[1]}\b.*histor", text)
    }
    assert {"Eq. 6", "Eq. 7", "Eq. 8"} <= cited <= rows


# -- files, pages, links -----------------------------------------------------------------------------------------------


def test_pages_named_in_the_code_exist():
    named = {
        name for text in SOURCES.values() for name in re.findall(r"\b(?:docs/)?theory/(\w+)", text) if name != "index"
    }
    assert {"rigid_beam", "rigid_block"} <= named
    assert [name for name in named if f"theory/{name}.md" not in PAGES] == []


@pytest.mark.parametrize("page", PAGES)
def test_files_named_on_the_page_exist(page):
    named = re.findall(r"`((?:\w+/)+\w+\.(?:py|bib))`", without_code(PAGES[page]))
    roots = (
        ROOT,
        ROOT / "src",
        ROOT / "src" / "stylobate",
        *ROOT.glob("packages/*/src/*"),
        *ROOT.glob("studies/src/*"),
    )
    missing = [path for path in named if not any((root / path).exists() for root in roots)]
    assert [path for path in missing if "my_model" not in path] == []


@pytest.mark.parametrize("page", [*PAGES, "../README.md", "../CONTRIBUTING.md", "../studies/README.md", *READMES])
def test_links_lead_somewhere(page):
    path = DOCS / page
    text = without_code(path.read_text(encoding="utf-8"))
    for target in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", text):
        if "gallery/" in target:
            assert (ROOT / "gallery").is_dir()
        else:
            assert (path.parent / target).exists(), target


def test_every_page_is_in_a_table_of_contents():
    listed = set()
    for page, text in PAGES.items():
        for block in re.findall(r"```\{toctree\}\n(.*?)```", text, re.DOTALL):
            entries = [line for line in block.split("\n") if line and not line.startswith(":")]
            listed |= {(Path(page).parent / entry).as_posix() for entry in entries}
    assert {page.removesuffix(".md") for page in PAGES} - listed == {"index"}


# -- what the site writes from the code --------------------------------------------------------------------------------


def extension(name: str):
    spec = importlib.util.spec_from_file_location(name, DOCS / "_ext" / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_command_and_option_is_on_the_page():
    from stylobate.cli.main import commands

    (_, text), (_, references) = extension("command_pages").texts(Path())
    for name, command in commands().commands.items():
        section = text.split(f"## {name}\n")[1].split("\n## ")[0]
        for option in command.params:
            if option.param_type_name == "option":
                assert f"`{option.opts[0]}" in section, (name, option.opts)
    assert "Housner, G. W. (1963)" in references


def test_every_model_says_what_it_assumes_and_where_it_ends():
    [(_, text)] = extension("model_pages").texts(Path())
    for name in MODELS:
        model = model_class(name)
        assert f"### `{name}`" in text
        assert f"theory/{extension('model_pages').PAGES[name]}.md" in PAGES
        for sentences in (model.assumptions, model.limits):
            assert len(sentences) >= 3
            assert all(sentence.endswith(".") for sentence in sentences)


def test_every_public_name_is_in_the_python_reference():
    import stylobate

    pages = {path.name: text for path, text in extension("api_pages").texts(Path())}
    assert all(f"st.{name}" in pages["public.txt"] for name in stylobate.__all__)
    assert "automodule:: strongmotion.formats.peer" in pages["strongmotion.md"]


def test_quick_tests_are_of_every_room():
    """But for the fuzzing, which tries hundreds, and the column in the browser, which is compiled first."""
    files = {*DOCS.parent.glob("tests/*/test_*.py"), *DOCS.parent.glob("packages/*/tests/*/test_*.py")}
    quick = {DOCS.parent / line for line in (DOCS.parent / "tests" / "quick.txt").read_text().splitlines()}
    room = {file: file.relative_to(DOCS.parent).parts[:2] for file in files}
    assert quick <= files
    assert {room[file] for file in files - quick} - {room[file] for file in quick} == {
        ("tests", "fuzz"),
        ("tests", "live"),
    }
