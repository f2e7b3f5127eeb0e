"""Processor levels that kernels are compiled for.

A level is a set of instructions that processors of several makers share. Code for a level computes equal bits on all of
them, so that it can be shipped and kept between machines; code for the exact processor cannot.
"""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping, MutableMapping
from typing import NamedTuple


class Level(NamedTuple):
    """What the compiler is asked for, by the names of LLVM.

    Parameters
    ----------
    cpu : str
        The processor that stands for the level.
    options : str
        Features beside its own: the full width of vectors where there are 512-bit registers.
    needs : tuple of str
        Features of a processor that can run it, besides those of the levels below.
    """

    cpu: str
    options: str
    needs: tuple[str, ...]


#: Levels of x86-64, each above those before it (System V ABI, AMD64 supplement, section 3.1.1: micro-architecture levels).
X86 = {
    "x86-64": Level("x86-64", "", ()),
    "x86-64-v2": Level("x86-64-v2", "", ("cx16", "popcnt", "sahf", "sse3", "ssse3", "sse4.1", "sse4.2")),
    "x86-64-v3": Level("x86-64-v3", "", ("avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe")),
    "x86-64-v4": Level("x86-64-v4", "-prefer-256-bit", ("avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl")),
}

#: The level of 64-bit ARM: what every processor of that kind has.
ARM = {"armv8-a": Level("generic", "", ())}


def levels_of(machine: str, features: Mapping[str, bool]) -> list[str]:
    """Levels that a machine can run, the highest last; none of kinds of processors that have no level here.

    Parameters
    ----------
    machine : str
        As of ``platform.machine``.
    features : mapping of str to bool
        Features of the processor by the names of LLVM.
    """
    kind = machine.lower()
    if kind in ("aarch64", "arm64"):
        return list(ARM)
    levels: list[str] = []
    if kind in ("x86_64", "amd64"):
        for name, level in X86.items():
            if not all(features.get(feature) for feature in level.needs):
                break
            levels.append(name)
    return levels


def levels_here() -> list[str]:
    """Levels that this machine can run, the highest last."""
    import llvmlite.binding as llvm

    return levels_of(platform.machine(), llvm.get_host_cpu_features())


def settings(name: str) -> dict[str, str]:
    """What is set in the environment of a process for its kernels to be compiled for a level."""
    level = (X86 | ARM)[name]
    return {"NUMBA_CPU_NAME": level.cpu, "NUMBA_CPU_FEATURES": level.options}


def choose(environment: MutableMapping[str, str] = os.environ) -> None:
    """Choose the highest level that this machine can run, before the compiler is loaded.

    A processor that is named in the environment is compiled for instead: a level by its name alone, with its options.
    """
    named = environment.get("NUMBA_CPU_NAME")
    if "NUMBA_CPU_FEATURES" in environment:
        return
    if named in X86:
        environment.update(settings(named))
    elif named is None and (here := levels_here()):
        environment.update(settings(here[-1]))


def name_of(cpu: str, options: str) -> str | None:
    """The level that a processor and options of the compiler are of; None for any other choice."""
    return next((name for name, level in (X86 | ARM).items() if (level.cpu, level.options) == (cpu, options)), None)
