"""Which blocks and tables of firing times the packets of one sensor use, by their mode.

A *key* tells all that the firing times depend on: returns of a shot, firing sequence (QT128),
operational state and azimuth flags (Pandar128, OT128). `Fields.firing_key` reads it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.kernels.spinning import BlockRoles
from recon4.recording.packets.hesai.layouts import HesaiLayout
from recon4.recording.packets.hesai.models import HesaiModel
from recon4.recording.packets.spinning import variants


@dataclass(frozen=True, slots=True, kw_only=True)
class FiringMode:
    """A key taken apart."""

    KEYS: ClassVar[int] = 128
    """Keys are smaller."""

    returns: int
    """Returns of a shot."""
    sequence: int
    """Firing sequence of a QT128: 1 = the packet starts with the first one."""
    flags: tuple[int, int]
    """Azimuth flags of blocks 1 and 2 of a Pandar128 or OT128."""
    high_resolution: bool
    """Whether a Pandar128 or OT128 fires twice as often."""


def firing_mode(key: int, blocks: int) -> FiringMode:
    """What a key means for packets with this number of blocks."""
    flags = key // 4 % 16
    return FiringMode(
        returns=min(max(key % 4, 1), blocks),
        sequence=key // 4 % 2,
        flags=(flags // 4, flags % 4),
        high_resolution=key < 64,
    )


def rows_of(model: HesaiModel, mode: FiringMode, rounds: int) -> NDArray[np.int64]:
    """Row of ``model.firing_us`` of each round of firing in a packet, (rounds,)."""
    round_ = np.arange(rounds)
    if model.name == "QT128":
        return np.asarray((mode.sequence + round_ + 1) % 2, dtype=np.int64)
    if model.name == "Pandar128":
        flag = np.array(mode.flags)[np.minimum(round_ * mode.returns, 1)]
        return np.asarray(flag if mode.high_resolution else 4 + flag % 2, dtype=np.int64)
    if model.name == "OT128":
        flag = np.array(mode.flags)[np.minimum(round_ * mode.returns, 1)]
        return np.asarray(flag % 2 if mode.high_resolution else 2 + 0 * flag, dtype=np.int64)
    return np.zeros(rounds, dtype=np.int64)


def packet_s(model: HesaiModel, blocks: int, mode: FiringMode) -> float:
    """Usual time from one data packet to the next [s]."""
    round_us = model.round_us(high_resolution=mode.high_resolution)
    return 1e-6 * round_us * max(blocks // mode.returns, 1)


def shot_times_us(model: HesaiModel, blocks: int, mode: FiringMode) -> Array:
    """When each channel fires after the stamp in each round of firing [µs], (rounds, C)."""
    rounds = max(blocks // mode.returns, 1)
    start_us = model.start_us(rounds, high_resolution=mode.high_resolution)
    return np.asarray(start_us[:, None] + model.firing_us[rows_of(model, mode, rounds)])


@dataclass(slots=True)
class FiringVariants:
    """The keys of a sensor met so far, each a variant for the kernel."""

    model: HesaiModel
    layout: HesaiLayout
    first_ns: NDArray[np.int64] = field(default_factory=lambda: np.zeros(FiringMode.KEYS, np.int64))
    """First shot after the stamp by key [ns], (KEYS,)."""
    variant: NDArray[np.uint8] = field(
        default_factory=lambda: np.full(FiringMode.KEYS, 255, np.uint8)
    )
    """Row of `roles` by key, (KEYS,); 255 = not met yet."""
    third: NDArray[np.uint8] = field(
        default_factory=lambda: np.full(FiringMode.KEYS, 255, np.uint8)
    )
    """Row of `roles` that reads the third returns, (KEYS,); as `variant` = there are none."""
    roles: BlockRoles | None = None
    """Of all keys met so far."""

    def meet(self, keys: NDArray[np.int64]) -> None:
        """Prepare for the keys of some packets, (N,)."""
        for key in np.flatnonzero(np.bincount(keys, minlength=FiringMode.KEYS)).tolist():
            if self.variant[key] == 255:
                self._add(key)

    def _add(self, key: int) -> None:
        mode = firing_mode(key, self.layout.blocks)
        time_us = shot_times_us(self.model, self.layout.blocks, mode)
        time_ns = np.rint(1e3 * time_us).astype(np.int64)
        first_ns = int(time_ns.min())
        self.first_ns[key] = first_ns
        start = np.arange(len(time_ns), dtype=np.int64) * mode.returns
        none = np.full(len(start), -1, dtype=np.int64)
        rows = rows_of(self.model, mode, len(time_ns))
        group = np.array([mode.returns], dtype=np.int64)

        def roles(block: NDArray[np.int64], twin: NDArray[np.int64]) -> BlockRoles:
            return BlockRoles(group, block[None], twin[None], rows[None], time_ns[None] - first_ns)

        twin = start + 1 if mode.returns > 1 else none
        self.variant[key] = self.third[key] = self._append(roles(start, twin))
        if mode.returns == 3:
            self.third[key] = self._append(roles(start + 2, none))

    def _append(self, roles: BlockRoles) -> int:
        """Row of a further variant."""
        row = 0 if self.roles is None else len(self.roles.group)
        self.roles = roles if self.roles is None else variants(self.roles, roles)
        return row
