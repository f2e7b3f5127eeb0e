"""What the page carries: the module, six columns with fifteen like each, shapes and earthquakes, words."""

from __future__ import annotations

from typing import Any

import numpy as np

import stylobate as st
from stylobate.campaign.campaign import Campaign
from stylobate.campaign.twins import the_twins
from stylobate.column.catalogue import known_column
from stylobate.kernels.run_codes import CHUNK, LANES
from stylobate.models.engine import engine_for
from stylobate.models.shared.stable_step import resolving
from stylobate.motion.pulses import SAMPLES_PER_CYCLE
from stylobate.motion.readers.source import samples
from stylobate.outcome import Outcome

from .columns import Memory, lanes_of
from .motions import EARTHQUAKES, PULSE, SINE, STRONG_PART, earthquake, pulse, sine

#: Columns of the page by their presets: what each is called where it is chosen, and in a sentence.
COLUMNS = {
    "parthenon": ("Parthenon, Athens", "The column of the Parthenon"),
    "segesta": ("Temple of Segesta", "The column of Segesta"),
    "olympieion": ("Olympieion, Athens", "The column of the Olympieion"),
    "trajan": ("Trajan's Column", "Trajan's Column"),
    "paper-12-drums": ("Twelve drums", "The column of twelve drums"),
    "paper-monolithic": ("One piece", "The column in one piece"),
}

#: Frequencies [Hz] and amplitudes [g] that may be chosen, both in hundredths.
FREQUENCIES, AMPLITUDES = (0.3, 4.0), (0.05, 1.5)

MODEL = st.DistinctElement2D()


def columns_like(name: str) -> list[Any]:
    """A preset, and the fifteen like it that ``stylobate run`` computes beside it."""
    column = st.preset(name)
    return [column, *the_twins(column, MODEL, Campaign(replicates=LANES - 1)).columns]


class Blob:
    """Arrays one behind the other, each from a multiple of eight bytes on."""

    def __init__(self) -> None:
        self.bytes = bytearray()

    def put(self, data: bytes | np.ndarray) -> list[int]:
        """Append an array; where it is, and how long."""
        raw = data if isinstance(data, bytes) else np.ascontiguousarray(data, dtype=np.float64).tobytes()
        self.bytes += bytes(-len(self.bytes) % 8)
        self.bytes += raw
        return [len(self.bytes) - len(raw), len(raw)]


def data_of(module: bytes, start: int) -> tuple[dict[str, Any], bytes]:
    """All that the page knows: plain values, and a blob to which they point.

    Parameters
    ----------
    module : bytes
    start : int
        Where the module's memory is free.
    """
    blob = Blob()
    result = {
        "start": start,
        "chunk": CHUNK,
        "g": st.g,
        "slot": 1 + round(max(SINE, PULSE) * FREQUENCIES[1] * SAMPLES_PER_CYCLE),
        "frequencies": FREQUENCIES,
        "amplitudes": AMPLITUDES,
        "module": blob.put(module),
        "version": st.__version__,
        "images": {},
        "columns": [],
        "shapes": shapes(blob),
        "earthquakes": [earthquake_data(name, blob) for name in EARTHQUAKES],
        "strong_part": STRONG_PART,
        "outcomes": {int(item): [item.sentence_of(2), item.sentence_of(1)] for item in Outcome},
    }
    for name in COLUMNS:
        those = columns_like(name)
        memory = Memory(lanes_of(those, MODEL), start)
        for motion in (sine(FREQUENCIES[1], 1.0), pulse(FREQUENCIES[1], 1.0), *map(earthquake, EARTHQUAKES)):
            step = engine_for(MODEL, those[0]).step
            assert resolving(step, motion) == step, f"{motion.name} shortens the step of {name}"
        result["images"][name] = blob.put(bytes(memory.bytes) + bytes(-len(memory.bytes) % 8))
        result["columns"].append(column_data(name, those, memory))
    return result, bytes(blob.bytes)


def column_data(name: str, those: list[Any], memory: Memory) -> dict[str, Any]:
    """A column for the page: where its numbers are, and how its drums are drawn [m]."""
    column, layout = those[0], memory.layout()
    return {
        "name": name,
        "title": COLUMNS[name][0],
        "subject": COLUMNS[name][1],
        "full": known_column(name).title,
        "drums": column.n,
        "height": round(column.height, 3),
        "width": round(column.drums[0].bottom_width, 3),
        "tonnes": round(float(column.masses.sum()) / 1000.0, 1),
        "round": column.section == "circular",
        "layout": layout,
        "shapes": [
            [[round(v, 4) for v in (d.bottom_width, d.top_width, d.height, d.centroid_height)] for d in item.drums]
            for item in those
        ],
    }


def shapes(blob: Blob) -> dict[str, Any]:
    """One cycle of the sine, which repeats, and the pulse; so many samples to a cycle."""
    cycle, once = sine(1.0, 1.0).samples[:SAMPLES_PER_CYCLE], pulse(1.0, 1.0).samples[: SAMPLES_PER_CYCLE + 1]
    return {
        "sine": {"samples": blob.put(cycle), "cycle": SAMPLES_PER_CYCLE, "length": SINE, "repeats": True},
        "pulse": {"samples": blob.put(once), "cycle": SAMPLES_PER_CYCLE, "length": PULSE, "repeats": False},
    }


def earthquake_data(name: str, blob: Blob) -> dict[str, Any]:
    """An earthquake for the page."""
    motion, terms = earthquake(name), samples()[name]
    z = motion.z_samples
    return {
        "name": name,
        "title": EARTHQUAKES[name],
        "about": terms.about,
        "terms": terms.terms,
        "sample": motion.dt,
        "count": motion.steps,
        "peak": motion.pga,
        "x": blob.put(motion.acceleration),
        "z": None if z is None else blob.put(z * motion.factor),
    }
