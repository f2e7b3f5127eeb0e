"""The tests that are sensitive to how a machine rounds, on every machine that this processor can play.

`make test-cpus`: compiled loops for the processor as it is, for any processor of its kind, without and with 512-bit
vectors; where it is not as it is, linear algebra with the kernels of another one as well. As many at a time as there are
cores, for the compiler uses one. `--smoke` is the short form for continuous integration: the processor that differs most
from this one, and short tests of every engine.
"""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

import llvmlite.binding as llvm

#: What is set for the compiler and for linear algebra; an empty value sets the variable to nothing, which numba tells from
#: not set.
TARGETS = {
    "generic": {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": "", "OPENBLAS_CORETYPE": "Nehalem"},
    "without AVX-512 (haswell)": {
        "NUMBA_CPU_NAME": "haswell",
        "NUMBA_CPU_FEATURES": "",
        "OPENBLAS_CORETYPE": "Haswell",
    },
    "with AVX-512 (skylake-avx512)": {"NUMBA_CPU_NAME": "skylake-avx512", "NUMBA_CPU_FEATURES": "-prefer-256-bit"},
}
#: The processor that differs most from any of today: no fused products and sums, the shortest vectors.
FARTHEST = "generic"

#: Tests that run every engine, and compile each once.
EVERY_ENGINE = ["tests/conservation", "tests/agreement/test_processors.py", "tests/agreement/test_dem2d.py"]
NEEDS = {"without AVX-512 (haswell)": ("avx2", "fma"), "with AVX-512 (skylake-avx512)": ("avx512f", "avx512vl")}


def targets() -> dict[str, dict[str, str]]:
    """Targets that this processor can run, and what is set for each."""
    has = llvm.get_host_cpu_features()
    found: dict[str, dict[str, str]] = {f"as it is ({llvm.get_host_cpu_name()})": {}}
    for name, settings in TARGETS.items():
        if all(has.get(feature) for feature in NEEDS.get(name, ())):
            found[name] = dict(settings)
        else:
            print(f"left out, as this processor cannot run it: {name}", flush=True)
    if platform.machine().lower() not in ("x86_64", "amd64"):
        for settings in found.values():
            settings.pop("OPENBLAS_CORETYPE", None)
    return found


def main(arguments: list[str]) -> int:
    smoke = "--smoke" in arguments
    rest = [one for one in arguments if one != "--smoke"] or (EVERY_ENGINE if smoke else ["tests"])
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

    asked = targets()
    if smoke:
        asked = {FARTHEST: asked[FARTHEST]}
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(passes, asked, asked.values()))
    failed = [name for name, passed in zip(asked, results, strict=True) if not passed]
    if failed:
        print(f"failed: {', '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
