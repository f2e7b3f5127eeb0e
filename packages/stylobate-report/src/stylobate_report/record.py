"""The end of each case in a report: what the model assumes, parameters, versions, digests, and what to cite."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from stylobate.bibliography import Citation
from stylobate.errors import InputError
from stylobate.models.base import Model
from stylobate.models.registry import model_class
from stylobate.results import Result, SeveralRuns
from stylobate.results.kinds import FileFact
from stylobate.version import __version__

from . import numbers as n
from .page import Code, Facts, Item, Note, Own, Points, Rows, Section

#: Beginning of a text that the reader must know before relying on a result.
NOTE = "Note: "

#: Title of the section on what to cite.
SOURCES = "Sources to cite"

#: Options that are results, told elsewhere.
FOUND = ("limit_analysis_g",)


def asked_section(result: Result, more: Sequence[tuple[str, str]] = ()) -> Section:
    """Request: the command as typed, and what else was chosen."""
    items: list[Item] = []
    asked = result.asked
    if asked is not None and asked.command:
        items.append(Code(typed(asked.command)))
    pairs = list(more)
    if asked is not None:
        if asked.models and not any(name == "model" for name, _ in more):
            pairs.append(("model", ", ".join(titled(model["name"]) for model in asked.models)))
        options = {
            key: value
            for key, value in asked.options.items()
            if value not in (None, [], "", False) and key not in FOUND
        }
        pairs += [(n.named(key), n.plain(value)) for key, value in options.items()]
        if asked.day:
            pairs.append(("computed on", asked.day))
    else:
        items.append("The folder does not hold the command line: it was written by a version that did not keep it.")
    return Section("What was asked", [*items, *([Facts(pairs)] if pairs else [])])


def basis_section(result: Result) -> Section:
    """The runs that a result rests on: where they lie, of which command, and what is not known of them."""
    title = "What it was computed from"
    sources = result.asked.sources if result.asked is not None else ()
    if not sources:
        text = "Not known: the folder does not keep what runs it was computed from. Compute it again to have them told here."
        return Section(title, [Note([text], "fair")])
    items: list[Item] = []
    for source in sources:
        records = list(source["records"])
        state = {True: ", as written", False: ", changed by somebody since it was written", None: ""}[
            source["unchanged"]
        ]
        pairs = [
            ("runs", f"{source['runs']} of {len(records)} record{'' if len(records) == 1 else 's'}"),
            ("column or state, as the table calls it", ", ".join(source["columns"]) or "not told"),
            ("model, as the table calls it", ", ".join(source["models"]) or "not told"),
            ("records", ", ".join(records[:MOST_NAMES]) + (", …" if len(records) > MOST_NAMES else "")),
            (f"SHA-256 of {source['table']}", f"{source['sha256']}{state}"),
        ]
        if source["command"] is not None:
            pairs.append(
                ("computed by", f"{typed(source['command'])}\non {source['day']}, version {source['version']}")
            )
        items.append(Facts(pairs, Own(source["path"])))
        if source["command"] is None:
            items.append(Note([NOT_TOLD.format(why=source["not_told"])], "fair"))
        elif source["unchanged"] is False:
            items.append(Note([CHANGED.format(table=source["table"])], "fair"))
    return Section(title, items)


#: Doubt about a table of runs beside which no file tells what the command was asked.
NOT_TOLD = (
    "Not known: {why} Which column stood, in which model with which parameters, and "
    "the motions with their digests and scale factors are not told; whoever signs this has to know them from elsewhere."
)

#: Doubt about a table that somebody has changed.
CHANGED = (
    "{table} is not as stylobate wrote it: whether its runs are those of the columns, models and motions below is not "
    "known."
)

#: Most names of records of a table that are told.
MOST_NAMES = 40


def typed(command: Sequence[str]) -> str:
    """A command line as it was typed."""
    return " ".join(["stylobate", *map(_typed, command)])


def model_section(names: Iterable[str]) -> Section:
    """Assumptions and limits of models."""
    items: list[Item] = []
    for name in dict.fromkeys(names):
        kind = known_model(name)
        if kind is None:
            items.append(f"This version of stylobate does not know the model {name}.")
            continue
        items += [f"{kind.title[:1].upper()}{kind.title[1:]} ({name}) assumes:", Points(kind.assumptions)]
        items += ["It ends here:", Points(kind.limits)]
    return Section("What the model assumes, and where it ends", items)


def known_model(name: str) -> type[Model] | None:
    """The class of a model; None if this version has none of that name."""
    try:
        return model_class(name)
    except InputError:
        return None


def warnings_of(result: Result, more: Sequence[str] = ()) -> list[Item]:
    """A note with everything that the reader must know before relying on the result; none if there is nothing."""
    found = list(more)
    if result.asked is not None:
        found += result.asked.warnings
        if result.asked.version != __version__:
            found.append(f"Computed by version {result.asked.version}; this report is written by {__version__}.")
    changed = [file.name for file in result.files if file.unchanged is False]
    if changed:
        found.append(
            f"Changed by somebody since stylobate wrote {'it' if len(changed) == 1 else 'them'}: {', '.join(changed)}."
        )
    return [Note([f"{NOTE}{text}" for text in dict.fromkeys(found)], "fair")] if found else []


def record_section(result: Result, parameters: Mapping[str, Any], versions: Mapping[str, Any]) -> Section:
    """Parameters of the computation and versions."""
    items: list[Item] = []
    if parameters:
        items.append(
            Facts(
                [(Own(key), Own(v) if isinstance(v, str) else n.plain(v)) for key, v in parameters.items()],
                "Parameters of the model by their names in the program, in SI units; –: not set.",
            )
        )
    known = {key: str(value) for key, value in versions.items() if value not in (None, "")}
    items.append(Facts([*known.items(), ("folder", Own(result.folder))], "Versions and inputs"))
    return Section("Parameters, versions and digests", items)


def files_section(results: Sequence[Result]) -> Section:
    """Files of all results, by the number of the result, with their digests."""
    state = {True: "as written", False: "changed since", None: "no list to check by"}
    body = [[str(k), Own(file.name), file.digest, state[file.unchanged]] for k, file in files_of(results)]
    return Section("Files this report rests on", [Rows(["case", "file", "SHA-256", "state"], body, numbers=True)])


def files_of(results: Sequence[Result]) -> list[tuple[int, FileFact]]:
    """Files of results, each with the number of its result from 1."""
    return [
        (k, file)
        for k, result in enumerate(results, start=1)
        for one in (result.runs if isinstance(result, SeveralRuns) else (result,))
        for file in one.files
    ]


def sources_section(citation: Citation) -> Section:
    """Citations."""
    package, *_ = [line for line in citation.text.splitlines() if line.startswith("  ")]
    items: list[Item] = [Points([Own(package.strip()), *(Own(reference.text) for reference in citation.references)])]
    if citation.motion:
        items += ["And the source of the ground motion:", Points([Own("; ".join(citation.motion.values()))])]
    return Section(SOURCES, items)


def versions_of(result: Result) -> dict[str, str]:
    """Of the package, Python and the machine, as far as the folder tells."""
    asked = result.asked
    if asked is None:
        return {}
    found = {"stylobate": asked.version, "Python": asked.python, "machine": asked.machine}
    digests = [str(structure.get("digest", "")) for structure in asked.structures]
    return found | ({"digest of what stood": "\n".join(digests)} if digests else {})


def titled(name: str) -> str:
    """A model by its title, its name behind."""
    kind = known_model(name)
    return name if kind is None else f"{kind.title} ({name})"


def _typed(word: str) -> str:
    """A word as a shell takes it."""
    import shlex

    return shlex.quote(word)
