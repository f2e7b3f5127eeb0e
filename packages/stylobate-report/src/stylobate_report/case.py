"""The report of somebody's own cases: one self-contained page for A4 from any folders of results."""

from __future__ import annotations

import hashlib
import logging
import re
from collections.abc import Iterable, Sequence
from datetime import date
from pathlib import Path
from typing import Any

from markupsafe import Markup

from stylobate.atomic import output_folder
from stylobate.errors import InputError, StylobateError
from stylobate.messages import Message, joined, say
from stylobate.probability.states import NO_MEASURE
from stylobate.results import Kind, Numbers, Result, RunResult, SeveralRuns, read_results
from stylobate.version import __version__

from . import page
from .language import Language, language_of, numbered, speaking
from .others import sections_of
from .page import Exact, print_pdf
from .project import Project, front_sections
from .record import NOTE, SOURCES, files_section
from .runs import run_sections, several_sections

_log = logging.getLogger("stylobate")

TEMPLATE = Path(__file__).with_name("case.html")

#: Names of the kinds of results.
TITLES = {
    "run": say("run in time"),
    "runs": say("runs in time"),
    "critical": say("critical amplitude"),
    "domain": say("safe–unsafe domain"),
    "probability": say("probability of collapse"),
    "pushover": say("pushover"),
    "limit": say("limit analysis"),
    "modes": say("natural frequencies"),
    "compare": say("models compared"),
    "states": say("states compared"),
    "suite": say("suite of records"),
    "ida": say("incremental dynamic analysis"),
    "fragility": say("fragility"),
    "risk": say("risk"),
    "survival": say("survival"),
    "infer": say("what shaking it was"),
    "sequence": say("earthquakes until it falls"),
    "records": say("records chosen"),
    "calibrate": say("losses from a measured history"),
    "study": say("study"),
}


def write_report(
    results: Iterable[Result | str | Path],
    out: str | Path,
    *,
    title: str | None = None,
    pdf: bool = False,
    project: Project | None = None,
) -> list[Path]:
    """Write the report of any results as one HTML file; each file appears whole or not at all.

    A file that is there already is replaced only if stylobate wrote it and nobody has changed it since.

    Parameters
    ----------
    results : iterable of Result or path
        Results (:func:`stylobate.results.read_results`), or folders that commands wrote; in the order of the report.
    out : path
        The HTML file.
    title : str, optional
        The site of the project or what stands, by default.
    pdf : bool
        Print it to a PDF file of the same name as well.
    project : Project, optional
        Begin with an executive page of this project (:func:`stylobate_report.project.read_project`), which is signed.

    Returns
    -------
    list of Path
        The files.

    Raises
    ------
    InputError
        A folder that holds no result, or a place that cannot be written.
    StylobateError
        There is no Chromium to print with, or it fails.
    """
    target = Path(out)
    if target.suffix.lower() not in (".html", ".htm"):
        raise InputError(f"{target} ends in {target.suffix!r}; a report is an HTML file: name it such as report.html.")
    all_results = [
        result for given in results for result in ([given] if isinstance(given, Result) else read_results([given]))
    ]
    if not all_results:
        raise InputError("no result is given to report; give the folder in which a command wrote it.")
    names = [target.name, *([target.with_suffix(".pdf").name] if pdf else [])]
    with output_folder(target.parent, names) as folder:
        return _write(all_results, folder / target.name, title, pdf, project)


def _write(
    results: Sequence[Result], target: Path, title: str | None, pdf: bool, project: Project | None
) -> list[Path]:
    shown: dict[bytes, int] = {}
    own = _names(results) | ({project.site} if project is not None else set())
    language = language_of("en" if project is None else project.language, own)
    with speaking(language):
        cases = []
        for number, result in enumerate(results, start=1):
            _log.info("case %d of %d: %s, %s.", number, len(results), result.kind.value, result.folder)
            cases.append(_case(result, number, shown, results, language))
    notes = _notes([case["notes"] for case in cases]) if project is not None or len(cases) > 1 else []
    front = []
    if project is not None:
        front = [page.part(language.section(section)) for section in front_sections(project, results, cases, notes)]
    cited = list(dict.fromkeys(text for case in cases for text in case["cited"]))
    end = [files_section(results), page.Section(SOURCES, [page.Points(list(map(page.Exact, cited)))])]
    names = _heading(results, project)
    kinds = joined(", ", dict.fromkeys(TITLES[result.kind.value] for result in results))
    day = date.today().isoformat()
    written = say(
        "{kinds:capital}. Written on {day} by stylobate {version}.",
        kinds=kinds,
        day=Exact(day),
        version=Exact(__version__),
    )
    lead = [language.say(written)]
    values = {
        "notes": page.kinds([language.item(note) for note in notes]),
        "version": __version__,
        "day": day,
        "lead": page.kinds(lead),
        "cases": cases,
        "front": front,
        "end": [page.part(language.section(section)) for section in end],
        "project": project,
        "language": language.tag,
        "words": {name: language.say(text) for name, text in WORDS.items()},
        "foot": Markup('"' + PAGES.sub(r'" counter(\1) "', re.sub(r'["\\\\<]', "", language.say(FOOT))) + '"'),
        "spoken": page.kinds(_spoken(language)),
    }
    files = [
        page.write_html(
            target, TEMPLATE, title=title or language.say(say("Report: {names}", names=Exact(names))), **values
        )
    ]
    if pdf:
        _log.info("printing %s.", target.name)
        files.append(print_pdf(target, target.with_suffix(".pdf")))
    return files


#: Words of the template.
WORDS = {
    "prepared": say("Prepared by, date"), "checked": say("Checked by, date"), "signature": say("Signature"),
    "appendix": say("Appendix: the results in full"), "name": say("name"), "role": say("role"), "place": say("place"),
    "date": say("date"),
}  # fmt: skip

#: Foot of a printed page, and the counters of a style sheet in it.
FOOT, PAGES = say("page {page} of {pages}"), re.compile(r"\{(pages?)\}")

#: What a report in another language says of itself before anything else.
SPOKEN_IN = say("Names, commands, parameters of the program and what is cited are as they are.")
PARTS_IN_ENGLISH = say("Parts in English, because they are not translated or are pictures drawn before: {sections}.")


def _spoken(language: Language) -> list[page.Item]:
    """How numbers are written, and which parts of the report stayed English; nothing of a report in English."""
    if not language.foreign:
        return []
    texts = [language.say(SPOKEN_IN)]
    if language.english:
        texts.append(language.say(PARTS_IN_ENGLISH.of(sections=Exact(", ".join(language.english)))))
    return [page.Note(texts, "fair" if language.english else "")]


def _heading(results: Sequence[Result], project: Project | None) -> str:
    """What a report is of: the site of its project, or what stands; the name of a result where nothing is known to stand."""
    if project is not None:
        return project.site
    standing = dict.fromkeys(stands.name for result in results for stands in result.structures)
    return ", ".join(standing or dict.fromkeys(result.name for result in results))


def _names(results: Sequence[Result]) -> set[str]:
    """Names that people gave, of which a report translates nothing."""
    requests = [result.request for result in results if result.request is not None]
    motions = [str(motion.get(key)) for request in requests for motion in request.motions for key in ("name", "record")]
    runs = [run for result in results for run in (result.runs if isinstance(result, SeveralRuns) else (result,))]
    motions += [str(run.response.provenance.get("motion")) for run in runs if isinstance(run, RunResult)]
    standing = [stands for result in results for stands in result.structures if stands.stack is None]
    compared = [result for result in results if isinstance(result, Numbers) and result.kind is Kind.STATES]
    labels = [state["label"] for result in compared for state in result.summary["states"]]
    bodies = [body.name for stands in standing for body in stands.bodies if not (body.fixed and body.name == "ground")]
    given = {
        *motions,
        *(name for name in bodies if not numbered(name)),
        *(label for label in labels if label not in NO_MEASURE),
        *(result.name for result in results),
        *(stands.name for result in results for stands in result.structures),
    }
    return given - {*TITLES.values()}


def _case(
    result: Result, number: int, shown: dict[bytes, int], all_: Sequence[Result], language: Language
) -> dict[str, Any]:
    """A case as the template takes it; its verdict is what the verdicts of its first section begin with."""
    sections = _sections_of(result, all_)
    notes = [item for item in sections[0].items if isinstance(item, page.Note) and "verdict" in item.look]
    verdict = joined(" ", (text for note in notes for text in note.texts[: note.first]))
    texts = [text for part in sections for item in part.items if isinstance(item, page.Note) for text in item.texts]
    known = [text.values["text"] for text in texts if isinstance(text, Message) and text.template == NOTE]
    sources = [item for part in sections if part.title == SOURCES for item in part.items]
    rest = [part for part in sections[1:] if part.title != SOURCES]
    parts = [sections[0], *(_once(part, number, shown) for part in rest)]
    return {
        "cited": [text for item in sources if isinstance(item, page.Points) for text in item.texts],
        "title": _title(result, language),
        "verdict": language.say(verdict),
        "notes": known,
        "parts": [page.part(language.section(section)) for section in parts],
    }


def _once(section: page.Section, number: int, shown: dict[bytes, int]) -> page.Section:
    """A section of a case with reference to the earlier case that shows the same, of all of it or of a table or picture."""

    def earlier(content: Any) -> int:
        known = hashlib.sha256(repr(content).encode()).digest()
        return shown.setdefault(known, number)

    if (case := earlier(section.items)) < number:
        return page.Section(section.title, [say("As in case {case}.", case=case)])
    items: list[page.Item] = []
    for item in section.items:
        if isinstance(item, (page.Rows, page.Facts, page.Picture)) and (case := earlier(item)) < number:
            items += [*filter(None, [item.caption]), say("As in case {case}.", case=case)]
        else:
            items.append(item)
    return page.Section(section.title, items)


def _notes(notes: Sequence[Sequence[str]]) -> list[page.Item]:
    """Caveats for the reader before relying on any of the results, each once, with the results that it holds for."""
    cases_by_text: dict[str, list[int]] = {}
    for number, texts in enumerate(notes, start=1):
        for text in dict.fromkeys(texts):
            cases_by_text.setdefault(text, []).append(number)
    on, on_all = say("On {cases}: {text}"), say("On all of them: {text}")
    each = [
        (on_all if len(cases) == len(notes) else on).of(cases=", ".join(map(str, cases)), text=text)
        for text, cases in cases_by_text.items()
    ]
    return [page.Note(each, "fair")] if each else []


def _sections_of(result: Result, all_: Sequence[Result]) -> list[page.Section]:
    """Sections of a result; values that cannot have been written by stylobate are bad input, not a fault of it."""
    try:
        return _sections(result, all_)
    except (KeyError, TypeError, ValueError, AttributeError, IndexError) as error:
        if isinstance(error, StylobateError):
            raise
        raise InputError(
            f"{result.folder} does not hold what 'stylobate {result.kind.value}' of this version writes "
            f"({type(error).__name__}: {str(error)[:100]}); run again."
        ) from error


def _sections(result: Result, all_: Sequence[Result]) -> list[page.Section]:
    if isinstance(result, RunResult):
        return run_sections(result)
    if isinstance(result, SeveralRuns):
        return several_sections(result)
    mine = {structure.digest for structure in result.structures}
    runs = [run for run in all_ if isinstance(run, RunResult) and run.response.structure.digest in mine]
    return sections_of(result, next((run for run in runs if run.motion is not None), None))


def _title(result: Result, language: Language) -> str:
    if isinstance(result, RunResult):
        return f"{result.name}: {result.response.provenance.get('motion', 'run')}, {result.response.model}"
    return f"{result.name}: {language.say(TITLES[result.kind.value])}"
