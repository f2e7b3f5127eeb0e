"""Processor time of an engine for an assembly in space: ``speed.py ENGINE VARIANT FILE`` prints one JSON object.

FILE holds bodies as shape, size [m] and centroid [m], the ground's acceleration along x and y in steps of ``dt`` [m/s², s],
and the duration [s].
"""

import importlib
import json
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scenes import Body, Scene


@dataclass(frozen=True)
class Standing(Scene):
    """Bodies that stand anywhere upright, shaken by samples."""

    places: tuple[tuple[float, ...], ...] = ()
    samples: tuple[tuple[float, ...], ...] = ()
    dt: float = 0.01

    def acceleration(self, time):
        times = self.dt * np.arange(len(self.samples[0]))
        return np.array([np.interp(time, times, component, right=0.0) for component in self.samples])

    def fallen(self, height):
        return False

    def starts(self):
        return [(np.array(place), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(3)) for place in self.places]


def main(name: str, variant: str, file: str) -> None:
    scene = json.loads(Path(file).read_text(encoding="utf-8"))
    bodies = tuple(Body(shape, tuple(size)) for shape, size, _ in scene["bodies"])
    places = tuple(tuple(place) for *_, place in scene["bodies"])
    samples = tuple(tuple(scene[c]) for c in "xy")
    module = importlib.import_module(f"engine_{name}")
    seen = module.engine(variant)(Standing(bodies, scene["duration"], places=places, samples=samples, dt=scene["dt"]))
    lower = seen.position[0, :, 2] - seen.position[-1, :, 2] > 0.3
    print(json.dumps({"version": module.VERSION, "seconds": seen.wall, "fallen": int(lower.sum())}))


if __name__ == "__main__":
    main(*sys.argv[1:])
