"""Forces at rest in a report: uplift, pushover with its capacity spectrum check, limit analysis, and what they assume."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from stylobate.codes.checks import CapacityCheck, capacity_spectrum_check
from stylobate.column import Column
from stylobate.errors import StylobateError
from stylobate.messages import digits, joined, say
from stylobate.results import Numbers, Result, RunResult
from stylobate.statics.limit import limit_analysis, listed, towards, weakest_direction
from stylobate.statics.pushover import pushover

from . import numbers as n
from .page import Exact, Facts, Item, Note, Points, Rows, Section
from .pictures import kept
from .structure import what_opens

#: Facts of a link in a limit analysis.
_LINK = ("link", "action", "force_n", "capacity_n", "yields")


def statics_section(column: Column, run: RunResult | None) -> Section:
    """Statics under horizontal forces: uplift and limit analysis."""
    opens, sentence = what_opens(column, run is not None and run.response.dims == "xyz")
    pairs = [(say("opens the first joint"), sentence)]
    try:
        pairs += _around(column) if column.as_found else _in_plane(column)
    except StylobateError as error:
        pairs.append((say("limit analysis"), say("does not apply: {error}", error=error)))
    if run is not None and run.motion is not None:
        peak = run.motion.horizontal_peak[0]
        pairs.append((say("peak of the motion over what opens the first joint"), digits(peak / opens, ".2f")))
    text = say(
        "Steady horizontal forces, proportional to the masses, as accelerations. Beyond these values a joint "
        "opens or the column becomes a mechanism; under an earthquake it then rocks and need not overturn."
    )
    if column.as_found or (run is not None and run.response.dims == "xyz"):
        text = joined(" ", [text, say("Azimuths are from x towards y.")])
    return Section(say("Statics"), [text, Facts(pairs)])


def statics_of_states(columns: Mapping[str, Column]) -> Section:
    """The same of several states of a column, a row each."""
    body = []
    for label, column in columns.items():
        try:
            multiplier = (_around(column) if column.as_found else _in_plane(column))[0][1]
        except StylobateError as error:
            multiplier = say("does not apply: {error}", error=error)
        body.append([label, what_opens(column)[1], multiplier])
    text = say(
        "Steady horizontal forces, proportional to the masses, as accelerations. What bears more of them at rest "
        "need not bear more earthquakes: the runs tell that."
    )
    header = [say("state"), say("opens the first joint"), say("limit analysis: becomes a mechanism at")]
    return Section(say("Statics"), [text, Rows(header, body, "", numbers=True)])


def _in_plane(column: Column) -> list[tuple[str, str]]:
    limit = limit_analysis(column)
    return [
        (say("limit analysis: becomes a mechanism at"), say("{found.multiplier:.4g} g", found=limit)),
        (say("bounds from below and from above"), say("{found.lower:.5g} and {found.upper:.5g} g", found=limit)),
        (
            say("mechanism"),
            joined("; ", (_rocks(active_joint.joint, active_joint.mode) for active_joint in limit.active[:4])),
        ),
    ]


def _rocks(joint: int, mode: str) -> str:
    return say("joint {joint} {mode}", joint=joint, mode=say(mode))


def _around(column: Column) -> list[tuple[str, str]]:
    weak = weakest_direction(column)
    return [
        (
            say("limit analysis: becomes a mechanism at"),
            say("{weak.multiplier:.4g} g, pushed towards azimuth {weak.azimuth:g}°", weak=weak),
        ),
        (say("mechanism"), _rocks(weak.joint, weak.mode)),
    ]


def pushover_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Sentence and body of a pushover."""
    s = result.summary
    led = say("top") if s.get("led_drum") is None else say("drum {s[led_drum]}", s=s)
    if s["peaked"]:
        sentence = say(
            "Under steady horizontal forces the column bears at most {s[collapse_multiplier_g]:.4g} times its "
            "weight; it bears none when its {led} has moved by {far}.",
            s=s,
            led=led,
            far=n.length(s["ultimate_displacement_m"]),
        )
    else:
        sentence = say(
            "The column bears {s[largest_multiplier_g]:.4g} times its weight, and more: the path ends before it "
            "gives way.",
            s=s,
        )
    pairs = [
        (say("largest horizontal force over the weight"), digits(s["largest_multiplier_g"], ".4g")),
        (say("displacement of its {led} at the largest force", led=led), n.length(s.get("peak_displacement_m"))),
        (say("displacement of its {led} where it bears none", led=led), n.length(s.get("ultimate_displacement_m"))),
        (say("governing joint"), n.plain(s.get("governing_joint"))),
        (say("steps of the path"), n.plain(s.get("steps"))),
        (say("end of the path"), n.plain(s.get("stop"))),
    ]
    limit = result.request.options.get("limit_analysis_g") if result.request is not None else None
    if isinstance(limit, float):
        pairs.insert(1, (say("limit analysis, independently"), digits(limit, ".4g")))
    caption = say("Pushover curve, and the column half way along it; the joint that governs is red.")
    return (sentence, " plain"), [Facts(pairs), *kept(result.pictures, "pushover", caption)]


def code_check(column: Column, result: Result, run: RunResult | None) -> Section:
    """The capacity spectrum check of a pushover against the motion of a run of the same column."""
    title = say("Capacity spectrum check")
    if run is None or run.motion is None:
        return Section(
            title,
            [
                say(
                    "No spectrum is known to check against: report the pushover together with a run of the same "
                    "column, whose motion then is the demand, or make the check in Python "
                    "(stylobate.codes.checks)."
                )
            ],
        )
    options = result.request.options if result.request is not None else {}
    loads = {
        key: options[key]
        for key in ("pattern", "base_tilt", "compressive_strength", "direction")
        if options.get(key) is not None
    }
    try:
        check = capacity_spectrum_check(
            towards(column, loads.get("direction", 0.0)), pushover(column, **loads), run.motion
        )
    except StylobateError as error:
        return Section(title, [say("The capacity spectrum check does not apply: {error}", error=error)])
    items = check_items(check, str(run.response.provenance.get("motion", "the motion of the run")))
    return Section(title, [*items[:1], *_beside_run(check, result, run), *items[1:]])


def _beside_run(check: CapacityCheck, result: Result, run: RunResult) -> list[Item]:
    """Words of the run in time on the displacement that the check expects."""
    r = run.response
    if r.collapsed:
        return [
            Note([say("The run in time under the same motion collapsed: rely on the run, not on this check.")], "bad")
        ]
    ultimate = result.summary.get("ultimate_displacement_m") if isinstance(result, Numbers) else None
    moved = r.measures.peak_top_displacement
    if not ultimate or not np.isfinite(moved) or not check.zero_displacement > 0.0:
        return []
    expected = check.demand * ultimate / check.zero_displacement
    sentence = say(
        "At the top the demand is {expected}; in the run in time under the same motion the top moved by up to {moved}",
        expected=n.length(expected), moved=n.length(moved),
    )  # fmt: skip
    if moved <= expected:
        return [Note([sentence + "."])]
    if check.passed and moved > 0.4 * ultimate:
        beyond = say(
            ", beyond the usable {usable}: by the run the check would not be passed", usable=n.length(0.4 * ultimate)
        )
        sentence += beyond
    less = say("The check underestimates the displacement here: rely on the run.")
    return [Note([joined(" ", [sentence + ".", less])], "fair")]


def check_items(check: CapacityCheck, demand: str) -> list[Item]:
    """A capacity spectrum check in words and numbers."""
    much = (
        say("{factor:.2f} times the demand", factor=check.factor) if check.demand > 0.0 else say("without any demand")
    )
    passed = say("For this one motion the check is passed: the usable displacement of {usable} is {much} of {demand}.")
    failed = say(
        "For this one motion the check is not passed: the usable displacement of {usable} is {much} of {demand}."
    )
    known = {"usable": n.length(check.usable_displacement), "much": much, "demand": n.length(check.demand)}
    proof = say("It is no proof to a code: the demand is not the design spectrum of the site.")
    sentence = joined(" ", [(passed if check.passed else failed).of(**known), proof])
    pairs = [
        (say("demand"), say("elastic displacement spectrum of {demand}, 5 % damping", demand=demand)),
        (say("participating mass M*"), say("{check.mass:.0f} kg (e* = {check.participation:.3f})", check=check)),
        (say("spectral acceleration that sets the mechanism off, a₀*"), n.acceleration(check.acceleration)),
        (say("displacement at which the capacity is zero, d₀*"), n.length(check.zero_displacement)),
        (say("usable displacement d_u* = 0.4 d₀*"), n.length(check.usable_displacement)),
        (say("secant period T_s"), say("{check.period:.2f} s", check=check)),
        (say("displacement demand at T_s"), n.length(check.demand)),
        (say("usable displacement over demand"), digits(check.factor, ".3f")),
        (say("confidence factor FC"), say("1, as if everything were known")),
    ]
    end = say(
        "Nonlinear kinematic analysis of Circolare 617/2009, C8A.4.2.2 and C8A.4.2.3, for an element on the "
        "ground; that circular was replaced by Circolare 7/2019. The starred values are those of the equivalent "
        "oscillator. The method takes a rocking column for an oscillator with a secant period, which it is not: "
        "a convention, to be read beside the run in time, never instead of it."
    )
    return [Note([sentence], "" if check.passed else "fair"), Facts(pairs), end]


def limit_result(result: Numbers) -> tuple[tuple[str, str], list[Item]]:
    """Sentence and body of a limit analysis."""
    s = result.summary
    becomes = say(
        "Under steady horizontal forces the column becomes a mechanism at {s[collapse_multiplier_g]:.4g} times its weight"
    )
    if s.get("moving"):
        becomes = say(
            "Under steady horizontal forces the assembly becomes a mechanism at "
            "{s[collapse_multiplier_g]:.4g} times its weight"
        )
    to = say(", pushed towards azimuth {s[weakest_azimuth_deg]:g}°", s=s) if "weakest_azimuth_deg" in s else ""
    sentence = joined("", [becomes.of(s=s), to, "."])
    modes = joined("; ", (_rocks(joint["joint"], joint["mode"]) for joint in s.get("active_joints", ())))
    pairs = [
        (say("mechanism"), modes or n.NONE),
        (say("numbers of the joints at their strength"), n.plain(s.get("joints_at_strength"))),
        (say("flow rule of friction"), n.plain(s.get("flow"))),
        *_who_moves(s),
    ]
    if "lower_bound_g" in s:
        pairs.insert(0, (say("kinematic bound, from above"), say("{s[upper_bound_g]:.6g} g", s=s)))
        pairs.insert(0, (say("static bound, from below"), say("{s[lower_bound_g]:.6g} g", s=s)))
    items: list[Item] = [Facts([(name, value) for name, value in pairs if value != n.NONE])]
    items += kept(result.pictures, "limit", say("Mechanism: velocities drawn as displacements."))
    items += kept(result.pictures, "directions", say("The multiplier by the direction in which the forces push."))
    if loaded_links := [link for link in s.get("links", ()) if link.get("force_n")]:
        body = [[Exact(link[key]) if key == "link" else n.plain(link[key]) for key in _LINK] for link in loaded_links]
        items.append(
            Rows(
                list(map(n.named, _LINK)),
                body,
                say("Links that must act: the least force that they hold [N], capacity [N]; the others need not."),
                numbers=True,
            )
        )
    return (sentence, " plain"), items


def _who_moves(s: dict[str, Any]) -> list[tuple[str, str]]:
    """Of an assembly, which bodies the mechanism moves, and where the multiplier is only a bound."""
    if not s.get("moving"):
        return []
    bound = say("only an upper bound: stones slide or round faces twist") if s["upper_bound"] else n.NONE
    return [
        (say("its lowest joint"), joined(" – ", s["between"])),
        (say("bodies that move"), listed(s["moving"])),
        ("multiplier", bound),
    ]


def static_model() -> Section:
    """Assumptions and limits of statics."""
    items: list[Item] = [
        say("Pushover and limit analysis assume:"),
        Points(
            [
                say("Drums are rigid and joints take no tension; friction is Mohr–Coulomb."),
                say("Forces are horizontal, proportional to the masses unless a pattern was given, and steady."),
                say("A column as found is pushed where it is weakest."),
                say(
                    "A circular column is taken by the diameters of its faces; crushing counts only where a strength "
                    "was given."
                ),
                say("Friction in an assembly in space is associated: where it acts, the multiplier is an upper bound."),
            ]
        ),
        say("They end here:"),
        Points(
            [
                say(
                    "The multiplier is where rocking begins, not where an earthquake overturns: for that, run it in "
                    "time."
                ),
                say("Neither size nor duration, frequency or order of the shaking enters."),
            ]
        ),
    ]
    return Section(say("What the analysis assumes, and where it ends"), items)
