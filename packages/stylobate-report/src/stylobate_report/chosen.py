"""What goes before runs, in a report: records chosen for a spectrum, losses of a history, frequencies and joints."""

from __future__ import annotations

import math
from typing import Any

from stylobate.messages import digits, joined, percent, say
from stylobate.results import Numbers

from . import numbers as n
from .page import Exact, Facts, Item, Note, Rows
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
    if drifting := [str(record["record"]) for record in s["records"] if record.get("drift_m")]:
        warning = say("Displacements of these records drift after double integration; correct the baseline first:")
        items.append(Note([warning, joined(", ", drifting)], "fair"))
    if s["refused"]:
        body = [[Exact(name), why] for name, why in s["refused"].items()]
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
        if loss := s.get(name):
            numbers = (n.plain(loss[key]) for key in ("value", "low", "high", "told"))
            body.append([Exact(f"{name} [{unit}]"), *numbers])
    header = [say("loss"), say("value"), say("low"), say("high"), say("told by the history")]
    items: list[Item] = [
        Rows(
            header,
            body,
            say("Losses, with the ends of {confidence}.", confidence=percent(s["confidence"])),
            numbers=True,
        )
    ]
    pairs = [(say("history"), Exact(s["history"])), (say("first tilt"), n.angle(s["first_tilt_rad"]))]
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


def modes_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Natural frequencies, what the loss of each joint takes off them, and the joints that measured ones tell of."""
    s, inferred = result.summary, result.summary.get("inferred") or {}
    keys = ["kind", "number", "azimuth_deg", "frequency_hz", "bent_joint", "holds_to_m", "holds_to_rad", "limited_by"]
    caption = say(
        "Each mode with the joint that it bends most; it holds up to a motion of the top at which a joint gives."
    )
    items: list[Item] = [table(s["modes"], keys, caption)]
    names = ("joint_bending_stiffness", "joint_normal_stiffness", "joint_shear_stiffness")
    symbols = dict(zip(names, ("k_b/J_A [N/m³]", "k_n [N/m³]", "k_s [N/m³]"), strict=True))
    pairs = [(symbols[name], _ends(s[name])) for name in names]
    pairs.append((say("Young's modulus of a solid column that bends alike [Pa]"), _ends(s["solid_modulus_pa"])))
    items += [Facts([pair for pair in pairs if pair[1] != n.NONE])]
    items += kept(result.pictures, "modes", say("Shapes of the lowest modes."))
    if inferred:
        rows = [
            {"frequency": symbols[name], **inferred[name], **_sides(inferred["bounded_by"].get(name))} for name in names
        ]
        body = [[n.plain(value) for value in row.values()] for row in rows]
        header = ["", *map(say, ("median", "low", "high")), say("low side by"), say("high side by")]
        items.append(Rows(header, body, say("Joints by the measured frequencies, intervals of 95 %."), numbers=True))
        best = [
            frequency | {"best_hz": inferred["best_hz"][f"{frequency['kind']} {frequency['number']}"]}
            for frequency in inferred["measured"]
        ]
        keys = ["kind", "number", "frequency_hz", "standard_deviation_hz", "best_hz"]
        items.append(table(best, keys, say("What was measured, and the frequencies of the best stiffnesses.")))
    if s["drops"]:
        header = [
            say("{kind} {number}", kind=say(change["kind"]), number=change["number"])
            for change in s["drops"][0]["drops"]
        ]
        body = [
            [row["joint"], *(digits(100.0 * change["drop"], ".2g") for change in row["drops"])] for row in s["drops"]
        ]
        words = say("Change of each frequency [%] where {share} of the stiffness of one joint remains.")
        items.append(Rows([say("joint"), *header], body, words.of(share=percent(s["left"])), numbers=True))
    notes = [*inferred.get("open", ()), *s["left_out"]]
    items += [Note(notes, "fair")] if notes else []
    return (s["sentence"], ""), items


def _ends(value: Any) -> str:
    """A number, or from which to which they are."""
    return (
        say("{low:.4g} to {high:.4g}", low=min(value), high=max(value)) if isinstance(value, list) else n.plain(value)
    )


def _sides(bounded: dict[str, Any] | None) -> dict[str, Any]:
    """Which measurement bounds either side."""
    return {f"{side} side": (bounded or {}).get(side) for side in ("low", "high")}
