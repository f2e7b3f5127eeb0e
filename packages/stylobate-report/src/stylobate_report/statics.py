"""Forces at rest in a report: uplift, pushover with its capacity spectrum check, limit analysis, and what they assume."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from stylobate.analysis.capacity_spectrum import CapacityCheck, capacity_spectrum_check
from stylobate.analysis.limit import limit_analysis, towards
from stylobate.analysis.limit_assemblies import listed
from stylobate.analysis.limit_directions import weakest_direction
from stylobate.analysis.pushover import pushover
from stylobate.column import Column
from stylobate.errors import StylobateError
from stylobate.results import Numbers, Result, RunResult

from . import numbers as n
from .page import Facts, Item, Note, Points, Rows, Section
from .pictures import kept
from .structure import what_opens

#: Facts of a link in a limit analysis.
_LINK = ("link", "action", "force_n", "capacity_n", "yields")


def statics_section(column: Column, run: RunResult | None) -> Section:
    """Statics under horizontal forces: uplift and limit analysis."""
    opens, said = what_opens(column, run is not None and run.response.dims == "xyz")
    pairs = [("opens the first joint", said)]
    try:
        pairs += _around(column) if column.as_found else _in_plane(column)
    except StylobateError as error:
        pairs.append(("limit analysis", f"does not apply: {error}"))
    if run is not None and run.motion is not None:
        peak = run.motion.horizontal_peak[0]
        pairs.append(("peak of the motion over what opens the first joint", f"{peak / opens:.2f}"))
    text = (
        "Steady horizontal forces, proportional to the masses, as accelerations. Beyond these values a joint opens or the "
        "column becomes a mechanism; under an earthquake it then rocks and need not overturn."
        + (
            " Azimuths are from x towards y."
            if column.as_found or (run is not None and run.response.dims == "xyz")
            else ""
        )
    )
    return Section("Statics", [text, Facts(pairs)])


def statics_of_states(columns: Mapping[str, Column]) -> Section:
    """The same of several states of a column, a row each."""
    body = []
    for label, column in columns.items():
        try:
            multiplier = (_around(column) if column.as_found else _in_plane(column))[0][1]
        except StylobateError as error:
            multiplier = f"does not apply: {error}"
        body.append([label, what_opens(column)[1], multiplier])
    text = (
        "Steady horizontal forces, proportional to the masses, as accelerations. What bears more of them at rest need not "
        "bear more earthquakes: the runs tell that."
    )
    header = ["state", "opens the first joint", "limit analysis: becomes a mechanism at"]
    return Section("Statics", [text, Rows(header, body, "", numbers=True)])


def _in_plane(column: Column) -> list[tuple[str, str]]:
    found = limit_analysis(column)
    return [
        ("limit analysis: becomes a mechanism at", f"{found.multiplier:.4g} g"),
        ("bounds from below and from above", f"{found.lower:.5g} and {found.upper:.5g} g"),
        ("mechanism", "; ".join(f"joint {one.joint} {one.mode}" for one in found.active[:4])),
    ]


def _around(column: Column) -> list[tuple[str, str]]:
    weak = weakest_direction(column)
    return [
        ("limit analysis: becomes a mechanism at", f"{weak.multiplier:.4g} g, pushed towards {weak.azimuth:g}°"),
        ("mechanism", f"joint {weak.joint} {weak.mode}"),
    ]


def pushover_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Sentence and body of a pushover."""
    s = result.summary
    led = "top" if s.get("led_drum") is None else f"drum {s['led_drum']}"
    if s["peaked"]:
        sentence = (
            f"Under steady horizontal forces the column bears at most {s['collapse_multiplier_g']:.4g} times its weight; it "
            f"bears none when its {led} has moved by {n.length(s['ultimate_displacement_m'])}."
        )
    else:
        sentence = (
            f"The column bears {s['largest_multiplier_g']:.4g} times its weight, and more: "
            "the path ends before it gives way."
        )
    pairs = [
        ("largest horizontal force over the weight", f"{s['largest_multiplier_g']:.4g}"),
        (f"displacement of its {led} at the largest force", n.length(s.get("peak_displacement_m"))),
        (f"displacement of its {led} where it bears none", n.length(s.get("ultimate_displacement_m"))),
        ("governing joint", n.plain(s.get("governing_joint"))),
        ("steps of the path", n.plain(s.get("steps"))),
        ("end of the path", n.plain(s.get("stop"))),
    ]
    limit = result.asked.options.get("limit_analysis_g") if result.asked is not None else None
    if isinstance(limit, float):
        pairs.insert(1, ("limit analysis, independently", f"{limit:.4g}"))
    caption = "Pushover curve, and the column half way along it; the joint that governs is red."
    return (sentence, " plain"), [Facts(pairs), *kept(result.pictures, "pushover", caption)]


def code_check(column: Column, result: Result, run: RunResult | None) -> Section:
    """The capacity spectrum check of a pushover against the motion of a run of the same column."""
    title = "Capacity spectrum check"
    if run is None or run.motion is None:
        return Section(
            title,
            [
                "No spectrum is known to check against: report the pushover together with a run of the same column, whose "
                "motion then is the demand, or make the check in Python (stylobate.analysis.capacity_spectrum)."
            ],
        )
    asked = result.asked.options if result.asked is not None else {}
    loads = {
        key: asked[key]
        for key in ("pattern", "base_tilt", "compressive_strength", "direction")
        if asked.get(key) is not None
    }
    try:
        check = capacity_spectrum_check(
            towards(column, loads.get("direction", 0.0)), pushover(column, **loads), run.motion
        )
    except StylobateError as error:
        return Section(title, [f"The capacity spectrum check does not apply: {error}"])
    items = check_items(check, str(run.response.provenance.get("motion", "the motion of the run")))
    return Section(title, [*items[:1], *_beside_run(check, result, run), *items[1:]])


def _beside_run(check: CapacityCheck, result: Result, run: RunResult) -> list[Item]:
    """Words of the run in time on the displacement that the check expects."""
    r = run.response
    if r.collapsed:
        return [Note(["The run in time under the same motion collapsed: rely on the run, not on this check."], "bad")]
    ultimate = result.summary.get("ultimate_displacement_m") if isinstance(result, Numbers) else None
    moved = r.measures.peak_top_displacement
    if not ultimate or not np.isfinite(moved) or not check.zero_displacement > 0.0:
        return []
    expected = check.demand * ultimate / check.zero_displacement
    said = (
        f"At the top the demand is {n.length(expected)}; in the run in time under the same motion the top moved by up to "
        f"{n.length(moved)}"
    )
    if moved <= expected:
        return [Note([f"{said}."])]
    if check.passed and moved > 0.4 * ultimate:
        said += f", beyond the usable {n.length(0.4 * ultimate)}: by the run the check would not be passed"
    return [Note([f"{said}. The check underestimates the displacement here: rely on the run."], "fair")]


def check_items(check: CapacityCheck, demand: str) -> list[Item]:
    """A capacity spectrum check in words and numbers."""
    much = f"{check.factor:.2f} times the demand" if check.demand > 0.0 else "without any demand"
    sentence = (
        f"For this one motion the check is {'passed' if check.passed else 'not passed'}: the usable displacement of "
        f"{n.length(check.usable_displacement)} is {much} of {n.length(check.demand)}. It is no proof to a code: the demand "
        "is not the design spectrum of the site."
    )
    pairs = [
        ("demand", f"elastic displacement spectrum of {demand}, 5 % damping"),
        ("participating mass M*", f"{check.mass:.0f} kg (e* = {check.participation:.3f})"),
        ("spectral acceleration that sets the mechanism off, a₀*", n.acceleration(check.acceleration)),
        ("displacement at which the capacity is zero, d₀*", n.length(check.zero_displacement)),
        ("usable displacement d_u* = 0.4 d₀*", n.length(check.usable_displacement)),
        ("secant period T_s", f"{check.period:.2f} s"),
        ("displacement demand at T_s", n.length(check.demand)),
        ("usable displacement over demand", f"{check.factor:.3f}"),
        ("confidence factor FC", "1, as if everything were known"),
    ]
    end = (
        "Nonlinear kinematic analysis of Circolare 617/2009, C8A.4.2.2 and C8A.4.2.3, for an element on the ground; that "
        "circular was replaced by Circolare 7/2019. The starred values are those of the equivalent oscillator. The method "
        "takes a rocking column for an oscillator with a secant period, which it is not: a convention, to be read beside "
        "the run in time, never instead of it."
    )
    return [Note([sentence], "" if check.passed else "fair"), Facts(pairs), end]


def limit_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Sentence and body of a limit analysis."""
    s = result.summary
    to = f", pushed towards {s['weakest_azimuth_deg']:g}°" if "weakest_azimuth_deg" in s else ""
    sentence = (
        f"Under steady horizontal forces the {'assembly' if s.get('moving') else 'column'} becomes a mechanism at "
        f"{s['collapse_multiplier_g']:.4g} times its weight{to}."
    )
    modes = "; ".join(f"joint {joint['joint']} {joint['mode']}" for joint in s.get("active_joints", ()))
    pairs = [
        ("mechanism", modes or n.NONE),
        ("numbers of the joints at their strength", n.plain(s.get("joints_at_strength"))),
        ("flow rule of friction", n.plain(s.get("flow"))),
        *_who_moves(s),
    ]
    if "lower_bound_g" in s:
        pairs.insert(0, ("kinematic bound, from above", f"{s['upper_bound_g']:.6g} g"))
        pairs.insert(0, ("static bound, from below", f"{s['lower_bound_g']:.6g} g"))
    items: list[Item] = [Facts([(name, value) for name, value in pairs if value != n.NONE])]
    items += kept(result.pictures, "limit", "Mechanism: velocities drawn as displacements.")
    items += kept(result.pictures, "directions", "The multiplier by the direction in which the forces push.")
    if held := [link for link in s.get("links", ()) if link.get("force_n")]:
        body = [[str(one[key]) if key in ("link", "action") else n.plain(one[key]) for key in _LINK] for one in held]
        items.append(
            Rows(
                [key.replace("_", " ") for key in _LINK],
                body,
                "Links that must act: the least force that they hold [N], capacity [N]; the others need not.",
                numbers=True,
            )
        )
    return (sentence, " plain"), items


def _who_moves(s: dict[str, Any]) -> list[tuple[str, str]]:
    """Of an assembly, which bodies the mechanism moves, and where the multiplier is only a bound."""
    if not s.get("moving"):
        return []
    bound = "only an upper bound: stones slide or round faces twist" if s["upper_bound"] else n.NONE
    return [
        ("its lowest joint", " – ".join(s["between"])),
        ("bodies that move", listed(s["moving"])),
        ("multiplier", bound),
    ]


def static_model() -> Section:
    """Assumptions and limits of statics."""
    items: list[Item] = [
        "Pushover and limit analysis assume:",
        Points(
            [
                "Drums are rigid and joints take no tension; friction is Mohr–Coulomb.",
                "Forces are horizontal, proportional to the masses unless a pattern was given, and steady.",
                "A column as found is pushed where it is weakest.",
                "A circular column is taken by the diameters of its faces; crushing counts only where a strength was given.",
                "Friction in an assembly in space is associated: where it acts, the multiplier is an upper bound.",
            ]
        ),
        "They end here:",
        Points(
            [
                "The multiplier is where rocking begins, not where an earthquake overturns: for that, run it in time.",
                "Neither size nor duration, frequency or order of the shaking enters.",
            ]
        ),
    ]
    return Section("What the analysis assumes, and where it ends", items)
