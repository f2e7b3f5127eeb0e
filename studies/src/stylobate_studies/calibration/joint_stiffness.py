"""What the stiffness of joints changes: shares of collapse, single verdicts, peaks and slips of four columns.

``python -m stylobate_studies.calibration.joint_stiffness`` takes some minutes and prints the table of the page on
measured columns.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

import stylobate as st
from stylobate.models.base import Case, Model, RunOptions
from stylobate.response.measures import Measures
from stylobate.simulate import run_checked

#: Stiffnesses k_n of all joints [N/m³]; k_s is half of it. The one that others are compared with.
STIFFNESSES, COMPARED = (1e9, 3e9, 1e10, 5e10, 2e11), 5e10

#: Columns, and the laws of contact in space that their section has.
COLUMNS = {
    "paper-12-drums": ("corners",),
    "sounion": ("rim", "bed"),
    "parthenon": ("rim", "bed"),
    "marcus-aurelius": ("rim", "bed"),
}

#: Periods of the pulses over 2π √(4R/3g), of the column as one body [-]; how many amplitudes there are, between these over
#: the acceleration that rocks it as one rigid body [-].
PERIODS, AMPLITUDES, BETWEEN = (0.15, 0.3, 0.6), 8, (1.0, 8.0)


@dataclass(frozen=True)
class Row:
    """One stiffness of one column and model, beside 5e10 N/m³.

    Parameters
    ----------
    runs, collapsed, failed, changed : int
        Runs, those that collapse, those that fail, and those whose verdict differs.
    first : float
        Geometric mean over the periods of the lowest amplitude of collapse over that on joints of 5e10 N/m³ [-].
    peak, slip : float
        Median ratios of the peak displacement of the top and of the largest residual slip, where it stands on both [-].
    """

    column: str
    model: str
    stiffness: float
    runs: int
    collapsed: int
    failed: int
    changed: int
    first: float
    peak: float
    slip: float

    def line(self) -> str:
        """As a line of the table."""
        ratios = " | ".join("–" if np.isnan(ratio) else f"{ratio:.2f}" for ratio in (self.first, self.peak, self.slip))
        failed = f", {self.failed} failed" * bool(self.failed)
        return (
            f"| {self.column} | {self.model} | {self.stiffness:.0e} | {self.collapsed} of {self.runs}{failed} | "
            f"{self.changed} | {ratios} |"
        )


def pulses(column: st.Column) -> list[list[st.Motion]]:
    """Ricker pulses of each period by rising amplitude."""
    radius = float(np.hypot(0.5 * column.base_width, column.centroid_height))
    slowest = 2.0 * np.pi * np.sqrt(4.0 * radius / (3.0 * column.gravity))
    opens = column.gravity * 0.5 * column.base_width / column.centroid_height
    sizes = opens * np.geomspace(*BETWEEN, AMPLITUDES)
    return [[st.ricker(1.0 / (share * slowest), float(a)) for a in sizes] for share in PERIODS]


def verdicts(column: st.Column, model: Model) -> list[Measures]:
    """Measures under all pulses, gone on with until they are decided."""
    cases = [Case(column, motion) for motions in pulses(column) for motion in motions]
    return [measures for _, measures in sorted(run_checked(cases, model, RunOptions(until_decided=True), None))]


def rows() -> Iterator[Row]:
    """The table, line by line: of the plane, then of each law in space."""
    for name in COLUMNS:
        yield from of_model(name, "plane", st.DistinctElement2D())
    for name, laws in COLUMNS.items():
        for law in laws:
            model = st.DistinctElement3D() if law == "corners" else st.DistinctElement3D(law=law)
            yield from of_model(name, f"space, {law}", model)


def of_model(name: str, called: str, model: Model) -> Iterator[Row]:
    """Lines of one column and one model."""
    column = st.preset(name)
    measures = {}
    for k in STIFFNESSES:
        joints = tuple(joint.changed(normal_stiffness=k, shear_stiffness=0.5 * k) for joint in column.joints)
        measures[k] = verdicts(column.unwarned(joints=joints), model)
    for k in STIFFNESSES:
        yield compared(name, called, k, measures[k], measures[COMPARED])


def compared(column: str, model: str, stiffness: float, soft: list[Measures], usual: list[Measures]) -> Row:
    """A line of the table."""
    fell, before = (np.array([run.collapsed for run in runs]) for runs in (soft, usual))
    both = [(run, other) for run, other in zip(soft, usual, strict=True) if not (run.collapsed or other.collapsed)]
    first = [lowest(fell, i) - lowest(before, i) for i in range(len(PERIODS))]
    step = np.log(BETWEEN[1] / BETWEEN[0]) / (AMPLITUDES - 1)
    return Row(
        column,
        model,
        stiffness,
        len(soft),
        int(fell.sum()),
        sum(run.outcome is st.Outcome.FAILED for run in soft),
        int((fell != before).sum()),
        float(np.exp(step * np.mean(first))),
        ratio([(run.peak_top_displacement, other.peak_top_displacement) for run, other in both]),
        ratio([(run.residual_joint_slip, other.residual_joint_slip) for run, other in both]),
    )


def lowest(fell: np.ndarray, period: int) -> float:
    """Place of the lowest amplitude of a period that fells the column; one beyond the last where none does."""
    own = fell[period * AMPLITUDES : (period + 1) * AMPLITUDES]
    return float(np.argmax(own)) if own.any() else float(AMPLITUDES)


def ratio(pairs: list[tuple[float, float]]) -> float:
    """Median of ratios of what is not next to nothing (0.1 mm) on either joints; none of fewer than five."""
    ratios = [value / other for value, other in pairs if min(value, other) > 1e-4]
    return float(np.median(ratios)) if len(ratios) >= 5 else float("nan")


if __name__ == "__main__":
    sys.stdout.write("| column | model | k_n [N/m³] | collapse | other verdicts | first collapse | peak | slip |\n")
    for row in rows():
        sys.stdout.write(row.line() + "\n")
        sys.stdout.flush()
