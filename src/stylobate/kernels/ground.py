"""Ground acceleration at any time: the one place where a record is sampled, for all kernels and for Python.

A record is linear between its samples and zero after the last one. At the last sample itself it has two values: that
sample just before, zero just after. ``side`` says which is meant: ``BEFORE`` for a step that ends there, ``AFTER`` for one
that begins there, ``MEAN`` for a scheme whose step goes from half a step before to half a step after (central
differences); the mean keeps the impulse of the record.

A sample array is passed as the address of its first value, so that ten thousand runs of one record hold one array.
Whoever passes an address keeps the array alive.
"""

from numba import types
from numba.extending import intrinsic

from .jit import apart, law, strict

#: Which of the two values at the end of a record is meant.
BEFORE, MEAN, AFTER = -1, 0, 1

#: A position this close to the last sample is at it [samples].
CLOSE = 1e-9


@intrinsic
def load(typingctx, address, index):
    """Value number ``index`` of the float64 array that starts at ``address``."""

    def build(context, builder, signature, args):
        double = context.get_value_type(types.float64)
        return builder.load(builder.gep(builder.inttoptr(args[0], double.as_pointer()), [args[1]]))

    return types.float64(types.int64, types.int64), build


@law
def sample(address, last, position, side=MEAN):
    """Value at a position, in samples from the first one, of the record whose samples 0 … ``last`` start at ``address``."""
    i = min(int(position), last - 1)
    left, right = load(address, i), load(address, i + 1)
    value = left + (right - left) * (position - i)
    if position > last - CLOSE:
        if position >= last + CLOSE or side == AFTER:
            value = 0.0
        elif side == MEAN:
            value = 0.5 * right
    return value


@strict
def sample_all(address, last, positions, side, out):
    """Values at many positions; from Python, see ``models/shared/ground.py``."""
    for k in range(len(positions)):
        out[k] = sample(address, last, positions[k], side)


@strict
def sample_one(address, last, position, side):
    """Value at one position; from Python, see ``models/shared/ground.py``."""
    return sample(address, last, position, side)


@apart
def fill_ground(out, rows, addresses, lasts, factors, starts, ratios, offset):
    """Write the acceleration of every lane at consecutive half steps.

    Parameters
    ----------
    out : array
        Value of row r and lane l at ``r * lanes + l``.
    rows : int
        Number of half steps to write.
    addresses, lasts : array of int, shape (lanes,)
        Sample arrays and the index of their last sample; address 0 stands for no motion.
    factors : array, shape (lanes,)
        Multiply the samples.
    starts : array of int, shape (lanes,)
        Half steps since the start of the run at row 0.
    ratios : array, shape (lanes,)
        Half a step over the sampling interval [-].
    offset : float
        Added to every value (1 where weights are scaled by 1 + a_v/g).

    Motions end where the rows of a call do: the last row there ends a step, the first one begins one.
    """
    lanes = len(addresses)
    for r in range(rows):
        side = BEFORE if r > 0 else AFTER
        row = out[r * lanes : (r + 1) * lanes]
        for l in range(lanes):
            value = offset
            if addresses[l] != 0:
                value += factors[l] * sample(addresses[l], lasts[l], (starts[l] + r) * ratios[l], side)
            row[l] = value
