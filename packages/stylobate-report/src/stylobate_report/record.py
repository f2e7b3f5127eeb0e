"""The end of each case in a report: what the model assumes, parameters, versions, digests, and what to cite."""

from __future__ import annotations

import shlex
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from stylobate.bibliography import Citation
from stylobate.errors import InputError
from stylobate.messages import Message, joined, say
from stylobate.models.base import Model
from stylobate.models.registry import model_class
from stylobate.results import Result, RunResult, SeveralRuns
from stylobate.results.reading import FileFact
from stylobate.version import __version__

from . import numbers as n
from .page import Code, Exact, Facts, Item, Note, Points, Rows, Section

#: What the reader must know before relying on a result.
NOTE = say("Note: {text}")

#: Title of the section on what to cite.
SOURCES = say("Sources to cite")

#: Options that are results, told elsewhere.
FOUND = ("limit_analysis_g",)


def request_section(result: Result, more: Sequence[tuple[str, str]] = ()) -> Section:
    """Request: the command as typed, and what else was chosen."""
    items: list[Item] = []
    request = result.request
    if request is not None and request.command:
        items.append(Code(typed(request.command)))
    pairs = list(more)
    if request is not None:
        if request.models and not any(name == "model" for name, _ in more):
            pairs.append((say("model"), joined(", ", (titled(model["name"]) for model in request.models))))
        options = {
            key: value
            for key, value in request.options.items()
            if value not in (None, [], "", False) and key not in FOUND
        }
        pairs += [(n.named(key), n.plain(value)) for key, value in options.items()]
        if request.day:
            pairs.append((say("computed on"), Exact(request.day)))
    else:
        items.append(say("The folder does not hold the command line: the file that keeps it is not there."))
    pairs.append((say("folder"), Exact(result.folder)))
    return Section(say("What was asked"), [*items, Facts(pairs)])


def basis_section(result: Result) -> Section:
    """The runs that a result rests on: where they lie, of which command, and what is not known of them."""
    title = say("What it was computed from")
    sources = result.request.sources if result.request is not None else ()
    if not sources:
        text = say(
            "Not known: the folder does not keep what runs it was computed from. Compute it again to have them told "
            "here."
        )
        return Section(title, [Note([text], "fair")])
    items: list[Item] = []
    for source in sources:
        records = list(source["records"])
        alone, several = say("{runs} of 1 record"), say("{runs} of {count} records")
        state = {True: say(", as written"), False: say(", changed by somebody since it was written"), None: ""}[
            source["unchanged"]
        ]
        pairs = [
            (
                say("runs"),
                (alone if len(records) == 1 else several).of(runs=source["runs"], count=len(records)),
            ),
            (say("column or state, as the table calls it"), joined(", ", source["columns"]) or say("not told")),
            (say("model, as the table calls it"), joined(", ", source["models"]) or say("not told")),
            (say("records"), joined(", ", records[:MOST_NAMES]) + (", …" if len(records) > MOST_NAMES else "")),
            (
                say("SHA-256 of {file}", file=source["table"]),
                Exact(source["sha256"]) + state,
            ),
        ]
        if source["command"] is not None:
            pairs.append(
                (
                    say("computed by"),
                    Exact(typed(source["command"]))
                    + say("\non {source[day]}, version {source[version]}", source=source),
                )
            )
        items.append(Facts(pairs, Exact(source["path"])))
        if source["command"] is None:
            items.append(Note([UNKNOWN_REQUEST.of(why=source["not_told"])], "fair"))
        elif source["unchanged"] is False:
            items.append(Note([CHANGED.of(table=source["table"])], "fair"))
    return Section(title, items)


#: Doubt about a table of runs beside which no file tells what the command was asked.
UNKNOWN_REQUEST = say(
    "Not known: {why} Which column stood, in which model with which parameters, and "
    "the motions with their digests and scale factors are not told; whoever signs this has to know them from elsewhere."
)

#: Doubt about a table that somebody has changed.
CHANGED = say(
    "{table} is not as stylobate wrote it: whether its runs are those of the columns, models and motions below is not "
    "known."
)

#: Most names of records of a table that are told.
MOST_NAMES = 40


def typed(command: Sequence[str]) -> str:
    """A command line as it was typed."""
    return shlex.join(["stylobate", *command])


def model_section(names: Iterable[str]) -> Section:
    """Assumptions and limits of models."""
    items: list[Item] = []
    for name in dict.fromkeys(names):
        kind = known_model(name)
        if kind is None:
            items.append(say("This version of stylobate does not know the model {name}.", name=name))
            continue
        items += [
            say("{title:capital} ({name}) assumes:", title=say(kind.title), name=name),
            Points(list(map(say, kind.assumptions))),
        ]
        items += [say("It ends here:"), Points(list(map(say, kind.limits)))]
    return Section(say("What the model assumes, and where it ends"), items)


def known_model(name: str) -> type[Model] | None:
    """The class of a model; None if this version has none of that name."""
    try:
        return model_class(name)
    except InputError:
        return None


def in_the_plane(result: Result) -> bool:
    """Whether every model of a result computes the plane."""
    if isinstance(result, SeveralRuns):
        return all(map(in_the_plane, result.runs))
    if isinstance(result, RunResult):
        models = [(result.response.model, result.response.provenance.get("parameters"))]
    else:
        model_tables = result.request.models if result.request is not None else ()
        models = [(str(model["name"]), model.get("parameters")) for model in model_tables]
    known = [(known_model(name), parameters or {}) for name, parameters in models]
    return bool(known) and all(kind is not None and kind.is_plane(parameters) for kind, parameters in known)


def headline(result: Result, answer: str) -> str:
    """An answer; that of the plane says so."""
    return say("In the plane: {answer}", answer=answer) if in_the_plane(result) else answer


def warnings_of(result: Result, more: Sequence[str] = ()) -> list[Item]:
    """A note with everything that the reader must know before relying on the result; none if there is nothing."""
    warnings = list(more)
    if result.request is not None:
        warnings += result.request.warnings
        if result.request.version != __version__:
            words = say("Computed by version {version}; this report is written by {own}.")
            warnings.append(words.of(version=result.request.version, own=__version__))
    changed = [file.name for file in result.files if file.unchanged is False]
    if changed:
        alone = say("Changed by somebody since stylobate wrote it: {names}.")
        words = alone if len(changed) == 1 else say("Changed by somebody since stylobate wrote them: {names}.")
        warnings.append(words.of(names=joined(", ", changed)))
    return noted(warnings)


def noted(texts: Iterable[str]) -> list[Item]:
    """A note with what the reader must know before relying on a result, each once; none if there is nothing."""
    each = [say(NOTE, text=text) for text in dict.fromkeys(texts)]
    return [Note(each, "fair")] if each else []


def record_section(parameters: Mapping[str, Any], versions: Mapping[str, Any]) -> Section:
    """Parameters of the computation and versions."""
    items: list[Item] = []
    if parameters:
        items.append(
            Facts(
                [(Exact(key), Exact(v) if isinstance(v, str) else n.plain(v)) for key, v in parameters.items()],
                say("Parameters of the model by their names in the program, in SI units; –: not set."),
            )
        )
    known = {
        Exact(key) if key in ("stylobate", "Python") else say(key): value
        if isinstance(value, Message)
        else Exact(value)
        for key, value in versions.items()
        if value not in (None, "")
    }
    items += [Facts([*known.items()], say("Versions and inputs"))] if known else []
    return Section(say("Parameters, versions and digests"), items)


def files_section(results: Sequence[Result]) -> Section:
    """Files of all results, by the number of the result, with their digests."""
    state = {True: say("as written"), False: say("changed since"), None: say("no list to check by")}
    body = [[str(k), Exact(file.name), Exact(file.digest), state[file.unchanged]] for k, file in files_of(results)]
    return Section(
        say("Files this report rests on"),
        [Rows([say("case"), say("file"), Exact("SHA-256"), say("state")], body, numbers=True)],
    )


def files_of(results: Sequence[Result]) -> list[tuple[int, FileFact]]:
    """Files of results, each with the number of its result from 1."""
    return [
        (k, file)
        for k, result in enumerate(results, start=1)
        for member in (result.runs if isinstance(result, SeveralRuns) else (result,))
        for file in member.files
    ]


def sources_section(citation: Citation) -> Section:
    """Citations."""
    package, *_ = [line for line in citation.text.splitlines() if line.startswith("  ")]
    items: list[Item] = [
        Points([Exact(package.strip()), *(Exact(reference.text) for reference in citation.references)])
    ]
    if citation.motion:
        items += [say("And the source of the ground motion:"), Points([Exact(joined("; ", citation.motion.values()))])]
    return Section(SOURCES, items)


def versions_of(result: Result) -> dict[str, str]:
    """Of the package, Python and the machine, as far as the folder tells."""
    request = result.request
    if request is None:
        return {}
    versions = {"stylobate": request.version, "Python": request.python, "machine": request.machine}
    digests = [str(structure.get("digest", "")) for structure in request.structures]
    return versions | ({"digest of what stood": joined("\n", digests)} if digests else {})


def titled(name: str) -> str:
    """A model by its title, its name behind."""
    kind = known_model(name)
    return name if kind is None else say("{model} ({name})", model=say(kind.title), name=name)
