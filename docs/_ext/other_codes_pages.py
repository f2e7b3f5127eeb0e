"""What the page on other codes shows: published thresholds beside ours, and the stored results of other engines."""

from validation import other_engines
from validation.tapered_figure import table


def texts(out):
    """Tables from what is stored."""
    return [
        (out / "peers_settings.md", f"{other_engines.dated()}\n\n{other_engines.settings()}"),
        (out / "peers_plane.md", other_engines.plane_table()),
        (out / "peers_verdicts.md", other_engines.verdict_table()),
        (out / "peers_round.md", other_engines.round_table()),
        (out / "peers_passes.md", other_engines.passes_table()),
        (out / "peers_within.md", other_engines.within_table()),
    ]


def computed(out):
    """The table of thresholds, computed with the validation cases; the picture of what is stored."""
    for picture in (other_engines.engines_compared, other_engines.passes_compared):
        picture().savefig(out / f"{picture.__name__}.png", dpi=150, facecolor="white")
    return [(out / "thresholds.md", table())]
