"""Values that a header states twice are compared with what was read: counts, steps, lengths, peaks, end marks."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from ...errors import InputError, OutOfRangeWarning, warn
from .numbers import NUMBER, number_in

#: Steps of accelerographs [s]: 5000 to 5 samples per second.
SHORTEST_STEP, LONGEST_STEP = 2e-4, 0.2

#: A step of film this many times the steps of its neighbours, so many on either side, may be a lost line.
GAP, NEIGHBOURS = 2.8, 3

#: Share of a stated peak by which the samples may depart from it: one g is 980 to 981 gal, and peaks are rounded.
PEAK_SHARE = 2e-3

#: Beyond this share, the peak and the samples are not of the same record.
WRONG_SHARE = 0.02

CUT = "the file is damaged or cut, fetch it again"


def check_step(dt: float | None, file: str, line: int) -> float:
    """A step that an accelerograph may have had, or a refusal."""
    if dt is None or not SHORTEST_STEP <= dt <= LONGEST_STEP:
        raise InputError(
            f"{file}, line {line}: the header states a step of {'no' if dt is None else f'{dt:g}'} s; records have "
            f"{SHORTEST_STEP:g} to {LONGEST_STEP:g} s: fetch the file again, or convert it to columns."
        )
    return dt


def check_sampling(dt: float, what: str) -> float:
    """A step of samples that is one of accelerographs, wherever it comes from; milliseconds are no seconds.

    Parameters
    ----------
    dt : float
        [s]
    what : str
        Whose step, for the message.
    """
    if not SHORTEST_STEP <= dt <= LONGEST_STEP:
        thousandth = dt > LONGEST_STEP and 1e-3 * dt >= SHORTEST_STEP
        remedy = (
            f"if it counts milliseconds, name the column time_ms (without times: `dt={1e-3 * dt:g}`)"
            if thousandth
            else "mend it"
        )
        raise InputError(
            f"{what} is {dt:g} s; allowed is {SHORTEST_STEP:g} to {LONGEST_STEP:g} s, as accelerographs have: {remedy}."
        )
    return dt


def rising_pairs(numbers: np.ndarray, file: str, start: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
    """Times and values of pairs, refused where a time falls, or where samples are missing between two of them.

    Parameters
    ----------
    numbers : array
        Time [s] and value in turn, shape (2 N,).
    file : str
    start, rows : int
        Lines above the pairs, and lines that hold them, the last one perhaps fewer than the others.
    """
    time, values = numbers.reshape(-1, 2).T.copy()
    steps = np.diff(time)
    per_row = -(-len(time) // rows)

    def where(at: int) -> str:
        line = start + (at + 1) // per_row + 1
        return f"{file}, line {line}: the time goes from {time[at]:g} s to {time[at + 1]:g} s"

    if (steps < 0.0).any():
        raise InputError(f"{where(int((steps < 0.0).argmax()))}, where it may not fall; mend it.")
    at = int(steps.argmax())
    if steps[at] > LONGEST_STEP:
        raise InputError(f"{where(at)}, a gap beyond the {LONGEST_STEP:g} s that records have between samples; {CUT}.")
    largest = np.lib.stride_tricks.sliding_window_view(np.pad(steps, NEIGHBOURS, mode="edge"), NEIGHBOURS).max(axis=1)
    around = np.maximum(largest[: len(steps)], largest[NEIGHBOURS + 1 :])  # of those before, and of those behind
    bad = np.flatnonzero(steps > GAP * around)
    if bad.size:
        warn(
            f"{where(int(bad[0]))}, {GAP:g} times the steps before and behind it and more; check that no line is missing.",
            OutOfRangeWarning,
        )
    return time, values


def check_same_step(first: float, second: float, file: str, line: int) -> None:
    """Two statements of one step agree, but for rounding."""
    if abs(first - second) > 0.01 * first:
        raise InputError(
            f"{file}, line {line}: the header states a step of {first:g} s and one of {second:g} s; {CUT}."
        )


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
    what: str = "peak",
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
    found = float(np.abs(values).max())
    apart = abs(found - peak) - 1.01 * half - 1e-6 * peak
    text = f"{file}, line {line}: the header states a {what} of {peak / size:g}, the samples hold {found / size:.6g}"
    if apart > wrong * peak:
        raise InputError(f"{text}; {CUT}.")
    if apart > PEAK_SHARE * peak:
        warn(f"{text}: the header may be of another processing.")


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
            f"{file}, line {line}: the header states its peak at {time:g} s, the samples have it at {at:g} s; check "
            "the step and whether samples are missing.",
            OutOfRangeWarning,
        )


def check_whole(lines: Sequence[str], ends_with_newline: bool, file: str) -> None:
    """The last number of a text was not cut: its digits are those of the numbers before it."""
    if ends_with_newline or not lines:
        return
    tokens = [token for line in lines[-8:] for token in re.split(r"[\s,;]+|(?<=[0-9.])(?=[+-])", line.strip()) if token]
    shapes = [_decimals(token) for token in tokens]
    if len(shapes) < 5 or any(shape is None for shape in shapes):
        return
    if len(set(shapes[:-1])) == 1 and shapes[-1] != shapes[0]:
        raise InputError(
            f"{file}, line {len(lines)}: the last number, {tokens[-1]!r}, has other digits than those before it and no "
            f"line end follows; {CUT}."
        )


def check_ended(ended: bool, file: str, line: int, mark: str) -> None:
    """The mark that closes a channel is there."""
    if not ended:
        raise InputError(f"{file}, line {line}: the samples end without the mark {mark!r} that closes them; {CUT}.")


def warn_of_missing(found: int, stated: int | None, file: str) -> None:
    """Fewer components than the header speaks of: the file may have been cut between two of them."""
    if stated is not None and found < stated:
        warn(
            f"{file}: the header speaks of {stated} components, the file holds {found}; check that it is whole.",
            OutOfRangeWarning,
        )


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


def _decimals(token: str) -> tuple[int, int] | None:
    """Digits after the point and of the exponent, or None where the token is no plain number."""
    found = re.fullmatch(r"[+-]?[0-9]*(?:\.(?P<after>[0-9]*))?(?:[eEdD][+-]?(?P<power>[0-9]+))?", token)
    if found is None or "." not in token:
        return None
    return len(found["after"] or ""), len(found["power"] or "")
