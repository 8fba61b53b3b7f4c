"""Small expressions in claims: arithmetic, comparisons, names. Nothing else is run.

The same text works on printed numbers (intervals) and on columns of tables (series).
"""

from __future__ import annotations

import ast
import operator
from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import Any

import numpy as np
import pandas as pd

from signkin.audit.rounding import Interval, as_interval, exponential, root
from signkin.errors import SignkinError, listed

_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
}
_COMPARE: dict[type[ast.cmpop], Callable[[Any, Any], Any]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
}
MOST_TEXT, MOST_POWER = 1_000, 64


class _Agree:
    """What `==` says of two intervals that meet: they agree as printed, and may differ yet."""


AGREE = _Agree()


def _exp(value: Any) -> Any:
    return np.exp(value) if isinstance(value, pd.Series | np.ndarray) else exponential(value)


def _sqrt(value: Any) -> Any:
    return np.sqrt(value) if isinstance(value, pd.Series | np.ndarray) else root(value)


_FUNCTIONS: dict[str, Callable[[Any], Any]] = {"abs": abs, "exp": _exp, "sqrt": _sqrt}


def evaluate(text: str, names: Mapping[str, Any]) -> Any:
    """Return the value of an expression; `names`: numbers, intervals or series by name.

    `a.b` is the name `a.b` (a number of another claim). Comparisons of intervals return True,
    False, or None where rounding leaves it open. Raises SignkinError for anything else than
    + - * / **, comparisons, and, or, not, in, abs, exp, sqrt, and
    filled(a, b): a, where it is empty b. `a == b` of intervals is True where they meet: the
    print allows that they are equal. Its negation is then open.
    """
    found = _safely(_parsed(text), names, str(text))
    return True if found is AGREE else found


def sides(text: str, names: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """Return what the comparisons of an expression compare: (text, value), each once."""
    out: dict[str, Any] = {}
    for node in ast.walk(_parsed(text)):
        if isinstance(node, ast.Compare):
            for side in (node.left, *node.comparators):
                if not isinstance(side, ast.List | ast.Tuple | ast.Constant):
                    out.setdefault(ast.unparse(side), _safely(side, names, str(text)))
    return list(out.items())


def _parsed(text: object) -> ast.expr:
    told = str(text) if len(str(text)) < 60 else f"{str(text)[:57]}..."
    try:
        if len(str(text)) > MOST_TEXT:
            raise ValueError
        return ast.parse(str(text), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise SignkinError(
            f"the expression {told!r} cannot be read",
            expected=f"one of at most {MOST_TEXT} signs, such as `a * b + c`",
        ) from None


def _safely(node: ast.expr, names: Mapping[str, Any], text: str) -> Any:
    try:
        return _value(node, names, text)
    except ZeroDivisionError:
        raise SignkinError(f"the expression {text!r} divides by zero") from None
    except (TypeError, AttributeError, ValueError, OverflowError, RecursionError):
        raise SignkinError(
            f"the expression {text!r} cannot be worked out", expected="numbers where it has them"
        ) from None


def _value(node: ast.expr, names: Mapping[str, Any], text: str) -> Any:
    match node:
        case ast.Constant(value=bool() | str() as value):
            return value
        case ast.Constant(value=int() | float() as value):
            # As it is written, so that 0.1 is a tenth.
            exact = Fraction(str(value))
            return exact if _exact(names) else value
        case ast.Name() | ast.Attribute():
            name = ast.unparse(node)
            if name not in names:
                raise SignkinError(
                    f"the name {name!r} in {text!r} is unknown", expected=listed(sorted(names), 30)
                )
            return names[name]
        case ast.UnaryOp(op=ast.USub(), operand=operand):
            return -_value(operand, names, text)
        case ast.UnaryOp(op=ast.Not(), operand=operand):
            return _not(_value(operand, names, text))
        case ast.BinOp(left=left, op=ast.Pow(), right=ast.Constant(value=int() as power)):
            if not 0 <= power <= MOST_POWER:
                raise SignkinError(f"the power {power} in {text!r}", expected=f"0 to {MOST_POWER}")
            return _value(left, names, text) ** power
        case ast.BinOp(left=left, op=op, right=right) if type(op) in _BINARY:
            return _BINARY[type(op)](_value(left, names, text), _value(right, names, text))
        case ast.BoolOp(op=op, values=values):
            return _joined(op, [_value(v, names, text) for v in values])
        case ast.Compare(
            left=left, ops=[ast.In()], comparators=[ast.List() | ast.Tuple() as items]
        ):
            wanted = [_value(item, names, text) for item in items.elts]
            value = _value(left, names, text)
            if isinstance(value, pd.Series):
                return value.isin(wanted)
            return _joined(ast.Or(), [_compared(ast.Eq(), value, item) for item in wanted])
        case ast.Compare(left=left, ops=ops, comparators=others):
            parts = [_value(n, names, text) for n in (left, *others)]
            found = [
                _compared(op, a, b) for op, a, b in zip(ops, parts[:-1], parts[1:], strict=True)
            ]
            return _joined(ast.And(), found)
        case ast.Call(func=ast.Name(id="filled"), args=[first, second]):
            return _value(first, names, text).fillna(_value(second, names, text))
        case ast.Call(func=ast.Name(id=name), args=[argument]) if name in _FUNCTIONS:
            return _FUNCTIONS[name](_value(argument, names, text))
    raise SignkinError(
        f"the expression {text!r} has {ast.unparse(node)!r}",
        expected="+ - * / **, comparisons, and, or, not, in, abs, exp, sqrt, filled",
    )


def _exact(names: Mapping[str, Any]) -> bool:
    return not any(isinstance(v, pd.Series | np.ndarray | float) for v in names.values())


def _compared(op: ast.cmpop, a: Any, b: Any) -> Any:
    if type(op) not in _COMPARE:
        raise SignkinError(f"the comparison {type(op).__name__}", expected="< <= > >= == != in")
    if isinstance(a, Interval) or isinstance(b, Interval):
        return _surely(op, as_interval(a), as_interval(b))
    return _COMPARE[type(op)](a, b)


def _surely(op: ast.cmpop, a: Interval, b: Interval) -> Any:
    """Compare intervals: True or False where every pair of values agrees, else None.

    `==` of intervals that meet is AGREE.
    """
    if isinstance(op, ast.Gt | ast.GtE):
        return _surely(ast.Lt() if isinstance(op, ast.Gt) else ast.LtE(), b, a)
    if isinstance(op, ast.Lt):
        return True if a.high < b.low else False if a.low >= b.high else None
    if isinstance(op, ast.LtE):
        return True if a.high <= b.low else False if a.low > b.high else None
    same = AGREE if a.meets(b) else False
    if a.low == a.high == b.low == b.high:
        return isinstance(op, ast.Eq)
    return same if isinstance(op, ast.Eq) else _not(same)


def _not(value: Any) -> Any:
    if value is None or value is AGREE:
        return None
    return ~value if isinstance(value, pd.Series) else not value


def _joined(op: ast.boolop, values: list[Any]) -> Any:
    """And, or; on True, False and None, and on series."""
    if any(isinstance(v, pd.Series) for v in values):
        out = values[0]
        for value in values[1:]:
            out = (out & value) if isinstance(op, ast.And) else (out | value)
        return out
    deciding = isinstance(op, ast.Or)
    certain = [v for v in values if v is not AGREE]
    if any(v is not None and bool(v) == deciding for v in certain):
        return deciding
    if deciding and AGREE in values:
        return AGREE
    if any(v is None for v in values):
        return None
    return AGREE if AGREE in values else not deciding
