"""What the header of a file states, held against its samples: steps, counts, lengths, peaks, directions, ends."""

from __future__ import annotations

import math
import re

import numpy as np

from stylobate.errors import InputError, OutOfRangeWarning, warn
from stylobate.messages import say
from stylobate.motion.motion import MAX_SAMPLES
from stylobate.motion.readers.numbers import NUMBER, number_in
from stylobate.motion.readers.record import CUT, LONGEST_STEP, SHORTEST_STEP, Component, direction

_FORTRAN = re.compile(r"\(\s*(?:\d*[pP]\s*,?\s*)?(\d*)\s*[feigFEIG](\d+)(?:\.\d+)?(?:[eE]\d+)?\s*\)")

#: Share of a stated peak by which the samples may depart from it: one g is 980 to 981 gal, and peaks are rounded.
PEAK_SHARE = 2e-3


#: Beyond this share, the peak and the samples are not of the same record.
WRONG_SHARE = 0.02


#: A label within a line: a bearing in one to three words, or a word.
LABEL = r"(?:[NS]\s*\d[\d.]*\s*[EW]\b|\S+)"


def check_step(dt: float | None, file: str, line: int) -> float:
    """A step that an accelerograph may have had, or a refusal."""
    if dt is None or not SHORTEST_STEP <= dt <= LONGEST_STEP:
        raise InputError(
            f"{file}, line {line}: the header states a step of {'no' if dt is None else f'{dt:g}'} s; records have "
            f"{SHORTEST_STEP:g} to {LONGEST_STEP:g} s: fetch the file again, or convert it to columns."
        )
    return dt


def check_count(count: float | None, file: str, line: int, what: str = "samples") -> int:
    """A number of samples as a header states it, refused when it is impossible."""
    if count is None or not math.isfinite(count) or count != int(count) or not 2 <= count <= MAX_SAMPLES:
        raise InputError(
            f"{file}, line {line}: the header promises {count if count is None else f'{count:g}'} {what}; "
            f"allowed is a whole number from 2 to {MAX_SAMPLES}, so fetch the file again."
        )
    return int(count)


def check_length(count: int, dt: float, stated: str | float | None, file: str, line: int) -> None:
    """A stated length of the record is that of the samples, to the digit in which it is given.

    Networks count from the first to the last sample, or one step more.
    """
    if stated is None:
        return
    length, half = printed(stated)
    slack = 0.51 * dt + half
    if length > 0.0 and not (count - 1) * dt - slack <= length <= count * dt + slack:
        raise InputError(
            f"{file}, line {line}: {count} samples of {dt:g} s last {count * dt:g} s, the header states {length:g} s; "
            f"{CUT}."
        )


def check_peak(
    values: np.ndarray,
    stated: str | float | None,
    size: float,
    file: str,
    line: int,
    *,
    wrong: float = WRONG_SHARE,
    what: str = say("peak"),
) -> None:
    """The largest sample is the peak that the header states.

    Parameters
    ----------
    values : array
        As read, in SI.
    stated : str or float or None
        The peak as printed, of either sign.
    size : float
        Its unit in SI.
    wrong : float
        Share of the peak beyond which the file is refused; a smaller departure is warned about.
    """
    if stated is None:
        return
    peak, half = printed(stated)
    peak, half = abs(peak) * size, half * size
    if peak == 0.0:
        return
    actual = float(np.abs(values).max())
    apart = abs(actual - peak) - 1.01 * half - 1e-6 * peak
    words = say("{file}, line {line}: the header states a {what} of {peak:g}, the samples hold {found:.6g}")
    text = words.of(file=file, line=line, what=what, peak=peak / size, found=actual / size)
    if apart > wrong * peak:
        raise InputError(f"{text}; {CUT}.")
    if apart > PEAK_SHARE * peak:
        warn(say("{text}: the header may be of another processing.", text=text))


def check_peak_time(values: np.ndarray, dt: float, stated: str | float | None, file: str, line: int) -> None:
    """The peak stands where the header states it, or at a sample as large; else a warning."""
    if stated is None:
        return
    time, half = printed(stated)
    if time <= 0.0:
        return
    first = max(0, round((time - half) / dt) - 1)
    last = round((time + half) / dt) + 1
    near = np.abs(values[first : last + 1])
    if near.size == 0 or near.max() < 0.98 * np.abs(values).max():
        at = int(np.abs(values).argmax()) * dt
        warn(
            say(
                "{file}, line {line}: the header states its peak at {time:g} s, the samples have it at {at:g} s; check the "
                "step and whether samples are missing.",
                file=file,
                line=line,
                time=time,
                at=at,
            ),
            OutOfRangeWarning,
        )


def check_direction(component: Component, stated: float, file: str, line: int) -> None:
    """An azimuth in the numbers of a header is that of the label; codes beyond 360 are none."""
    if component.azimuth is None or not 0.0 < stated <= 360.0:
        return
    apart = abs((component.azimuth - stated + 180.0) % 360.0 - 180.0)
    if apart > 1.0:
        raise InputError(
            f"{file}, line {line}: the text states the direction {component.label!r}, the numbers {stated:g}°; "
            "the file is damaged, fetch it again."
        )


def check_ended(ended: bool, file: str, line: int, mark: str) -> None:
    """The mark that closes a channel is there."""
    if not ended:
        raise InputError(f"{file}, line {line}: the samples end without the mark {mark!r} that closes them; {CUT}.")


def warn_of_missing(count: int, stated: int | None, file: str) -> None:
    """Fewer components than the header speaks of: the file may have been cut between two of them."""
    if stated is not None and count < stated:
        warn(
            say(
                "{file}: the header speaks of {stated} components, the file holds {found}; check that it is whole.",
                file=file,
                stated=stated,
                found=count,
            ),
            OutOfRangeWarning,
        )


def oriented(component: Component) -> Component:
    """Fill in azimuth and vertical from the label, and turn a downward component upward."""
    azimuth, vertical, sign = direction(component.label)
    component.vertical = vertical
    component.azimuth = azimuth if component.azimuth is None and not vertical else component.azimuth
    if sign < 0.0:
        component.values = -component.values
        component.processing.append(say("sign turned: the file counts downward as positive, here upward is"))
    return component


def printed(stated: str | float) -> tuple[float, float]:
    """A number as printed, and half a unit of its last digit."""
    if isinstance(stated, (float, int)):
        return float(stated), 0.0
    value = number_in(stated)
    if value is None:
        return 0.0, 0.0
    text = stated.strip().rstrip(".").lower().replace("d", "e")
    digits, _, power = text.partition("e")
    decimals = len(digits.partition(".")[2])
    return value, 0.5 * 10.0 ** (int(power or 0) - decimals) if re.fullmatch(NUMBER, stated.strip()) else 0.0


def fortran_width(text: str) -> int | None:
    """Width of a field in a Fortran format such as ``(8f10.6)`` found in ``text``, or None."""
    match = _FORTRAN.search(text)
    width = int(match.group(2)) if match else 0
    return width if 1 <= width <= 40 else None
