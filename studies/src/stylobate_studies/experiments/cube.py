"""Tosses of a cube, computed from their initial state: errors after each impact and at rest, face on which it rests."""

from __future__ import annotations

import hashlib
import itertools
import math
from collections.abc import Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.campaign.campaign import Campaign, Progress
from stylobate.campaign.digests import Digests, Hasher
from stylobate.campaign.runs import Request, Runs, Stopped
from stylobate.constants import g
from stylobate.models.base import Case
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.models.start import Toss
from stylobate.motion import Motion
from stylobate.response.poses import rotation_matrices
from stylobate.simulate import run_options, simulate, thread_count

from .cube_files import HALF, Recorded, cube

#: Change of velocity between two frames, beyond gravity, that is an impact [m/s]; frames that belong to one; frames from
#: an impact to where errors are taken.
STRIKES, TOGETHER, LATER = 0.25, 3, 3

#: The computed cube may come to rest so much later [s].
LONGER = 0.5

#: Names of the instants at which errors are taken.
WHEN = ("first impact", "second impact", "third impact", "rest")

#: A quarter of the usual step: an impact of one vertex at a restitution of 0.1 loses its last tenth in a few steps.
MODEL = DistinctElement3D(step_factor=0.1)


def impacts(toss: Recorded) -> list[int]:
    """Frames at which impacts begin, from jumps of the measured velocity."""
    velocity = np.diff(toss.position, axis=0) / toss.dt
    jump = np.diff(velocity, axis=0)
    jump[:, 2] += g * toss.dt
    strong = np.flatnonzero(np.linalg.norm(jump, axis=1) > STRIKES)
    return [int(k) for n, k in enumerate(strong) if n == 0 or k - strong[n - 1] > TOGETHER]


def start_of(toss: Recorded, first: int) -> Toss:
    """The state at the first frame, from the free flight before the first impact: least squares of a parabola, mean spin."""
    n = max(3, first + 1)
    t = np.arange(n) * toss.dt
    fallen = toss.position[:n] + 0.5 * g * t[:, None] ** 2 * (0.0, 0.0, 1.0)
    (velocity, position), *_ = np.linalg.lstsq(np.stack((t, np.ones(n)), axis=1), fallen, rcond=None)
    turns = rotation_matrices(toss.orientation[:n])
    spin = np.mean([vector_of(turns[k + 1] @ turns[k].T) for k in range(n - 1)], axis=0) / toss.dt
    return Toss(tuple(position), tuple(toss.orientation[0]), tuple(velocity), tuple(spin))


def vector_of(turn: np.ndarray) -> np.ndarray:
    """Rotation vector of a matrix [rad], for turns of less than a half."""
    skew = 0.5 * np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    sine = float(np.linalg.norm(skew))
    angle = math.atan2(sine, 0.5 * (float(np.trace(turn)) - 1.0))
    return skew * (angle / sine if sine > 1e-12 else 1.0)


def face_down(turn: np.ndarray) -> int:
    """Which of the six faces is lowest: ±1, ±2, ±3 for the axes of the body."""
    axis = int(np.argmax(np.abs(turn[2])))
    return int(-np.sign(turn[2, axis])) * (axis + 1)


def at(when: float, time: np.ndarray, position: np.ndarray, turns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Position and orientation at a time between two states: along the straight line, and about the axis between them."""
    i = min(max(int(np.searchsorted(time, when)) - 1, 0), len(time) - 2)
    share = (when - time[i]) / (time[i + 1] - time[i])
    vector = share * vector_of(turns[i + 1] @ turns[i].T)
    angle = float(np.linalg.norm(vector))
    x, y, z = vector / angle if angle > 1e-12 else vector
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turn = np.eye(3) + math.sin(angle) * skew + (1.0 - math.cos(angle)) * skew @ skew
    return position[i] + share * (position[i + 1] - position[i]), turn @ turns[i]


def still(toss: Recorded) -> Motion:
    """Ground at rest for as long as a toss was filmed."""
    return Motion((len(toss.position) - 1) * toss.dt, np.zeros(2))


def compare(toss: Recorded, friction: float, restitution: float) -> dict[str, Any]:
    """Errors of one toss at each of :data:`WHEN`: position [widths of the cube], rotation [°]; face at rest right or not."""
    impact_frames = impacts(toss)
    first = impact_frames[0] if impact_frames else len(toss.position) - 1
    frames = len(toss.position) - 1
    response = simulate(
        cube(friction, restitution),
        still(toss),
        MODEL,
        start=start_of(toss, first),
        tail=LONGER,
        until_end=True,
        output_interval=0.25 * toss.dt,
    )
    time, position = response.time, response.body_position[:, 0]
    turns, measured = rotation_matrices(response.body_orientation[:, 0]), rotation_matrices(toss.orientation)
    row: dict[str, Any] = {
        "toss": toss.name,
        "impacts": len(impact_frames),
        "energy_imbalance": response.energy_imbalance,
    }
    instants = [min(k + 1 + LATER, frames) for k in impact_frames[:3]] + [frames]
    for when, k in zip([*WHEN[: len(impact_frames[:3])], WHEN[3]], instants):
        there, turn = (position[-1], turns[-1]) if when == WHEN[3] else at(k * toss.dt, time, position, turns)
        row[f"{when}: position [widths]"] = float(np.linalg.norm(there - toss.position[k])) / (2.0 * HALF)
        row[f"{when}: rotation [deg]"] = math.degrees(float(np.linalg.norm(vector_of(turn @ measured[k].T))))
    row["rest face right"] = face_down(turns[-1]) == face_down(measured[-1])
    return row


def facts(toss: Recorded) -> list[Any]:
    """Marks of a recorded toss among others, as plain values."""
    states = hashlib.sha256(toss.position.tobytes() + toss.orientation.tobytes()).hexdigest()
    return [toss.name, toss.dt, len(toss.position), states]


def run(
    tosses: Sequence[Recorded],
    settings: Sequence[tuple[float, float]],
    *,
    threads: int | None = None,
    progress: Progress | None = None,
    ledger: Path | None = None,
) -> list[Any]:
    """All tosses with each pair of friction and restitution, one table each; resumes from its ledger.

    Raises
    ------
    Stopped
        It was interrupted; what is finished is in the ledger.
    """
    import pandas

    todo = list(itertools.product(range(len(settings)), range(len(tosses))))
    rows: dict[int, dict] = {}
    options = run_options(LONGER)
    hasher, recorded = Hasher(MODEL, options), [facts(toss) for toss in tosses]
    each = [hasher.of_product([cube(*settings[s]).digest, recorded[t]], __file__) for s, t in todo]

    def make(number: int) -> dict[str, Any]:
        setting, toss = todo[number]
        return compare(tosses[toss], *settings[setting])

    cases = [Case(cube(*settings[s]), still(tosses[t])) for s, t in todo]
    request = Request(cases, Digests.of(each), [(np.arange(len(todo)), MODEL, options)])
    count = thread_count(threads)
    try:
        with closing(Runs(Campaign(ledger=ledger))) as runs, closing(runs.products(request, make, count)) as finished:
            for number, row in finished:
                rows[number] = row
                if progress:
                    progress(len(rows), len(todo))
    except KeyboardInterrupt:
        raise Stopped(len(rows), len(todo), ledger) from None
    n = len(tosses)
    return [pandas.DataFrame([rows[s * n + i] for i in range(n)]) for s in range(len(settings))]


def scores(table: Any) -> dict[str, Any]:
    """Medians of the errors and the share of right faces."""
    after = {}
    for when in WHEN:
        errors = [table.get(f"{when}: {what}") for what in ("position [widths]", "rotation [deg]")]
        if errors[0] is None or errors[1] is None:
            continue
        after[when] = {
            "tosses": int(errors[0].notna().sum()),
            "position_error_widths": float(errors[0].median()),
            "position_error_widths_90": float(errors[0].quantile(0.9)),
            "rotation_error_deg": float(errors[1].median()),
            "rotation_error_deg_90": float(errors[1].quantile(0.9)),
        }
    return {
        "tosses": len(table),
        "rest_face_accuracy": float(table["rest face right"].mean()),
        "position_error_widths": after["rest"]["position_error_widths"],
        "rotation_error_deg": after["rest"]["rotation_error_deg"],
        "after": after,
    }


def badness(table: Any) -> float:
    """Aim of a calibration: the mean over tosses of the position errors after impacts and at rest [widths]."""
    columns = [f"{when}: position [widths]" for when in WHEN if f"{when}: position [widths]" in table]
    return float(np.nanmean(table[columns].to_numpy(dtype=float)))
