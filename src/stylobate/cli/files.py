"""Files that a command writes into the folder of ``--out``, and the campaign whose runs it keeps there."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import console

if TYPE_CHECKING:
    import pandas

    from ..campaign.campaign import Campaign


class Files(list[Path]):
    """Files of a command, in the order in which they are written.

    Parameters
    ----------
    command : str
        Its name.
    folder : path, optional
        None if no files are wanted.
    """

    def __init__(self, command: str, folder: Path | None) -> None:
        super().__init__()
        self.command, self.folder = command, folder

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
        self, asked: Campaign, title: str = "runs", *, in_folder: bool = False, waits: bool = False
    ) -> Iterator[Campaign]:
        """What is asked for, with the ledger of the folder and a bar of progress while it is under way.

        Parameters
        ----------
        asked : Campaign
        title : str
            What is counted.
        in_folder : bool
            What runs it finds the ledger in the folder by itself.
        waits : bool
            While another process is at work on that ledger, instead of being refused.
        """
        ledger = console.ledger(self.folder, waits=waits)
        with console.progress(title) as progress:
            yield dataclasses.replace(asked, ledger=None if in_folder else ledger, progress=progress)

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

    def asked(self, **what: Any) -> None:
        """Write what the command was asked, with the command line and its warnings.

        Parameters
        ----------
        **what
            ``structures``, ``models``, ``motions`` and options, as :meth:`stylobate.results.asked.Asked.of` takes them, or
            what :func:`stylobate.results.sources.kept_of` says of the runs that it rests on.
        """
        from ..results.asked import Asked, asked_file

        found = Asked.of(console.COMMAND, warnings=[*what.pop("earlier", ()), *console.WARNED], **what)
        self.json(found.to_dict(), asked_file(self.command))

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
    from ..results.asked import asked_file

    with console.folder(out, *writes, asked_file(command)) as folder:
        yield Files(command, folder)
