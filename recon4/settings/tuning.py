"""Tuning: what an algorithm needs besides what people choose.

A tuning record stands beside its algorithm and says where its values come from. If the algorithm
also has settings, the record is those settings, completed: it may be passed wherever they are
expected, so that a test tries another value without a global one.
"""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import TypeVar

Tuning = TypeVar("Tuning")


def tuned(kind: type[Tuning], settings: object) -> Tuning:
    """The settings of people, completed by the tuning of an algorithm.

    Args:
        kind: The tuning record, a subclass of the record of the settings.
        settings: The settings; a record of this kind is returned as it is.
    """
    if isinstance(settings, kind):
        return settings
    assert is_dataclass(settings)
    return kind(**{field.name: getattr(settings, field.name) for field in fields(settings)})
