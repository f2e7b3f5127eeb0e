"""What the page on other codes shows: the table of published thresholds beside ours."""

from validation.tapered_figure import table


def computed(out):
    """The table of thresholds, computed with the validation cases."""
    return [(out / "thresholds.md", table())]
