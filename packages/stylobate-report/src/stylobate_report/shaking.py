"""The ground motion in a report: what it is, its measures, its course and its spectrum."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from stylobate.column import Column
from stylobate.constants import g
from stylobate.motion import Motion
from stylobate.motion.intensity import displacement_drift, motion_summary
from stylobate.plots import draw_motion, draw_spectra
from stylobate.response import Response
from stylobate.results import Result

from . import numbers as n
from .page import Facts, Item, Note, Own, Rows, Section
from .pictures import picture

#: Most motions of a table, and the digits of a digest in it.
MOST, DIGITS = 40, 12

#: Steps of conditioning that bear on the baseline; of filters those with a lower corner.
CORRECTED = re.compile(r"baseline|mean|trend|filter of order \d+, (?!0 )")

#: Facts of a record, in words.
SAID = ("station", "station_name", "network", "event", "start_time", "stage", "terms")


def motion_section(
    motion: Motion | None, response: Response | None, asked: Mapping[str, Any] | None, column: Column | None
) -> Section:
    """The section on the motion of a run.

    Parameters
    ----------
    motion : Motion or None
        What acted; None where the folder does not hold it.
    response : Response
        Whose recorded ground is taken where there is no motion.
    asked : mapping or None
        What is known of the motion.
    column : Column or None
        What it is compared with.
    """
    if motion is not None:
        note: list[Item] = []
    elif response is not None:
        motion = recorded_ground(response)
        note = [
            "The folder does not hold the motion: what is told here is the ground as the run recorded it, "
            f"{motion.duration:.2f} s in steps of {1000.0 * motion.dt:.3g} ms, which cuts short peaks."
        ]
    else:
        return Section("The ground motion", ["It is not kept with these results."])
    known = dict(asked or {})
    facts = [("motion", str(known.get("name") or motion.name))]
    facts.append(("duration and time step", f"{motion.duration:.2f} s, {motion.dt:.4g} s"))
    metadata = known.get("metadata") or {}
    facts += [
        (key.replace("_", " "), str(metadata[key]) if key == "stage" else Own(metadata[key]))
        for key in SAID
        if metadata.get(key) not in (None, "", "None")
    ]
    done = [str(one) for one in (known.get("processing") or motion.processing)]
    recorded = any(metadata.get(key) for key in ("format", "station", "network", "event"))
    facts.append(("processing", "\n".join(done) or ("none, as its source gives it" if recorded else "none")))
    if left_out := [str(one) for one in known.get("left_out") or ()]:
        facts.append(("left out", "\n".join(left_out)))
    items: list[Item] = [*note, Facts(facts), _measures(motion)]
    if metadata.get("stage") in ("uncorrected", "raw counts"):
        text = "Its source gives this record as uncorrected; " + (
            "what was corrected stands under processing."
            if any(CORRECTED.search(one) for one in done)
            else "its baseline was not corrected here either: velocities and displacements may drift."
        )
        items.insert(len(note) + 1, Note([text], "fair"))
    drifts = {axis: displacement_drift(motion, axis) for axis in motion.components} if recorded else {}
    if worst := max(map(abs, drifts.values()), default=0.0):
        text = (
            f"Integrated twice, this record ends {worst:.2g} m from where it began: unless the ground moved so far for "
            "good, its baseline drifts, and so do velocities and displacements of the ground."
        )
        items.insert(len(note) + 1, Note([text], "fair"))
    if column is not None and motion.horizontal_peak[0] > 0.0:
        items.append(_beside(motion, column))
    items.append(picture(draw_motion(motion, " "), "Acceleration and velocity of the ground, as they acted."))
    if motion.horizontal_peak[0] > 0.0:
        caption = (
            "Response spectra of a linear oscillator, 5 % of critical damping, to compare motions. What rocks is no such "
            "oscillator: its response cannot be read from them."
        )
        items.append(picture(draw_spectra(motion, title=" "), caption))
    return Section("The ground motion", items)


def motions_section(result: Result) -> Section:
    """The motions of a result of several: which records, components, azimuths, and by how much they were scaled."""
    motions = result.asked.motions if result.asked is not None else ()
    left_out = f" The first {MOST} of {len(motions)}." if len(motions) > MOST else ""
    body = [
        [
            str(motion.get("name")), axes_in_words(motion), _peaks(motion), n.plain(motion.get("factor")), _scales(motion),
            f"{float(motion['duration_s']):.2f}", f"{float(motion['dt_s']):.4g}", str(motion.get("digest", ""))[:DIGITS],
        ]
        for motion in motions[:MOST]
    ]  # fmt: skip
    caption = (
        "The motions as the model takes them, as they were given where there are several models: components with their "
        "azimuths from north, peaks with the factor in them. The factor is that of the record; runs at several levels "
        "multiply the motion by the scale factors besides, in brackets how many of them. The digest, "
        f"here its first {DIGITS} places, is that of samples and factor; in full it stands in the file of what was asked. "
        f"{n.NONE}: not kept, or not known.{left_out}"
    )
    header = ["motion", "components", "peak [g]", "factor", "scale factors", "duration [s]", "step [s]", "digest"]
    items: list[Item] = [Rows(header, body, caption, numbers=True)]
    facts = [(str(motion.get("name")), "\n".join(told)) for motion in motions[:MOST] if (told := _done(motion))]
    if facts:
        items.append(
            Facts(facts, "Where they come from, what was done to them, and what the model leaves out of them.")
        )
    return Section("The ground motions" if len(motions) > 1 else "The ground motion", items)


def axes_in_words(motion: Mapping[str, Any]) -> str:
    """Components of a motion with their azimuths [degrees]; that it is reversed, where the azimuths do not tell."""
    azimuths = motion.get("azimuths") or {}
    each = [axis if azimuths.get(axis) is None else f"{axis} {azimuths[axis]:g}°" for axis in motion["components"]]
    x, before = azimuths.get("x"), motion.get("azimuth_deg")
    told = x is not None and before is not None and round(x - before) % 360 == 180  # these are the azimuths as reversed
    return ", ".join(each) + (", reversed" if motion.get("reversed") and not told else "")


def _peaks(motion: Mapping[str, Any]) -> str:
    return (
        ", ".join(f"{axis}\N{NO-BREAK SPACE}{value:.3f}" for axis, value in (motion.get("peaks_g") or {}).items())
        or n.NONE
    )


def _scales(motion: Mapping[str, Any]) -> str:
    if not motion.get("scales"):
        return n.NONE
    low, high, number = motion["scales"]
    return f"{low:.3g}" if number == 1 else f"{low:.3g} to {high:.3g} ({number})"


def _done(motion: Mapping[str, Any]) -> list[str]:
    metadata = motion.get("metadata") or {}
    known = [str(metadata[key]) for key in SAID if metadata.get(key) not in (None, "", "None")]
    left_out = [f"left out: {one}" for one in motion.get("left_out") or ()]
    done = dict.fromkeys([*map(str, motion.get("processing") or ()), *left_out])
    return [*([", ".join(known)] if known else []), *done]


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
        ("peak acceleration [g]", "pga_g", ".3f"),
        ("peak velocity [m/s]", "pgv_m_s", ".3f"),
        ("Arias intensity [m/s]", "arias_m_s", ".3g"),
        ("CAV [m/s]", "cav_m_s", ".3g"),
        ("duration 5–95 % [s]", "duration_5_95_s", ".2f"),
    )
    body = [[axis, *(format(s[key][axis], form) for _, key, form in parts)] for axis in s["components"]]
    pulse = (
        f" The strongest pulse in x has a period of {s['pulse_period_s']:.2f} s."
        if s.get("pulse_period_s") and math.isfinite(s["pulse_period_s"])
        else ""
    )
    caption = (
        "Measures of each component, z is vertical. CAV is the cumulative absolute velocity; the duration is that between 5 "
        f"and 95 % of the Arias intensity.{pulse}"
    )
    return Rows(["component", *(name for name, _, _ in parts)], body, caption, numbers=True)


def _beside(motion: Motion, column: Column) -> str:
    """The motion beside what opens the column."""
    peak = motion.horizontal_peak[0]
    opens = column.uplift_acceleration
    much = peak / opens
    said = (
        f"The largest horizontal component peaks at {peak / g:.3f} g; {opens / g:.3f} g would open the first joint if it "
        f"acted steadily, so the column "
    )
    if much <= 1.0:
        return said + "is not set rocking by the horizontal shaking alone."
    return said + (
        f"rocks: the peak is {much:.1f} times that. Whether it overturns depends on how long and in what order the "
        "shaking acts, which neither this ratio nor the spectrum tells."
    )
