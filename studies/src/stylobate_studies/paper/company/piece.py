"""The runs behind the paper's sentence on top beams, as a piece of the study."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from stylobate.analysis.studies import run_study
from stylobate.atomic import replacing
from stylobate.campaign.campaign import Progress

from ..folder import is_ready
from .records import read_records
from .shares import summary
from .study import falls, study_of


def company_piece(folder: Path, threads: int, progress: Progress | None) -> dict[str, Any]:
    """What the study of columns in company comes to under the records that come with the package."""
    place = folder / "company.json"
    if not is_ready(place):
        folder.mkdir(exist_ok=True)
        made = summary(falls(run_study(study_of(read_records(None)), folder, threads=threads, progress=progress)))
        with replacing(place) as partial:
            partial.write_text(json.dumps(made), encoding="utf-8")
    return json.loads(place.read_text(encoding="utf-8"))
