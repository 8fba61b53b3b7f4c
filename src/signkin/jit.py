"""How kernels are compiled; and with numba's JIT off, how they run as plain Python.

numba leaves a function as it is where NUMBA_DISABLE_JIT is set. Divisions by zero and what is
not a number are no errors in compiled code, so they are none here either.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

import numpy as np
from numba import config, njit

Kernel = TypeVar("Kernel", bound=Callable[..., Any])

JIT_OFF = bool(config.DISABLE_JIT)  # type: ignore[attr-defined]


def kernel(function: Kernel) -> Kernel:
    """Compile a function, without Python's lock, and keep its machine code on disk.

    Sums keep their order: nothing here allows the compiler to change it.
    """
    if not JIT_OFF:
        compiled: Any = njit(cache=True, nogil=True, error_model="numpy")(function)
        return compiled

    @wraps(function)
    def quiet(*arguments: Any) -> Any:
        with np.errstate(all="ignore"):
            return function(*arguments)

    return quiet  # type: ignore[return-value]


def helper(function: Kernel) -> Kernel:
    """Compile a function into those that call it; its machine code is kept with theirs."""
    compiled: Any = njit(nogil=True, error_model="numpy")(function)
    return compiled


def inlined(function: Kernel) -> Kernel:
    """Compile a function in place of each of its calls."""
    compiled: Any = njit(nogil=True, error_model="numpy", forceinline=True)(function)
    return compiled
