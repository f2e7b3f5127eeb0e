"""Files that a command writes into the folder of ``--out``, and the campaign whose runs it keeps there."""

from __future__ import annotations

import dataclasses
import shlex
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import console

if TYPE_CHECKING:
    import pandas

    from ..campaign.campaign import Campaign
    from ..results.command_request import CommandRequest

#: Options that say where and how it is computed and told, and not what is asked; whether a value follows.
ELSEWHERE = {
    "--threads": True,
    "--dask": True,
    "--device": True,
    "--out": True,
    "--mix-devices": False,
    "--json": False,
}


class Files(list[Path]):
    """Files of a command, in the order in which they are written.

    Parameters
    ----------
    command : str
        Its name.
    folder : path, optional
        None if no files are wanted.
    before : CommandRequest, optional
        What this command was asked when it last left a result in the folder, which the new one replaces.
    """

    def __init__(self, command: str, folder: Path | None, before: CommandRequest | None = None) -> None:
        super().__init__()
        self.command, self.folder, self.before = command, folder, before
        self.replaces = before is not None and _question(before.command) != _question(console.COMMAND)

    @property
    def wanted(self) -> bool:
        """Whether there is a folder for them."""
        return self.folder is not None

    @property
    def names(self) -> list[str]:
        """Their paths as texts."""
        return [str(file) for file in self]

    def __truediv__(self, name: str) -> Path:
        assert self.folder is not None
        return self.folder / name

    @contextmanager
    def campaign(
        self, campaign: Campaign, title: str = "runs", *, in_folder: bool = False, waits: bool = False
    ) -> Iterator[Campaign]:
        """What is asked for, with the ledger of the folder and a bar of progress while it is under way.

        Parameters
        ----------
        campaign : Campaign
        title : str
            What is counted.
        in_folder : bool
            What runs it finds the ledger in the folder by itself.
        waits : bool
            While another process is at work on that ledger, instead of being refused.
        """
        ledger = console.ledger(self.folder, waits=waits)
        with console.progress(title) as progress:
            yield dataclasses.replace(campaign, ledger=None if in_folder else ledger, progress=progress)

    def table(self, table: pandas.DataFrame, name: str) -> None:
        """Write a table as CSV."""
        self.append(console.write_table(table, self / name))

    def json(self, value: Any, name: str) -> None:
        """Write a JSON file."""
        self.append(console.write_json(self / name, value))

    def data(self, data: bytes, name: str) -> None:
        """Write a file as it came."""
        from ..atomic import replacing

        with replacing(self / name) as partial:
            partial.write_bytes(data)
        self.append(self / name)

    def picture(self, figure: Any, name: str) -> None:
        """Write a picture, named without its ending."""
        from .. import plots

        self += plots.save(figure, self / name)

    def write_request(self, **what: Any) -> None:
        """Write what the command was asked, with the command line and its warnings.

        Parameters
        ----------
        **what
            ``structures``, ``models``, ``motions`` and options, as :meth:`stylobate.results.CommandRequest.of` takes them,
            or what :func:`stylobate.results.command_request.kept_of` says of the runs that it rests on.
        """
        from ..results.command_request import CommandRequest, others_in, request_file_name

        assert self.folder is not None
        earlier = what.pop("earlier", ())
        request = CommandRequest.of(console.COMMAND, **what)
        if self.before is not None and not self.replaces and not request.holds(self.before):
            self.replaces = True
            console.note(_replaced(self.folder, self.before, " of what its files held then"))
        others = others_in(self.folder, self.command)
        if others and not any(Path(source["path"]).resolve() == self.folder.resolve() for source in request.sources):
            console.note(
                f"{self.folder} holds the result of {' and '.join(others)} too, and a report of the folder tells all of "
                "them; give each result an `out` of its own to keep them apart."
            )
        request = dataclasses.replace(request, warnings=(*earlier, *console.WARNED))
        self.json(request.to_dict(), request_file_name(self.command))

    def summary(self, result: dict[str, Any], name: str) -> None:
        """Write the JSON object of the command, which lists its files, as the last of them."""
        self.append(self / name)
        result["files"] = self.names
        console.write_json(self / name, result)


@contextmanager
def files(out: Path | None, command: str, *writes: str) -> Iterator[Files]:
    """Files of a command; the folder is made and tried before anything is computed, see :func:`console.folder`."""
    if out is None:
        yield Files(command, None)
        return
    from ..atomic import OwnFiles
    from ..errors import InputError
    from ..results.command_request import CommandRequest, others_in, request_file_name

    with console.folder(out, *writes, request_file_name(command)) as folder:
        assert folder is not None
        before = None
        if (folder / request_file_name(command)).is_file():
            with suppress(InputError):  # damaged, or of a later version: it is replaced all the same
                before = CommandRequest.read(folder / request_file_name(command))
        elif others := others_in(folder, command):
            names = [name for name in console.file_names(writes) if (folder / name).exists()]
            if names:
                console.note(
                    f"warning: {folder} holds the result of {' and '.join(others)}, and its {', '.join(names)} may be "
                    "replaced; give another `out` to keep both."
                )
        output = Files(command, folder, before)
        if before is not None and output.replaces:
            console.note(_replaced(folder, before))
        yield output
        if output.replaces:  # what the other question had and this one has not would be taken for a part of its result
            own = OwnFiles(folder)
            for name in console.file_names(writes):
                if folder / name not in output:
                    own.remove(folder / name)


def _question(words: Sequence[str]) -> list[str]:
    """The words of a command line that say what is asked."""
    question, remaining = [], iter(words)
    for word in remaining:
        name, equals, _ = word.partition("=")
        if name not in ELSEWHERE:
            question.append(word)
        elif ELSEWHERE[name] and not equals:
            next(remaining, None)
    return question


def _replaced(folder: Path, before: CommandRequest, detail: str = "") -> str:
    """What is said where the result of another question is replaced."""
    line = shlex.join(("stylobate", *before.command))
    return (
        f"warning: {folder} held the result of another question, asked on {before.day}{detail}: '{line}'. The new result "
        "replaces it; give another `out` to keep both (finished runs in the folder serve either)."
    )


# Design values of links, as commands write and print them.

#: What it writes: a table and a picture.
WRITES = ("design.csv", "design")


def write_design(values: pandas.DataFrame, files: Files) -> None:
    """Write the table, and the picture of the links that have a capacity; nothing where there are no links."""
    from .. import plots
    from ..probability.design import worst_of

    if len(values):
        files.table(values, WRITES[0])
    if len(worst_of(values)):
        files.picture(plots.draw_design_values(values), WRITES[1])


def describe_design(values: pandas.DataFrame) -> None:
    """Print the links used most of every state, and the clearance that layers need; nothing where there are none."""
    import numpy as np
    import pandas

    from ..probability.design import OPEN, WHICH_LEVEL, as_read, basis_of, clearances, where, worst_of
    from . import console

    if not len(values):
        return
    level = ("level",) if where(values) else ()
    words = f"{where(values)}: not exceeded under 84 % of the motions, with the 95 % interval {basis_of(values)}."
    if len(worst := worst_of(values)):
        print(f"Design values{words}")
        rows = as_read(worst.groupby("state", sort=False).head(6))
        table: dict[str, Any] = {key: rows[key] for key in ("state", *level, "link", "quantity", "unit")}
        table |= {"84 %": rows["value_84"], "from": rows["low_84"], "to": rows["high_84"]}
        table |= {
            "over capacity": rows["use_value_84"],
            "at most": rows["use_high_84"],
            "limited by": rows["limited_by"],
        }
        table |= {"at [s]": rows["instant_84_s"], "towards [°]": rows["azimuth_84_deg"]}
        console.print_table(pandas.DataFrame(table), digits=3)
        if not np.isfinite(rows["high_84"].to_numpy(dtype=float)).all():
            print(OPEN)
        if len(rows) < len(worst):
            print(
                f"{len(rows)} of {len(worst)} rows, of the links used most; design.csv in --out has all, at every level."
            )
    if len(wide := clearances(values)):
        print(f"Clearance that layers need [m]{words}")
        table = {key: wide[key] for key in ("state", *level, "link")} | {
            "84 %": wide["value_84"],
            "from": wide["low_84"],
        }
        console.print_table(pandas.DataFrame(table | {"to": wide["high_84"]}), digits=3)
    if level:
        print(WHICH_LEVEL)
