"""Design values of links, as commands write and print them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas

    from .files import Files

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
        some = as_read(worst.groupby("state", sort=False).head(6))
        told: dict[str, Any] = {key: some[key] for key in ("state", *level, "link", "quantity", "unit")}
        told |= {"84 %": some["value_84"], "from": some["low_84"], "to": some["high_84"]}
        told |= {
            "over capacity": some["use_value_84"],
            "at most": some["use_high_84"],
            "limited by": some["limited_by"],
        }
        told |= {"at [s]": some["instant_84_s"], "towards [°]": some["azimuth_84_deg"]}
        console.print_table(pandas.DataFrame(told), digits=3)
        if not np.isfinite(some["high_84"].to_numpy(dtype=float)).all():
            print(OPEN)
        if len(some) < len(worst):
            print(
                f"{len(some)} of {len(worst)} rows, of the links used most; design.csv in --out has all, at every level."
            )
    if len(wide := clearances(values)):
        print(f"Clearance that layers need [m]{words}")
        told = {key: wide[key] for key in ("state", *level, "link")} | {
            "84 %": wide["value_84"],
            "from": wide["low_84"],
        }
        console.print_table(pandas.DataFrame(told | {"to": wide["high_84"]}), digits=3)
    if level:
        print(WHICH_LEVEL)
