"""The level of processors that kernels are compiled for: chosen by what the machine has, or as it is named."""

import pytest

from stylobate.kernels import levels

V2 = dict.fromkeys(levels.X86["x86-64-v2"].needs, True)
V3 = V2 | dict.fromkeys(levels.X86["x86-64-v3"].needs, True)
V4 = V3 | dict.fromkeys(levels.X86["x86-64-v4"].needs, True)


@pytest.mark.parametrize(
    ("features", "highest"),
    [
        ({}, "x86-64"),
        (V2, "x86-64-v2"),
        (V3, "x86-64-v3"),
        (V4, "x86-64-v4"),
        (V4 | {"avx512vl": False}, "x86-64-v3"),  # Knights Landing
        (V4 | {"fma": False}, "x86-64-v2"),  # a level needs all of those below
    ],
)
def test_the_highest_level_of_which_nothing_is_missing(features, highest):
    assert levels.levels_of("x86_64", features)[-1] == levels.levels_of("AMD64", features)[-1] == highest


def test_other_kinds_of_processors():
    assert levels.levels_of("arm64", {}) == levels.levels_of("aarch64", {"neon": True}) == ["armv8-a"]
    assert levels.levels_of("ppc64le", {}) == []


def test_what_is_named_is_compiled_for():
    exact = {"NUMBA_CPU_NAME": "znver4", "NUMBA_CPU_FEATURES": "+avx2"}
    environment = dict(exact)
    levels.choose(environment)
    assert environment == exact
    environment = {"NUMBA_CPU_NAME": "x86-64-v4"}
    levels.choose(environment)
    assert environment == levels.settings("x86-64-v4")
    environment = {"NUMBA_CPU_NAME": "znver4"}  # with the features of this processor, as the compiler does by itself
    levels.choose(environment)
    assert environment == {"NUMBA_CPU_NAME": "znver4"}


def test_this_process_is_compiled_for_a_level():
    environment: dict[str, str] = {}
    levels.choose(environment)
    here = levels.levels_here()
    if not here:
        pytest.skip("no level of this kind of processor")
    assert levels.name_of(environment["NUMBA_CPU_NAME"], environment["NUMBA_CPU_FEATURES"]) == here[-1]
    assert levels.name_of("znver4", "") is None
