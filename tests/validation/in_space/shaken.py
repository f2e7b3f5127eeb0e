"""Round columns shaken from two sides, as shares of collapse and medians: what a law of friction changes for users."""

import json
import sys
from collections.abc import Iterator
from typing import Any

import numpy as np

import stylobate as st

COLUMNS, MOTIONS = 40, 8


def column(rng) -> st.Column:
    """A round column of one to three drums."""
    wide = rng.uniform(0.6, 1.6)
    return st.Column.tapered(
        height=wide * rng.uniform(3.5, 7.0), bottom_width=wide, top_width=wide * rng.uniform(0.75, 1.0), density=2500.0,
        drums=int(rng.choice([1, 1, 2, 3])), section="circular", name="column",
        joint=st.Joint(5e9, 2.5e9, friction_coefficient=0.7),
    )  # fmt: skip


def motion(rng) -> st.Motion:
    """Noise of 0.3 to 5 Hz within eight seconds, a pulse of 0.5 to 1.5 Hz in it, 0.2 to 0.7 g, along and across."""
    time = np.arange(0.0, 10.0, 0.01)
    envelope = np.sin(np.pi * np.clip(time / 8.0, 0.0, 1.0)) ** 2
    parts = []
    for share in (1.0, rng.uniform(0.2, 0.9)):
        rates, phases = rng.uniform(0.3, 5.0, 30), rng.uniform(0.0, 2.0 * np.pi, 31)
        noise = np.sin(2.0 * np.pi * np.outer(time, rates) + phases[:30]).sum(axis=1) / 30.0**0.5
        pulse = np.sin(2.0 * np.pi * rng.uniform(0.5, 1.5) * time + phases[30]) * np.exp(-(((time - 4.0) / 1.5) ** 2))
        parts.append(share * (envelope * noise + pulse))
    size = rng.uniform(0.2, 0.7) * st.g / np.abs(parts[0]).max()
    return st.Motion(0.01, size * parts[0], lateral=size * parts[1])


def shaken() -> Iterator[dict[str, Any]]:
    """Every column under all motions, undamped and with losses of stone."""
    motions = [motion(np.random.default_rng([51, k])) for k in range(MOTIONS)]
    for number in range(COLUMNS):
        for losses in ("none", "stone"):
            table = st.simulate_many(
                column(np.random.default_rng([50, number])),
                motions,
                st.DistinctElement3D(losses=losses),
                tail=6.0,
                threads=1,
            )
            for fell, peak, rest, slip in zip(
                table["collapsed"], table["peak_top_displacement_m"], table["residual_top_displacement_m"],
                table["residual_joint_slip_m"], strict=True,
            ):  # fmt: skip
                yield {
                    "losses": losses,
                    "fell": bool(fell),
                    "peak": float(peak),
                    "residual": float(rest),
                    "slip": float(slip),
                }


def shares(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """Runs, those that collapsed, and medians of those that stand [m], by losses."""
    kinds = {}
    for losses in ("none", "stone"):
        runs = [row for row in rows if row["losses"] == losses]
        stand = [row for row in runs if not row["fell"]]
        medians = {key: float(np.nanmedian([row[key] for row in stand])) for key in ("peak", "residual", "slip")}
        kinds[losses] = {"runs": len(runs), "fell": len(runs) - len(stand)} | medians
    return kinds


if __name__ == "__main__":
    print(json.dumps(shares(list(shaken())), indent=1), file=sys.stdout)
