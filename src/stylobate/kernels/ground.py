"""Ground acceleration for a block of lanes: sample arrays are shared by address, each lane has its own factor.

A sample array is passed as the address of its first value, so that ten thousand runs of one record hold one array.
Whoever passes an address keeps the array alive.
"""

from numba import types
from numba.extending import intrinsic

from .jit import apart, law


@intrinsic
def load(typingctx, address, index):
    """Value number ``index`` of the float64 array that starts at ``address``."""

    def build(context, builder, signature, args):
        double = context.get_value_type(types.float64)
        return builder.load(builder.gep(builder.inttoptr(args[0], double.as_pointer()), [args[1]]))

    return types.float64(types.int64, types.int64), build


@law
def sample(address, last, position):
    """Linear between the samples 0 … ``last``, zero after the last one.

    A step that ends with the motion sees the last sample, the step that starts there sees zero: both are given half
    of it, which keeps the impulse.
    """
    i = min(int(position), last - 1)
    left, right = load(address, i), load(address, i + 1)
    value = left + (right - left) * (position - i)
    if position > last - 1e-9:
        value = 0.5 * right if position < last + 1e-9 else 0.0
    return value


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

    Rows that end a motion hold its last sample, rows that start where it has ended hold zero: motions end where a row does.
    """
    lanes = len(addresses)
    for r in range(rows):
        row = out[r * lanes : (r + 1) * lanes]
        for l in range(lanes):
            value = offset
            position = (starts[l] + r) * ratios[l]
            if addresses[l] != 0 and position < lasts[l] + (1e-9 if r > 0 else -1e-9):
                i = min(int(position), lasts[l] - 1)
                left, right = load(addresses[l], i), load(addresses[l], i + 1)
                value += factors[l] * (left + (right - left) * (position - i))
            row[l] = value
