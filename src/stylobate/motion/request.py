"""The request for motions as one value: from what, in which directions, at which size. It expands into motions."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np

from ..constants import g
from ..errors import InputError, OutOfRangeWarning, check_all, check_choice, check_kind, check_range, warn
from ..messages import say
from .conditioning import conditioned_alike, warn_of_peak, warn_of_scaling
from .motion import FACTORS, Motion
from .orientation import keep_axes, rotated, turned
from .readers import Suite, read_motion, read_suite
from .readers.columns import parse_columns
from .specs import (
    azimuth_range,
    parse_acceleration,
    parse_angle,
    parse_harmonic,
    parse_number,
    parse_pulse,
    parse_synthetic,
    parse_time,
)

#: Of which a motion comes, by the parameters of a request.
SOURCES = ("harmonic", "pulse", "synthetic", "files")

#: Choices for the horizontal components of a record besides one of them by name.
COMPONENTS = ("all", "strongest")

#: Time that follows a pulse whose length is left open, times p of the column [-]: free rocking from close to overturning
#: has come to a verdict by then.
FREE_ROCKING = 20.0


#: Azimuths that differ by less are one direction [degrees].
SAME_DIRECTION = 1e-6


@dataclass(frozen=True)
class MotionRequest:
    """Requests for motions: the same for the command line, study files and pages.

    Exactly one of ``harmonic``, ``pulse``, ``synthetic`` and ``files`` is given. The steps are taken in the order of the
    parameters below.

    Parameters
    ----------
    harmonic, across : str, optional
        As typed: ``1.0Hz,0.3g,10s``, and a second sine along y, ``1.0Hz,0.15g,90deg``.
    pulse, synthetic : str, optional
        As typed: ``ricker,1.0Hz,0.3g``; ``greece,6.5Mw,20km,seed=3``.
    files : tuple of path
        The files of the components of one record, or one folder of records.
    separate : bool
        Each of the files is a record of its own, or a folder of them.
    unit : str, optional
        Of files that state none.
    dt : float, optional
        Step of files without times [s].
    columns : str, optional
        Of text files whose header is not ours: ``t [s], x [g], -, z [g]``.
    component : str, optional
        ``all`` horizontal components of a record, one after the other as x; the ``strongest``; or one alone, by its number,
        label or azimuth. As recorded by default.
    azimuths : tuple of float
        To each of which the whole motion is turned (:func:`stylobate.motion.rotated`) [degrees]; as it is by default.
    signs : str
        ``+``, or ``both``: reversed as well, which is turned by 180°; the vertical component stays upward.
    condition : tuple of str
        Steps of conditioning as typed: ``bandpass=0.1Hz,25Hz``.
    scale : float, optional
        Multiplies every component [-].
    pga : float, optional
        The peak along x that every component is scaled for [m/s²]; of several azimuths that of the strongest, and all have
        the same factor.
    vertical : bool
        The vertical component acts.

    Raises
    ------
    InputError
        No motion or several are asked for, or options of a record without one.
    """

    harmonic: str | None = None
    across: str | None = None
    pulse: str | None = None
    synthetic: str | None = None
    files: tuple[str | Path, ...] = ()
    separate: bool = False
    unit: str | None = None
    dt: float | None = None
    columns: str | None = None
    component: str | None = None
    azimuths: tuple[float, ...] = ()
    signs: str = "+"
    condition: tuple[str, ...] = ()
    scale: float | None = None
    pga: float | None = None
    vertical: bool = True

    def __post_init__(self) -> None:
        for name, kind in (("files", (str, Path)), ("azimuths", Real), ("condition", str)):
            object.__setattr__(self, name, tuple(check_all(name, getattr(self, name), kind)))
        for name in ("harmonic", "across", "pulse", "synthetic", "unit", "columns"):
            check_kind(name, getattr(self, name), str, optional=True)
        check_kind("component", self.component, (str, int), optional=True)
        if self.columns is not None:
            parse_columns(self.columns)
        if self.scale is not None:
            check_range("`scale`", self.scale, *FACTORS)
        for name in ("dt", "pga"):
            check_kind(name, getattr(self, name), Real, optional=True)
        given = [f"`{source}`" for source in SOURCES if getattr(self, source) not in (None, ())]
        if len(given) != 1:
            what = "no motion is given" if not given else f"{' and '.join(given)} are both given"
            raise InputError(f"{what}; give one of `harmonic`, `pulse`, `synthetic` and `files`.", "files")
        for name in ("unit", "dt", "columns", "component"):
            if getattr(self, name) is not None and not self.files:
                raise InputError(f"`{name}` describes a record, but none is given; leave it out or give `files`.", name)
        if self.across is not None and self.harmonic is None:
            raise InputError("`across` is the sine along y beside that along x; give `harmonic` as well.", "across")
        check_choice("`signs`", self.signs, ("+", "both"))
        if self.scale is not None and self.pga is not None:
            raise InputError("`scale` and `pga` are both given; give one of the two.", "pga")
        for azimuth in self.azimuths:
            check_range("azimuth", azimuth, -360.0, 360.0, unit="degrees")
        if (same := self._two_apart(0.0)) is not None:
            raise InputError(
                f"the azimuths hold {same[0]:g}° and {same[1]:g}°, which are one direction; give each direction once, such "
                "as 0:330:12 for a full circle.",
                "azimuths",
            )
        opposite = self._two_apart(180.0)
        if self.signs == "both" and opposite is not None:
            warn(
                say(
                    "the azimuths hold {one:g}° and {other:g}°, each of which is the other one reversed, and both signs are "
                    "asked for as well, so that directions are computed twice: a full circle holds both signs; leave "
                    "`signs='both'` out, or give half of the circle, such as 0:150:6.",
                    one=opposite[0],
                    other=opposite[1],
                ),
                OutOfRangeWarning,
            )

    def _two_apart(self, angle: float) -> tuple[float, float] | None:
        """The first two azimuths that are so far apart [degrees]."""
        pairs = combinations(self.azimuths, 2)
        return next(
            (two for two in pairs if abs((two[1] - two[0] - angle + 180.0) % 360.0 - 180.0) < SAME_DIRECTION), None
        )

    @classmethod
    def typed(
        cls,
        *,
        motion: Sequence[str | Path] | None = None,
        azimuth: str | None = None,
        vertical: str = "on",
        **words: Any,
    ) -> MotionRequest:
        """The request as a person types it, by the names of options: quantities with their units.

        Parameters
        ----------
        motion : sequence of path, optional
            ``files``.
        azimuth : str, optional
            ``30deg``; or several ``azimuths``, ``0:330:12``.
        vertical : str
            ``on`` or ``off``.
        **words
            Any of the other parameters of :class:`MotionRequest`: ``dt="0.01s"``, ``scale="1.5"``, ``pga="0.4g"``.
        """
        if azimuth is not None and words.get("azimuths") is not None:
            raise InputError("`azimuth` and `azimuths` are both given; give one of the two.", "azimuth")
        check_choice("`vertical`", vertical, ("on", "off"))
        read: dict[str, Callable[[Any], Any]] = {
            "azimuths": lambda text: tuple(azimuth_range(text).tolist()),
            "dt": lambda text: parse_time(text, "dt"),
            "scale": lambda text: parse_number("`scale`", text),
            "pga": lambda text: parse_acceleration(text, "pga"),
        }
        made = {name: read.get(name, lambda text: text)(text) for name, text in words.items() if text is not None}
        if azimuth is not None:
            made["azimuths"] = (parse_angle(azimuth, "azimuth"),)
        return cls(files=tuple(motion or ()), vertical=vertical == "on", **made)

    @property
    def several(self) -> bool:
        """Whether it may expand into several motions: a folder, files that are records, several directions or signs."""
        folders = [path for path in self.files if Path(path).is_dir()]
        if folders and len(self.files) > 1 and not self.separate:
            raise InputError(
                f"`files` is {folders[0]}, a folder, and other paths; give one folder, or files of one record."
            )
        many = self.separate or bool(folders)
        return many or self.component == "all" or len(self.azimuths) > 1 or self.signs == "both"

    def motion(self, frequency_parameter: float | None = None, *, amplitude_open: bool = False) -> Motion:
        """The one motion that is asked for.

        Parameters
        ----------
        frequency_parameter : float, optional
            p of the column that is shaken [rad/s]: a pulse whose length is left open is followed by 20/p.
        amplitude_open : bool
            The amplitude is what is looked for: ``?g`` in a harmonic or a pulse, which then has 1 m/s².

        Raises
        ------
        InputError
            Several motions are asked for, or the motion cannot be made.
        """
        folder = next((path for path in self.files if Path(path).is_dir()), None)
        if folder is not None and not self.separate:
            raise InputError(f"{folder} is a folder; give the file or the files of one record here.")
        if self.several:
            raise InputError("several motions are asked for; one motion, one direction and one sign can be given here.")
        (motion,) = self._variants(self._source(frequency_parameter, amplitude_open))
        return motion

    def expand(self, frequency_parameter: float | None = None, *, amplitude_open: bool = False) -> Suite:
        """All motions that are asked for, and what could not be used, with the reason; see :meth:`motion`.

        Raises
        ------
        InputError
            Not one of them can be used.
        """
        if not self.several:
            return Suite((_without_origin(self.motion(frequency_parameter, amplitude_open=amplitude_open)),), {})
        if self.separate or any(Path(path).is_dir() for path in self.files):
            picked = None if self.component in COMPONENTS else self.component
            suite = read_suite(self._listed(), self.unit, self.dt, columns=self.columns, component=picked)
        else:
            suite = Suite((self._source(frequency_parameter, amplitude_open),), {})
        motions, refused = [], dict(suite.refused)
        for motion in suite.motions:
            try:
                motions += self._variants(motion)
            except InputError as error:
                refused[motion.name] = str(error)
        if not motions:
            raise InputError(f"no record of the suite can be used; the first reason: {next(iter(refused.values()))}")
        return Suite(tuple(map(_without_origin, motions)), refused)

    def _listed(self) -> list[Path]:
        paths: list[Path] = []
        for path in map(Path, self.files):
            paths += sorted(p for p in path.iterdir() if p.is_file() and p.name[0] != ".") if path.is_dir() else [path]
        if not paths:
            raise InputError(f"{' and '.join(map(str, self.files))} holds no file; give a folder of records, or files.")
        return paths

    def _source(self, frequency_parameter: float | None, amplitude_open: bool) -> Motion:
        """The motion as it is recorded or computed."""
        if self.files:
            picked = None if self.component in COMPONENTS else self.component
            return read_motion(self.files, self.unit, self.dt, columns=self.columns, component=picked)
        if self.synthetic is not None:
            return parse_synthetic(self.synthetic)
        if self.harmonic is not None:
            motion, unknown = parse_harmonic(self.harmonic, self.across, allow_unknown=True)
        else:
            motion, unknown = parse_pulse(str(self.pulse), allow_unknown=True)
            if frequency_parameter is not None:
                length = motion.metadata["pulse_length"] + FREE_ROCKING / frequency_parameter
                motion, unknown = parse_pulse(str(self.pulse), length, allow_unknown=True)
        if unknown and not amplitude_open:
            name, text = ("harmonic", self.harmonic) if self.harmonic is not None else ("pulse", self.pulse)
            raise InputError(f"`{name}` {text!r} leaves the amplitude open; state it here, such as 0.3g.", "amplitude")
        if amplitude_open and not unknown:
            raise InputError(
                f"the motion {self.harmonic or self.pulse!r} states its amplitude, which is what is looked for; write ?g "
                "for it.",
                "amplitude",
            )
        return motion

    def _variants(self, motion: Motion) -> list[Motion]:
        """The motion in every direction and with every sign asked for, conditioned and scaled."""
        variants = []
        for first in _as_x(motion, self.component):
            ready = []
            for azimuth in self.azimuths or (None,):
                variant = first if azimuth is None else self._turned(first, azimuth)
                if azimuth is not None or self.signs == "both":
                    known = _direction(variant, motion.name) | ({} if azimuth is None else {"azimuth": azimuth})
                    variant = variant.replace(metadata={**variant.metadata, "direction": known})
                if len(self.azimuths) > 1:
                    variant = variant.replace(name=f"{variant.name} at {azimuth:g}°")
                ready += [variant, _reversed(variant, motion.name)] if self.signs == "both" else [variant]
            for step in self.condition:
                ready = conditioned_alike(ready, step)
            strongest = max(ready, key=lambda variant: variant.pga)
            variants += [self._sized(variant, strongest) for variant in ready]
        return variants

    def _turned(self, motion: Motion, azimuth: float) -> Motion:
        if motion.y_samples is None and not self.files:  # a computed motion along x has nothing along y
            motion = motion.replace(ay=np.zeros(motion.steps))
        return rotated(motion, azimuth)

    def _sized(self, motion: Motion, strongest: Motion) -> Motion:
        """The motion as large as asked for; turned ones are that of one record, with the factor of the strongest."""
        if self.scale is not None:
            processing = (*motion.processing, say("multiplied by {self.scale:g}", self=self))
            motion = motion.scaled(self.scale).replace(processing=processing)
        if self.pga is not None:
            times = strongest.scaled_to_pga(self.pga).factor / strongest.factor
            size = say("{peak:g} g", peak=self.pga / g)
            text = say("multiplied by {times:.4g}: scaled to a peak of {size} along x", times=times, size=size)
            if len(self.azimuths) > 1:
                motion = motion.scaled(times).replace(name=f"{motion.name}, scaled to {size}")
                text = say("{step}, that of the strongest of these directions", step=text)
            else:
                motion = motion.scaled_to_pga(self.pga)
            motion = motion.replace(processing=(*motion.processing, text))
        if self.scale is not None or self.pga is not None:
            warn_of_scaling(motion)
        warn_of_peak(motion)
        return motion if self.vertical else keep_axes(motion, "xy")


def _without_origin(motion: Motion) -> Motion:
    """A motion of a suite as a record of its own, called as it was asked for: each is of another one."""
    return motion.replace(metadata={key: value for key, value in motion.metadata.items() if key != "record"})


def _as_x(motion: Motion, component: str | None) -> Iterator[Motion]:
    """The motion with the horizontal components as x that are asked for; the other one then is y."""
    if component not in COMPONENTS or motion.lateral is None:
        yield motion
        return
    second = turned(motion, 90.0)
    if component == "all":
        facts = {"direction": _direction(motion, motion.name)}
        yield motion.replace(name=f"{motion.name} first component", metadata={**motion.metadata, **facts})
        yield second.replace(name=f"{motion.name} second component", metadata={**second.metadata, **facts})
    else:
        yield motion if motion.pga >= second.pga else second


def _direction(motion: Motion, record: str) -> dict[str, Any]:
    """Direction to which a motion has been turned, and the record that it is made of."""
    return {"record": record, "reversed": False, **motion.metadata.get("direction", {})}


def _reversed(motion: Motion, record: str) -> Motion:
    """The motion turned by 180°, so that x and y point the other way; ``direction`` tells where x pointed before."""
    y = motion.y_samples
    azimuths = dict(motion.metadata.get("azimuths") or {})
    direction = {"azimuth": azimuths.get("x"), **_direction(motion, record), "reversed": True}
    azimuths |= {axis: (azimuths[axis] + 180.0) % 360.0 for axis in "xy" if azimuths.get(axis) is not None}
    return motion.replace(
        ax=-motion.samples,
        ay=None if y is None else -y,
        name=f"{motion.name} reversed",
        metadata={**motion.metadata, "direction": direction} | ({"azimuths": azimuths} if azimuths else {}),
        processing=(*motion.processing, say("horizontal components reversed")),
    )
