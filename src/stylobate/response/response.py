"""Response of a column or an assembly in one run: its data, with words, tables, pages and files at hand."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING

from .. import notebook, store
from ..bibliography import cite_run
from .joint_forces import JointForces, joint_forces
from .recorded import ASIDE, Recorded, size_of, telling_states
from .summary import summary_of
from .words import describe, doubt_of, sentence_of, title_of

if TYPE_CHECKING:
    import xarray

    from .. import Film


_NOT_IN_TABLE = ("outcome", "reason", "wall_s", "model", "version", "mechanism", "collapse")


def as_html(response: Recorded) -> str:
    """HTML without scripts and without anything from the network."""
    facts = {key: value for key, value in summary_of(response).items() if key not in _NOT_IN_TABLE}
    return notebook.page(title_of(response), sentence_of(response), facts, _strip(response))


def _strip(response: Recorded) -> str:
    """The telling states beside one another, in one scale, as a picture."""
    states, bodies = telling_states(response), response.bodies
    panels = [[(response.outline(k, i), bool(bodies.fixed[i])) for i in bodies.shown] for k in states]
    return notebook.silhouettes(panels, [f"{response.time[k]:.2f} s" for k in states], ASIDE * size_of(response))


@dataclass(frozen=True, eq=False, repr=False)
class Response(Recorded):
    """Result of :func:`stylobate.simulate`; everything relative to the moving base.

    Histories and measures can be read off it directly: ``response.time``, ``response.peak_top_displacement``.

    Parameters
    ----------
    structure : Column, Assembly or Specimen
        What stood.
    histories : Histories
    measures : Measures
    model : str
        Name of the model, as on the command line.
    provenance : dict
        Versions, parameters and digests that reproduce the run; plain values.
    wall_time : float
        Time the run took [s].
    mechanism : Mechanism, optional
        What fell where, of a column that was followed to the ground.
    followed : bool
        Whether any two bodies, and all of them with the ground, may strike each other; of neighbours only otherwise.
    twins : tuple of Measures
        Of the columns that were computed beside this one (:func:`stylobate.certainty`); no file keeps them.
    """

    @classmethod
    def of(cls, recorded: Recorded) -> Response:
        """The response to what was recorded."""
        return cls(**{field.name: getattr(recorded, field.name) for field in fields(Recorded)})

    @property
    def sentence(self) -> str:
        """Outcome, in one or two sentences."""
        return sentence_of(self)

    def describe(self) -> str:
        """What happened, in one or two sentences, and why it may be otherwise in space."""
        return f"{self.sentence} {doubt_of(self)}".rstrip()

    def __repr__(self) -> str:
        return describe(self)

    def _repr_html_(self) -> str:
        return as_html(self)

    def summary(self) -> dict:
        """The JSON object of ``stylobate run``."""
        return summary_of(self)

    def citation(self) -> str:
        """Citations for this run: the package, the sources of its model, and where its motion comes from."""
        return cite_run(self.provenance).text

    def animate(
        self,
        *,
        frames_per_second: float = 30.0,
        speed: float = 1.0,
        window: tuple[float, float] | None = None,
    ) -> Film:
        """A film that plays where a notebook shows it; ``.save(path)`` writes it as a page of its own.

        Parameters
        ----------
        frames_per_second : float
            Frames that are shown in a second [1/s].
        speed : float
            At which that many are shown: 0.5 keeps twice as many states. The viewer chooses how fast it plays.
        window : (float, float), optional
            Beginning and end of what is shown [s]; all by default.
        """
        from .. import Film

        return Film(self, frames_per_second, speed, window)

    def joint_forces(self) -> JointForces:
        """Normal force, shear and moment of every joint of a column in the plane, averaged over two recording intervals.

        Raises
        ------
        InputError
            It is no run of a column in the plane, or has fewer than three states at equal intervals.
        """
        return joint_forces(self)

    def with_provenance(self, provenance: dict, wall_time: float) -> Response:
        """A copy with provenance and wall time filled in (done once, by ``simulate``)."""
        return replace(self, provenance=self.provenance | provenance, wall_time=wall_time)

    def to_xarray(self) -> xarray.Dataset:
        """Histories as a labelled data set with units; measures as attributes, column and provenance as JSON texts.

        Returns
        -------
        xarray.Dataset
            Dimensions ``time`` [s], ``drum`` (``body`` for an assembly), ``axis`` (x, y, z) and ``joint``.
        """
        from .recorded import to_dataset

        return to_dataset(self)

    def save(self, path: str | Path) -> Path:
        """Write netCDF; the file appears whole or not at all.

        Raises
        ------
        InputError
            The folder is missing or cannot be written to.
        StylobateError
            The disk is full.
        """
        from .recorded import to_dataset

        return store.write(to_dataset(self, derived=False), "response", path)

    @classmethod
    def load(cls, path: str | Path) -> Response:
        """Read a response written by :meth:`save`.

        Raises
        ------
        InputError
            There is no such file, it is damaged, or it is not a response.
        """
        from .recorded import load

        return cls.of(load(path))
