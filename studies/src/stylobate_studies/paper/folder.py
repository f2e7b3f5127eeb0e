"""The folder of a study: whose it is, which study it holds, and which of its pieces are whole."""

from __future__ import annotations

import dataclasses
import json
import os
import warnings
from pathlib import Path

import numpy as np

from stylobate.atomic import LIST, OwnFiles, guard_of, replacing, set_aside
from stylobate.campaign.ledger import refuse_former
from stylobate.column import preset
from stylobate.column.catalogue import PAPER
from stylobate.errors import DamagedFileWarning, InputError
from stylobate.kernels.sources import source_digest
from stylobate.version import __version__

from . import cases as c

#: Line of the list of own files that tells the folder's purpose.
KIND = "study of the paper"

#: Folders in it.
ROOMS = ("data", "figures", "tables")


def check_folder(folder: Path) -> None:
    """Refuse a folder that holds anything but a study; nothing in it is touched.

    Raises
    ------
    InputError
        It is neither new nor empty nor the folder of a study, something in it was changed by somebody else, or it holds
        unfinished runs of an earlier version.
    """
    if not os.path.lexists(folder):
        return
    if not folder.is_dir():
        raise InputError(f"{folder} is no folder; choose another --out.")
    own = OwnFiles(folder)
    if own.kind != KIND:
        if set(os.listdir(folder)) - {LIST}:
            raise InputError(f"{folder} is not empty and is no folder of this study; choose a new or an empty one.")
        return
    for room in ROOMS:
        if (folder / room).is_symlink():
            raise InputError(f"{folder / room} is a link to another folder; choose another --out.")
    refuse_former(*folder.glob("data/*.sqlite"), *folder.glob("data/*/*.sqlite"))
    for path in own:
        if path.relative_to(own.folder).parts[0] != "data" and os.path.lexists(path):
            own.check(path)


def claim(own: OwnFiles, grids: c.Grids) -> None:
    """Say in a folder that was checked which study it holds.

    Pieces of another version of the code are of no use to this one: those that are as they were written are removed.

    Raises
    ------
    InputError
        The folder holds a study on other grids.
    """
    grid = {name: np.asarray(value).tolist() for name, value in dataclasses.asdict(grids).items()}
    code = {
        "version": __version__,
        "kernels": source_digest(),
        "models": {label: [model.name, model.parameters()] for label, model in c.MODELS.items()},
        "variants": {name: [model.parameters(), change, time] for name, (_, model, change, time) in c.VARIANTS.items()},
        "columns": {name: preset(name).digest for name in PAPER},
        "cases": [c.FREQUENCIES.tolist(), c.AMPLITUDES.tolist(), c.DURATION],
    }
    if own.kind != KIND:
        own.claim(KIND)
    data = own.folder / "data"
    data.mkdir(exist_ok=True)
    place = data / "study.json"
    if is_ready(place):
        study = json.loads(place.read_text(encoding="utf-8"))
        if study.get("grids") != grid:
            raise InputError(f"{own.folder} holds another study (quick or full); choose another folder.")
        if study.get("code") == json.loads(json.dumps(code)):
            return
    for path in own:
        if path.is_relative_to(data):
            own.remove(path)
    with replacing(place) as partial:
        partial.write_text(json.dumps({"grids": grid, "code": code}, indent=1, sort_keys=True), encoding="utf-8")


def is_ready(place: Path) -> bool:
    """Whether a piece is there as it was written; one that was damaged since is set aside, to be computed anew.

    Raises
    ------
    InputError
        Something else is in its place.
    """
    own = guard_of(place)
    if own is None:
        return place.exists()
    if own.holds(place):
        return True
    if own.lists(place) and place.is_file() and not place.is_symlink():
        aside = set_aside(place)
        message = f"{place} is damaged or was changed; it is kept as {aside.name} and computed anew."
        warnings.warn(message, DamagedFileWarning, stacklevel=2)
    own.check(place)
    return False
