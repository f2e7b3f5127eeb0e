"""The ground motion in a report: what it is, its measures, its course and its spectrum."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from stylobate.column import Column
from stylobate.constants import g
from stylobate.messages import digits, joined, say
from stylobate.motion import Motion
from stylobate.motion.intensity import displacement_drift, motion_summary
from stylobate.plots import draw_motion, draw_spectra
from stylobate.response import Response
from stylobate.results import Result

from . import numbers as n
from .page import Exact, Facts, Item, Note, Rows, Section
from .pictures import picture

#: Most motions of a table, and the digits of a digest in it.
MOST, DIGITS = 40, 12

#: Steps of conditioning that bear on the baseline; of filters those with a lower corner.
CORRECTED = re.compile(r"baseline|mean|trend|filter of order \d+, (?!0 )")

#: Facts of a record, in words.
STATION_FACTS = ("station", "station_name", "network", "event", "start_time", "stage", "terms")


def motion_section(
    motion: Motion | None, response: Response | None, motion_facts: Mapping[str, Any] | None, column: Column | None
) -> Section:
    """The section on the motion of a run.

    Parameters
    ----------
    motion : Motion or None
        What acted; None where the folder does not hold it.
    response : Response
        Whose recorded ground is taken where there is no motion.
    motion_facts : mapping or None
        What is known of the motion.
    column : Column or None
        What it is compared with.
    """
    if motion is not None:
        note: list[Item] = []
    elif response is not None:
        motion = recorded_ground(response)
        note = [
            say(
                "The folder does not hold the motion: what is told here is the ground as the run recorded it, "
                "{motion.duration:.2f} s in steps of {dt:.3g} ms, which cuts short peaks.",
                motion=motion,
                dt=1000.0 * motion.dt,
            )
        ]
    else:
        return Section(say("The ground motion"), [say("It is not kept with these results.")])
    known = dict(motion_facts or {})
    facts = [(say("motion"), Exact(known.get("name") or motion.name))]
    facts.append((say("duration and time step"), say("{motion.duration:.2f} s, {motion.dt:.4g} s", motion=motion)))
    metadata = known.get("metadata") or {}
    facts += [
        (say(key.replace("_", " ")), say(str(metadata[key])) if key == "stage" else Exact(metadata[key]))
        for key in STATION_FACTS
        if metadata.get(key) not in (None, "", "None")
    ]
    done = list(known.get("processing") or motion.processing)
    recorded = any(metadata.get(key) for key in ("format", "station", "network", "event"))
    facts.append(
        (say("processing"), joined("\n", done) or (say("none, as its source gives it") if recorded else say("none")))
    )
    if left_out := known.get("left_out") or ():
        facts.append((say("left out"), joined("\n", left_out)))
    items: list[Item] = [*note, Facts(facts), _measures(motion)]
    if metadata.get("stage") in ("uncorrected", "raw counts"):
        text = (
            say("Its source gives this record as uncorrected; what was corrected stands under processing.")
            if any(CORRECTED.search(step) for step in done)
            else say("Its source gives this record as uncorrected; its baseline was not corrected here either: "
                     "velocities and displacements may drift.")
        )  # fmt: skip
        items.insert(len(note) + 1, Note([text], "fair"))
    drifts = {axis: displacement_drift(motion, axis) for axis in motion.components} if recorded else {}
    if worst := max(map(abs, drifts.values()), default=0.0):
        text = say(
            "Integrated twice, this record ends {worst:.2g} m from where it began: unless the ground moved so "
            "far for good, its baseline drifts, and so do velocities and displacements of the ground.",
            worst=worst,
        )
        items.insert(len(note) + 1, Note([text], "fair"))
    if column is not None and motion.horizontal_peak[0] > 0.0:
        items.append(_beside(motion, column))
    items.append(picture(draw_motion(motion, " "), say("Acceleration and velocity of the ground, as they acted.")))
    if motion.horizontal_peak[0] > 0.0:
        caption = say(
            "Response spectra of a linear oscillator, 5 % of critical damping, to compare motions. What rocks is "
            "no such oscillator: its response cannot be read from them."
        )
        items.append(picture(draw_spectra(motion, title=" "), caption))
    return Section(say("The ground motion"), items)


def motions_section(result: Result) -> Section:
    """The motions of a result of several: which records, components, azimuths, and by how much they were scaled."""
    motions = result.request.motions if result.request is not None else ()
    body = [
        [
            Exact(motion.get("name")), axes_in_words(motion), _peaks(motion), n.plain(motion.get("factor")), _scales(motion),
            digits(float(motion["duration_s"]), ".2f"), digits(float(motion["dt_s"]), ".4g"),
            Exact(str(motion.get("digest", ""))[:DIGITS]),
        ]
        for motion in motions[:MOST]
    ]  # fmt: skip
    caption = say(
        "The motions as the model takes them, as they were given where there are several models: components with "
        "their azimuths from north, peaks with the factor in them. The factor is that of the record; runs at "
        "several levels multiply the motion by the scale factors besides, in brackets how many of them. The "
        "digest, here its first {DIGITS} places, is that of samples and factor; in full it stands in the file of "
        "what was asked. –: not kept, or not known.",
        DIGITS=DIGITS,
    )
    caption = joined(" ", [caption, n.first_of(MOST, len(motions))])
    header = [
        say("motion"),
        say("components"),
        say("peak [g]"),
        say("factor"),
        say("scale factors"),
        say("duration [s]"),
        say("step [s]"),
        say("digest"),
    ]
    items: list[Item] = [Rows(header, body, caption, numbers=True)]
    facts = [(Exact(motion.get("name")), joined("\n", texts)) for motion in motions[:MOST] if (texts := _done(motion))]
    if facts:
        items.append(
            Facts(facts, say("Where they come from, what was done to them, and what the model leaves out of them."))
        )
    return Section(say("The ground motions") if len(motions) > 1 else say("The ground motion"), items)


def axes_in_words(motion: Mapping[str, Any]) -> str:
    """Components of a motion with their azimuths [degrees]; that it is reversed, where the azimuths do not tell."""
    azimuths = motion.get("azimuths") or {}
    each = [axis if azimuths.get(axis) is None else f"{axis} {azimuths[axis]:g}°" for axis in motion["components"]]
    x, before = azimuths.get("x"), motion.get("azimuth_deg")
    half_turn = (
        x is not None and before is not None and round(x - before) % 360 == 180
    )  # these are the azimuths as reversed
    return ", ".join(each) + (say(", reversed") if motion.get("reversed") and not half_turn else "")


def _peaks(motion: Mapping[str, Any]) -> str:
    peaks = (
        say("{axis}\N{NO-BREAK SPACE}{peak:.3f}", axis=axis, peak=peak)
        for axis, peak in (motion.get("peaks_g") or {}).items()
    )
    return joined(", ", peaks) or n.NONE


def _scales(motion: Mapping[str, Any]) -> str:
    if not motion.get("scales"):
        return n.NONE
    low, high, number = motion["scales"]
    if number == 1:
        return digits(low, ".3g")
    return say("{low:.3g} to {high:.3g} ({count})", low=low, high=high, count=number)


def _done(motion: Mapping[str, Any]) -> list[str]:
    metadata = motion.get("metadata") or {}
    known = [
        say(str(metadata[key])) if key == "stage" else Exact(metadata[key])
        for key in STATION_FACTS
        if metadata.get(key) not in (None, "", "None")
    ]
    left_out = [say("left out: {what}", what=part) for part in motion.get("left_out") or ()]
    done = dict.fromkeys([*(motion.get("processing") or ()), *left_out])
    return [*([joined(", ", known)] if known else []), *done]


def recorded_ground(response: Response) -> Motion:
    """The ground of a run as it was recorded, in equal steps."""
    time, values = response.time, response.histories.acceleration
    count = max(len(time), 2)
    even = np.linspace(float(time[0]), float(time[-1]) or 1.0, count)
    axes = [np.interp(even, time, values[:, k]) for k in range(3)]
    y, z = (axes[k] if axes[k].any() else None for k in (1, 2))
    return Motion(float(even[1] - even[0]), axes[0], y, z, name=str(response.provenance.get("motion", "motion")))


def _measures(motion: Motion) -> Rows:
    s = motion_summary(motion, spectrum=False)
    parts = (
        (say("peak acceleration [g]"), "pga_g", ".3f"),
        (say("peak velocity [m/s]"), "pgv_m_s", ".3f"),
        (say("Arias intensity [m/s]"), "arias_m_s", ".3g"),
        (say("CAV [m/s]"), "cav_m_s", ".3g"),
        (say("duration 5–95 % [s]"), "duration_5_95_s", ".2f"),
    )
    body = [[axis, *(digits(s[key][axis], form) for _, key, form in parts)] for axis in s["components"]]
    pulse = (
        say("The strongest pulse in x has a period of {s[pulse_period_s]:.2f} s.", s=s)
        if s.get("pulse_period_s") and math.isfinite(s["pulse_period_s"])
        else ""
    )
    caption = say("Measures of each component, z is vertical. CAV is the cumulative absolute velocity; the duration is that "
                  "between 5 and 95 % of the Arias intensity.")  # fmt: skip
    caption = joined(" ", [caption, pulse])
    return Rows([say("component"), *(name for name, _, _ in parts)], body, caption, numbers=True)


def _beside(motion: Motion, column: Column) -> str:
    """The motion beside what opens the column."""
    peak = motion.horizontal_peak[0]
    opens = column.uplift_acceleration
    much = peak / opens
    still = say("The largest horizontal component peaks at {peak:.3f} g; {opens:.3f} g would open the first "
                "joint if it acted steadily, so the column is not set rocking by the horizontal shaking alone.")  # fmt: skip
    rocks = say(
        "The largest horizontal component peaks at {peak:.3f} g; {opens:.3f} g would open the first joint if "
        "it acted steadily, so the column rocks: the peak is {much:.1f} times that. Whether it overturns "
        "depends on how long and in what order the shaking acts, which neither this ratio nor the spectrum "
        "tells."
    )
    return (still if much <= 1.0 else rocks).of(peak=peak / g, opens=opens / g, much=much)
