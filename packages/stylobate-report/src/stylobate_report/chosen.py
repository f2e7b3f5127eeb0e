"""What goes before runs, in a report: records chosen for a target spectrum, and losses from a measured history."""

from __future__ import annotations

import math

from stylobate.messages import digits, joined, percent, say
from stylobate.results import Numbers

from . import numbers as n
from .page import Facts, Item, Note, Own, Rows
from .pictures import kept
from .tables import table

#: Facts of a record that was chosen.
CHOSEN = ("record", "factor", "compared_by", "misfit", "least_ratio", "largest_ratio", "pga_g", "pgv_m_s", "magnitude",
          "distance_km", "drift_m")  # fmt: skip


def records_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """How well a set of records follows its target, and each of them."""
    s = result.summary
    items: list[Item] = [Facts([(say("target"), s["target_words"]), (say("the set meets it"), n.plain(s["meets"]))])]
    caption = say("Records chosen, each multiplied by one factor; ratios are those of its own spectrum to the target.")
    items.append(table(s["records"], CHOSEN, caption))
    items += kept(
        result.pictures, "records", say("Spectra of the scaled records, their mean, the target, and the misfit.")
    )
    if drifting := [str(one["record"]) for one in s["records"] if one.get("drift_m")]:
        said = say("Displacements of these records drift after double integration; correct the baseline first:")
        items.append(Note([said, joined(", ", drifting)], "fair"))
    if s["refused"]:
        body = [[Own(name), why] for name, why in s["refused"].items()]
        items.append(
            Rows([say("record"), say("why it was not considered")], body, say("Records that were not considered."))
        )
    items.append(
        say("A rocking column has no period of its own: the set that follows a spectrum need not harm it most.")
    )
    return (s["sentence"], "" if s["meets"] else " fair"), items


def calibration_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Losses with their intervals, and how well the motion with them follows the measured one."""
    s, body = result.summary, []
    for name, unit in (("stiffness_damping", "s"), ("rolling_resistance", "–")):
        if one := s.get(name):
            numbers = (n.plain(one[key]) for key in ("value", "low", "high", "told"))
            body.append([Own(f"{name} [{unit}]"), *numbers])
    header = [say("loss"), say("value"), say("low"), say("high"), say("told by the history")]
    items: list[Item] = [
        Rows(
            header,
            body,
            say("Losses, with the ends of {confidence}.", confidence=percent(s["confidence"])),
            numbers=True,
        )
    ]
    pairs = [(say("history"), Own(s["history"])), (say("first tilt"), n.angle(s["first_tilt_rad"]))]
    pairs.append((say("noise of the history"), say("{noise_rad:.2g}°", noise_rad=math.degrees(s["noise_rad"]))))
    pairs.append((say("decrements"), str(s["decrements"])))
    pairs.append(
        (say("difference from computed decrements"), say("{discrepancy:.2g} %", discrepancy=100.0 * s["discrepancy"]))
    )
    pairs.append((say("normal stiffness that the damping belongs to"), say("{s[normal_stiffness]:.3g} N/m³", s=s)))
    if laws := s.get("laws"):
        pairs.append(
            (
                say("laws of round faces"),
                joined(", ", (say("{law} {share}", law=law, share=percent(share)) for law, share in laws.items())),
            )
        )
    if rest := s.get("restitution"):
        limits = say("{rest[value]:.3f} ({rest[low]:.3f} to {rest[high]:.3f})", rest=rest)
        pairs += [
            (say("restitution by successive extremes"), limits),
            (say("of a rigid block"), digits(rest["housner"], ".3f")),
        ]
    items += [
        Facts(pairs),
        *kept(result.pictures, "calibration", say("The measured history, and motions with these losses.")),
    ]
    items.append(
        say("Losses are those of this column on this joint and at these tilts; elsewhere they are an assumption.")
    )
    return (s["sentence"], "" if s["reached"] else " bad"), items
