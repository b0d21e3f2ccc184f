"""Sums of outer products, four numbers at a time, to the same bytes as one after the other.

Numba joins no statements to operations on several numbers, and LLVM sees too late that these lie
side by side: the sums of a point take three times as long. No product is fused with a sum.
Numba does not notice a change here in what it has compiled for kernels that call these: after one,
remove ``recon4/kernels/__pycache__``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

_ROW = ir.VectorType(ir.DoubleType(), 4)


def _outer(typing: Any, sums: Any, to: Any, weight: Any, v: Any) -> Any:
    def make(builder: Any, numbers: Any, rows: Any, at: Callable[[int], Any]) -> None:
        by, values = numbers
        for i, value in enumerate(values):
            for k in range(i // _ROW.count, len(rows)):
                product = builder.fmul(by, builder.fmul(_spread(builder, value), rows[k]))
                _add(builder, at(_ROW.count * (len(rows) * i + k)), product)

    return types.void(sums, types.int64, types.float64, v), _of_rows(make)


def _scaled(typing: Any, sums: Any, to: Any, weight: Any, v: Any, factor: Any) -> Any:
    def make(builder: Any, numbers: Any, rows: Any, at: Callable[[int], Any]) -> None:
        by, _, factor = numbers
        for k, row in enumerate(rows):
            product = builder.fmul(builder.fmul(by, row), _spread(builder, factor))
            _add(builder, at(_ROW.count * k), product)

    return types.void(sums, types.int64, types.float64, v, types.float64), _of_rows(make)


def _row(typing: Any, sums: Any, to: Any, v: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        v = _numbers(builder, args[2])
        if len(v) == _ROW.count:
            place = builder.bitcast(builder.gep(data, [args[1]]), _ROW.as_pointer())
            _add(builder, place, _joined(builder, v))
        else:
            for k, number in enumerate(v):
                at = builder.add(args[1], ir.Constant(ir.IntType(64), k))
                _add(builder, builder.gep(data, [at]), number)
        return context.get_dummy_value()

    return types.void(sums, types.int64, v), code


add_outer: Any = intrinsic(_outer)
"""``add_outer(sums, to, weight, v)``: ``sums[to + L * i + j] += weight * (v[i] * v[j])``, j >= i.

``v`` is a tuple of M numbers; a row has L numbers, M rounded up to a multiple of 4. What lies
below the diagonal or beyond M has no meaning.
"""
add_scaled: Any = intrinsic(_scaled)
"""``add_scaled(sums, to, weight, v, factor)``: ``sums[to + j] += (weight * v[j]) * factor``."""
add_row: Any = intrinsic(_row)
"""``add_row(sums, to, v)``: ``sums[to + j] += v[j]``; ``v`` is a tuple of at most four numbers."""


def _of_rows(make: Callable[..., None]) -> Callable[..., Any]:
    """Code that is given the tuple in rows of lanes, and where the sums are."""

    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        array = context.make_array(signature.args[0])(context, builder, args[0])
        v = _numbers(builder, args[3])
        rows = [_joined(builder, v[k : k + _ROW.count]) for k in range(0, len(v), _ROW.count)]

        def at(offset: int) -> Any:
            place = builder.add(args[1], ir.Constant(ir.IntType(64), offset))
            return builder.bitcast(builder.gep(array.data, [place]), _ROW.as_pointer())

        make(builder, (_spread(builder, args[2]), v, *args[4:]), rows, at)
        return context.get_dummy_value()

    return code


def _numbers(builder: Any, given: Any) -> Any:
    """The numbers of a tuple."""
    return cgutils.unpack_tuple(builder, given)  # type: ignore[no-untyped-call]


def _joined(builder: Any, numbers: Any) -> Any:
    """Up to four numbers side by side, with zeros behind them."""
    row = ir.Constant(_ROW, [0.0] * _ROW.count)
    for k, number in enumerate(numbers):
        row = builder.insert_element(row, number, ir.Constant(ir.IntType(32), k))
    return row


def _spread(builder: Any, number: Any) -> Any:
    """One number in all lanes."""
    return _joined(builder, [number] * _ROW.count)


def _add(builder: Any, place: Any, product: Any) -> None:
    builder.store(builder.fadd(builder.load(place, align=8), product), place, align=8)
