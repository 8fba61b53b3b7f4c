"""Eight numbers at a time in LLVM's terms, for compiled kernels (see lanes.py).

Made with numba's extension interface (`numba.extending`) and some of its internals; nothing here
can be called from Python. Without the JIT lanes_numpy.py stands in.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic, lower_builtin, models, register_model, type_callable

from signkin.binning.lanes_numpy import ROUND_BITS, SQRT_HALF_BITS, WIDTH

_DOUBLE, _WHOLE, _INDEX = ir.DoubleType(), ir.IntType(64), ir.IntType(32)
_DOUBLES, _WHOLES = ir.VectorType(_DOUBLE, WIDTH), ir.VectorType(_WHOLE, WIDTH)
_ANYTHING = ir.Constant(_DOUBLES, ir.Undefined)

_inline: Any = intrinsic  # a checker of types takes what it makes for a class


class Lanes(types.Type):
    """The type of eight numbers."""

    def __init__(self) -> None:
        super().__init__(name="Lanes")


LANES = Lanes()


@register_model(Lanes)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager: Any, of_type: Any) -> None:
        super().__init__(manager, of_type, _DOUBLES)


# --- arithmetic ------------------------------------------------------------------------------


def _all_equal(builder: Any, value: Any) -> Any:
    first = builder.insert_element(_ANYTHING, value, ir.Constant(_INDEX, 0))
    mask = ir.Constant(ir.VectorType(_INDEX, WIDTH), [0] * WIDTH)
    return builder.shuffle_vector(first, _ANYTHING, mask)


def _define(sign: Callable[..., Any], instruction: str) -> None:
    """Let a sign of arithmetic work on lanes, and on lanes and one number."""

    @type_callable(sign)
    def typing(_context: Any) -> Any:
        def typer(a: Any, b: Any) -> Any:
            kinds = (Lanes, types.Float)
            both = isinstance(a, kinds) and isinstance(b, kinds)
            return LANES if both and (a is LANES or b is LANES) else None

        return typer

    def lower(_context: Any, builder: Any, signature: Any, values: Any) -> Any:
        a, b = (
            value if kind is LANES else _all_equal(builder, value)
            for kind, value in zip(signature.args, values, strict=True)
        )
        return getattr(builder, instruction)(a, b)

    for pair in ((Lanes, Lanes), (Lanes, types.Float), (types.Float, Lanes)):
        lower_builtin(sign, *pair)(lower)


_define(operator.add, "fadd")
_define(operator.sub, "fsub")
_define(operator.mul, "fmul")
_define(operator.truediv, "fdiv")


@_inline
def splat(_typing: Any, _x: Any) -> Any:
    """Return lanes that are all x."""

    def codegen(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        return _all_equal(builder, values[0])

    return LANES(types.float64), codegen


@_inline
def larger(_typing: Any, a: Any, b: Any) -> Any:
    """Return the larger of each pair of lanes."""

    def codegen(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        x, y = values
        return builder.select(builder.fcmp_ordered(">", x, y), x, y)

    return LANES(a, b), codegen


@_inline
def where_above(_typing: Any, x: Any, limit: Any, value: Any, otherwise: Any) -> Any:
    """Return `value` in the lanes in which x is above the limit, `otherwise` in the others."""

    def codegen(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        above = builder.fcmp_ordered(">", values[0], values[1])
        return builder.select(above, values[2], values[3])

    return LANES(x, limit, value, otherwise), codegen


@_inline
def any_above(_typing: Any, x: Any, limit: Any) -> Any:
    """Return whether x is above the limit in some lane."""

    def codegen(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        above = builder.fcmp_ordered(">", *values)
        bits = ir.IntType(WIDTH)
        return builder.icmp_unsigned("!=", builder.bitcast(above, bits), ir.Constant(bits, 0))

    return types.boolean(x, limit), codegen


@_inline
def total(_typing: Any, x: Any) -> Any:
    """Return the sum of the lanes, by halves: always in the same order."""

    def codegen(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        left = [builder.extract_element(values[0], ir.Constant(_INDEX, i)) for i in range(WIDTH)]
        while len(left) > 1:
            half = len(left) // 2
            left = [builder.fadd(left[i], left[i + half]) for i in range(half)]
        return left[0]

    return types.float64(x), codegen


@_inline
def moved_up(_typing: Any, x: Any) -> Any:
    """Return each lane's neighbour below, and 0 in the first."""

    def codegen(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        mask = ir.Constant(ir.VectorType(_INDEX, WIDTH), [WIDTH, *range(WIDTH - 1)])
        return builder.shuffle_vector(values[0], ir.Constant(_DOUBLES, [0.0] * WIDTH), mask)

    return LANES(x), codegen


# --- arrays ----------------------------------------------------------------------------------


def _place(context: Any, builder: Any, kinds: Any, values: Any) -> Any:
    """Return the address of an array's element as that of lanes. Nothing is checked."""
    kind = kinds[0]
    array = context.make_array(kind)(context, builder, values[0])
    indices = [
        context.cast(builder, value, of, types.intp)
        for value, of in zip(cgutils.unpack_tuple(builder, values[1]), kinds[1], strict=True)
    ]
    address = cgutils.get_item_pointer(
        context, builder, kind, array, indices, wraparound=False, boundscheck=False
    )
    return builder.bitcast(address, _DOUBLES.as_pointer())


@_inline
def load(_typing: Any, array: Any, place: Any) -> Any:
    """Return eight elements of an array from `place`, a full index, along the last axis."""

    def codegen(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        value = builder.load(_place(context, builder, signature.args, values))
        value.align = 8
        return value

    return LANES(array, place), codegen


@_inline
def store(_typing: Any, array: Any, place: Any, value: Any) -> Any:
    """Write lanes to eight elements of an array from `place`, a full index, on."""

    def codegen(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        written = builder.store(values[2], _place(context, builder, signature.args, values))
        written.align = 8
        return context.get_dummy_value()

    return types.void(array, place, value), codegen


@_inline
def transpose(_typing: Any, source: Any, at: Any, target: Any, to: Any) -> Any:
    """Write the columns of the eight rows from `at` on to the eight rows from `to` on.

    Rows are of eight elements, one after the other in memory.
    """

    def codegen(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        bases = [
            _place(context, builder, signature.args[i : i + 2], values[i : i + 2]) for i in (0, 2)
        ]
        rows = []
        for i in range(WIDTH):
            row = builder.load(builder.gep(bases[0], [ir.Constant(_WHOLE, i)]))
            row.align = 8
            rows.append(row)
        # Three rounds: in each, rows `step` apart exchange every other run of `step` lanes.
        for step in (4, 2, 1):
            low = [i if not i & step else i + WIDTH - step for i in range(WIDTH)]
            high = [i + step if not i & step else i + WIDTH for i in range(WIDTH)]
            for i in range(WIDTH):
                if i & step:
                    continue
                a, b = rows[i], rows[i + step]
                for at, mask in ((i, low), (i + step, high)):
                    picked = ir.Constant(ir.VectorType(_INDEX, WIDTH), mask)
                    rows[at] = builder.shuffle_vector(a, b, picked)
        for i in range(WIDTH):
            written = builder.store(rows[i], builder.gep(bases[1], [ir.Constant(_WHOLE, i)]))
            written.align = 8
        return context.get_dummy_value()

    return types.void(source, at, target, to), codegen


# --- the parts of logs and exponentials that look at bits -------------------------------------


def _same_everywhere(value: int) -> Any:
    return ir.Constant(_WHOLES, [value] * WIDTH)


@_inline
def mantissa(_typing: Any, x: Any) -> Any:
    """Return x divided by the power of two that brings it to sqrt(1/2) .. sqrt(2)."""

    def codegen(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        bits = builder.bitcast(values[0], _WHOLES)
        power = builder.ashr(
            builder.sub(bits, _same_everywhere(SQRT_HALF_BITS)), _same_everywhere(52)
        )
        rest = builder.sub(bits, builder.shl(power, _same_everywhere(52)))
        return builder.bitcast(rest, _DOUBLES)

    return LANES(x), codegen


@_inline
def power_and_round(_typing: Any, x: Any) -> Any:
    """Return the exponent of that power of two, plus ROUND."""

    def codegen(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        bits = builder.bitcast(values[0], _WHOLES)
        power = builder.ashr(
            builder.sub(bits, _same_everywhere(SQRT_HALF_BITS)), _same_everywhere(52)
        )
        return builder.bitcast(builder.add(power, _same_everywhere(ROUND_BITS)), _DOUBLES)

    return LANES(x), codegen


@_inline
def two_to_the(_typing: Any, k: Any) -> Any:
    """Return two to the power of k, whole numbers with ROUND added."""

    def codegen(_context: Any, builder: Any, _signature: Any, values: Any) -> Any:
        bits = builder.bitcast(values[0], _WHOLES)
        biased = builder.add(bits, _same_everywhere(1023))
        return builder.bitcast(builder.shl(biased, _same_everywhere(52)), _DOUBLES)

    return LANES(k), codegen
