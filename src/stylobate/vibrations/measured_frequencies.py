"""From measured natural frequencies to the stiffness of joints: intervals by sampling what else is not known."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..column.column import Column
from ..column.files import tables_of
from ..errors import InputError, check_kind, check_range, check_whole
from ..messages import joined, say
from ..notebook import NotebookSummary
from .closed_joints import vibrating
from .modes import ACROSS, ALONG, AROUND, UPWARD, _coupled
from .small_vibrations import Vibrating

#: Normal deviate of both ends of a 95 % interval, and half of the square of it, by which a likelihood falls there.
TWO_SIDED = 1.959963984540054

FALLS = 0.5 * TWO_SIDED**2

#: Range in which stiffnesses are looked for [N/m³]: from what carries nothing to what no measurement tells from rigid.
SOFTEST, STIFFEST = 1e6, 1e14

#: Points a side of the first look for where the answer lies, of the tables of frequencies there, and of the answer.
FIRST, TABLE, FINE = 33, 20, 160

#: A frequency so many standard deviations from the measured one is left out; its logarithm where nothing vibrates.
FARTHEST, UNSTABLE = 5.0, -20.0

#: χ² of the best stiffnesses above which the measurements contradict one another: exceeded once in a thousand.
CONTRADICTS = 0.999

#: Ranges of what is not stated of the ground: density [kg/m³] and Poisson's ratio (loose to dense, dry to wet soil) [-].
GROUND_DENSITY, GROUND_POISSON = (1700.0, 2100.0), (0.25, 0.45)

#: Draws of what is not known besides the two stiffnesses.
DRAWS = 100

#: Names of the groups of coordinates by the kind of a measurement.
GROUPS = {"bending": ALONG, "across": ACROSS, "torsion": AROUND, "axial": UPWARD}

_ENTRY = re.compile(
    r"\s*(?P<kinds>(?:[a-z]+\s+)*)(?:(?P<number>\d+)\s+)?(?P<value>\d+\.?\d*|\.\d+)\s*(?P<unit>[A-Za-z]+)?\s*"
    r"(?:(?:±|\+-|\+/-)\s*(?P<spread>\d+\.?\d*|\.\d+)\s*(?P<of>%|[A-Za-z]+)?)?\s*"
)


@dataclass(frozen=True)
class Measured:
    """A measured frequency of one mode.

    Parameters
    ----------
    frequency : float
        [Hz]
    spread : float
        Relative standard deviation of the measurement [-].
    kind : {"bending", "across", "torsion", "axial"}
        ``across`` is bending out of the plane of x and z, of rectangular columns.
    number : int
        Of its kind, from 1.

    Raises
    ------
    InputError
    """

    frequency: float
    spread: float
    kind: str = "bending"
    number: int = 1

    def __post_init__(self) -> None:
        if self.kind not in GROUPS:
            raise InputError(f"kind of a measurement is {self.kind!r}; allowed are {', '.join(GROUPS)}.", "measured")
        check_range("measured frequency", self.frequency, 0.01, 1e4, unit="Hz", field="measured")
        check_range(
            "spread of a measured frequency",
            self.spread,
            1e-4,
            0.5,
            remedy="±3% is usual of ambient vibration",
            field="measured",
        )
        check_whole("number of a measured mode", self.number, 1, 20)

    @property
    def name(self) -> str:
        """Such as ``bending 2``."""
        return say("{kind} {number}", kind=say(self.kind), number=self.number)


def parse_measured(text: str) -> tuple[Measured, ...]:
    """Measured frequencies as typed: ``1.27Hz±3%,6.5Hz±6%,torsion 9.0Hz±6%``.

    ± is one standard deviation, of a mean of several records that of the mean. What names no kind is bending, numbered by
    rising frequency; a number behind the kind says which mode it is.

    Raises
    ------
    InputError
        An entry is not of that form, or two are of one mode.
    """
    entries: list[tuple[str, int | None, float, float]] = []
    for part in text.split(","):
        match = _ENTRY.fullmatch(part)
        example = "such as 1.27Hz±3% or torsion 9.0Hz±6%"
        if match is None:
            raise InputError(
                f"measured frequency {part.strip()!r} cannot be read; write it as kind, value and spread, {example}.",
                "measured",
            )
        kinds = match["kinds"].split()
        if len(kinds) > 1:
            raise InputError(
                f"measured frequency {part.strip()!r} names two modes, {' and '.join(kinds)}; a measurement is of one mode: "
                "give it as the one that the records of two seismometers show, or leave it out.",
                "measured",
            )
        if kinds and kinds[0] not in GROUPS:
            raise InputError(
                f"measured frequency {part.strip()!r} is of kind {kinds[0]!r}; allowed are {', '.join(GROUPS)}.",
                "measured",
            )
        if (match["unit"] or "").lower() != "hz":
            unit = "without a unit" if not match["unit"] else f"in {match['unit']}"
            raise InputError(f"measured frequency {part.strip()!r} is {unit}; give it in Hz, {example}.", "measured")
        if match["spread"] is None:
            raise InputError(
                f"measured frequency {part.strip()!r} has no spread; give its standard deviation, {example}.",
                "measured",
            )
        value, spread = float(match["value"]), float(match["spread"])
        if match["of"] == "%":
            spread /= 100.0
        elif (match["of"] or "").lower() == "hz":
            spread /= max(value, 1e-300)
        else:
            raise InputError(f"the spread of {part.strip()!r} has no unit; give it in % or Hz, {example}.", "measured")
        number = None if match["number"] is None else int(match["number"])
        entries.append((kinds[0] if kinds else "bending", number, value, spread))
    measured = []
    for kind in dict.fromkeys(kind for kind, *_ in entries):
        own = sorted((entry for entry in entries if entry[0] == kind), key=lambda entry: entry[2])
        stated = [entry[1] for entry in own if entry[1] is not None]
        if stated and len(stated) < len(own):
            raise InputError(
                f"some measured frequencies of {kind} say which mode they are and some do not; number all of them, such as "
                f"{kind} 1 1.27Hz±3%, or none.",
                "measured",
            )
        measured += [Measured(value, spread, kind, number or i) for i, (_, number, value, spread) in enumerate(own, 1)]
    check_measured(measured)
    return tuple(measured)


def check_measured(measured: Sequence[Measured]) -> None:
    """Refuse two measurements of one mode, and frequencies that do not rise with their number."""
    if not measured:
        raise InputError("no frequency is measured; give one at least, such as 1.27Hz±3%.", "measured")
    for kind in GROUPS:
        own = sorted((reading for reading in measured if reading.kind == kind), key=lambda reading: reading.number)
        for low, high in pairwise(own):
            if low.number == high.number:
                raise InputError(
                    f"{low.frequency:g} Hz and {high.frequency:g} Hz are both given as {low.name}; a mode has one "
                    f"frequency: give "
                    "their mean with a spread that holds both, or number them as modes of their own.",
                    "measured",
                )
            if low.frequency >= high.frequency:
                raise InputError(
                    f"{low.name} is given as {low.frequency:g} Hz and {high.name} as {high.frequency:g} Hz; "
                    f"frequencies rise with "
                    "their number: correct the numbers.",
                    "measured",
                )


class Interval(NamedTuple):
    """Median and both ends of a 95 % interval; None where the measurements leave it open."""

    median: float | None
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Ground:
    """Ground under the base of a column, an elastic half-space under a square footing.

    Parameters
    ----------
    shear_wave_velocity : (float, float)
        V_s, from and to [m/s]; uniform between.
    half_width : float
        B, half the side of the footing [m].
    density, poisson : (float, float)
        From and to [kg/m³], [-]; uniform between.

    Notes
    -----
    Static stiffness of a square surface footing (Gazetas 1991): sway 9 G B/(2 − ν), rocking 3.6 G B³/(1 − ν), torsion
    8.3 G B³, vertical 4.54 G B/(1 − ν), with G = ρ V_s². The footing has no mass and no height. Eq. (M5).
    """

    shear_wave_velocity: tuple[float, float]
    half_width: float
    density: tuple[float, float] = GROUND_DENSITY
    poisson: tuple[float, float] = GROUND_POISSON

    def __post_init__(self) -> None:
        for name, unit, (low, high) in (
            ("shear_wave_velocity", "m/s", (30.0, 4000.0)),
            ("density", "kg/m³", (1000.0, 3500.0)),
            ("poisson", "", (0.0, 0.499)),
        ):
            ends = getattr(self, name)
            ends = (ends, ends) if isinstance(ends, (int, float)) else tuple(ends)
            for end in ends:
                check_range(f"{name} of the ground", end, low, high, unit=unit, field="ground")
            if len(ends) != 2 or ends[0] > ends[1]:
                raise InputError(
                    f"{name} of the ground is {ends}; give one value, or the lower one and the upper one.", "ground"
                )
            object.__setattr__(self, name, ends)
        check_range("half_width of the ground", self.half_width, 0.05, 100.0, unit="m", field="ground")

    def stiffness(self, draws: np.ndarray) -> np.ndarray:
        """Springs at the base for draws between 0 and 1 of V_s, density and ν, shape (M, 3): sway, sway, vertical [N/m],
        rocking, rocking, torsion [N m], shape (M, 6).  # Eq. (M5); Gazetas (1991), square footing"""
        ends = (self.shear_wave_velocity, self.density, self.poisson)
        speed, density, nu = (low + (high - low) * draws[:, i] for i, (low, high) in enumerate(ends))
        modulus, b = density * speed**2, self.half_width
        sway = 9.0 * modulus * b / (2.0 - nu)
        rocking = 3.6 * modulus * b**3 / (1.0 - nu)
        upward, torsion = 4.54 * modulus * b / (1.0 - nu), 8.3 * modulus * b**3
        return np.stack((sway, sway, upward, rocking, rocking, torsion), axis=1)


def parse_ground(text: str) -> Ground | None:
    """Ground as typed: ``rigid``, or ``vs=300m/s,half_width=4m``; ``vs=200:400m/s`` is a range, as of ``density`` and
    ``poisson``.

    Raises
    ------
    InputError
    """
    if text.strip() == "rigid":
        return None
    examples = {"vs": "300m/s", "half_width": "4m", "density": "1900kg/m3", "poisson": "0.35"}
    values: dict[str, tuple[float, ...]] = {}
    for part in text.split(","):
        name, sign, value = (piece.strip() for piece in part.partition("="))
        if not sign or name not in examples:
            raise InputError(
                f"ground is {text!r}; allowed is rigid, or vs=300m/s,half_width=4m, with density and poisson "
                f"where they are known.",
                "ground",
            )
        match = re.fullmatch(r"([\d.eE+-]+)(?::([\d.eE+-]+))?\s*([^\d\s].*)?", value)
        unit = "" if match is None else (match[3] or "").strip().replace("³", "3")
        if match is None or unit != examples[name].lstrip("0123456789."):
            raise InputError(
                f"{name} of the ground is {value!r}; write it with its unit, if it has one, as {name}={examples[name]}.",
                "ground",
            )
        try:
            values[name] = tuple(float(end) for end in (match[1], match[2] or match[1]))
        except ValueError:
            raise InputError(f"{name} of the ground is {value!r}, no number; correct it.", "ground") from None
    missing = next((name for name in ("vs", "half_width") if name not in values), None)
    if missing is not None:
        raise InputError(
            f"ground {text!r} has no {missing}; give vs and half_width, such as vs=300m/s,half_width=4m.", "ground"
        )
    more: dict[str, Any] = {name: values[name] for name in ("density", "poisson") if name in values}
    width = values["half_width"]
    if width[0] != width[1]:
        raise InputError("half_width of the ground is a range; give one value [m].", "ground")
    return Ground((values["vs"][0], values["vs"][1]), width[0], **more)


# -- frequencies of many stiffnesses -----------------------------------------------------------------------------------


class _Family:
    """Columns alike but for the stiffness of their joints and of the ground: frequencies of many of them at once.

    All joints have the same k_b/J_A and k_s; the ground is in series with the base joint, through a footing without mass.
    """

    def __init__(self, column: Column, model: Any) -> None:
        standing = vibrating(column, model)
        groups = list(GROUPS.values())
        if any(_coupled(standing, group, other) for group in groups for other in groups if group != other):
            raise InputError(
                f"measured frequencies are compared with a column whose bending, torsion and axial motion are "
                f"apart, and those of "
                f"{column.name!r} are not: leave what is as found, and links beside the axis, out of its file.",
                "measured",
            )
        self.column, self.standing = column, standing
        n = len(standing.masses)
        self.rest = standing.stiffness_matrix.copy()
        self.bending, self.shear = np.zeros((6 * n, 6 * n)), np.zeros((6 * n, 6 * n))
        self.rows = np.zeros((6, 6 * n))
        self.base = np.zeros((2, 6))
        for j, (joint, matrix) in enumerate(zip(standing.joints, standing.joint_matrices, strict=True)):
            at = np.concatenate((6 * joint.upper + np.arange(6), 6 * joint.lower + np.arange(6)))
            self.rest[np.ix_(at, at)] -= matrix
            unit = joint.bending / joint.second_moment
            alone = standing.joint_matrix(replace(joint, shear=0.0, torsion=0.0))
            if j == 0:
                self.rows[:, at] = _relative(standing, joint)
                half_solved = np.linalg.lstsq(self.rows[:, at].T, matrix, rcond=None)[0]
                diagonal = np.linalg.lstsq(self.rows[:, at].T, half_solved.T, rcond=None)[0].diagonal()
                closing = np.array([0.0, 0.0, 1.0, 1.0, 1.0, 0.0])
                self.base = np.stack(
                    (diagonal * closing / unit, diagonal * (1.0 - closing) / (joint.shear / joint.area))
                )
                continue
            self.bending[np.ix_(at, at)] += alone / unit
            self.shear[np.ix_(at, at)] += (matrix - alone) / (joint.shear / joint.area)
        self.ratio = np.array(
            [joint.bending / joint.second_moment * joint.area / joint.springs.sum() for joint in standing.joints]
        )

    def squares(
        self, kind: str, numbers: Sequence[int], bending: np.ndarray, shear: np.ndarray, ground: np.ndarray | None
    ) -> np.ndarray:
        """Squares of the circular frequencies of some modes [1/s²], shape (K, modes); negative where the column falls over.

        Parameters
        ----------
        kind : str
        numbers : sequence of int
        bending, shear : array
            k_b/J_A and k_s [N/m³], shape (K,).
        ground : array or None
            Springs at the base, shape (K, 6); None for rigid ground.
        """
        pick = (6 * np.flatnonzero(self.standing.free)[:, None] + np.array(GROUPS[kind])).ravel()
        if max(numbers) > len(pick):
            raise InputError(
                f"{kind} {max(numbers)} is measured, and {self.column.name!r} of {self.column.n} drums has "
                f"{len(pick)} modes of "
                f"{kind}; correct the number.",
                "measured",
            )
        base = self.base[0] * bending[:, None] + self.base[1] * shear[:, None]
        if ground is not None:
            base = base * ground / (base + ground)
        square = np.ix_(pick, pick)
        root = np.linalg.inv(np.linalg.cholesky(self.standing.mass_matrix[square]))
        rest, first, second = (root @ stiffness[square] @ root.T for stiffness in (self.rest, self.bending, self.shear))
        rows = self.rows[:, pick] @ root.T
        out = np.empty((len(bending), len(numbers)))
        for begin in range(0, len(bending), 4096):
            chunk = slice(begin, begin + 4096)
            matrix = rest + bending[chunk, None, None] * first + shear[chunk, None, None] * second
            matrix = matrix + np.einsum("rp,kr,rq->kpq", rows, base[chunk], rows, optimize=True)
            out[chunk] = np.linalg.eigvalsh(matrix)[:, [number - 1 for number in numbers]]
        return out


def _relative(standing: Vibrating, joint: Any) -> np.ndarray:
    """Slips, opening, rotations and twist of a joint in its axes per coordinate of its two bodies, shape (6, 12)."""
    passing = joint.frame.T @ standing._passing(joint, joint.middle)
    turning = np.zeros((3, 12))
    turning[:, 3:6], turning[:, 9:] = joint.frame.T, -joint.frame.T
    return np.concatenate((passing, turning))


# -- the answer --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class MeasuredJoints(NotebookSummary):
    """Result of :func:`joints_from_frequencies`: intervals of 95 %.

    Parameters
    ----------
    column : Column
    measured : tuple of Measured
    bending, shear : Interval
        Of k_b/J_A and of k_s of all joints [N/m³].
    bounded_by : dict
        For ``joint_bending_stiffness`` and ``joint_shear_stiffness``, which measurement bounds the ``low`` and the ``high``
        side; None where nothing does.
    best : dict
        Frequencies of the best stiffnesses, by the names of the measurements [Hz].
    variation : float or None
        Coefficient of variation of k_b/J_A [-]; None where it is open.
    ratio : array
        k_b/(k_n J_A) of each joint by the law of the model [-].
    ground : Ground or None
    draws : int
    """

    column: Column
    measured: tuple[Measured, ...]
    bending: Interval
    shear: Interval
    bounded_by: dict[str, dict[str, str | None]]
    best: dict[str, float]
    variation: float | None
    ratio: np.ndarray
    ground: Ground | None
    draws: int

    @property
    def normal(self) -> Interval:
        """k_n that has this bending stiffness by the law of the model [N/m³], of the base joint."""
        return Interval(*(None if end is None else end / float(self.ratio[0]) for end in self.bending))

    @property
    def inferred_column(self) -> Column | None:
        """The column on joints of the medians; None where one of them is open."""
        if self.bending.median is None or self.shear.median is None:
            return None
        joints = tuple(
            joint.changed(normal_stiffness=self.bending.median / float(ratio), shear_stiffness=self.shear.median)
            for joint, ratio in zip(self.column.joints, self.ratio, strict=True)
        )
        return self.column.unwarned(joints=joints)

    @property
    def scatter(self) -> dict[str, float] | None:
        """``[scatter]`` of a study: the coefficient of variation of the stiffness, at most 2; None where it is open."""
        return None if self.variation is None else {"joint_stiffness": min(self.variation, 2.0)}

    @property
    def open_words(self) -> list[str]:
        """What stays open, in sentences."""
        sentences = []
        for words, interval in (("k_b/J_A", self.bending), ("k_s", self.shear)):
            if interval.low is None and interval.high is None:
                sentences.append(
                    say("{name} stays open on both sides: these frequencies do not tell of it", name=words)
                )
            elif interval.high is None:
                sentences.append(
                    say("{name} has no upper bound: rigid joints would give these frequencies too", name=words)
                )
            elif interval.low is None:
                sentences.append(say("{name} has no lower bound within {least:g} N/m³", name=words, least=SOFTEST))
        return sentences

    @property
    def sentence(self) -> str:
        """The intervals in words."""
        words = say("k_b/J_A is {bending}, k_s {shear} (95 %).")
        return words.of(bending=_words(self.bending), shear=_words(self.shear))

    def summary(self) -> dict[str, Any]:
        """``inferred`` in the JSON object of ``stylobate modes``."""
        names = {
            "joint_bending_stiffness": self.bending,
            "joint_normal_stiffness": self.normal,
            "joint_shear_stiffness": self.shear,
        }
        return {name: interval._asdict() for name, interval in names.items()} | {
            "confidence": 0.95,
            "bounded_by": self.bounded_by,
            "open": self.open_words,
            "measured": [
                {"kind": reading.kind, "number": reading.number, "frequency_hz": reading.frequency}
                | {"standard_deviation_hz": reading.spread * reading.frequency}
                for reading in self.measured
            ],
            "best_hz": self.best,
            "scatter": self.scatter,
            "draws": self.draws,
        }

    def tables(self) -> dict[str, Any] | None:
        """The inferred column as the tables of its file; None where it is open."""
        column = self.inferred_column
        return None if column is None else tables_of(column)


def _words(interval: Interval) -> str:
    if interval.median is not None:
        return say("{one.low:.3g} to {one.high:.3g} N/m³, median {one.median:.3g}", one=interval)
    above, below = say("above {end:.3g} N/m³"), say("below {end:.3g} N/m³")
    ends = [words.of(end=end) for words, end in ((above, interval.low), (below, interval.high)) if end is not None]
    return joined(" ", ends) or say("open on both sides")


class _Table(NamedTuple):
    """What each measurement would be over logarithms of stiffnesses, for draws of what else is not known.

    ``bending`` and ``shear`` are ln of k_b/J_A and k_s, shapes (K,) and (L,); ``values``, shape (measurements, M, K, L), the
    squares of circular frequencies [1/s²] as computed, and ln of the frequencies [Hz] as refined.
    """

    bending: np.ndarray
    shear: np.ndarray
    values: np.ndarray


Box = tuple[tuple[float, float], tuple[float, float]]


def joints_from_frequencies(
    column: Column | Sequence[Column],
    measured: Sequence[Measured] | str,
    model: Any,
    ground: Ground | str | None,
    *,
    draws: int = DRAWS,
    seed: int = 0,
) -> MeasuredJoints:
    """Stiffness of a column's joints from its measured frequencies.

    Parameters
    ----------
    column : Column or sequence of Column
        The column, or several that could as well stand there (hollow or solid, with more or less on top): each draw
        takes one of them. Their joint stiffnesses do not count.
    measured : sequence of Measured, or str
        As :func:`parse_measured` reads it.
    model : DistinctElement2D or DistinctElement3D
        The law that makes k_b/J_A of k_n.
    ground : Ground, str or None
        On which it was measured, in words as :func:`parse_ground` reads them; None is rigid.
    draws : int
        Of ground and columns.
    seed : int

    Raises
    ------
    InputError
        A frequency that no stiffness gives, measurements that contradict one another, or a column whose joints are open.

    Notes
    -----
    All joints have one k_b/J_A and one k_s, each as probable at any order of magnitude; a measurement ±x has a
    lognormal error of that standard deviation. Ground and columns are drawn (seed), the two stiffnesses are
    integrated over on a grid for each draw, and the intervals are quantiles of what is left. A side is open where the
    end of the range, 1e6 or 1e14 N/m³, is likelier than a 95 % interval allows; the other side is then where the
    likelihood has fallen by as much.
    # Eq. (M4)
    """
    measured = parse_measured(measured) if isinstance(measured, str) else tuple(measured)
    ground = parse_ground(ground) if isinstance(ground, str) else ground
    check_measured(measured)
    check_whole("draws", draws, 1, 100_000)
    columns = list(column) if isinstance(column, Sequence) else [column]
    for candidate in columns:
        check_kind("column", candidate, Column)
    families = [_Family(candidate, model) for candidate in columns]
    springs = _ground_draws(ground, draws, seed)
    whole = (math.log(SOFTEST), math.log(STIFFEST))
    few = min(draws, 8 * len(families))
    coarse = _refined(_table(families, measured, springs, (whole, whole), FIRST, few), measured)
    _refuse_impossible(coarse, measured, columns[0], ground)
    box = _box(coarse, measured)
    posterior = None
    for _ in range(2):  # the second time where the first one has found the answer to be
        if box is not None:
            fine = _refined(_table(families, measured, springs, box, TABLE, draws), measured)
            posterior = _Posterior.of(fine, measured)
            box = _box(fine, measured)
    _refuse_contradiction(posterior, coarse, measured)
    assert posterior is not None
    first, second = posterior.interval(0), posterior.interval(1)
    variation = None
    if first.low is not None and first.high is not None:
        variation = math.sqrt(math.expm1((math.log(first.high / first.low) / (2.0 * TWO_SIDED)) ** 2))
    names = "joint_bending_stiffness", "joint_shear_stiffness"
    bounded = {
        name: _bounding(coarse, measured, axis, interval)
        for axis, (name, interval) in enumerate(zip(names, (first, second), strict=True))
    }
    return MeasuredJoints(
        columns[0], measured, first, second, bounded, posterior.best, variation, families[0].ratio, ground, draws
    )


def _ground_draws(ground: Ground | None, draws: int, seed: int) -> np.ndarray | None:
    """Springs of the ground for each draw: its three numbers are spread evenly (Sobol)."""
    if ground is None:
        return None
    from scipy.stats import qmc

    with np.errstate(all="ignore"):
        points = qmc.Sobol(3, rng=np.random.default_rng(seed)).random_base2(max(1, math.ceil(math.log2(draws))))
    return ground.stiffness(points[:draws])


def _table(
    families: Sequence[_Family],
    measured: Sequence[Measured],
    springs: np.ndarray | None,
    box: Box,
    points: int,
    draws: int,
) -> _Table:
    """Frequencies in a box of logarithms of stiffnesses; rigid ground and one column need no draws."""
    many = draws if springs is not None or len(families) > 1 else 1
    (a, b), (c, d) = box
    first, second = np.linspace(a, b, points), np.linspace(c, d, points)
    k, s = (np.exp(logarithms).ravel() for logarithms in np.meshgrid(first, second, indexing="ij"))
    values = np.empty((len(measured), many, points, points))
    for i in range(many):
        family = families[i % len(families)]
        under = None if springs is None else np.broadcast_to(springs[i], (len(k), 6))
        for kind in dict.fromkeys(reading.kind for reading in measured):
            which = [m for m, reading in enumerate(measured) if reading.kind == kind]
            squares = family.squares(kind, [measured[m].number for m in which], k, s, under)
            for m, column in zip(which, squares.T, strict=True):
                values[m, i] = column.reshape(points, points)
    return _Table(first, second, values)


def _score(table: _Table, measured: Sequence[Measured], blunt: float = 0.0) -> np.ndarray:
    """Log-likelihood of every draw and pair of stiffnesses, shape (M, K, L).  # Eq. (M4)

    ``blunt`` is a further error of the logarithm of a frequency, where a grid is coarse.
    """
    total = np.zeros(table.values.shape[1:])
    for reading, values in zip(measured, table.values, strict=True):
        size = math.hypot(math.log1p(reading.spread), blunt)
        total -= 0.5 * ((values - math.log(reading.frequency)) / size) ** 2
    return total


def _refined(table: _Table, measured: Sequence[Measured], points: int = FINE) -> _Table:
    """Frequencies on finer grids, by cubic splines over both stiffnesses of asinh(ω²/ω₀²).

    That is a logarithm of what vibrates, and goes on smoothly to what falls over; ω₀ is a tenth of what is measured.
    """
    from scipy.interpolate import CubicSpline

    def finer(old: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        new = np.linspace(old[0], old[-1], points)
        return new, CubicSpline(old, np.eye(len(old)), axis=0)(new)

    (first, weights), (second, other) = finer(table.bending), finer(table.shear)
    values = np.empty((*table.values.shape[:2], points, points))
    for own, out, squares in zip(measured, values, table.values, strict=True):
        scale = (0.1 * 2.0 * math.pi * own.frequency) ** 2
        surface = np.einsum("ka,dab,lb->dkl", weights, np.arcsinh(squares / scale), other, optimize=True)
        least = (2.0 * math.pi * math.exp(UNSTABLE)) ** 2
        out[...] = 0.5 * np.log(np.maximum(scale * np.sinh(surface), least)) - math.log(2.0 * math.pi)
    return _Table(first, second, values)


def _box(table: _Table, measured: Sequence[Measured]) -> Box | None:
    """Where the likelihood of some draw is not negligible, with a cell to every side; None where it is nowhere."""
    cell = 0.5 * max(table.bending[1] - table.bending[0], table.shear[1] - table.shear[0])
    near = np.ones(table.values.shape[1:], dtype=bool)
    for reading, values in zip(measured, table.values, strict=True):
        near &= np.abs(values - math.log(reading.frequency)) < FARTHEST * math.log1p(reading.spread) + cell
    region = near.any(axis=0)
    if not region.any():
        return None
    ends = []
    for old, seen in ((table.bending, region), (table.shear, region.T)):
        at = np.flatnonzero([bool(np.asarray(seen)[i].any()) for i in range(len(old))])
        ends.append((float(old[max(at[0] - 1, 0)]), float(old[min(at[-1] + 1, len(old) - 1)])))
    return ends[0], ends[1]


class _Posterior(NamedTuple):
    """Likelihood on a fine grid: summed over the draws, and the logarithm of the largest of any; both axes as of the
    table.
    """

    axes: tuple[np.ndarray, np.ndarray]
    summed: np.ndarray
    largest: np.ndarray
    best: dict[str, float]

    @classmethod
    def of(cls, table: _Table, measured: Sequence[Measured], blunt: float = 0.0) -> _Posterior:
        """Of measurements."""
        score = _score(table, measured, blunt)
        place = np.unravel_index(int(score.argmax()), score.shape)
        best = {
            reading.name: math.exp(float(values[place])) for reading, values in zip(measured, table.values, strict=True)
        }
        summed = np.exp(score - score.max()).sum(axis=0)
        return cls((table.bending, table.shear), summed, score.max(axis=0), best)

    def profile(self, axis: int) -> np.ndarray:
        """Largest log-likelihood over the other stiffness and all draws, less the largest of all."""
        return self.largest.max(axis=1 - axis) - float(self.largest.max())

    def opens(self, axis: int) -> tuple[bool, bool]:
        """Whether the end of the range is as likely as what is within a 95 % interval, at the lower and the upper side."""
        profile, values = self.profile(axis), self.axes[axis]
        ends = values[0] <= math.log(SOFTEST) + 1e-9, values[-1] >= math.log(STIFFEST) - 1e-9
        return ends[0] and profile[0] > -FALLS, ends[1] and profile[-1] > -FALLS

    def interval(self, axis: int) -> Interval:
        """Of a stiffness: quantiles of what is left; where a side is open, the other one by the likelihood."""
        low, high = self.opens(axis)
        values = self.axes[axis]
        if low or high:
            ends = self.ends(axis)
            return Interval(None, None if low else math.exp(ends[0]), None if high else math.exp(ends[1]))
        share = np.cumsum(self.summed.sum(axis=1 - axis))
        share = (share - 0.5 * self.summed.sum(axis=1 - axis)) / share[-1]
        first, middle, last = np.exp(np.interp((0.5, 0.025, 0.975), share, values)).tolist()
        return Interval(first, middle, last)

    def ends(self, axis: int) -> tuple[float, float]:
        """Where the likelihood has fallen as at the ends of a 95 % interval, logarithms."""
        profile, values = self.profile(axis), self.axes[axis]
        at = np.flatnonzero(profile > -FALLS)

        def between(inside: int, outside: int) -> float:
            if not 0 <= outside < len(values):
                return float(values[inside])
            share = (profile[inside] + FALLS) / (profile[inside] - profile[outside])
            return float(values[inside] + share * (values[outside] - values[inside]))

        return between(int(at[0]), int(at[0]) - 1), between(int(at[-1]), int(at[-1]) + 1)


def _bounding(coarse: _Table, measured: Sequence[Measured], axis: int, interval: Interval) -> dict[str, str | None]:
    """Which measurement bounds either side: without it that side moves farthest, on the coarse grid."""
    blunt = 0.5 * float(coarse.bending[1] - coarse.bending[0])
    whole = _Posterior.of(coarse, measured, blunt).ends(axis)
    moves = []
    for omitted in range(len(measured)):
        others = [reading for i, reading in enumerate(measured) if i != omitted]
        if not others:
            moves.append((math.inf, math.inf))
            continue
        rest = _Posterior.of(
            _Table(coarse.bending, coarse.shear, np.delete(coarse.values, omitted, axis=0)), others, blunt
        )
        ends = rest.ends(axis)
        moves.append((whole[0] - ends[0], ends[1] - whole[1]))
    by_side: dict[str, str | None] = {}
    for side, name in enumerate(("low", "high")):
        most = int(np.argmax([move[side] for move in moves]))
        by_side[name] = None if interval[1 + side] is None else measured[most].name
    return by_side


def _refuse_impossible(table: _Table, measured: Sequence[Measured], column: Column, ground: Ground | None) -> None:
    """Refuse a frequency that no stiffness of the joints gives."""
    for reading, values in zip(measured, table.values, strict=True):
        if values.max() <= UNSTABLE + 1.0:
            raise InputError(
                f"{column.name!r} falls over on this ground, whatever the stiffness of its joints; correct vs and "
                f"half_width.",
                "ground",
            )
        largest, least = math.exp(float(values.max())), math.exp(float(values[values > UNSTABLE + 1.0].min()))
        if reading.frequency > largest * (1.0 + 2.0 * reading.spread):
            rest = "rigid joints on this ground give" if ground is not None else f"joints of {STIFFEST:g} N/m³ give"
            remedy = (
                "is its mode another one, or the ground stiffer" if ground is not None else "is its mode another one"
            )
            raise InputError(
                f"{reading.name} of {column.name!r} is measured as {reading.frequency:g} Hz, which no stiffness of the "
                f"joints gives: "
                f"{rest} {largest:.4g} Hz at most; {remedy}? Correct it, or leave it out.",
                "measured",
            )
        if reading.frequency < least * (1.0 - 2.0 * reading.spread):
            raise InputError(
                f"{reading.name} of {column.name!r} is measured as {reading.frequency:g} Hz, which no stiffness of the "
                f"joints gives: on "
                f"joints on which it just stands it is {least:.4g} Hz; is its mode another one? Correct it, or "
                f"leave it out.",
                "measured",
            )


def _refuse_contradiction(posterior: _Posterior | None, coarse: _Table, measured: Sequence[Measured]) -> None:
    """Refuse measurements that no pair of stiffnesses gives together."""
    from scipy.stats import chi2

    best = -math.inf if posterior is None else float(posterior.largest.max())
    if -2.0 * best <= float(chi2.ppf(CONTRADICTS, len(measured))):
        return
    given = _Posterior.of(coarse, measured).best if posterior is None else posterior.best
    off = [abs(math.log(given[reading.name] / reading.frequency)) / math.log1p(reading.spread) for reading in measured]
    worst = measured[int(np.argmax(off))]
    nearest = ", ".join(f"{name} {value:.4g} Hz" for name, value in given.items())
    raise InputError(
        f"no stiffness of the joints gives these frequencies together; the nearest gives {nearest}, so that {worst.name}, "
        f"measured as {worst.frequency:g} Hz ± {100.0 * worst.spread:g} %, is off most: is its mode another one, the ground "
        "another, or its spread too small?",
        "measured",
    )
