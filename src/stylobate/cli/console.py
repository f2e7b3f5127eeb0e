"""Output of a command: one JSON object or a few lines for people, progress, and result files."""

from __future__ import annotations

import json
import logging
import math
import shutil
import sys
import textwrap
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import reworded
from ..messages import MESSAGES, Message, messages_in

if TYPE_CHECKING:
    import pandas

    from ..probability.evidence import Ida
    from ..response import Response

#: The command line that is run, as typed, and what was warned of since it began.
COMMAND: list[str] = []
WARNED: list[str] = []

#: The field that the last complaint was about, where it was bad input of a field.
FIELD: str | None = None

#: Options that are not called after the parameter that they give.
OPTIONS = {"files": "--motion", "hazards": "--hazard"}


def in_options(message: object) -> str:
    """The message of an error or a warning, with the options that give the parameters in it."""

    def words(text: str) -> str:
        return reworded(text, lambda name: OPTIONS.get(name, f"--{name.replace('_', '-')}"))

    text = str(message)
    return text.changed(words) if isinstance(text, Message) else words(text)


#: How messages name parameters: as options, unless a command is done for somebody who does not see these.
WORDING: Callable[[object], str] = in_options


#: Time until the first line about progress, where there is no terminal [s].
FIRST_LINE = 10.0

#: Least time in which runs must have ended before their pace says anything [s].
STEADY = 5.0

#: Speed above which a run was kept from an earlier call: so fast it is read, and no model computes [1/s].
FASTEST = 5000.0

#: Widest line of a table or a caveat [characters], and what stands where there is no value.
WIDEST, MISSING = 100, "-"


def emit(result: Mapping[str, Any]) -> None:
    """Print the result as one JSON object."""
    print(as_json(result))


def say(sentence: str, facts: Mapping[str, str], files: list[Path] | None = None) -> None:
    """Print a sentence, facts in two columns, and where the files are."""
    print(sentence)
    width = max((len(name) for name in facts), default=0)
    for name, value in facts.items():
        print(f"  {name:<{width}}  {value}")
    print_files(files)


def print_files(files: Sequence[Path] | None) -> None:
    """Say which files were written, and where, folder by folder; nothing where there are none."""
    for folder in dict.fromkeys(file.parent for file in files or ()):
        names = [file.name for file in files or () if file.parent == folder]
        print(f"{counted(len(names), 'file')} in {folder}: {', '.join(names)}")


def counted(number: int, noun: str) -> str:
    """So many of something: "1 file", "2 files"."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def as_json(value: Any, indent: int | None = None) -> str:
    """JSON with null where a number is not finite: NaN is no JSON."""
    text = json.dumps(_finite(value), ensure_ascii=False, allow_nan=False, indent=indent, default=str)
    # bytes of a file name that are not UTF-8 become JSON escapes, from which the name can be restored
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def write_json(path: Path, value: Any) -> Path:
    """Write a JSON file, whole or not at all; what its messages are made of stands in it, for reports in other languages."""
    messages = messages_in(value)
    return write_text(path, as_json(value | {MESSAGES: messages} if messages else value, indent=2))


def write_text(path: Path, text: str) -> Path:
    """Write a text and a line end, whole or not at all."""
    from ..atomic import replacing

    with replacing(path) as partial:
        partial.write_text(text + "\n", encoding="utf-8")
    return path


def write_table(table: pandas.DataFrame, path: Path) -> Path:
    """Write a table as CSV, whole or not at all."""
    from ..atomic import replacing

    with replacing(path) as partial:
        table.to_csv(partial, index=False)
    return path


def print_table(table: pandas.DataFrame, digits: int = 4) -> None:
    """Print a table for people."""
    print(table.to_string(index=False, na_rep="-", float_format=lambda value: f"{value:.{digits}g}"))


def print_side_by_side(table: pandas.DataFrame) -> None:
    """Print a table of few rows turned round, each row a column of at most a hundred characters in all.

    The first column of the table names its rows; what no row has a value for is left out.
    """
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    shown = Table(box=None, pad_edge=False)
    shown.add_column(Text(str(table.columns[0])), no_wrap=True)
    for name in table.iloc[:, 0]:
        shown.add_column(Text(str(name)), overflow="fold")
    for name in table.columns[1:]:
        values = [_as_text(value) for value in table[name]]
        if any(value != MISSING for value in values):
            shown.add_row(Text(name), *map(Text, values))
    Console(width=_width(), highlight=False).print(shown)


def _width() -> int:
    """Width of a line [characters]: the terminal's, up to the widest."""
    return min(WIDEST, shutil.get_terminal_size((WIDEST, 24)).columns)


def _as_text(value: Any) -> str:
    """A value of a table for people."""
    if isinstance(value, (list, tuple)):
        return " ".join(_as_text(element) for element in value) or MISSING
    if value is None or value == "" or (isinstance(value, float) and math.isnan(value)):
        return MISSING
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def print_doubt(*results: Mapping[str, Any]) -> None:
    """Say what stands before all that rests on the runs of results, because of their model, each different one once."""
    from ..response.words import each_doubt

    for doubt in each_doubt(result.get("doubt") or "" for result in results):
        print(textwrap.fill(doubt, _width(), break_long_words=False, break_on_hyphens=False))


#: Motions of which is told what is left out.
MOST_LEFT_OUT = 12


def print_left_out(inputs: Sequence[Mapping[str, Any]]) -> None:
    """Say what of the motions the model does not take."""
    left_out = [facts for facts in inputs if facts["left_out"]]
    for entry in left_out[:MOST_LEFT_OUT]:
        print(f"left out of {entry['motion']}: {'; '.join(entry['left_out'])}")
    if len(left_out) > MOST_LEFT_OUT:
        print(f"and of {len(left_out) - MOST_LEFT_OUT} more motions; --json names all of them")


def print_refused(refused: Mapping[str, str]) -> None:
    """Say which files of a suite were not used, and why."""
    for name, reason in refused.items():
        print(f"not used: {name}: {WORDING(reason)}")


def folder(out: Path | None, *writes: str) -> AbstractContextManager[Path | None]:
    """The output folder, made and tried before anything is computed; None if no files are wanted.

    ``writes`` are the names of the files to be, a picture by its name without an ending: what is there and is somebody
    else's is refused before anything is computed.
    """
    from ..atomic import output_folder

    return nullcontext() if out is None else output_folder(out, file_names(writes))


def file_names(writes: Iterable[str]) -> list[str]:
    """Names of files to be, with both endings of a picture that is named without one."""
    return [name for write in writes for name in ((write,) if "." in write else (f"{write}.png", f"{write}.svg"))]


def ledger(folder: Path | None, *, waits: bool = False) -> Path | None:
    """Place where commands keep the finished runs of a folder; refused while another process is at work on it.

    A command that ``waits`` for that one is not refused.
    """
    from ..campaign.ledger import RUNS_FILE, refuse_held
    from . import signals

    if folder is None:
        return None
    if not waits:
        refuse_held(folder / RUNS_FILE)
    signals.KEPT.append(
        f"interrupted; what is finished is kept in {folder}: the same command goes on from there, and begins the run "
        "under way again."
    )
    return folder / RUNS_FILE


def note(sentence: str) -> None:
    """Say on standard error what a person should know while a command goes on."""
    print(f"stylobate: {WORDING(sentence)}", file=sys.stderr, flush=True)


def warn(sentence: str) -> None:
    """Say once what is kept with the results too, and stands in a report of them."""
    kept = in_options(sentence)
    if kept not in WARNED:
        WARNED.append(kept)
        note(f"warning: {sentence}")


#: Hears of progress (title, done, all) instead of a bar, where a command is run for somebody else than a terminal.
LISTENER: Callable[[str, float, float], None] | None = None

#: Sees what a command has come to before its files are written, where somebody waits for it: the response of a run, or what
#: makes the analysis of the runs that are finished.
VIEWER: Callable[[Any], None] | None = None


def show(seen: Response | Callable[[], Ida]) -> None:
    """Let it be seen, where somebody waits for it."""
    if VIEWER is not None:
        VIEWER(seen)


class Notes(logging.Handler):
    """Says on standard error what the package tells its log: that it compiles, how long it will take, how far it is."""

    def emit(self, record: logging.LogRecord) -> None:
        """Say it; lines about waiting are told from others by how they end."""
        note(record.getMessage().rstrip(".") + " ...")


def log_to_stderr() -> None:
    """From now on let a person who waits know for what; for a process that is one command."""
    log = logging.getLogger("stylobate")
    log.setLevel(logging.INFO)
    log.addHandler(Notes())


class Pace:
    """Time that the rest will take, from what has been finished at a steady pace; nothing as long as none is known.

    What was finished before a pause that is longer than all the time before it does not count: the pause is that in which
    code is compiled, or the first runs are under way. Nor does what was finished too fast to have been computed: it was
    kept from an earlier call. Runs end many at a time: a pace is known once the time in which they ended holds three of
    their longest pauses.
    """

    def __init__(self) -> None:
        self.began = self.last = self.base = time.monotonic()
        self.first = self.pause = 0.0

    def remaining(self, done: float, total: float) -> str | None:
        """So many are done of so many: the time that the others take, for people; None where it is not known."""
        from ..models.base import duration

        now = time.monotonic()
        pause, self.last, before = now - self.last, now, self.last - self.began
        if pause > before or done - self.first > FASTEST * (now - self.base):
            self.base, self.first, self.pause = now, done, 0.0
        self.pause = max(self.pause, pause if now > self.base else 0.0)
        spent, finished = now - self.base, done - self.first
        if spent < max(STEADY, 3.0 * self.pause) or finished <= 0.0:
            return None
        return duration(spent * (total - done) / finished)


class Lines:
    """Progress in lines, each after half as much time again as the one before.

    Parameters
    ----------
    title : str
        What is counted.
    """

    def __init__(self, title: str) -> None:
        self.title, self.due = title, FIRST_LINE
        self.began, self.pace = time.monotonic(), Pace()
        self.reported = -math.inf

    def __call__(self, done: float, total: float) -> None:
        """So many are done, of so many."""
        time_left, now = self.pace.remaining(done, total), time.monotonic()
        if now - self.began < self.due or done <= max(self.reported, 0.0) or done >= total:
            return
        self.due, self.reported = 1.5 * (now - self.began), done
        to_go = "" if time_left is None else f", about {time_left} to go"
        so_far = f"{done:.0f}" if float(done).is_integer() else f"{done:.3g}"
        logging.getLogger("stylobate").info("%s of %.10g %s%s.", so_far, total, self.title, to_go)


@contextmanager
def progress(title: str) -> Iterator[Callable[[float, float], None]]:
    """A bar with the remaining time on standard error; lines where that is not a terminal."""
    if LISTENER is not None:
        yield partial(LISTENER, title)
        return
    if not sys.stderr.isatty():
        yield Lines(title)
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[left]}"))
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task, pace = bar.add_task(title, total=None, left=""), Pace()

        def update(done: float, total: float) -> None:
            time_left = pace.remaining(done, total)
            bar.update(task, completed=done, total=total, left="" if time_left is None else f"about {time_left} to go")

        yield update


def length(value: float) -> str:
    """A length for people."""
    if not math.isfinite(value):
        return "unknown"
    if value == 0.0 or abs(value) >= 0.1:
        return f"{value:.3f} m"
    return f"{1000.0 * value:.3g} mm"


def _finite(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _finite(element) for key, element in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(element) for element in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, Path):
        return str(value)
    item = getattr(value, "item", None)  # numbers of numpy
    return _finite(item()) if callable(item) else value
