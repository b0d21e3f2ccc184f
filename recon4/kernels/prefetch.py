"""Rows of a table are fetched into the cache while others are worked on; no value depends on it.

Numba does not notice a change here in what it has compiled for kernels that call these: after one,
remove ``recon4/kernels/__pycache__``.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

_BYTES = ir.IntType(8).as_pointer()
_INT = ir.IntType(32)
_TYPE = ir.FunctionType(ir.VoidType(), [_BYTES, _INT, _INT, _INT])
_HOW = [ir.Constant(_INT, value) for value in (0, 3, 1)]
"""To read; into all caches; data, not instructions."""


class Ahead(NamedTuple):
    """How far ahead rows are fetched."""

    points: int = 8
    """Half and twice as many take the same time."""


AHEAD = Ahead()


def _row(typing: Any, table: Any, row: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        array = context.make_array(signature.args[0])(context, builder, args[0])
        columns = cgutils.unpack_tuple(builder, array.shape)[1]  # type: ignore[no-untyped-call]
        first = builder.mul(args[1], columns)
        last = builder.add(first, builder.sub(columns, ir.Constant(columns.type, 1)))
        fetch = builder.module.declare_intrinsic("llvm.prefetch", [_BYTES], _TYPE)
        for at in (first, last):
            place = builder.bitcast(builder.gep(array.data, [at]), _BYTES)
            builder.call(fetch, [place, *_HOW])
        return context.get_dummy_value()

    return types.void(table, types.int64), code


fetch_row: Any = intrinsic(_row)
"""``fetch_row(table, row)``: begin to read the first and the last bytes of a row, (R, C) in C
order, of at most two lines of the cache (128 bytes); any number is allowed for the row."""
