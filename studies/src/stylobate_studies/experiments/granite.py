"""Boulders on the shaking table, computed: the choice made beforehand, a grid for calibration, realisations of the rest."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from stylobate.campaign.campaign import Campaign, Progress
from stylobate.campaign.digests import Hasher
from stylobate.campaign.runs import Request, run_all
from stylobate.column.specimen import Specimen
from stylobate.constants import g
from stylobate.models.base import Case
from stylobate.models.dem3d.model import DistinctElement3D
from stylobate.motion import Motion
from stylobate.response import Response
from stylobate.simulate import simulate

from . import choices as c
from . import scores
from .footprint import mean_of, registered, worn
from .granite_files import NAMES, Granite, Test


@dataclass(frozen=True, eq=False)
class Variant:
    """One way to compute all tests of a specimen: its body, the azimuth [rad], the radius of its edges [m]."""

    kind: str
    name: str
    body: Specimen
    azimuth: float = 0.0
    edges: float = 0.0

    @property
    def settings(self) -> dict[str, float]:
        """Friction, restitution, azimuth [°] and the radius to which edges are worn [m]."""
        return {
            "friction": self.body.joint.tan_phi,
            "restitution": self.body.restitution,
            "azimuth_deg": math.degrees(self.azimuth),
            "edges_m": self.edges,
        }


def variants(granite: Granite, realisations: int, calibrate: bool, seed: int = 1) -> list[Variant]:
    """All variants, the choice made beforehand first."""
    names = [name for name in NAMES if name in granite.scans]
    variants = [Variant("fixed", name, granite.scans[name].specimen()) for name in names]
    if calibrate:
        for name, friction, restitution in itertools.product(names, c.FRICTION_GRID, c.RESTITUTION_GRID):
            variants.append(Variant("grid", name, granite.scans[name].specimen(friction, restitution)))
        for name, radius in itertools.product(names, c.EDGES):
            body = worn(granite.scans[name], radius).specimen(like=variants[names.index(name)].body)
            variants.append(Variant("edges", name, body, edges=radius))
    for name in names:
        rng = np.random.default_rng((seed, NAMES.index(name)))
        mine = granite.scans[name]
        scans = [mine, *(registered(scan, mine) for scan in granite.scans.values() if scan is not mine)] * (
            realisations > 0
        )
        for _ in range(realisations):
            friction, restitution = rng.uniform(*c.FRICTIONS), rng.uniform(*c.RESTITUTIONS)
            azimuth = rng.uniform(-c.AZIMUTH, c.AZIMUTH)
            mean = mean_of(scans, rng.dirichlet(np.ones(len(scans))).tolist())
            body = mean.specimen(friction, restitution, like=variants[names.index(name)].body)
            variants.append(Variant("realisation", name, body, azimuth))
    return variants


def motion_of(test: Test, azimuth: float) -> Motion:
    """The part of a table motion in which something happens, in the axes of the scan."""
    a, name = test.acceleration, f"test {test.number}"
    if azimuth == 0.0:
        return Motion(test.dt, a, name=name)
    return Motion(test.dt, math.cos(azimuth) * a, ay=math.sin(azimuth) * a, name=name)


def again(granite: Granite, name: str, number: int, interval: float = 0.05) -> Response:
    """A test of a specimen as fixed beforehand, with a state every so many seconds."""
    test = next(candidate for candidate in granite.tests if candidate.number == number)
    body = granite.scans[name].specimen()
    return simulate(body, motion_of(test, 0.0), DistinctElement3D(), output_interval=interval)


def run(
    granite: Granite,
    variants: list[Variant],
    *,
    threads: int | None = None,
    progress: Progress | None = None,
    ledger: Path | None = None,
) -> Any:
    """One row per variant and test; resumes from its ledger.

    Raises
    ------
    Stopped
        It was interrupted; what is finished is in the ledger.
    """
    import pandas

    motions: dict[tuple[int, float], Motion] = {}
    pairs = [(v, test) for v in range(len(variants)) for test in granite.tests]
    for v, test in pairs:
        key = (test.number, variants[v].azimuth)
        if key not in motions:
            motions[key] = motion_of(test, variants[v].azimuth)
    cases = [Case(variants[v].body, motions[test.number, variants[v].azimuth]) for v, test in pairs]
    made = run_all(
        Request.of(cases, Hasher(DistinctElement3D())), Campaign(threads=threads, progress=progress, ledger=ledger)
    )
    rows = []
    for (v, test), row in zip(pairs, made):
        assert row is not None
        rows.append(
            {"variant": v, "kind": variants[v].kind, "specimen": variants[v].name, "test": test.number} | _kept(row)
        )
    return pandas.DataFrame(rows)


def _kept(row: dict[str, Any]) -> dict[str, Any]:
    return {
        "toppled": row["outcome"] == "collapsed",
        "failed": row["outcome"] == "failed",
        "decided": bool(row["decided"]),
        "peak_tilt_deg": math.degrees(row["peak_tilt_rad"] or 0.0),
        "energy_imbalance": row["energy_imbalance"],
    }


def tests_table(granite: Granite, runs: Any) -> Any:
    """One row per specimen and test: what was measured, what is computed, and with what probability."""
    import pandas

    rows = []
    for name in [specimen for specimen in NAMES if specimen in granite.scans]:
        mine = runs[runs["specimen"] == name]
        fixed = mine[mine["kind"] == "fixed"].set_index("test")
        chance = mine[mine["kind"] == "realisation"].groupby("test")["toppled"].mean()
        for test in granite.tests:
            outcome: Any = fixed.loc[test.number]
            rows.append(
                {
                    "specimen": name,
                    "test": test.number,
                    "record": test.record,
                    "pga_g": test.facts["pga_g"],
                    "pga_10hz_g": test.facts["pga_10hz_g"],
                    "pgv_m_s": test.facts["pgv_ms"],
                    "hard": bool(c.HARD <= test.logit[name] <= 1.0 - c.HARD),
                    "observed": test.toppled[name],
                    "computed": bool(outcome["toppled"]),
                    "decided": bool(outcome["decided"]),
                    "peak_tilt_deg": float(outcome["peak_tilt_deg"]),
                    "energy_imbalance": float(outcome["energy_imbalance"]),
                    "probability": float(chance[test.number]) if len(chance) else math.nan,
                    "logit": test.logit[name],
                }
            )
    return pandas.DataFrame(rows)


def summary(granite: Granite, table: Any, realisations: int) -> dict[str, Any]:
    """Scores of each specimen."""
    out: dict[str, Any] = {}
    for name, rows in table.groupby("specimen"):
        chance = rows["probability"].to_numpy() if realisations else None
        observed, computed, hard = (rows[key].to_numpy(dtype=bool) for key in ("observed", "computed", "hard"))
        result = scores.score(observed, computed, hard, chance)
        result["undecided"] = int((~rows["decided"]).sum())
        result["fragility_pgv_m_s"] = {
            key: scores.with_interval(rows["pgv_m_s"].to_numpy(), rows[key].to_numpy(dtype=bool))
            for key in ("observed", "computed")
        }
        out[str(name)] = result
    return out


def half_table(table: Any) -> Any:
    """See :func:`stylobate_studies.experiments.scores.half_toppled`; for both specimens."""
    import pandas

    rows = []
    for name, tests in table.groupby("specimen"):
        pgv = tests["pgv_m_s"].to_numpy()
        ratio = pgv / (g * tests["pga_10hz_g"].to_numpy())
        verdicts = (tests[key].to_numpy(dtype=bool) for key in ("observed", "computed"))
        rows += [{"specimen": name} | row for row in scores.half_toppled(pgv, ratio, *verdicts)]
    return pandas.DataFrame(rows)


def calibration(granite: Granite, variants: list[Variant], runs: Any) -> list[dict[str, Any]]:
    """Friction and restitution, and the radius of edges, that do best on one specimen, and how they do on the other."""
    observed = {name: np.array([test.toppled[name] for test in granite.tests]) for name in NAMES}
    hard = {name: np.array([c.HARD <= t.logit[name] <= 1.0 - c.HARD for t in granite.tests]) for name in NAMES}
    computed = {v: runs.loc[runs["variant"] == v, "toppled"].to_numpy(dtype=bool) for v in range(len(variants))}
    rows = []
    for kind, name in itertools.product(("grid", "edges"), NAMES):
        mine = [(v, variant) for v, variant in enumerate(variants) if (variant.kind, variant.name) == (kind, name)]
        if not mine:
            continue
        best, chosen = max(mine, key=lambda pair: scores.matthews(observed[name], computed[pair[0]]))
        row = {"calibrated_on": name, **{k: x for k, x in chosen.settings.items() if k != "azimuth_deg"}}
        row["accuracy_there"] = float((observed[name] == computed[best]).mean())
        for v, variant in enumerate(variants):
            if variant.kind == kind and variant.name != name and variant.settings == chosen.settings:
                right = observed[variant.name] == computed[v]
                row |= {"tested_on": variant.name, "accuracy": float(right.mean())}
                row["hard_accuracy"] = float(right[hard[variant.name]].mean())
                row["predicted_over_observed"] = float(computed[v].sum() / max(1, observed[variant.name].sum()))
        rows.append(row)
    return rows


def worst(table: Any, count: int = 10) -> Any:
    """The tests in which the computed verdict is wrong and was least to be expected.

    By the computed probability where there is one, else by the logistic fit of the data set.
    """
    wrong = table[table["observed"] != table["computed"]].copy()
    chance = wrong["probability"].where(wrong["probability"].notna(), wrong["logit"])
    if table["probability"].notna().any():
        wrong["surprise"] = (chance - wrong["observed"]).abs()
    else:
        wrong["surprise"] = (wrong["computed"].astype(float) - chance).abs()
    return wrong.sort_values(["surprise", "specimen", "test"], ascending=[False, True, True]).head(count)
