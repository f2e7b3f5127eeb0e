"""The kernel for graphics cards, in the compiler's simulator, against the loop over lanes.

Both are compiled for any x86 processor, which has no fused multiply-add: nothing is left for the compiler to contract in one
and not in the other, and all that is no sum over drums has the same bits. No test here needs a card.
"""

import importlib.util
import json
import os
import platform
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

HERE = Path(__file__).parents[1]
ANY_X86 = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
PTX = """
import numba.cuda.dispatcher as dispatcher
dispatcher.get_current_device = lambda: type("Card", (), {"compute_capability": (8, 0)})  # laws ask, though they are told
from stylobate.kernels.gpu.column import compiled
from stylobate.models.plane.laws import point_law
for damped in (False, True):
    print(compiled(point_law(2, damped, 8, False), (8, 0)))
"""

simulated = pytest.mark.skipif(
    platform.machine().lower() not in ("x86_64", "amd64"), reason="other processors fuse products and sums always"
)


@pytest.fixture(scope="module")
def batches():
    """What came of every batch, by the loop, by the card, and by the card in launches of three chunks of steps."""
    settings = os.environ | ANY_X86 | {"NUMBA_ENABLE_CUDASIM": "1", "PYTHONPATH": str(HERE)}
    command = [sys.executable, str(HERE / "simulated_card.py")]
    done = subprocess.run(command, env=settings, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@simulated
@pytest.mark.parametrize("batch", ["one_drum", "three_drums", "sliding"])
def test_runs_of_the_card_have_the_bits_of_the_loop(batches, batch):
    # one drum: falls and stands from a pose, more runs than lanes; three: scatter, losses of stone; sliding: on a slope
    found = batches[batch]
    assert [one["bits"] for one in found["card"]] == [one["bits"] for one in found["loop"]]


@simulated
@pytest.mark.parametrize("batch", ["one_drum", "three_drums", "sliding"])
def test_sums_of_work_differ_by_their_order_only(batches, batch):
    # three sums, rounded once per step and drum: in two orders they differ by half a unit each time, of what is at stake
    found = batches[batch]
    for card, loop in zip(found["card"], found["loop"], strict=True):
        terms = 3 * card["steps"] * found["drums"]
        assert abs(card["energy_imbalance"] - loop["energy_imbalance"]) <= terms * np.finfo(float).eps


@simulated
@pytest.mark.parametrize("batch", ["one_drum", "three_drums", "sliding"])
def test_a_run_has_the_same_bits_however_launches_cut_it(batches, batch):
    assert batches[batch]["cut"] == batches[batch]["card"]


@simulated
def test_the_batches_fall_rock_slide_and_end_early(batches):
    outcomes = {one["outcome"] for found in batches.values() for one in found["card"]}
    assert {"collapsed", "displaced"} <= outcomes, outcomes
    assert all(len({one["steps"] for one in found["card"]}) > 1 for found in batches.values())


@pytest.mark.skipif(importlib.util.find_spec("numba_cuda") is None, reason="numba-cuda is not installed")
def test_the_kernel_compiles_for_a_card_that_is_not_there():
    done = subprocess.run([sys.executable, "-c", PTX], capture_output=True, text=True, check=False)
    if "NvvmSupportError" in done.stderr:
        pytest.skip("the compiler for cards (NVVM) is not installed")
    assert done.returncode == 0, done.stderr
    assert done.stdout.count(".entry") == 2
    assert "fma.rn.f64" in done.stdout
    assert ".f32" not in done.stdout  # double precision, nothing else
    assert "__local_depot" not in done.stdout  # no memory of a thread's own beside its registers
