"""Checksums of Hesai packets: CRC-32/MPEG-2 (polynomial 04c11db7, not reflected).

Checked is the sum of the tail, which holds time and return mode; summing up the body too would
take longer than decoding it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.checksums import crc32_of_rows
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.hesai.layouts import CRC_POLYNOMIAL, HesaiLayout


def _tables() -> NDArray[np.uint32]:
    """What each byte adds to the sum, with 0 to 3 bytes behind it, (4, 256)."""
    rest = np.arange(256, dtype=np.uint64) << 24
    for _ in range(8):
        rest = (rest << 1) ^ np.where(rest & 0x80000000, CRC_POLYNOMIAL, 0).astype(np.uint64)
    tables = [rest.astype(np.uint32)]
    for _ in range(3):
        tables.append((tables[-1] << np.uint32(8)) ^ tables[0][tables[-1] >> np.uint32(24)])
    return np.stack(tables)


TABLES = _tables()


def crc32(rows: NDArray[np.uint8]) -> NDArray[np.uint32]:
    """Checksum of each row, (N,).

    Args:
        rows: Bytes, (N, K).
    """
    return crc32_of_rows(rows, TABLES)


def write(payloads: Payloads, layout: HesaiLayout) -> None:
    """Put the checksum of the tail into packets that have one."""
    at = layout.crc_at
    if at >= 0:
        total = crc32(payloads[:, layout.crc_from : at])
        payloads[:, at : at + 4] = total.astype("<u4").view(np.uint8).reshape(-1, 4)
