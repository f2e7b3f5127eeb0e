"""The kernels for graphics cards, in the compiler's simulator, against the loops over lanes.

Both are compiled for any x86 processor, which has no fused multiply-add: nothing is left for the compiler to contract in one
and not in the other, and all that is no sum over drums has the same bits. No test here needs a card.
"""

import dataclasses
import json
import os
import platform
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import stylobate as st
from stylobate.column.links import Dowel
from stylobate.models.engine import engine_for
from stylobate_gpu import card_check, kinds
from stylobate_gpu.device import kernel_for

HERE = Path(__file__).parents[1]
ANY_X86 = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
BATCHES = ["one_drum", "three_drums", "round_monolith", "round_drums"]

simulated = pytest.mark.skipif(
    platform.machine().lower() not in ("x86_64", "amd64"), reason="other processors fuse products and sums always"
)


@pytest.fixture(scope="module")
def batches():
    """What came of every batch, by the loop, by the card, and by the card in launches of three chunks of steps."""
    settings = os.environ | ANY_X86 | {"NUMBA_ENABLE_CUDASIM": "1", "PYTHONPATH": str(HERE)}
    command = [sys.executable, str(HERE / "simulated_card.py"), *BATCHES]
    done = subprocess.run(command, env=settings, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@simulated
@pytest.mark.parametrize("batch", BATCHES)
def test_runs_of_the_card_have_the_bits_of_the_loop(batches, batch):
    # one drum: falls and stands from a pose, in the plane more runs than lanes; three: scatter, losses of stone in the
    # plane, a run that ends early; others, by their names: ``PYTHONPATH=tests NUMBA_ENABLE_CUDASIM=1 python
    # packages/stylobate-gpu/tests/simulated_card.py sliding with_corners drums_of_stone``
    results = batches[batch]
    assert [run["bits"] for run in results["card"]] == [run["bits"] for run in results["loop"]]


@simulated
@pytest.mark.parametrize("batch", BATCHES)
def test_sums_of_work_differ_by_their_order_only(batches, batch):
    # three sums, rounded once per step and drum: in two orders they differ by half a unit each time, of what is at stake
    results = batches[batch]
    for card, loop in zip(results["card"], results["loop"], strict=True):
        terms = 3 * card["steps"] * results["drums"]
        assert abs(card["energy_imbalance"] - loop["energy_imbalance"]) <= terms * np.finfo(float).eps


@simulated
@pytest.mark.parametrize("batch", BATCHES)
def test_a_run_has_the_same_bits_however_launches_cut_it(batches, batch):
    assert batches[batch]["cut"] == batches[batch]["card"]


@simulated
def test_the_batches_fall_rock_slide_and_end_early(batches):
    for names, seen in ((BATCHES[:2], {"collapsed", "rocked"}), (BATCHES[2:], {"collapsed", "displaced"})):
        outcomes = {run["outcome"] for name in names for run in batches[name]["card"]}
        assert seen <= outcomes, outcomes
    assert all(len({run["steps"] for run in batch["card"]}) > 1 for batch in batches.values())


@simulated
def test_runs_say_what_computed_them(batches):
    devices = [run["by"] for batch in batches.values() for run in batch["card"]]
    assert set(devices) == {"gpu (simulated)"}
    assert {run["by"] for batch in batches.values() for run in batch["loop"]} == {"cpu"}


def built():
    """Kernels that are there from these sources."""
    return sorted(set(kinds.kinds()) - set(kinds.missing()))


def test_kernels_are_compiled_for_cards_that_are_not_there():
    if not built():
        pytest.skip("no kernel for graphics cards was built from these sources: make ptx")
    for name in built():
        text = kinds.text_of(name)
        assert len(re.findall(r"^\t\.param \.u64", text, re.MULTILINE)) == kinds.NUMBERS, name
        assert f".entry {kinds.ENTRY}(" in text
        assert "fma.rn.f64" in text
        assert ".f32" not in text  # double precision, nothing else
        assert "__local_depot" not in text  # no memory of a thread's own beside its registers


def test_a_kernel_of_other_sources_is_not_used(tmp_path, monkeypatch):
    monkeypatch.setattr(kinds, "FOLDER", tmp_path)
    with pytest.raises(st.InputError, match="the kernel 'plane' for graphics cards was not built from the sources"):
        kinds.text_of("plane")
    (tmp_path / "plane.ptx").write_text(f"{kinds.stamp()}0\n.version 9.0\n")
    with pytest.raises(st.InputError, match="`make ptx`"):
        kinds.text_of("plane")
    (tmp_path / "plane.ptx").write_text(f"{kinds.stamp()}\n.version 9.0\n")
    assert kinds.text_of("plane").endswith(".version 9.0\n")


@pytest.mark.parametrize("name", sorted(kinds.kinds()))
def test_every_kernel_has_runs_by_which_it_is_checked(name):
    engine = st.DistinctElement2D if name.startswith("plane") else st.DistinctElement3D
    model, cases = card_check.cases_for(name, engine)
    assert kernel_for(model, engine_for(model, cases[0].column).kind) == name


def test_what_has_no_kernel_is_left_to_the_processor():
    joint = st.Joint(5e8, 2.5e8, friction_angle=30.0)
    size = {"height": 3.0, "bottom_width": 0.6, "top_width": 0.5, "drums": 3, "density": 2400.0, "joint": joint}
    column, plane, space, bed = st.Column.tapered(**size), st.DistinctElement2D(), st.DistinctElement3D(), "bed"
    round_ = st.Column.tapered(**size, section="circular")
    linked = column.replace(links=(Dowel(joint=2, shear_stiffness=1e8, shear_capacity=1e4),))
    several = st.DistinctElement2D(points=3), st.DistinctElement3D(law=bed)
    assert kernel_for(plane, engine_for(plane, column).kind) == "plane"
    assert kernel_for(space, engine_for(space, column).kind) == "corner"
    assert kernel_for(space, engine_for(space, round_).kind) == "rim"
    for model, other in ((several[0], column), (several[1], round_), (plane, linked), (space, linked)):
        assert kernel_for(model, engine_for(model, other).kind) is None, (model, other)


class Wrong:
    """Lanes of the processor that stand for those of a card, and tell peaks that are larger by a share."""

    share = 0.0

    def __init__(self, device, name, make, runs, turn):
        del device, name, runs, turn
        self.block = make()
        self.lanes = self.block.lanes

    def __getattr__(self, name):
        return getattr(self.block, name)

    def collect(self, lane):
        measures = self.block.collect(lane)
        return dataclasses.replace(measures, peak_rotation=measures.peak_rotation * (1.0 + self.share))


def test_a_card_that_computes_otherwise_is_not_used(monkeypatch):
    monkeypatch.setattr(card_check, "CardLanes", Wrong)
    device = type("Card", (), {"name": "a card"})
    card_check.check(device(), "plane", st.DistinctElement2D)
    monkeypatch.setattr(Wrong, "share", 2.0 * card_check.ALIKE)
    with pytest.raises(st.StylobateError, match=r"the graphics card \(a card\) computes otherwise than the processor"):
        card_check.check(device(), "plane", st.DistinctElement2D)
