"""Counts the browsers connected to the viewers."""

from __future__ import annotations

from collections import Counter


class Sockets:
    """Counts the browsers that look, in all and by person."""

    def __init__(self, *, most: int, most_a_person: int) -> None:
        self._most, self._most_a_person = most, most_a_person
        self._open: Counter[str] = Counter()

    def enter(self, person: str) -> bool:
        """Count one more; False, and nothing counted, if that is too many."""
        if self._open.total() >= self._most or self._open[person] >= self._most_a_person:
            return False
        self._open[person] += 1
        return True

    def leave(self, person: str) -> None:
        """Count one less."""
        self._open[person] -= 1
