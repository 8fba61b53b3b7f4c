"""Eight numbers at a time, for compiled kernels: their arithmetic, and what they live in.

Inside of a kernel a value of type Lanes holds eight numbers, and +, -, *, / work on each. `load`
and `store` move them from and to arrays. A compiler that is left to find such groups by itself
finds them here and there; this says where they are. What each lane comes to does not depend on
how wide a machine's vectors are: no sum is reordered, none is fused.

lanes_llvm.py makes them of numba's extension interface, lanes_numpy.py of arrays where the JIT
is off (NUMBA_DISABLE_JIT=1), which is slow and shows each step to a debugger.

That interface and what it wants of numba's inside can change with any minor version, so
pyproject.toml caps numba and llvmlite. Who raises the cap checks that

- tests/unit/test_lanes.py and test_without_jit.py pass: the same results compiled and in NumPy;
- tests/oracle/test_processors.py passes: the same bytes with narrow and with wide vectors, so
  LLVM still fuses and reorders nothing unasked;
- `cgutils.get_item_pointer`, `context.make_array`, `context.cast` and the typed pointers of
  llvmlite (`as_pointer`, `bitcast`, `gep`) are still there, with these arguments;
- the machine code that is kept is still named `<file>.<function>-<line>.<python>.nbi` and `.nbc`,
  in the folder that `.stats.cache_path` tells (stale.py, compiled.py);
- `make bench` is no slower.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from signkin.binning.lanes_numpy import ROUND, WIDTH
from signkin.jit import JIT_OFF, helper

if TYPE_CHECKING or JIT_OFF:
    from signkin.binning.lanes_numpy import (
        any_above,
        larger,
        load,
        mantissa,
        moved_up,
        power_and_round,
        splat,
        store,
        total,
        transpose,
        two_to_the,
        where_above,
    )
else:
    from signkin.binning.lanes_llvm import (
        any_above,
        larger,
        load,
        mantissa,
        moved_up,
        power_and_round,
        splat,
        store,
        total,
        transpose,
        two_to_the,
        where_above,
    )

__all__ = [
    "WIDTH",
    "aligned",
    "any_above",
    "exp",
    "exp_in_place",
    "larger",
    "load",
    "log",
    "moved_up",
    "new_aligned",
    "splat",
    "store",
    "total",
    "transpose",
    "where_above",
]


def new_aligned(n: int) -> NDArray[np.float64]:
    """Return an array of n numbers, of any value, that starts on a line of the cache.

    Lanes that lie across two lines take twice as long to load.
    """
    room = np.empty(n + WIDTH)
    skipped = (-(room.ctypes.data // 8)) % WIDTH
    return room[skipped : skipped + n]


aligned = helper(new_aligned)  # for kernels

LEAST_EXPONENT = -345.0  # log of the smallest number that exp does not take for 0
_LN2_HIGH = 6.93147180369123816490e-01  # ln 2 in two parts, the first with trailing zeros
_LN2_LOW = 1.90821492927058770002e-10
_LOG2_E = 1.4426950408889634
_LOG = (
    6.666666666666735130e-01, 3.999999999940941908e-01, 2.857142874366239149e-01,
    2.222219843214978396e-01, 1.818357216161805012e-01, 1.531383769920937332e-01,
    1.479819860510658591e-01,
)  # fmt: skip
L1, L2, L3, L4, L5, L6, L7 = _LOG
C2, C3, C4, C5, C6, C7, C8, C9, C10, C11, C12, C13 = (1.0 / math.factorial(k) for k in range(2, 14))


@helper
def log(x: Any) -> Any:
    """Return the natural logs of lanes, which are positive and normal, to the last bit or so.

    The method of the C library fdlibm: a power of two, and a polynomial in (m - 1)/(m + 1).
    """
    e = power_and_round(x) - ROUND
    f = mantissa(x) - 1.0
    s = f / (2.0 + f)
    z = s * s
    w = z * z
    r = z * (L1 + w * (L3 + w * (L5 + w * L7))) + w * (L2 + w * (L4 + w * L6))
    h = 0.5 * f * f
    return e * _LN2_HIGH - ((h - (s * (h + r) + e * _LN2_LOW)) - f)


@helper
def exp(x: Any) -> Any:
    """Return the exponentials of lanes, which are at most 0; below LEAST_EXPONENT 0."""
    value = larger(x, splat(LEAST_EXPONENT))
    shifted = value * _LOG2_E + ROUND
    k = shifted - ROUND
    r = (value - k * _LN2_HIGH) - k * _LN2_LOW
    # The powers of r together, not one after the other: a short chain is a fast one.
    r2 = r * r
    r4 = r2 * r2
    p = ((C2 + r * C3) + r2 * (C4 + r * C5)) + r4 * ((C6 + r * C7) + r2 * (C8 + r * C9))
    p = p + (r4 * r4) * ((C10 + r * C11) + r2 * (C12 + r * C13))
    p = 1.0 + (r + r2 * p)
    return where_above(x, splat(LEAST_EXPONENT), p * two_to_the(shifted), splat(0.0))


@helper
def exp_in_place(values: Any, n: int) -> None:
    """Replace values[:n], at most 0, by exponentials. There is room for whole lanes."""
    for i in range(0, n, WIDTH):
        store(values, (i,), exp(load(values, (i,))))
