"""A study as data: columns × motions × levels × models × realisations; every case has a digest of what decides it."""

from __future__ import annotations

import io
import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..atomic import replacing
from ..column.structure import Structure
from ..errors import InputError, check_all, check_choice, check_range
from ..models.base import Case, Cases, Model
from ..models.shared.ground import share_of
from ..motion import Motion
from ..motion.conditioning import warn_of_scaling
from ..motion.intensity import IntensityMeasure, measures_by_column, parse_measure, powers_by_column
from ..motion.orientation import record_of
from ..motion.sequence import spans_of
from ..response.rows import Rows
from ..version import __version__
from .campaign import COMPUTING, Campaign
from .digests import LENGTH, Digests, Hasher, samples_of
from .runs import Group, Request, finished_rows
from .twins import LAW, Twins, the_twins

if TYPE_CHECKING:
    import pandas

#: Most cases of a study.
MAX_CASES = 20_000_000


#: Measures of a motion that relate it to the slenderness of a column.
RELATIVE = ("pga_over_g_tan_alpha", "omega_g_over_p", "uniform_duration_s", "pgv_p_over_g_tan_alpha")

#: Runs that are kept besides the table, the worst and the median run.
KEEP = ("rows", "histories")


@dataclass(frozen=True, eq=False, init=False)
class Study:
    """Columns × motions × levels × models × realisations.

    Parameters
    ----------
    columns : sequence of Column or Assembly
    motions : sequence of Motion
        Already turned and reversed as they are to act (:meth:`stylobate.MotionRequest.expand`).
    models : sequence of Model
    levels : sequence of float
        Of ``im`` in its unit (pga and sa in g, pgv in m/s), to each of which every motion is scaled; factors of the
        motions without ``im``.
    im : IntensityMeasure or str, optional
        Such as ``pga``; see :func:`stylobate.motion.intensity.parse_measure`.
    keep : {"rows", "histories"}
        ``histories`` keeps a file of histories per case, not only of the worst and the median one.
    campaign, **settings : Campaign, optional
        With replicates, twins of each column are run instead of the column itself.

    Raises
    ------
    InputError
        Nothing to run, too much of it, a level that a motion cannot be scaled to.

    Warns
    -----
    OutOfRangeWarning
        A level that takes a factor above 10 of a record.
    """

    columns: Sequence[Any]
    motions: Sequence[Motion]
    models: Sequence[Model]
    levels: Sequence[float]
    im: IntensityMeasure | None
    campaign: Campaign
    keep: str
    factors: np.ndarray = field(repr=False)

    def __init__(
        self,
        columns: Sequence[Any],
        motions: Sequence[Motion],
        models: Sequence[Model],
        levels: Sequence[float] = (1.0,),
        im: IntensityMeasure | str | None = None,
        *,
        keep: str = "rows",
        campaign: Campaign | None = None,
        **settings: Any,
    ) -> None:
        campaign = Campaign.of("Study", campaign, settings, COMPUTING)
        im = parse_measure(im) if isinstance(im, str) else im
        given = {"columns": columns, "motions": motions, "models": models, "levels": levels}
        for name, value in (given | {"im": im, "campaign": campaign, "keep": keep}).items():
            object.__setattr__(self, name, value)
        for name, what, kind in (
            ("columns", "column", Structure), ("motions", "record", Motion), ("models", "model", Model),
            ("levels", "level", Real),
        ):  # fmt: skip
            object.__setattr__(self, name, tuple(check_all(name, getattr(self, name), kind)))
            if not getattr(self, name):
                raise InputError(f"the study names no {what}; give at least one.")
        names = [column.name for column in self.columns]
        if len(set(names)) < len(names):
            raise InputError(f"two columns have the same name ({', '.join(names)}); give each a name of its own.")
        must_be_alike(self.columns, "study")
        without = next((column for column in self.columns if not (column.stack or column).scattered), None)
        if campaign.replicates and without is not None:
            raise InputError(
                f"{without.name!r} is {without.described}, and only columns and assemblies in space have realisations; "
                "leave [scatter] out."
            )
        check_choice("keep", self.keep, KEEP)
        for level in self.levels:
            check_range("one of the levels", level, 0.0, 1e6, open_low=True, field="levels")
        if self.size > MAX_CASES:
            raise InputError(f"the study has {self.size} cases; allowed is up to {MAX_CASES}: give fewer.")
        if self.im is not None:
            self.im.warn_of_drift(self.motions)
        object.__setattr__(self, "factors", np.array([self._factors(motion) for motion in self.motions]))

    @property
    def shape(self) -> tuple[int, int, int, int, int]:
        """Numbers of models, columns, motions, levels and realisations (1 without scatter)."""
        axes = (self.models, self.columns, self.motions, self.levels)
        models, columns, motions, levels = map(len, axes)
        return models, columns, motions, levels, max(1, self.campaign.replicates)

    @property
    def size(self) -> int:
        """Number of cases."""
        return int(np.prod([float(count) for count in self.shape]))

    def case(self, number: int) -> Case:
        """A case by its number; its model is ``models[number // (size // len(models))]``."""
        model, column, motion, level, realisation = (int(index) for index in np.unravel_index(number, self.shape))
        stands = self.stands[model][column][realisation]
        return Case(stands, self.motions[motion].scaled(float(self.factors[motion, level])))

    def model_of(self, number: int) -> Model:
        """The model of a case."""
        return self.models[number // (self.size // len(self.models))]

    @cached_property
    def stands(self) -> list[list[Sequence[Any]]]:
        """The columns as they stand: by model, column and realisation."""
        if not self.campaign.replicates:
            return [[[column] for column in self.columns] for _ in self.models]
        return [[twins.columns for twins in of_model] for of_model in self.twins]

    @cached_property
    def twins(self) -> list[list[Twins]]:
        """Twins by model and column; none without replicates."""
        models = self.models if self.campaign.replicates else ()
        return [[the_twins(column, model, self.campaign) for column in self.columns] for model in models]

    @property
    def of_one_law(self) -> list[Model]:
        """Models in which not all columns vary by the law of their joints, so that doubts about it stand."""
        vary = [all(twins.groups for twins in of_model) for of_model in self.twins] or [False] * len(self.models)
        return [model for model, does in zip(self.models, vary, strict=True) if not does]

    @cached_property
    def quiet(self) -> np.ndarray:
        """Share below which each motion counts as quiet [-], shape (motions,)."""
        return np.array([share_of(motion, self.campaign.whole) for motion in self.motions])

    def plan(self) -> Plan:
        """Runs, as plain data with the digest of every case."""
        sizes = self.factors * np.array([[motion.factor] for motion in self.motions])
        each = list(zip(self.motions, sizes.tolist(), self.quiet.tolist(), strict=True))
        digests = np.empty((self.size, LENGTH), dtype=np.uint8)
        number = 0
        for model, columns in zip(self.models, self.stands, strict=True):
            hasher = Hasher(model, self.campaign.options)
            ends = [[hasher.of_motion(motion, size, quiet) for size in row] for motion, row, quiet in each]
            for realisations in columns:
                starts = [hasher.of_column(column) for column in realisations]
                for motion in ends:
                    for end in motion:
                        for start in starts:
                            digests[number] = np.frombuffer(Hasher.ended(start, end), np.uint8)
                            number += 1
        return Plan(self._axes(), Digests(digests))

    def request(self, plan: Plan) -> Request:
        """All cases, as the plan of this study tells them."""
        return Request(Cases(len(plan), self.case), plan.digests, list(self._groups()))

    def _groups(self) -> Iterator[Group]:
        """Cases that run together: of one model and one share of quiet."""
        each = self.size // len(self.models)
        motion = np.arange(each) // (self.shape[3] * self.shape[4]) % self.shape[2]
        for place, model in enumerate(self.models):
            for quiet in sorted(set(self.quiet.tolist())):
                numbers = place * each + np.flatnonzero(self.quiet[motion] == quiet)
                yield numbers, model, replace(self.campaign.options, quiet=quiet)

    def _axes(self) -> dict[str, Any]:
        def entry_of(motion: Motion) -> dict[str, Any]:
            direction = motion.metadata.get("direction") or {}
            known = (motion.metadata.get("azimuths") or {}).get("x")
            return {
                "record": record_of(motion),
                "motion": motion.name,
                "azimuth_deg": direction.get("azimuth", known),
                "reversed": bool(direction.get("reversed", False)),
                "begins_s": [span.begins for span in spans_of(motion)],
            }

        number, sizes = self.campaign.replicates, self.campaign.scatter
        scatter = sizes.given if sizes is not None and number else None
        if number and sizes is None:  # by material, and in space by the laws of joints
            usual = {
                f"{column.name}, {model.name}": twins.scatter.given
                for model, twins_by_column in zip(self.models, self.twins, strict=True)
                for column, twins in zip(self.columns, twins_by_column, strict=True)
            }
            same = len({str(spreads) for spreads in usual.values()}) == 1
            scatter = next(iter(usual.values())) if same else usual
        return {
            "models": [{"model": model.name, "parameters": model.parameters()} for model in self.models],
            "columns": [{"column": column.name, **column.widths} for column in self.columns],
            "motions": [entry_of(motion) for motion in self.motions],
            "intensities": self._intensities(),
            "powers": powers_by_column(),
            "measure": "factor" if self.im is None else self.im.name,
            "unit": "-" if self.im is None else self.im.unit,
            "levels": list(self.levels),
            "factors": self.factors.tolist(),
            "realisations": number,
            "laws": [[list(twins.groups) for twins in of_model] for of_model in self.twins],
            "scatter": scatter,
            "seed": self.campaign.seed,
            "tail_s": self.campaign.tail,
            "version": __version__,
        }

    def _intensities(self) -> dict[str, list[list[float | None]]]:
        """Measures of each motion for each column, by their names in the table, shape (motions, columns) each."""
        angles = [column.slenderness for column in self.columns]
        relations = [
            (1.0 if angle is None else math.tan(angle), column.frequency_parameter)
            for column, angle in zip(self.columns, angles, strict=True)
        ]
        seen: dict[tuple, list[dict[str, float]]] = {}
        for motion in self.motions:
            if samples_of(motion) not in seen:
                seen[samples_of(motion)] = measures_by_column(motion.replace(factor=1.0), relations)
        intensities = {}
        for name, power in powers_by_column().items():
            if name in RELATIVE and all(angle is None for angle in angles):
                continue
            sizes = [abs(motion.factor) ** power for motion in self.motions]
            each = [[measures.get(name) for measures in seen[samples_of(motion)]] for motion in self.motions]
            if any(value is not None for values in each for value in values):
                intensities[name] = [
                    [None if value is None else value * size for value in values]
                    for values, size in zip(each, sizes, strict=True)
                ]
        return intensities

    def _factors(self, motion: Motion) -> list[float]:
        if self.im is None:
            return [float(level) for level in self.levels]
        if self.im.power == 0:
            raise InputError(f"{self.im.name} does not change with the size of a motion; scale by another measure.")
        value = self.im.of(motion)
        if not value > 0.0:
            raise InputError(f"{self.im.name} of {motion.name!r} is {value:g}, and cannot be scaled to a level.")
        factors = [float((level / value) ** (1.0 / self.im.power)) for level in self.levels]
        warn_of_scaling(motion.scaled(max(factors)))
        return factors


def must_be_alike(structures: Sequence[Structure], what: str) -> None:
    """Refuse a study or suite of several kinds of structures: they are measured by different things.

    Raises
    ------
    InputError
    """
    if len({structure.slenderness is None for structure in structures}) > 1:
        names = ", ".join(structure.name for structure in structures)
        raise InputError(f"the {what} holds columns and assemblies ({names}); give each kind a {what} of its own.")


#: File in the folder of a study, beside its finished runs.
PLAN_FILE = "plan.npz"


@dataclass(frozen=True, eq=False)
class Plan:
    """Runs of a study.

    Parameters
    ----------
    axes : dict
        Models, columns, motions, levels, factors and realisations as plain values.
    digests : Digests
        Of each case, in the order (model, column, motion, level, realisation).
    """

    axes: dict[str, Any]
    digests: Digests

    def __len__(self) -> int:
        return len(self.digests)

    @property
    def shape(self) -> tuple[int, ...]:
        """Numbers of models, columns, motions, levels and realisations (1 without scatter)."""
        sizes = [len(self.axes[name]) for name in ("models", "columns", "motions", "levels")]
        return (*sizes, max(1, self.axes["realisations"]))

    def known(self, ledger: Path) -> Rows:
        """Rows of the cases that a ledger holds."""
        rows = Rows(len(self))
        for number, row in finished_rows(ledger, self.digests):
            rows[number] = row
        return rows

    def labels(self) -> pandas.DataFrame:
        """Identity of each case: column, record, direction, level, factor, intensities as scaled, model and realisation."""
        import pandas

        axes = self.axes
        model, column, motion, level, realisation = np.unravel_index(np.arange(len(self)), self.shape)

        def picked(values: list[Any], index: np.ndarray) -> Any:
            kept = pandas.Series(values)
            return kept.to_numpy()[index]

        table = {name: picked([entry[name] for entry in axes["columns"]], column) for name in axes["columns"][0]}
        for name in ("record", "motion", "azimuth_deg", "reversed"):
            table[name] = picked([entry[name] for entry in axes["motions"]], motion)
        factor = np.array(axes["factors"])[motion, level]
        table |= {"measure": axes["measure"], "im": np.array(axes["levels"])[level], "factor": factor}
        for name, values in axes["intensities"].items():
            table[name] = np.array(values, dtype=float)[motion, column] * factor ** axes["powers"][name]
        table |= {"model": picked([entry["model"] for entry in axes["models"]], model)}
        table |= {"realisation": realisation + 1 if axes["realisations"] else np.zeros(len(self), dtype=np.int64)}
        laws = axes.get("laws") or []
        if any(of_column for of_model in laws for of_column in of_model):
            whole = [[of_column or [-1] * self.shape[4] for of_column in of_model] for of_model in laws]
            table[LAW] = np.array(whole)[model, column, realisation] + 1
        return pandas.DataFrame(table)

    def save(self, folder: Path) -> Path:
        """Write it into the folder of the study, whole or not at all."""
        content = io.BytesIO()
        np.savez(
            content,
            axes=np.frombuffer(json.dumps(self.axes, default=str).encode(), np.uint8),
            digests=self.digests.digests,
        )
        target = folder / PLAN_FILE
        with replacing(target) as partial:
            partial.write_bytes(content.getvalue())
        return target

    @classmethod
    def load(cls, folder: str | Path) -> Plan:
        """Read the plan of a study's folder.

        Raises
        ------
        InputError
            The folder is not that of a study, or its plan is damaged.
        """
        place = Path(folder) / PLAN_FILE
        if not place.is_file():
            raise InputError(
                f"{folder} is no folder of a study: it has no {PLAN_FILE}; give that in which a study keeps its runs."
            )
        try:
            with np.load(place, allow_pickle=False) as archive:
                return cls(json.loads(archive["axes"].tobytes()), Digests(archive["digests"]))
        except Exception:  # whatever a damaged archive makes of it
            raise InputError(f"{place} is damaged; run the study again, which finds its finished runs there.") from None
