"""Speed of the batched Housner block against a native reference that runs the same scheme on the same runs.

Run as a script for a line of text; ``measure`` returns the numbers. One thread.
"""

from __future__ import annotations

import math
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

SOURCE = Path(__file__).with_name("housner_native.cpp")
FLAGS = ("-O3", "-march=native", "-mprefer-vector-width=512", "-ffast-math", "-fopenmp-simd")

#: As in the native reference.
ALPHA, P, RESTITUTION, STEP, SAMPLE, LOWEST, HIGHEST = 0.16, 1.7, 0.94, 4e-3, 1e-3, 0.17, 0.30


def measure(steps: int = 2500, repeats: int = 15) -> dict[str, float | None]:
    """Time per lane and step [ns] of the kernel and, where a C++ compiler is found, of the native reference.

    Returns
    -------
    dict
        ``housner_ns_per_step``, ``housner_native_ns_per_step`` (None without a compiler) and the largest relative
        difference of the sum of the peak rotations, ``housner_difference``.
    """
    native, native_sum = _native(steps, repeats)
    ours, our_sum = _kernel(steps, repeats)
    difference = None if native_sum is None else abs(our_sum / native_sum - 1.0)
    return {"housner_ns_per_step": ours, "housner_native_ns_per_step": native, "housner_difference": difference}


def _kernel(steps: int, repeats: int) -> tuple[float, float]:
    from stylobate.kernels.rocking import step as kernel
    from stylobate.models.rocking.block import half_steps

    n = kernel.LANES
    samples = np.sin(2.0 * np.pi * np.arange(round(steps * STEP / SAMPLE) + 1) * SAMPLE)
    table = half_steps(samples, SAMPLE, STEP, steps)
    remain = np.append(np.maximum.accumulate(np.abs(table)[::-1])[::-1], 0.0)
    a, g = (np.ones((2 * kernel.CHUNK + 1) * n) for _ in range(2))
    coefficients = kernel.trigonometry(False)
    best, total = math.inf, 0.0
    for _ in range(repeats):
        state = np.zeros((kernel.ROWS, n))
        for row, value in (
            ("SIDE", 1.0), ("ALPHA", ALPHA), ("P2", P * P), ("E", RESTITUTION), ("STEP", STEP), ("LEFT", steps),
            ("SIN_A", math.sin(ALPHA)), ("COS_A", math.cos(ALPHA)), ("X_EVENT", 0.5 * math.pi), ("COLLAPSE", 0.0),
        ):  # fmt: skip
            state[getattr(kernel, row) // n] = value
        whole = np.zeros((kernel.WHOLE, n), dtype=np.int64)
        whole[kernel.A_ADDRESS], whole[kernel.REMAIN_ADDRESS] = table.ctypes.data, remain.ctypes.data
        whole[kernel.LAST] = len(table) - 1
        real = np.zeros((kernel.REAL, n))
        real[kernel.FACTOR] = np.linspace(LOWEST, HIGHEST, n)
        real[kernel.GAMMA_MIN] = 1.0
        begin = time.perf_counter()
        kernel.advance(state.ravel(), whole, real, a, g, coefficients, steps, 1e-5, False, False, False)
        best = min(best, time.perf_counter() - begin)
        total = float(state[kernel.PEAK // n].sum())
    return best / (n * steps) * 1e9, total


def _native(steps: int, repeats: int) -> tuple[float | None, float | None]:
    compiler = next((found for name in ("c++", "g++", "clang++") if (found := shutil.which(name))), None)
    if compiler is None:
        return None, None
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "housner_native"
        if subprocess.run([compiler, *FLAGS, "-o", program, SOURCE], capture_output=True, check=False).returncode:
            return None, None
        output = subprocess.run([program, "64", str(steps), str(repeats)], capture_output=True, check=True, text=True)
    nanoseconds, total = output.stdout.split()
    return float(nanoseconds), float(total)


if __name__ == "__main__":
    print(measure())
