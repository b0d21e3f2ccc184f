"""Headers of ``.npy`` files whose number of rows is known only when they are closed."""

from __future__ import annotations

HEADER_BYTES = 128


def npy_header(descr: str, shape: tuple[int, ...]) -> bytes:
    """Header of a version 1.0 ``.npy`` file, of constant size so that it can be rewritten.

    Args:
        descr: Type of the numbers, such as ``<f4``.
        shape: Of the array.
    """
    text = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape}, }}"
    body = text.encode("latin1").ljust(HEADER_BYTES - 11) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(body).to_bytes(2, "little") + body
