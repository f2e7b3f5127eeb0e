"""Compiled kernels for the wheel: `make kernels`, for the levels of processors that the compiler can emit here.

Common runs are made once, so that what they need is compiled, and once more, which tells what a process reads of it. That is
compiled for every other level too, without being run, and goes into the package's folder, from which `make wheel` takes it.
What is there already from the same sources, compiler and Python is kept. LEVELS="x86-64-v3" for some levels, LEVELS=here
for that of this machine.
"""

from __future__ import annotations

import importlib
import os
import pickle
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BUILT = ROOT / "src" / "stylobate" / "kernels" / "built"
CACHE = ROOT / "build" / "kernels"


def common_runs() -> None:
    """Runs of every engine, short ones, and what the command line makes of a first one."""
    import stylobate as st
    from stylobate.cli.main import call

    square_drums = [("paper-12-drums", model) for model in ("dem2d", "dem3d", "rigid-block", "rigid-beam")]
    for column, model in (*square_drums, ("parthenon", "dem3d")):
        code = call(["run", column, "--model", model, "--harmonic", "1.0Hz,0.3g,0.5s", "--json"])
        assert code == 0, (column, model)
    joint = st.Joint(normal_stiffness=5e9, shear_stiffness=2.5e9, friction_coefficient=0.5)
    drums = {"height": 1.8, "bottom_width": 0.5, "top_width": 0.4, "drums": 3, "density": 2500.0, "joint": joint}
    square, round_ = (st.Column.tapered(section=section, **drums) for section in ("rectangular", "circular"))
    links = (
        st.Dowel(joint=1, shear_stiffness=1e7, clearance=1e-4),
        st.Bar(joint=2, shear_stiffness=1e7, axial_stiffness=2e7),
    )
    motion = st.harmonic(frequency=2.0, amplitude=5.0, duration=0.5)
    plane, space = st.DistinctElement2D(), st.DistinctElement3D()
    runs = (
        (square.replace(links=links), plane, {}),
        (square, st.DistinctElement2D(losses="stone"), {}),
        (square, plane, {"until_rest": True}),
        (round_, space, {}),
        (round_.replace(links=links), space, {}),
        (round_, st.DistinctElement3D(losses="stone"), {}),
        (round_, st.DistinctElement3D(law="bed"), {}),
        (st.preset("paper-monolithic"), st.HousnerBlock(), {}),
    )
    for column, model, options in runs:
        st.simulate(column, motion, model, **options)
    for name, model in (("portal", plane), ("portal_in_space", space)):
        st.simulate(st.read_assembly(ROOT / "gallery" / "assemblies" / f"{name}.toml"), motion.scaled(2.0), model)


def compile_all(entries: Path, names: Path) -> None:
    """Compile variants that a file lists for the level of this process; writes the names of their files to another one."""
    from numba.core.registry import cpu_target

    files = []
    for module, name, kinds in pickle.loads(entries.read_bytes()):
        kernel = getattr(importlib.import_module(module), name)
        kernel.compile(kinds)
        files.append(kernel._cache.file_of(kinds, cpu_target.target_context))
    names.write_bytes(pickle.dumps(files))


def read_here(entries: Path) -> None:
    """Make the common runs, and write which variants they read from disk to a file."""
    from stylobate.kernels import cache

    common_runs()
    entries.write_bytes(pickle.dumps(list(dict.fromkeys(cache.read))))


def main(arguments: list[str]) -> int:
    from stylobate.kernels.levels import ARM, X86, levels_here, settings

    here = levels_here()
    known = list(ARM) if here == list(ARM) else [name for name in X86 if name != "x86-64"] if here else []
    wanted = [here[-1] if name == "here" and here else name for name in arguments] or known
    if not set(wanted) <= set(known):
        print(f"levels of this kind of processor are {', '.join(known) or 'not known'}", file=sys.stderr)
        return 2
    for path in list(BUILT.glob("*/*.kernel")):  # found again by their names
        (CACHE / "kernels" / path.parent.name).mkdir(parents=True, exist_ok=True)
        shutil.move(path, CACHE / "kernels" / path.parent.name / path.name)
    shutil.rmtree(BUILT, ignore_errors=True)
    environment = os.environ | {"STYLOBATE_CACHE": str(CACHE)}

    def process(level: str, *parts: str | Path) -> None:
        subprocess.run([sys.executable, __file__, *map(str, parts)], check=True, env=environment | settings(level),
                       stdout=subprocess.DEVNULL)  # fmt: skip

    with tempfile.TemporaryDirectory() as folder:
        entries, names = Path(folder) / "entries", Path(folder) / "names"
        for _ in range(2):  # compiled, then read
            process(here[-1], "--read", entries)
        for level in wanted:
            started = time.monotonic()
            process(level, "--compile", entries, names)
            total = 0
            for place, name in pickle.loads(names.read_bytes()):
                (BUILT / place).mkdir(parents=True, exist_ok=True)
                total += Path(shutil.copy(CACHE / "kernels" / place / name, BUILT / place / name)).stat().st_size
            count = len(list((BUILT / level).iterdir()))
            seconds = time.monotonic() - started
            print(f"{level}: {count} kernels, {total / 1e6:.1f} MB, in {seconds:.0f} s", flush=True)
    return 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--read"]:
        read_here(Path(sys.argv[2]))
    elif sys.argv[1:2] == ["--compile"]:
        compile_all(Path(sys.argv[2]), Path(sys.argv[3]))
    else:
        sys.exit(main(sys.argv[1:]))
