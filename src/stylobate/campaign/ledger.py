"""The ledger of a campaign: finished runs on disk, so that a campaign that was stopped goes on where it was."""

from __future__ import annotations

import json
import sqlite3
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import InputError

#: Runs are written at most this often [s]; what a killed campaign loses.
COMMIT_INTERVAL = 1.0


class Ledger:
    """Finished runs of one campaign in an SQLite file.

    Parameters
    ----------
    path : str or Path
        Made if it is not there.
    key : mapping
        Everything that decides the results. A ledger with another key belongs to another campaign and is refused.

    Raises
    ------
    InputError
        The file is the ledger of another campaign, or no ledger.
    """

    def __init__(self, path: str | Path, key: Mapping[str, Any]) -> None:
        self.path = Path(path)
        text = json.dumps(key, sort_keys=True, default=str)
        try:
            self._file = sqlite3.connect(self.path)
            self._file.execute("PRAGMA journal_mode = WAL")
            self._file.execute("CREATE TABLE IF NOT EXISTS campaign (key TEXT)")
            self._file.execute("CREATE TABLE IF NOT EXISTS runs (number INTEGER PRIMARY KEY, row TEXT)")
            found = self._file.execute("SELECT key FROM campaign").fetchone()
            if found is None:
                self._file.execute("INSERT INTO campaign VALUES (?)", (text,))
                self._file.commit()
        except sqlite3.Error as error:
            raise InputError(
                f"{self.path} cannot be used to keep the progress ({error}); delete it or choose another folder."
            ) from None
        if found is not None and found[0] != text:
            self._file.close()
            raise InputError(
                f"{self.path} keeps the unfinished runs of another campaign (or of another version); "
                "choose another folder, or delete the file to give those runs up."
            )
        self._written = time.monotonic()

    def rows(self) -> dict[int, dict]:
        """Finished runs by their number."""
        return {number: json.loads(row) for number, row in self._file.execute("SELECT number, row FROM runs")}

    def record(self, number: int, row: Mapping[str, Any]) -> None:
        """Keep a finished run."""
        self._file.execute("INSERT OR REPLACE INTO runs VALUES (?, ?)", (number, json.dumps(row)))
        if time.monotonic() - self._written > COMMIT_INTERVAL:
            self._file.commit()
            self._written = time.monotonic()

    def close(self) -> None:
        """Write what is open; the campaign can go on from here later."""
        self._file.commit()
        self._file.close()


def discard(path: str | Path) -> None:
    """Delete a ledger: the campaign is over and its results are elsewhere."""
    for ending in ("", "-wal", "-shm"):
        Path(f"{path}{ending}").unlink(missing_ok=True)
