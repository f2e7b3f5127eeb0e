"""Contents of a file before it becomes a motion: components with their direction, and the facts of the header."""

from __future__ import annotations

import math
import re

import numpy as np

from ...constants import g
from ...errors import InputError, warn
from ...messages import say
from ...percent import percent
from ..drift import as_asked, best_of, cures_of
from ..motion import MAX_SAMPLES, STRONGEST, Motion, integrate
from .component import Component
from .steps import resampled, same_step
from .together import check_one_record, common_span

#: A mean beyond this share of the peak is not an earthquake: an instrument's offset was left in.
OFFSET_SHARE = 0.1

#: A smaller peak is not recorded on purpose [g]: the unit is wrong, or the numbers are raw counts.
SMALLEST_PEAK = 1e-3

#: A velocity beyond every recorded one [m/s]: the unit is wrong, or the baseline has drifted away.
LARGEST_VELOCITY = 10.0


#: A label within a line: a bearing in one to three words, or a word.
LABEL = r"(?:[NS]\s*\d[\d.]*\s*[EW]\b|\S+)"
_ANGLE = r"(?P<angle>\d{1,3}(?:\.\d*)?)\s*(?:°|DEG\.?)?"
#: ``N10.5E`` anywhere; ``N345`` and ``90 DEG`` at the beginning of a label.
_BEARING = re.compile(rf"\b(?P<pole>[NS])\s*{_ANGLE}\s*(?P<side>[EW])\b")
_FROM_NORTH = re.compile(rf"N\.?\s*(?=\d\d){_ANGLE}(?!\w)")
_DEGREES = re.compile(rf"[+]?{_ANGLE}(?=[\s,;:]|$)")
_POINTS = {
    "N": 0.0, "NS": 0.0, "E": 90.0, "EW": 90.0, "S": 180.0, "SN": 180.0, "W": 270.0, "WE": 270.0,
    "NE": 45.0, "SE": 135.0, "SW": 225.0, "NW": 315.0,
}  # fmt: skip
#: SEED codes of accelerometers whose last letter is a direction; any code that ends in Z is vertical. The two signs of a
#: location may touch the code, as in HNZ00 and 00HNZ.
_CODE = re.compile(r"(?:\d\d)?(?:[BCDEFGHLMS][NLG](?P<way>[NEV])|[A-Z]{2}(?P<up>Z))(?:\d[A-Z0-9]|[A-Z]\d)?")
#: A vertical of a sensor, wherever its code stands in a label: XX.HILL.00.HNZ.
_CODE_UP = re.compile(r"(?:\d\d)?[BCDEFGHLMS][HLNG]Z(?:\d[A-Z0-9]|[A-Z]\d)?")
#: Words of the vertical that leave its sense open, which then is upward; and those that state it.
_UPRIGHT = {"V", "Z", "VER", "VRT", "VERT", "VERTIC", "VERTICAL"}
_UP = {"U", "UP", "UD", "UPDN", "UPDOWN", "UPWARD", "UPWARDS"}
_DOWN = {"D", "DN", "DWN", "DU", "DOWN", "DNUP", "DOWNUP", "DOWNWARD", "DOWNWARDS"}


def direction(label: str) -> tuple[float | None, bool, float]:
    """Azimuth [degrees], whether vertical, and the sign that makes upward positive, from a label of any network.

    ``90 DEG``, ``N10.5E``, ``S74E``, ``N345``, ``Up``, ``-UP``, ``Vert(Down)``, ``Roof UP``, ``NORTH-SOUTH``, ``HNZ``,
    ``H1`` (azimuth unknown).
    """
    text = re.sub(r"COMP(?:ONENT)?", " ", label.upper().replace("_", " ")).strip(" .:;")
    text = re.sub(r"\b([NSEW])(?:ORTH|OUTH|AST|EST)\b", r"\1", text)
    words = re.findall(r"[A-Z0-9]+", text)
    minus = -1.0 if re.match(r"-\s*[A-Z]", text) or re.search(r"[A-Z](?:;?-|\s?\(-\))$", text) else 1.0
    bare = words[0].rstrip("0123456789") if words else ""
    if bare in (_UPRIGHT | _UP | _DOWN) - {"U", "D", "V"}:  # UP1, VERT00, Z00
        words[0] = bare
    code = _CODE.fullmatch(words[0]) if words else None
    if words and (words[0] in _UPRIGHT or (code and (code["up"] or code["way"] == "V"))):
        return None, True, -minus if len(words) > 1 and words[1] in _DOWN and len(words[1]) > 1 else minus
    if words and words[0] in _UP | _DOWN:
        return None, True, -minus if words[0] in _DOWN else minus
    if any(map(_CODE_UP.fullmatch, words)):
        return None, True, minus
    if minus < 0.0 or re.match(r"-\s*\d", text):  # against a direction that is not vertical: whose, is not known
        return None, False, 1.0
    if (found := _BEARING.search(text)) and float(found["angle"]) <= 90.0:
        angle = float(found["angle"])
        angle = angle if found["pole"] == "N" else 180.0 - angle
        return (angle if found["side"] == "E" else -angle) % 360.0, False, 1.0
    if (found := _FROM_NORTH.match(text) or _DEGREES.match(text)) and float(found["angle"]) <= 360.0:
        return float(found["angle"]) % 360.0, False, 1.0
    if code:
        return _POINTS[code["way"]], False, 1.0
    first = re.split(r"[\s,.;:]", text)[0].replace("-", "", not text.startswith("-")).replace("/", "")
    if first in _POINTS and not re.search(r"^\w+\W+\d|\d\s*(?:°|DEG)", text):  # of N 5 the angle is not known
        return _POINTS[first], False, 1.0
    if upright := [word for word in words if len(word) > 1 and word in _UPRIGHT | _UP | _DOWN]:  # Roof UP
        return None, True, -minus if upright[-1] in _DOWN else minus
    return None, False, 1.0


def oriented(component: Component) -> Component:
    """Fill in azimuth and vertical from the label, and turn a downward component upward."""
    azimuth, vertical, sign = direction(component.label)
    component.vertical = vertical
    component.azimuth = azimuth if component.azimuth is None and not vertical else component.azimuth
    if sign < 0.0:
        component.values = -component.values
        component.processing.append(say("sign turned: the file counts downward as positive, here upward is"))
    return component


def assemble(
    components: list[Component], name: str, *, component: str | None = None, dt: float | None = None
) -> Motion:
    """Make a motion of the components of one record: the first two horizontal ones are x and y, the vertical one z.

    Parameters
    ----------
    components : list of Component
        With the facts of their files; those of x hold for the motion.
    name : str
        Of the motion and in messages.
    component : str, optional
        Label, azimuth in degrees or number (from 1) of the one component that is to be x.
    dt : float, optional
        Step for a record whose steps are unequal [s].

    Raises
    ------
    InputError
        No horizontal component, several records, components of different steps, or whose times do not overlap.
    """
    if component is not None:
        chosen = _choose(components, component, name)
        name = chosen.file or name
        components, rest = [chosen], [one for one in components if one is not chosen]
        chosen.vertical = False
        dropped = [one.label or "?" for one in rest]
    else:
        dropped = []
    horizontal = [one for one in components if not one.vertical]
    vertical = [one for one in components if one.vertical]
    if not horizontal:
        raise InputError(
            f"{name} holds only the vertical component {vertical[0].label!r}, and a motion needs a horizontal one; "
            "give the horizontal files with it.",
            "component",
        )
    if len(horizontal) > 2 or len(vertical) > 1:
        raise InputError(
            f"{name} holds {len(components)} components ({', '.join(one.label or '?' for one in components)}), more "
            "than one place's two horizontal ones and the vertical; choose one by its number with `component='1'`.",
            "component",
        )
    used = horizontal + vertical
    check_one_record(used)
    histories = {tuple(one.history): one.file for one in used}
    processing = [
        text if len(histories) == 1 else f"{file}: {text}" for steps, file in histories.items() for text in steps
    ]
    axes = [axis for axis, _ in zip(["x", "y"], horizontal)] + ["z"] * len(vertical)
    step = same_step(used, name, dt, processing)
    values, last, note = common_span(used, axes, step)
    if note:
        processing.append(note)
        warn(say("{name}: {note}.", name=name, note=note))
    for axis, one in zip(axes, used):
        processing += [say("{axis}: {text}", axis=axis, text=text) for text in one.processing]
    _warn_of_peak(values, step, name)
    _warn_of_offset(values, name)
    facts = used[0].facts | {key: last.facts[key] for key in ("start_time", "first_time") if key in last.facts}
    facts |= {
        "azimuths": {axis: one.azimuth for axis, one in zip(axes, used)},
        "labels": {axis: one.label for axis, one in zip(axes, used)},
        "dt_found": step if all(one.time is None for one in used) else None,
        "components": {axis: dict(one.metadata) for axis, one in zip(axes, used) if one.metadata},
    }
    if dropped:
        facts["components_left_out"] = dropped
    return Motion(
        step,
        values["x"],
        values.get("y"),
        values.get("z"),
        name=name,
        metadata=facts,
        processing=tuple(processing),
    )


def _choose(components: list[Component], wanted: str, name: str) -> Component:
    """The component of a label, a number, an azimuth or an axis x, y, z as the whole record would have it."""
    text = str(wanted).strip()
    folded = " ".join(text.lower().split())
    exact = [component for component in components if " ".join(component.label.lower().split()) == folded]
    if len(exact) == 1:
        return exact[0]
    if re.fullmatch(r"[0-9]{1,3}", text) and 1 <= int(text) <= len(components):
        return components[int(text) - 1]
    if re.fullmatch(r"[0-9]{1,3}(\.[0-9]+)?", text):
        near = [
            component
            for component in components
            if component.azimuth is not None and abs(component.azimuth - float(text) % 360.0) < 0.5
        ]
        if len(near) == 1:
            return near[0]
    horizontal = [component for component in components if not component.vertical]
    vertical = [component for component in components if component.vertical]
    axes = dict(zip("xy", horizontal)) | ({"z": vertical[0]} if len(vertical) == 1 else {})
    if folded in axes and len(horizontal) <= 2:
        return axes[folded]
    azimuth, upright, _ = direction(text)
    alike = vertical if upright else [one for one in horizontal if azimuth is not None and one.azimuth == azimuth]
    if len(alike) == 1 and not text[:1].isdigit():
        return alike[0]
    by_axis = {id(one): axis for axis, one in axes.items()}
    labels = ", ".join(
        f"{i} ({component.label or 'no label'}{', axis ' + by_axis[id(component)] if id(component) in by_axis else ''})"
        for i, component in enumerate(components, 1)
    )
    raise InputError(
        f"{name} has no component {wanted!r}; it holds {labels}: give a number, a label or an axis.", "component"
    )


def _doubt(text: str) -> None:
    warn(text)


def _warn_of_peak(values: dict[str, np.ndarray], step: float, name: str) -> None:
    peaks = {axis: float(np.abs(array).max(initial=0.0)) / g for axis, array in values.items()}
    for axis, peak in peaks.items():
        if peak > STRONGEST:
            _doubt(
                f"{name}: the peak of component {axis} is {peak:.3g} g, more than was ever recorded; check the unit."
            )
    if 0.0 < max(peaks.values()) < SMALLEST_PEAK:
        _doubt(
            say(
                "{name}: the peak is {max:.3g} g, which shakes no column; check the unit, and whether these are "
                "accelerations.",
                name=name,
                max=max(peaks.values()),
            )
        )
    for axis, array in values.items():
        fastest = float(np.abs(integrate(array, step)).max())
        if fastest > LARGEST_VELOCITY and peaks[axis] <= STRONGEST:
            cure = best_of(cures_of(array, step, LARGEST_VELOCITY))
            drift = "" if cure is None else f", or take off the drift of the baseline ({as_asked(cure)})"
            _doubt(
                f"{name}: component {axis} reaches a velocity of {fastest:.3g} m/s, more than was ever recorded; check the "
                f"unit and the step{drift}."
            )


def _warn_of_offset(values: dict[str, np.ndarray], name: str) -> None:
    for axis, array in values.items():
        peak = float(np.abs(array).max(initial=0.0))
        mean = float(array.mean()) if array.size else 0.0
        if peak > 0.0 and abs(mean) > OFFSET_SHARE * peak:
            _doubt(
                say(
                    "{name}: the mean of component {axis} is {mean:.3g} g, {share} of its peak, as when an "
                    "instrument's offset was left in; take it off ({step}) unless it is meant.",
                    name=name,
                    axis=axis,
                    mean=mean / g,
                    share=percent(abs(mean) / peak),
                    step="`condition='demean'`",
                )
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


def check_count(count: float | None, file: str, line: int, what: str = "samples") -> int:
    """A number of samples as a header states it, refused when it is impossible."""
    if count is None or not math.isfinite(count) or count != int(count) or not 2 <= count <= MAX_SAMPLES:
        raise InputError(
            f"{file}, line {line}: the header promises {count if count is None else f'{count:g}'} {what}; "
            f"allowed is a whole number from 2 to {MAX_SAMPLES}, so fetch the file again."
        )
    return int(count)


__all__ = ["LABEL", "Component", "assemble", "check_count", "direction", "oriented", "resampled"]
