"""What the types of records rule out is not compiled, and what is left computes the same."""

import os
import subprocess
import sys

import numba
import numpy as np
import pytest

from stylobate.kernels.jit import kernel, law


def joint(rows: int) -> np.ndarray:
    """Joints with dashpots in so many rows; one row stands for none."""
    return np.ones(3, np.dtype([("k", np.float64, (2,)), ("d", np.float64, (rows, 2)), ("n", np.int64)]))


@numba.njit
def dashpot(x):
    return 10.0 * x


@law
def force(e, l, damped):
    if damped:
        return e.k[l] + dashpot(e.d[1, l])
    return e.k[l]


@kernel
def forces(state, out):
    joints = state[0]
    for j in range(joints.shape[0]):
        e = joints[j]
        rows = e.d.shape[0]
        for l in range(e.k.shape[0]):
            out[j, l] = force(e, l, rows > 1) + (5.0 if not rows > 1 and e.n > 0 else 0.0)


def test_only_the_branch_that_types_choose_is_compiled():
    out = np.zeros((3, 2))
    forces((joint(1), 0), out)
    assert (out == 6.0).all()
    assert not dashpot.overloads  # what only joints with dashpots call
    forces((joint(2), 0), out)
    assert (out == 11.0).all()
    assert len(dashpot.overloads) == 1


@kernel
def first(records, number):
    part = records[number:]
    total = 0.0
    for k in range(part.shape[0]):
        total += part[k].d[0, 0]
    if part.shape[0] > 1:  # of an array, not of its type
        total += 100.0
    if records[number].n > 0:
        total += 1000.0
    return total


@pytest.mark.parametrize(("number", "expected"), [(0, 1103.0), (1, 1102.0), (2, 1001.0)])
def test_what_only_a_run_knows_is_left_to_it(number, expected):
    assert first(joint(1), number) == expected


LINKLESS = """
import numba
import numpy as np
from stylobate.kernels.plane import links, motion, step
from stylobate.kernels.plane.records import point_joint, types
from stylobate.kernels.shared.records import STATE

kinds = types(point_joint(2, False, 1), False, 2, 1, False)
counts = {"body": 2, "joint": 1, "load": 2, "link": 0, "bond": 0, "ground": 33, "hold": 0, "touch": 2, "span": 2}
state = (*(np.zeros(counts.get(name, 1), kinds[name]) for name in STATE[:-1]), 1)
step.gather.compile((numba.types.Tuple(tuple(numba.typeof(one) for one in state)),))
for one in (links.add_links, links.across, links.straight, links.look_for_slack):
    assert not any(kinds["link"].names[0] in str(sig) for sig in one.overloads)
assert motion.gather.overloads
"""


def test_links_and_dashpots_of_columns_without_them_are_not_compiled(tmp_path):
    """Code for an undamped column in the plane without links: no law of a link, and no dashpot. Compiled anew, in a process
    of its own: what is read from disk compiles nothing."""
    script = f"from stylobate.kernels import cache\ncache.SHIPPED = cache.Path({str(tmp_path)!r})\n{LINKLESS}"
    environment = os.environ | {"STYLOBATE_CACHE": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", script], env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
