"""What goes before runs, in a report: records chosen for a target spectrum, and losses from a measured history."""

from __future__ import annotations

import math

from stylobate.percent import percent
from stylobate.results import Numbers

from . import numbers as n
from .page import Facts, Item, Note, Rows
from .pictures import kept
from .tables import table

#: Facts of a record that was chosen.
CHOSEN = ("record", "factor", "compared_by", "misfit", "least_ratio", "largest_ratio", "pga_g", "pgv_m_s", "magnitude",
          "distance_km", "drift_m")  # fmt: skip


def records_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """How well a set of records follows its target, and each of them."""
    s = result.summary
    items: list[Item] = [Facts([("target", s["target_words"]), ("the set meets it", n.plain(s["meets"]))])]
    caption = "Records chosen, each multiplied by one factor; ratios are those of its own spectrum to the target."
    items.append(table(s["records"], CHOSEN, caption))
    items += kept(result.pictures, "records", "Spectra of the scaled records, their mean, the target, and the misfit.")
    if drifting := [str(one["record"]) for one in s["records"] if one.get("drift_m")]:
        said = "Displacements of these records drift after double integration; correct the baseline first:"
        items.append(Note([said, ", ".join(drifting)], "fair"))
    if s["refused"]:
        body = [[str(name), str(why)] for name, why in s["refused"].items()]
        items.append(Rows(["record", "why it was not considered"], body, "Records that were not considered."))
    items.append("A rocking column has no period of its own: the set that follows a spectrum need not harm it most.")
    return (str(s["sentence"]), "" if s["meets"] else " fair"), items


def calibration_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Losses with their intervals, and how well the motion with them follows the measured one."""
    s, body = result.summary, []
    for name, unit in (("stiffness_damping", "s"), ("rolling_resistance", "–")):
        if one := s.get(name):
            body.append([f"{name} [{unit}]", *(n.plain(one[key]) for key in ("value", "low", "high", "told"))])
    header = ["loss", "value", "low", "high", "told by the history"]
    items: list[Item] = [Rows(header, body, f"Losses, with the ends of {percent(s['confidence'])}.", numbers=True)]
    pairs = [("history", str(s["history"])), ("first tilt", n.angle(s["first_tilt_rad"]))]
    pairs.append(("noise of the history", f"{math.degrees(s['noise_rad']):.2g}°"))
    pairs.append(("decrements", str(s["decrements"])))
    pairs.append(("difference from computed decrements", f"{100.0 * s['discrepancy']:.2g} %"))
    pairs.append(("normal stiffness that the damping belongs to", f"{s['normal_stiffness']:.3g} N/m³"))
    if laws := s.get("laws"):
        pairs.append(("laws of round faces", ", ".join(f"{law} {percent(share)}" for law, share in laws.items())))
    if rest := s.get("restitution"):
        limits = f"{rest['value']:.3f} ({rest['low']:.3f} to {rest['high']:.3f})"
        pairs += [("restitution by successive extremes", limits), ("of a rigid block", f"{rest['housner']:.3f}")]
    items += [
        Facts(pairs),
        *kept(result.pictures, "calibration", "The measured history, and motions with these losses."),
    ]
    items.append("Losses are those of this column on this joint and at these tilts; elsewhere they are an assumption.")
    return (str(s["sentence"]), "" if s["reached"] else " bad"), items
