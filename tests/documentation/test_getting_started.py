"""The page for newcomers, typed as it stands: its files, its Python and its commands, and the lines that they print."""

import re
from pathlib import Path

from stylobate.cli.main import call

PAGE = (Path(__file__).parents[2] / "docs" / "start" / "getting_started.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```(\w+)\n(.*?)```", PAGE, re.DOTALL)


def label(line: str) -> str:
    """What a line of the output is about: everything before its value."""
    return re.split(r"\s{2,}(?=\S)", line.strip(), maxsplit=1)[0]


def test_everything_on_the_page_works_in_its_order(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    printed, compared = "", 0
    for kind, text in BLOCKS:
        if kind == "toml":
            (tmp_path / "mycolumn.toml").write_text(text, encoding="utf-8")
        elif kind == "python":
            exec(compile(text, "getting_started.md", "exec"), {})
        elif kind == "sh" and text.startswith("stylobate"):
            for line in text.strip().split("\n"):
                assert call([word.strip('"') for word in re.findall(r'"[^"]*"|\S+', line)[1:]]) == 0, line
            printed = capsys.readouterr().out
        elif kind == "text" and printed:
            seen = {label(line) for line in printed.split("\n")}
            wanted = {label(line) for line in text.strip().split("\n")}
            if not text.startswith("time_s"):
                assert wanted <= seen, wanted - seen
                compared += 1
    assert compared == 3
    assert (tmp_path / "pulse" / "response.nc").exists()


def test_the_numbers_of_statics_on_the_page_are_those_of_the_column(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    [column] = [text for kind, text in BLOCKS if kind == "toml"]
    (tmp_path / "mycolumn.toml").write_text(column, encoding="utf-8")
    assert call(["columns", "mycolumn.toml"]) == 0
    assert capsys.readouterr().out in [text for kind, text in BLOCKS if kind == "text"]
