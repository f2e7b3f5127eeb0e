"""Many scenes in space at once: turned and renumbered, tumbles, collapses to rest, loads that last; renewed by ``make
populations``."""

import json
import math
import sys
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np

import stylobate as st
from stylobate.column.assembly_files import load_structure
from stylobate.column.catalogue import PAPER
from stylobate.column.shapes import matrix_of
from stylobate.models.engine import engine_for
from stylobate.models.shared.ledger import TERMS, released, unaccounted
from stylobate.models.space import loose as assemblies
from stylobate.models.space.loose import engine_of, step_for

from .plane import GALLERY
from .random_scenes import scene, tumble, turned
from .resting import counted_at_rest, resting

#: What is kept.
FILE = Path(__file__).with_name("populations.json")

#: Decided runs that are turned, tumbles and how long they last [s], and joints: the first of scenes, both of tumbles.
SCENES, TUMBLES, LASTS = 200, 500, 3.0
LAWS = st.Joint(5e9, 2.5e9, 35.0), st.Joint(5e10, 2.5e10, 35.0)

#: How long debris that rolls is waited for [s].
PATIENCE = 8.0

#: Times at which scenes are compared with their twins [s].
TIMES = (0.0, 0.2, 0.4, 0.8)

#: Shares by which the motion of a twin that is neither turned nor renumbered is larger.
NUDGES = (1e-12, 1e-7)

#: Sizes of the motion with which structures of the gallery are thrown over, the first that does it [g].
SIZES = (0.5, 0.8, 1.2, 1.8, 2.7)


def run(stones, motion, name: str) -> st.Response:
    """One run until rest."""
    assembly = st.SpatialAssembly(tuple(stones), LAWS[0], name=name)
    return st.simulate(assembly, motion, st.DistinctElement3D(), until_rest=True)


# -- turned and renumbered -----------------------------------------------------------------------------------------------


def verdict(response: st.Response) -> tuple:
    """Outcome, what fell, what stands displaced."""
    blocks = response.measures.blocks
    assert blocks is not None
    return str(response.measures.outcome), sorted(name for name, _ in blocks.fell_at), sorted(blocks.displaced)


def apart(response: st.Response, other: st.Response, angle: float) -> list[float]:
    """How far the bodies of a scene and of its twin are from one another at some times, at most [m]."""
    axes = matrix_of((math.cos(0.5 * angle), 0.0, 0.0, math.sin(0.5 * angle)))
    numbers = {body.name: i for i, body in enumerate(other.structure.bodies)}
    order = [numbers[body.name] for body in response.structure.bodies]
    last = min(len(response.time), len(other.time)) - 1
    distances = []
    for k in np.minimum(np.searchsorted(response.time, TIMES), last):
        away = other.body_position[k][order] @ axes - response.body_position[k]
        distances.append(float(np.linalg.norm(away, axis=1).max()))
    return distances


def twins(number: int) -> tuple[str, st.Response, dict[str, tuple[st.Response, list[float]]]] | None:
    """Family, run, and twins of the scene of a number with how far they are from it; None if it has no verdict."""
    family, stones, motion = scene(number)
    plain = run(stones, motion, family)
    if not plain.decided:
        return None
    rng = np.random.default_rng([7, number])
    angle, order = rng.uniform(0.0, 2.0 * math.pi), rng.permutation(len(stones))
    others = {"turned": (turned(stones, motion, angle, order), angle)}
    others |= {f"{nudge:g}": ((stones, motion.scaled(1.0 + nudge)), 0.0) for nudge in NUDGES}
    results = {}
    for key, (made, back) in others.items():
        twin = run(*made, family)
        results[key] = twin, apart(plain, twin, back)
    return family, plain, results


def turning() -> Iterator[dict[str, Any]]:
    """Of every decided scene its verdict, and of each twin whether outcome, fallen and displaced are the same."""
    assemblies.LONGEST_WAIT = PATIENCE
    number = decided = 0
    while decided < SCENES:
        made = twins(number)
        number += 1
        if made is None:
            continue
        decided += 1
        family, plain, others = made
        mine = verdict(plain)
        row: dict[str, Any] = {"scene": number - 1, "family": family, "outcome": mine[0], "fallen": len(mine[1])}
        for key, (twin, way) in others.items():
            same = [a == b for a, b in zip(mine, verdict(twin), strict=True)]
            row[key] = {"same": same, "outcome": str(twin.measures.outcome), "apart": [float(f"{x:.2g}") for x in way]}
        yield row


# -- tumbles -------------------------------------------------------------------------------------------------------------


def tumbling() -> Iterator[dict[str, Any]]:
    """Of every tumble of ten bodies what its ledger misses, how deep contacts were, and what free flight lost."""
    model = st.DistinctElement3D()
    for number in range(TUMBLES):
        joint = LAWS[number % len(LAWS)]
        assembly = st.SpatialAssembly(tuple(tumble(number)), joint, name="tumble", settle=False)
        numbers = engine_for(model, assembly).acting
        engine = engine_of(assembly, numbers, 0.3)
        engine.start(step_for(engine, assembly, numbers))
        start, flown = engine.energies(), 0.0
        engine.advance(1)  # velocities are known between steps from here on
        begun, speed, momentum = engine.time, engine.vectors("v"), engine.vectors("l")
        while engine.time < LASTS:
            engine.advance(1)
            if engine.struck_at is None:
                fallen = speed - [0.0, 0.0, assembly.gravity * (engine.time - begun)]
                for now, then in ((engine.vectors("v"), fallen), (engine.vectors("l"), momentum)):
                    flown = max(flown, float((size_of(now - then)[engine.free] / size_of(then)[engine.free]).max()))
        change = engine.energies() - start
        stake = start[1] + released(change)
        yield {
            "stiffness": joint.normal_stiffness,
            "missed": float(change[0] - change[1:].sum()) / stake,
            "deepest": float(engine.now["deepest"][0]),
            "flight": flown,
            "failed": engine.failed,
        }


def size_of(vectors: np.ndarray) -> np.ndarray:
    """Lengths of vectors."""
    return np.linalg.norm(vectors, axis=1)


# -- collapses of the gallery --------------------------------------------------------------------------------------------


def collapsing() -> Iterator[dict[str, Any]]:
    """Of every structure of the gallery and every preset, thrown over and followed until rest, what its ledger misses."""
    for name in (*sorted(GALLERY.glob("*.toml")), *PAPER):
        structure = load_structure(name)
        flat = not isinstance(structure, st.SpatialAssembly)
        model = st.DistinctElement2D() if flat else st.DistinctElement3D()
        for size in SIZES:
            motion = st.sine_pulse(0.8, size * 9.81)
            if not flat:
                motion = st.Motion(motion.dt, motion.acceleration, lateral=0.5 * motion.acceleration)
            response = st.simulate(structure, motion, model, until_rest=True)
            if response.measures.collapsed or response.measures.reason:
                break
        energy = response.histories.energy
        change = np.array([float(energy[name][-1] - energy[name][0]) for name in TERMS])
        blocks = response.measures.blocks
        yield {
            "structure": structure.name,
            "size": size,
            "fallen": len(blocks.fell_at) if blocks is not None else None,
            "missed": unaccounted(change) / max(released(change), 1e-300),
            "deepest": response.provenance.get("deepest_penetration_m"),
            "lasted": float(response.time[-1]),
            "failed": response.measures.reason if response.measures.outcome is st.Outcome.FAILED else "",
        }


#: Populations by name.
POPULATIONS: dict[str, Callable[[], Iterator[dict[str, Any]]]] = {
    "turning": turning,
    "tumbling": tumbling,
    "collapsing": collapsing,
    "resting": resting,
}


def stored() -> dict[str, Any]:
    """What is kept."""
    return json.loads(FILE.read_text(encoding="utf-8"))


def counted(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Twins with another outcome, other fallen or other displaced bodies than their scene, and those that differ."""
    twins_ = [key for key, value in rows[0].items() if isinstance(value, dict)]
    return {
        "drawn": rows[-1]["scene"] + 1,
        "families": {
            family: sum(row["family"] == family for row in rows) for family in dict.fromkeys(r["family"] for r in rows)
        },
        "outcomes": Counter(row["outcome"] for row in rows),
        "twins": {
            key: {
                "other": [sum(not row[key]["same"][k] for row in rows) for k in range(3)],
                "failed": sum(row[key]["outcome"] == "failed" for row in rows),
                "apart": [float(f"{x:.1g}") for x in np.median([row[key]["apart"] for row in rows], axis=0)],
            }
            for key in twins_
        },
        "differing": [row for row in rows if not all(row[key]["same"][0] for key in twins_)],
    }


def spread(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Of tumbles by the stiffness of their contacts, what they miss on average and at most, and the largest of the rest."""
    statistics = {}
    for stiffness in dict.fromkeys(row["stiffness"] for row in rows):
        tumbles = [row for row in rows if row["stiffness"] == stiffness]
        missed = np.array([row["missed"] for row in tumbles])
        statistics[f"{stiffness:g}"] = {
            "tumbles": len(tumbles),
            "failed": sum(row["failed"] for row in tumbles),
            "mean": float(missed.mean()),
            "99 %": float(np.quantile(np.abs(missed), 0.99)),
            "lost": float(missed.max()),
            "gained": float(-missed.min()),
            "deepest": max(row["deepest"] for row in tumbles),
            "flight": max(row["flight"] for row in tumbles),
        }
    return statistics


#: What is kept of a population, where that is not all rows.
KEPT = {"turning": counted, "tumbling": spread, "resting": counted_at_rest}


def renew(*names: str) -> None:
    """Compute some populations, or all, and keep what they come down to."""
    for name in names or POPULATIONS:
        rows = []
        for row in POPULATIONS[name]():
            rows.append(row)
            print(json.dumps(row), flush=True)
        keep(name, rows)


def keep(name: str, rows: list[dict[str, Any]]) -> None:
    """Write what a population comes down to."""
    content = (stored() if FILE.exists() else {}) | {name: KEPT.get(name, list)(rows), "date": date.today().isoformat()}
    FILE.write_text(json.dumps(content, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")


#: Twins of scenes as the page calls them.
TWINS = {"turned": "turned and renumbered", "1e-12": "motion larger by 1e-12", "1e-07": "motion larger by 1e-7"}


def turned_table() -> str:
    """Twins that differ from their scenes, in Markdown."""
    kept = stored()["turning"]
    scenes = sum(kept["families"].values())
    lines = [
        f"| twins of {scenes} scenes | other outcome | other bodies fallen | other ones displaced | no verdict "
        f"| apart, median, after {' / '.join(f'{time:g}' for time in TIMES)} s [m] |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for key, name in TWINS.items():
        counts = kept["twins"][key]
        other, away = (
            " | ".join(map(str, counts["other"])),
            " / ".join(f"{x:.0e}" if x else "0" for x in counts["apart"]),
        )
        lines.append(f"| {name} | {other} | {counts['failed']} | {away} |")
    return "\n".join(lines) + "\n"


def tumbles_table() -> str:
    """What tumbles miss, by the stiffness of their contacts, in Markdown."""
    lines = [
        "| contacts [N/m³] | tumbles | without verdict | lost on average | 99 % miss less than | most lost | most gained "
        "| deepest contact | free flight keeps momenta to |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for stiffness, statistics in stored()["tumbling"].items():
        shares = " | ".join(f"{100.0 * statistics[key]:.2g} %" for key in ("mean", "99 %", "lost", "gained"))
        cells = f"{statistics['tumbles']} | {statistics['failed']} | {shares} | {1000.0 * statistics['deepest']:.0f} mm"
        lines.append(f"| {stiffness} | {cells} | {statistics['flight']:.0e} |")
    return "\n".join(lines) + "\n"


def collapses_table() -> str:
    """What collapses of the gallery miss of what they set free, in Markdown."""
    lines = [
        "| structure | pulse [g] | fallen | missed | deepest contact | followed for |",
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for row in stored()["collapsing"]:
        depth = "" if row["deepest"] is None else f"{1000.0 * row['deepest']:.2g} mm"
        fell = "" if row["fallen"] is None else row["fallen"]
        missed = row["failed"] or f"{100.0 * row['missed']:.2g} %"
        lines.append(f"| {row['structure']} | {row['size']} | {fell} | {missed} | {depth} | {row['lasted']:.3g} s |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    warnings.simplefilter("ignore", st.OutOfRangeWarning)  # what is not in equilibrium as drawn begins as drawn
    renew(*sys.argv[1:])
