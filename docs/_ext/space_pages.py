"""What the pages on assemblies in space show: reference rows as they are kept, and the study of columns in company."""

import json
from pathlib import Path

from validation.in_space import plane, study
from validation.in_space.row import MISSED, NONE

from stylobate_studies.company.shares import markdown, runs_told

#: What the study of columns in company has left.
STORED = Path(__file__).parents[1] / "company.json"


def texts(out):
    """Tables from what is stored."""
    found = json.loads(STORED.read_text(encoding="utf-8"))
    said = f"{runs_told(found)} Computed on {found['date']}.\n"
    return [
        (out / "references_summary.md", study.summary() + "\n"),
        (out / "references_families.md", study.counts()),
        (out / "references_missed.md", study.listed(MISSED)),
        (out / "references_none.md", study.listed(NONE)),
        (out / "references_multipliers.md", study.listed("met", only="limit3d_")),
        (out / "plane_in_space.md", plane.tables(study.stored()[study.PLANE])),
        (out / "company.md", markdown(found) + "\n" + said),
    ]
