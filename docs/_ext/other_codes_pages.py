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
    ]


def computed(out):
    """The table of thresholds, computed with the validation cases; the picture of what is stored."""
    other_engines.engines_compared().savefig(out / "engines_compared.png", dpi=150, facecolor="white")
    return [(out / "thresholds.md", table())]
