"""Is the posterior of past shaking right? Ruins that are made, inferred without their draw; renewed by ``make ruins``."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.stats import chi2

import stylobate as st
from stylobate.campaign.campaign import Campaign
from stylobate_ruins import abc
from stylobate_ruins.answers import FEWEST, UNITS, Answers
from stylobate_ruins.infer import infer
from stylobate_ruins.prior import Prior
from stylobate_ruins.ruin import Fact, Observed, Ruin
from stylobate_ruins.ruin_check import checks_of
from stylobate_ruins.simulations import FELL, TAIL, Simulations, simulations_of

#: Where the figures are kept.
KEPT = Path(__file__).with_name("figures.json")

#: Draws of the table and of that with the prior of the figures by a forest; ruins that are made.
DRAWS, FOREST_DRAWS, RUINS, MORE, OF_KIND = 4000, 1600, 200, 1000, 250

#: Heights, widths below and above [m] and drums of three columns; and of slender ones, of which more fall.
STOUT = {"A": (5.0, 0.80, 0.68, 4), "B": (6.0, 0.90, 0.76, 5), "C": (3.5, 0.60, 0.52, 3)}
SLENDER = {"A": (5.0, 0.60, 0.56, 4), "B": (6.0, 0.72, 0.66, 5), "C": (3.5, 0.42, 0.38, 3)}

#: Errors with which offsets are measured where they are to tell as much as they can [m].
SLIP_SDS = {"1 mm": 1e-3, "exact": 1e-6}

#: Errors of a survey: offsets [m], azimuths of falls and twists [degrees]; the slip up to which it gives a bound alone [m].
OFFSET_SD, TOWARDS_SD, TWIST_SD, BOUND = 0.003, 15.0, 1.0, 0.02

#: Errors of what tells nothing: of offsets [m], of twists [degrees].
UNKNOWN_OFFSET, UNKNOWN_TWIST = 10.0, 1000.0

#: What a survey sees beside states; and ruins of which less is seen, or what tells nothing.
SURVEY = ("offsets", "falls")
KINDS = {
    "states alone": (), "offsets of all joints": ("offsets",), "the offset of one joint": ("an offset",),
    "twists of all joints": ("twists",), "azimuths of falls": ("falls",), "the largest slip": ("the largest",),
    "no slip above 20 mm, or the largest": ("a bound",), "what tells nothing": ("nothing",),
    "one offset, and what tells nothing": ("an offset", "nothing"),
    "all that tells something": ("offsets", "twists", "falls", "a bound"),
}  # fmt: skip


def three_columns(sizes: dict[str, tuple[float, float, float, int]] = STOUT) -> list[st.Column]:
    """Round columns of 5 m, 6 m and 3.5 m, of three to five drums."""
    joint = st.Joint(normal_stiffness=5e9, shear_stiffness=5e9, friction_coefficient=0.67)
    return [
        st.Column.tapered(
            height=height, bottom_width=low, top_width=high, drums=drums, section="circular", density=2600.0, joint=joint,
            name=name,
        )
        for name, (height, low, high, drums) in sizes.items()
    ]  # fmt: skip


#: What shaking may have been: all that is not known is drawn; and as the forest had it, one law without losses.
USUAL = Prior(pgv=(0.1, 1.5), period=(0.3, 1.6))
OF_FOREST = Prior(
    pga=(0.15, 0.8), period=(0.3, 1.6), law=("rim",), stiffness_damping=(0.0,),
    scatter=st.Scatter(0.11, 0.2, 0.02, 0.005, 0.005, 0.0),
)  # fmt: skip


def table_of(prior: Prior, count: int, folder: str | Path | None = None, columns=None) -> Simulations:
    """Table of the columns under a prior."""
    columns = three_columns() if columns is None else columns
    campaign = Campaign(tail=TAIL)
    return simulations_of(columns, prior, st.DistinctElement3D(), count, 1, folder=folder, campaign=campaign)


def seen_of(
    table: Simulations, k: int, stream: np.random.Generator, kinds: Sequence[str] = SURVEY, sd: float = OFFSET_SD
) -> list[Fact]:
    """What a survey sees of draw k: states, and kinds of all else; offsets with a standard deviation [m]."""
    facts = []

    def measured(i: int, kind: str, exact: np.ndarray | float, sd: float, joint: int = 0) -> None:
        seen = exact + sd * stream.standard_normal(np.shape(exact) or 1)
        label = f"{table.final_states[i].name}: {kind} {joint + 1}, {sd:g}"
        facts.append(Fact(i, kind, label, tuple(abs(seen) if kind == "largest" else seen), sd, joint))

    for i, remains in enumerate(table.final_states):
        fell, joints, largest = remains.verdict[k] == FELL, range(remains.slip.shape[1]), float(remains.largest[k])
        facts.append(Fact(i, "state", f"{remains.name} {'fell' if fell else 'stands'}", (float(fell),)))
        if fell:
            if "falls" in kinds:
                measured(i, "fell towards", remains.towards[k], TOWARDS_SD)
            continue
        for j in joints if "offsets" in kinds else joints[1:2] if "an offset" in kinds else ():
            measured(i, "offset", remains.slip[k, j], sd, j)
        for j in joints if "twists" in kinds else ():
            measured(i, "twist", remains.twist[k, j], TWIST_SD, j)
        if "a bound" in kinds and largest <= BOUND:  # a survey that gives the largest slip where it is beyond the bound
            facts.append(Fact(i, "no slip above", f"{remains.name}: no slip above", (BOUND,)))
        elif {"a bound", "the largest"} & set(kinds):
            measured(i, "largest", largest, sd)
        if "nothing" in kinds:
            measured(i, "twist", remains.twist[k, 0], UNKNOWN_TWIST, 0)
            measured(i, "offset", remains.slip[k, 0], UNKNOWN_OFFSET, 0)
    return facts


def calibration(ruins: Simulations, numbers: np.ndarray, table: Simulations, inside: bool, **seen) -> dict:
    """Ranks of what was drawn in its posterior, and how often intervals hold it.

    Parameters
    ----------
    ruins, numbers
        Draws of which ruins are made.
    table : Simulations
        From which they are inferred; where ``inside``, these draws are among its own and left out, twenty together.
    """
    stream, few, wide = np.random.default_rng(11), 0, {name: [] for name in UNITS}
    ranks, around, off, off_ln = ({name: [] for name in UNITS} for _ in range(4))
    sizes = {name: float(np.log(table.parameters[name]).std()) for name in UNITS if name != "azimuth_deg"}
    for block in np.array_split(numbers, max(1, len(numbers) // 20)):
        kept = np.ones(len(table), bool)
        if inside:
            kept[block] = False
        rest = table.subset(np.flatnonzero(kept & table.sound))
        for k in block.tolist():
            if not ruins.sound[k]:
                continue
            answers = Answers(rest, seen_of(ruins, k, stream, **seen), 3)
            if len(answers.matching(answers.facts)) < FEWEST:
                few += 1
                continue
            taken = answers.to(answers.facts)
            for column, (name, scores) in enumerate(answers.scores.items()):
                true = float(np.interp(ruins.parameters[name][k], scores.values, scores.levels))
                rank = float(taken.weights[taken.targets[:, column] < true].sum())
                ranks[name].append(rank)
                around[name].append(rank)
                wide[name].append(abc.spread(taken.targets[:, column], taken.weights))
                middle = float(np.average(taken.targets[:, column], weights=taken.weights))
                off[name].append(true - middle)
                off_ln[name].append(np.log(ruins.parameters[name][k] / scores.value(middle)) / sizes[name])
            angles, turn = answers.azimuths(taken), rest.prior.turn
            true, middle = float(ruins.parameters["azimuth_deg"][k]), abc.middle_direction(angles, taken.weights, turn)
            away = float(abc.apart(true, middle, turn))
            ranks["azimuth_deg"].append(float(taken.weights[angles < true].sum()))
            around["azimuth_deg"].append(float(taken.weights[abc.apart(angles, middle, turn) < away].sum()))
            level = turn / np.sqrt(12.0)
            wide["azimuth_deg"].append(abc.spread_around(angles, taken.weights, turn) / level)
            off["azimuth_deg"].append(away / level)
    statistics: dict = {"ruins": len(ranks["pgv_m_s"]), "too_few_matched": few}
    for name in UNITS:
        rank, beside = np.array(ranks[name]), np.array(around[name])
        counts = np.bincount(np.minimum((10 * rank).astype(int), 9), minlength=10)
        even = len(rank) / 10.0
        statistics[name] = {
            "p_ranks": float(chi2.sf(((counts - even) ** 2 / even).sum(), 9)), "counts": counts.tolist(),
            "cover_50": float(np.mean(np.abs(beside - 0.5) < 0.25)), "cover_90": float(np.mean(np.abs(beside - 0.5) < 0.45)),
            "spread_over_prior": float(np.sqrt(np.mean(np.square(wide[name])))),
            "error_over_prior": float(np.sqrt(np.mean(np.square(off[name])))),
        }  # fmt: skip
        if off_ln[name]:
            statistics[name]["error_of_ln_over_prior"] = float(np.sqrt(np.mean(np.square(off_ln[name]))))
    return statistics


def by_kind(table: Simulations, numbers: np.ndarray) -> dict:
    """How often 90 % intervals hold what was drawn, by what is seen of ruins beside states."""
    results = {}
    for name, kinds in KINDS.items():
        statistics = calibration(table, numbers, table, True, kinds=kinds)
        results[name] = {quantity: statistics[quantity]["cover_90"] for quantity in UNITS}
        results[name] |= {"ruins": statistics["ruins"], "spread_of_pgv": statistics["pgv_m_s"]["spread_over_prior"]}
    return results


def other_law(table: Simulations, count: int) -> dict:
    """Ruins that one law of contact has made, inferred with the other alone."""
    results = {}
    for law, name in enumerate(table.prior.law):
        own = table.parameters["law"] == law
        made = np.flatnonzero(own & table.sound)[:count]
        statistics = calibration(table, made, table.subset(np.flatnonzero(~own)), False)
        results[f"made with {name}"] = {quantity: statistics[quantity]["cover_90"] for quantity in UNITS} | {
            "ruins": statistics["ruins"]
        }
    return results


def moved_by_hand(table: Simulations, count: int = 20) -> dict:
    """How many ruins without an earthquake are flagged: a column taken down, a drum pushed out; and of shaken ones."""
    stream, flags = np.random.default_rng(5), {"taken_down": 0, "pushed_out": 0}
    sound = table.subset(np.flatnonzero(table.sound))
    for number in range(count):
        moved = number % len(sound.final_states)
        for what in flags:
            facts = []
            for i, remains in enumerate(sound.final_states):
                down = what == "taken_down" and i == moved
                facts.append(Fact(i, "state", f"{remains.name} {'fell' if down else 'stands'}", (float(down),)))
                joint = int(stream.integers(remains.slip.shape[1]))
                for j in range(remains.slip.shape[1]) if not down else ():
                    x, y = OFFSET_SD * stream.standard_normal(2)
                    if what == "pushed_out" and i == moved and j == joint:
                        angle, far = stream.uniform(0.0, 2.0 * np.pi), stream.uniform(0.1, 0.25)
                        x, y = x + far * np.cos(angle), y + far * np.sin(angle)
                    facts.append(Fact(i, "offset", f"{remains.name}: joint {j + 1}", (x, y), OFFSET_SD, j))
            flags[what] += flagged(sound, facts)
    alarms = [flagged(sound, seen_of(sound, k, stream)) for k in range(200)]
    return flags | {"of": count, "false_alarms": int(np.sum(alarms)), "of_shaken": len(alarms)}


def flagged(table: Simulations, facts: list[Fact]) -> bool:
    """Whether a ruin is told not to be one of shaking alone: something odd, or nothing in the table that looks like it."""
    answers = Answers(table, facts, 3)
    return not len(answers.matching(facts)) or any(check.odd for check in checks_of(answers, FEWEST))


def what_slips_tell(folder: Path) -> dict:
    """Errors of ln PGV over the prior's spread by states alone and with slips, of stout and of slender columns."""
    results: dict = {}
    for name, sizes in {"stout": STOUT, "slender": SLENDER}.items():
        (folder / name).mkdir(parents=True, exist_ok=True)
        table = table_of(OF_FOREST, FOREST_DRAWS, folder / name, three_columns(sizes))
        numbers = np.random.default_rng(2).permutation(FOREST_DRAWS)
        for label, sd in {"states": None, **SLIP_SDS}.items():
            seen = {"kinds": ()} if sd is None else {"kinds": ("offsets",), "sd": sd}
            statistics = calibration(table, numbers, table, True, **seen)
            results[f"{name}, {label}"] = statistics["pgv_m_s"]["error_of_ln_over_prior"]
        results[f"{name}, ruins"] = statistics["ruins"]
    return results


def quickness(folder: Path) -> dict:
    """Times of an inference of ten thousand draws: the table, by its processor time, and a second question to it."""
    seen = [
        Observed("A", "stands", no_slip_above=0.05),
        Observed("B", "stands"),
        Observed("C", "fell", fell_towards=40.0, towards_sd=TOWARDS_SD),
    ]
    before, began = time.process_time(), time.perf_counter()
    infer(Ruin(three_columns(), seen, USUAL, 10_000, 1), out=folder).summary()
    first, wall = time.process_time() - before, time.perf_counter() - began
    other = [Observed("A", "stands", offsets=[(1, 0.01, 0.0, 0.002)]), *seen[1:]]
    before, began = time.process_time(), time.perf_counter()
    infer(Ruin(three_columns(), other, USUAL, 10_000, 1), out=folder).summary()
    return {
        "draws": 10_000, "first_processor_s": first, "first_wall_s": wall,
        "second_processor_s": time.process_time() - before,
        "second_wall_s": time.perf_counter() - began,
    }  # fmt: skip


def renewed(folder: Path) -> dict:
    """All figures, with tables kept in a folder."""
    for name in ("usual", "long"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    table = table_of(USUAL, DRAWS, folder / "usual")
    numbers = np.random.default_rng(2).permutation(DRAWS)
    return {
        "calibration": calibration(table, numbers[:RUINS], table, True),
        "calibration_of_more": calibration(table, numbers[:MORE], table, True),
        "by_kind": by_kind(table, numbers[:OF_KIND]),
        "other_law": other_law(table, 300),
        "moved_by_hand": moved_by_hand(table),
        "what_slips_tell": what_slips_tell(folder),
        "quickness": quickness(folder / "long"),
    }


def stored() -> dict:
    """Figures as they were last computed."""
    return json.loads(KEPT.read_text())


if __name__ == "__main__":
    place = Path(sys.argv[1] if len(sys.argv) > 1 else "demo/ruins")
    KEPT.write_text(json.dumps(renewed(place), indent=1, sort_keys=True) + "\n")
