"""Tables of the page on references in space, from the rows as they are kept."""

from validation.in_space import plane, populations, study
from validation.in_space.row import MISSED, NONE


def texts(out):
    """Tables from what is stored."""
    return [
        (out / "references_summary.md", study.summary() + "\n"),
        (out / "references_families.md", study.counts()),
        (out / "references_missed.md", study.listed(MISSED)),
        (out / "references_none.md", study.listed(NONE)),
        (out / "references_multipliers.md", study.listed("met", only="limit3d_")),
        (out / "turned_in_space.md", populations.turned_table()),
        (out / "tumbles_in_space.md", populations.tumbles_table()),
        (out / "collapses_in_space.md", populations.collapses_table()),
        (out / "plane_in_space.md", plane.tables(study.stored()[study.PLANE])),
    ]
