"""Limits of deliveries, which come from other people where they are verified."""

from __future__ import annotations

from msgspec import Struct


class DeliveryLimits(Struct, frozen=True, kw_only=True):
    """What is read of a delivery or a signed report."""

    max_pdf_bytes: int = 256 << 20
    """Of a report whose signature is checked."""
    max_manifest_bytes: int = 16 << 20
    max_files: int = 10_000
    """In a delivery."""
    block_bytes: int = 1 << 20
    """Read at a time."""


DELIVERIES = DeliveryLimits()
