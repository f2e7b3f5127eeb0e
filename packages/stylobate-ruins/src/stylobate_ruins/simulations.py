"""One table of simulations for many questions: what stands, shaken by every draw of a prior, and what is left of it."""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stylobate.atomic import digest as digest_of_file
from stylobate.atomic import replacing
from stylobate.campaign.campaign import Campaign
from stylobate.campaign.digests import LENGTH, Digests, Hasher, laws
from stylobate.campaign.runs import Group, Request, run_all
from stylobate.column.scatter import drawn_twin, usual_scatter
from stylobate.column.structure import Structure
from stylobate.errors import InputError
from stylobate.models.base import Case, Cases, Model
from stylobate.models.drums.stepped import LossyDrums
from stylobate.models.shared.ground import QUIET
from stylobate.response.rows import Rows
from stylobate.version import __version__

from .prior import Draws, Prior
from .ruin import bodies_of, joints_of

if TYPE_CHECKING:
    import pandas

#: File of the table beside its ledger.
TABLE_FILE = "simulations.npz"

#: Verdicts of a run of the table. What still moves at its end counts as standing: of 487 columns in space that the law of
#: barriers left undecided three seconds after the shaking, one fell within the next minute.
STANDS, FELL, FAILED = 0, 1, 2

#: Time after each motion in which drums come to rest, or nearly so [s].
TAIL = 3.0

#: Draws whose motions are held at the same time while digests are made.
TOGETHER = 200


@dataclass(frozen=True, eq=False)
class FinalState:
    """What is left of one structure by every draw.

    Parameters
    ----------
    name : str
    verdict : array of int8
        ``STANDS``, ``FELL``, or ``FAILED``, shape (draws,).
    towards : array
        Azimuth of the fall, from x towards y [degrees], NaN of what stands, shape (draws,).
    slip : array
        Offset vectors of the joints [m], shape (draws, joints, 2).
    twist : array
        Of the joints [degrees], shape (draws, joints).
    fallen : array of bool
        Bodies of an assembly that have fallen, of those that can move, shape (draws, bodies); of columns none are told.
    moved : array
        How far these have moved in plan [m], shape (draws, bodies, 2).
    """

    name: str
    verdict: np.ndarray
    towards: np.ndarray
    slip: np.ndarray
    twist: np.ndarray
    fallen: np.ndarray
    moved: np.ndarray

    @classmethod
    def of(cls, structure: Structure, rows: Sequence[dict[str, Any]]) -> FinalState:
        """From rows of runs (``Measures.row()``)."""
        joints, bodies = joints_of(structure), bodies_of(structure) if structure.stack is None else []
        fallen, moved = np.zeros((len(rows), len(bodies)), dtype=bool), np.full((len(rows), len(bodies), 2), np.nan)
        verdict = np.full(len(rows), FAILED, dtype=np.int8)
        towards, slip = np.full(len(rows), np.nan), np.full((len(rows), joints, 2), np.nan)
        twist = np.full((len(rows), joints), np.nan)
        for k, row in enumerate(rows):
            if row["outcome"] == "failed":
                continue
            verdict[k] = FELL if row["collapsed"] else STANDS
            azimuth = row.get("collapse_azimuth_deg")
            towards[k] = np.nan if azimuth is None else azimuth
            slip[k] = np.transpose([row["residual_slip_x_m"], row["residual_slip_y_m"]])
            twist[k] = np.degrees(row["residual_twist_rad"])
            if bodies:
                fallen[k] = [body in row["fallen"] for body in bodies]
                moved[k] = np.transpose([row["residual_displacement_x_m"], row["residual_displacement_y_m"]])
        return cls(structure.name, verdict, towards, slip, twist, fallen, moved)

    @property
    def largest(self) -> np.ndarray:
        """Longest offset of a joint [m], shape (draws,)."""
        return np.hypot(*np.moveaxis(self.slip, -1, 0)).max(axis=1)


@dataclass(frozen=True, eq=False)
class Simulations:
    """The table.

    Parameters
    ----------
    prior : Prior
    parameters : dict of array
        What each draw is, by name, shape (draws,).
    final_states : tuple of Left
        A structure each.
    seed : int
    """

    prior: Prior
    parameters: dict[str, np.ndarray]
    final_states: tuple[FinalState, ...]
    seed: int = 0

    def __len__(self) -> int:
        return len(self.parameters["pgv_m_s"])

    @property
    def sound(self) -> np.ndarray:
        """Draws under which every structure could be computed, shape (draws,)."""
        return (
            np.all([state.verdict != FAILED for state in self.final_states], axis=0)
            if self.final_states
            else np.ones(len(self), bool)
        )

    def subset(self, which: np.ndarray) -> Simulations:
        """Some of the draws."""
        states = [
            FinalState(state.name, *(getattr(state, name)[which] for name in FIELDS)) for state in self.final_states
        ]
        return replace(
            self,
            parameters={name: values[which] for name, values in self.parameters.items()},
            final_states=tuple(states),
        )

    @property
    def table(self) -> pandas.DataFrame:
        """One row per draw: its motion, the verdict and the longest offset of each structure."""
        import pandas

        data = {"draw": np.arange(1, len(self) + 1)} | dict(self.parameters)
        law = data.pop("law").astype(int)
        data["law"] = np.array(self.prior.law)[law]
        words = np.array(["stands", "fell", "failed"])
        for state in self.final_states:
            data[f"{state.name}: state"] = words[state.verdict]
            data[f"{state.name}: fell towards [deg]"] = state.towards
            data[f"{state.name}: largest slip [m]"] = np.where(state.verdict == STANDS, state.largest, np.nan)
        return pandas.DataFrame(data)


#: Arrays of what is left of a structure.
FIELDS = ("verdict", "towards", "slip", "twist", "fallen", "moved")


def simulations_of(
    structures: Sequence[Structure],
    prior: Prior,
    model: Model,
    count: int,
    seed: int = 0,
    *,
    folder: str | Path | None = None,
    campaign: Campaign | None = None,
) -> Simulations:
    """Shake structures by the first draws of a prior; what a folder keeps of that is not computed again.

    Parameters
    ----------
    structures : sequence of Structure
        Columns, or assemblies in space: each under every draw, and each draw a twin of its own.
    prior : Prior
    model : Model
        In space; law and damping are those of the draws.
    count, seed : int
        Draws.
    folder : path, optional
        Keeps the table, and finished runs in its ledger: more draws of the same prior add to them.
    campaign : Campaign

    Raises
    ------
    InputError
        A model in the plane, or one whose losses do not vary; a structure that it does not take.
    """
    if model.is_plane(model.parameters()) or not isinstance(model, LossyDrums):
        raise InputError(
            f"{model.name} is no model in space whose losses vary, and ruins have directions; use dem3d "
            "(DistinctElement3D).",
            "model",
        )
    campaign = campaign or Campaign()
    table = _Table(
        tuple(structure.stack or structure for structure in structures), prior.draws(count, seed), model, campaign
    )
    kept = None if folder is None else Path(folder) / TABLE_FILE
    if kept is not None and (simulations := table.read(kept)) is not None:
        return simulations
    rows = run_all(table.request(), campaign.kept_in(folder)) if structures else Rows(0)
    made = table.of(rows)
    if kept is not None:
        table.write(kept, made)
    return made


class _Table:
    """Cases of a table: case ``k n + i`` is draw k of structure i of n."""

    def __init__(self, structures: tuple[Structure, ...], draws: Draws, model: Model, campaign: Campaign) -> None:
        self.structures, self.draws, self.model = structures, draws, model
        self.options = replace(campaign.options, quiet=0.0 if campaign.whole else QUIET)
        given = draws.prior.scatter
        self.scatter = [
            replace(usual_scatter(structure), offset=0.0) if given is None else given for structure in structures
        ]

    def case(self, number: int) -> Case:
        """A case: a twin of a structure, and the motion of the draw."""
        k, i = divmod(number, len(self.structures))
        twin, _ = drawn_twin(self.structures[i], self.scatter[i], k, self.draws.seed + i, space=True)
        if twin.stack is not None:
            model: Any = self.model
            losses = self.draws.losses(twin.stack, k, model.rolling_resistance)
            twin = self.draws.on_joints(twin.stack, k).unwarned(losses=losses)
        return Case(twin, self.draws.motion(k))

    def groups(self) -> list[Group]:
        """All columns together, which carry their losses; assemblies, whose losses are the model's, by their damping."""
        numbers = np.arange(len(self.draws) * len(self.structures)).reshape(len(self.draws), -1)
        columns = np.array([structure.stack is not None for structure in self.structures])
        groups = [(numbers[:, columns].ravel(), self.model, self.options)]
        damping = self.draws.parameters["stiffness_damping_s"] if not columns.all() else np.zeros(0)
        for size in np.unique(damping).tolist():
            model = replace(self.model, stiffness_damping=size)
            groups.append((numbers[damping == size][:, ~columns].ravel(), model, self.options))
        return [group for group in groups if len(group[0])]

    def request(self) -> Request:
        """All cases, to be run."""
        count = len(self.draws) * len(self.structures)
        digests, groups = np.empty((count, LENGTH), dtype=np.uint8), self.groups()
        for numbers, model, _ in groups:
            for first in range(0, len(numbers), TOGETHER):  # a hasher keeps the samples that it has read
                chunk = numbers[first : first + TOGETHER].tolist()
                cases = Cases(len(chunk), lambda j, chunk=chunk: self.case(chunk[j]))
                digests[chunk] = Hasher(model, self.options).of_cases(cases, [self.options.quiet] * len(chunk))
        return Request(Cases(count, self.case), Digests(digests), groups)

    def of(self, rows: Rows) -> Simulations:
        """The table of finished runs."""
        n, states = len(self.structures), []
        for i, structure in enumerate(self.structures):
            own = [rows[k * n + i] or {} for k in range(len(self.draws))]
            states.append(FinalState.of(structure, own))
        return Simulations(self.draws.prior, self.draws.parameters, tuple(states), self.draws.seed)

    @property
    def digest(self) -> str:
        """Of all that decides the table."""
        content = {
            "structures": [structure.nameless_digest for structure in self.structures],
            "scatter": [scatter.given for scatter in self.scatter],
            "prior": self.draws.prior.facts(),
            "draws": [len(self.draws), self.draws.seed],
            "model": [self.model.name, self.model.parameters()],
            "options": [self.options.tail, self.options.quiet],
            "laws": [__version__, *laws()],
            "sources": [
                digest_of_file(Path(__file__).with_name(f"{module}.py"))
                for module in ("simulations", "prior", "ground_motion")
            ],
        }
        return hashlib.sha256(json.dumps(content, sort_keys=True, default=str).encode()).hexdigest()

    def write(self, place: Path, made: Simulations) -> None:
        """Keep the table, whole or not at all."""
        arrays = {f"{i} {name}": getattr(state, name) for i, state in enumerate(made.final_states) for name in FIELDS}
        arrays |= {f"parameter {name}": values for name, values in made.parameters.items()}
        content = io.BytesIO()
        np.savez(content, digest=np.array(self.digest), **arrays)
        with replacing(place) as partial:
            partial.write_bytes(content.getvalue())

    def read(self, place: Path) -> Simulations | None:
        """The table that was kept; None of another one, or where none can be read: the ledger has its runs."""
        if not place.is_file():
            return None
        try:
            with np.load(place, allow_pickle=False) as archive:
                if "digest" not in archive.files:
                    raise InputError(f"{place} is there already and is no table of simulations; move it away.")
                if str(archive["digest"]) != self.digest:
                    return None
                names = [structure.name for structure in self.structures]
                states = [
                    FinalState(name, *(archive[f"{i} {field}"] for field in FIELDS)) for i, name in enumerate(names)
                ]
                start = "parameter "
                parameters = {name[len(start) :]: archive[name] for name in archive.files if name.startswith(start)}
        except InputError:
            raise
        except Exception:  # whatever a damaged file makes of it
            return None
        return Simulations(self.draws.prior, parameters, tuple(states), self.draws.seed)
