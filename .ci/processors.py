"""The tests that are sensitive to how a machine rounds, on every machine that this processor can play.

`make test-cpus`: compiled loops for each level of processors that this one can run; below its own, linear algebra with the
kernels of an older one as well. As many at a time as there are cores, for the compiler uses one. `--smoke` is the short form
for continuous integration: the lowest level, which differs most from this one, and short tests of every engine.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

from stylobate.kernels.levels import levels_here, settings

#: Kernels of linear algebra for processors of a level, besides those of this one.
ALGEBRA = {"x86-64": "Nehalem", "x86-64-v2": "Nehalem", "x86-64-v3": "Haswell"}

#: Tests that run every engine, and compile each once.
EVERY_ENGINE = ["tests/conservation", "tests/agreement/test_processors.py", "tests/agreement/test_dem2d.py"]


def targets() -> dict[str, dict[str, str]]:
    """Levels that this processor can run, the lowest first, and what is set for each."""
    levels = levels_here()
    return {
        level: settings(level)
        | ({"OPENBLAS_CORETYPE": ALGEBRA[level]} if level in ALGEBRA and level != levels[-1] else {})
        for level in levels
    } or {"as it is": {}}


def main(arguments: list[str]) -> int:
    smoke = "--smoke" in arguments
    rest = [argument for argument in arguments if argument != "--smoke"] or (EVERY_ENGINE if smoke else ["tests"])
    which = "processor and not slow" if smoke else "processor"
    command = [sys.executable, "-m", "pytest", "-q", "-m", which, "-p", "no:cacheprovider", *rest]

    def passes(name: str, settings: dict[str, str]) -> bool:
        begin = time.monotonic()
        done = subprocess.run(
            command, env=os.environ | settings, check=False, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
        )
        end = f"{'passed' if done.returncode == 0 else 'FAILED'} in {time.monotonic() - begin:.0f} s"
        print(f"== {name}\n{done.stdout}== {name}: {end}", flush=True)
        return done.returncode == 0

    levels = targets()
    if smoke:
        lowest = next(iter(levels))
        levels = {lowest: levels[lowest]}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(passes, levels, levels.values()))
    failed = [name for name, passed in zip(levels, results, strict=True) if not passed]
    if failed:
        print(f"failed: {', '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
