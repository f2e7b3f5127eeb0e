"""Compiled functions that test for non-finite states still find them when a fast caller has them compiled."""

import importlib
import math
import pkgutil
from functools import cache

import numba
import numpy as np
import pytest

from stylobate import kernels
from stylobate.column import preset
from stylobate.kernels import jit, run_codes
from stylobate.kernels.plane import clip, look
from stylobate.kernels.rigid_beam import step as rigid_beam
from stylobate.models.drums.records import Topology
from stylobate.models.plane.columns import Records
from stylobate.models.plane.packing import interface_law, point_law
from stylobate.models.rigid_beam.model import RigidBeam
from stylobate.models.rigid_beam.state import measures_of
from stylobate.models.rocking.model import HousnerBlock
from stylobate.outcome import Outcome

NAN, INF = math.nan, math.inf


@cache
def compiled(function):
    """The function as a fast loop gets it: compiled on the loop's behalf, and not from a cache."""
    options = {key: value for key, value in function.targetoptions.items() if key != "nopython"}
    fresh = numba.njit(**options)(function.py_func)

    @numba.njit(fastmath=jit.FAST, error_model="numpy")
    def loop(*arguments):
        return fresh(*arguments)

    return loop


def test_every_compiled_function_states_its_own_mode():
    # A function that states none takes that of the first one that calls it.
    count = 0
    for module in pkgutil.walk_packages(kernels.__path__, f"{kernels.__name__}."):
        for name, value in vars(importlib.import_module(module.name)).items():
            if isinstance(value, numba.core.registry.CPUDispatcher):
                assert "fastmath" in value.targetoptions, f"{module.name}.{name}"
                count += 1
    assert count > 50


@pytest.mark.parametrize("bad", [NAN, INF, -INF])
def test_drums_without_finite_positions_have_failed(bad):
    types = point_law(2, False, run_codes.LANES, False)
    drum, watch = np.zeros(3, types["body"]), np.zeros(1, types["watch"])
    drum["im"][1:] = 1.0
    watch["status"] = run_codes.RUNNING
    for lane, name in enumerate(("x", "z", "th")):
        drum[name][1 + lane % 2, lane] = bad
    compiled(look.check_finite)(drum, watch)
    failed, running = run_codes.FAILED, run_codes.RUNNING
    assert watch["status"][0, :4].tolist() == [failed] * 3 + [running]


@pytest.mark.parametrize("bad", [NAN, INF, -INF])
def test_bodies_without_finite_positions_are_reported(bad):
    types = point_law(2, True, 1, False)
    check = compiled(look.check_finite)
    for name in ("x", "z", "th"):
        body, watch = np.zeros(2, types["body"]), np.zeros(1, types["watch"])
        body["im"], watch["status"] = 1.0, run_codes.RUNNING
        check(body, watch)
        assert watch["status"][0, 0] == run_codes.RUNNING
        body[name][1] = bad
        check(body, watch)
        assert watch["status"][0, 0] == run_codes.FAILED


@pytest.mark.parametrize("bad", [NAN, INF, -INF])
def test_beams_without_finite_states_have_failed(bad):
    drum, lane, watch = np.zeros(4, rigid_beam.DRUM), np.zeros(1, rigid_beam.LANE), np.zeros(1, rigid_beam.WATCH)
    watch["status"], watch["end"], watch["when"] = run_codes.RUNNING, 9, -1
    for name in ("ih", "half", "fl", "fu", "ks"):
        drum[name] = 1.0
    for place, name in enumerate(("th", "w", "x", "v")):
        drum[name][1 + place % 2, place] = bad
    lane["work"][0, 4] = bad
    compiled(rigid_beam.observe)(drum, lane, watch)
    assert watch["status"][0, :6].tolist() == [run_codes.FAILED] * 5 + [run_codes.RUNNING]


@pytest.mark.parametrize("law", [point_law(2, False, 16, False), interface_law(False, False, 16, False)])
def test_ledger_of_drums_without_finite_velocities_is_nan(law):
    records = Records(law, Topology(3, ((0, 1), (1, 2))))
    for name in ("m", "i", "im", "ii"):
        records.body[name] = 1.0
    ledgers, out = compiled(records.kernel.ledgers), np.zeros((1, 6))
    given = np.zeros((1, 2)), np.full(1, 1e-3), np.zeros(1, dtype=np.int64), out
    ledgers(records.state, *given)
    assert np.isfinite(out).all()
    records.body["vx"][1, 0] = NAN
    ledgers(records.state, *given)
    assert math.isnan(out[0, 1])


@pytest.mark.parametrize("place", ["theta", "slip", "energy", "unaccounted"])
def test_a_beam_with_a_value_that_is_not_finite_has_no_verdict(place):
    column = preset("paper-12-drums")
    zero = (
        "energy",
        "start",
        "work",
        "given",
        "unaccounted",
        "released",
        "lost",
        "side",
        "time",
        "top",
        "residual",
        "turn",
        "opening",
    )
    facts = dict.fromkeys(zero, 0.0) | {"end": 1.0, "failure": "", "step": 1e-3, "steps": 1000}
    facts |= {name: np.zeros(12) for name in ("theta", "omega", "slip")}
    beam = RigidBeam(sliding=True).pack(column)
    assert measures_of(beam, facts).decided
    bad = np.where(np.arange(12) == 3, NAN, 0.0) if place in ("theta", "slip") else NAN
    measures = measures_of(beam, facts | {place: bad})
    assert measures.outcome is Outcome.FAILED
    assert not measures.decided


@pytest.mark.parametrize("place", ["x", "v", "unaccounted"])
def test_a_rocking_block_with_a_value_that_is_not_finite_has_no_verdict(place):
    block = HousnerBlock().block(preset("paper-monolithic"))
    facts = dict.fromkeys(("x", "v", "work", "start", "unaccounted"), 0.0)
    facts |= {
        "side": 1.0,
        "peaks": (0.1, 0.0),
        "collapse_time": -1.0,
        "end": 1.0,
        "failure": "",
        "step": 1e-3,
        "steps": 1000,
    }
    assert block.measures(**facts).decided
    measures = block.measures(**facts | {place: NAN})
    assert measures.outcome is Outcome.FAILED
    assert not measures.decided


def test_a_chord_without_overlap_has_no_depth():
    # The search for the extent of an overlap starts from infinity.
    depth_square = compiled(clip.depth_square)
    x, z = np.array([0.0, 2.0, 2.0, 0.0]), np.array([0.0, 0.0, 0.5, 0.5])
    assert depth_square(x, z, 4, 1.0, 0.0) == pytest.approx(2.0 * 0.25)
    assert depth_square(x, 0.0 * z, 4, 1.0, 0.0) == 0.0
