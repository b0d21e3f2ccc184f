"""How often each kind of finding was right: counts over runs with known truth.

``measured.toml`` is written with ``python -m tests.benchmarks.precision RUNS --toml NAME``; each
source is one set of runs. An *alarm* makes the verdict worse than good. It is *true* in a run whose
trajectory is wrong, or whose fault it names.
"""

from __future__ import annotations

import tomllib
from functools import cache
from importlib import resources

import msgspec

from recon4.model.finding_kinds import FindingKind


class Alarms(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Alarms of one kind in the runs of one source."""

    alarms: int
    true: int
    of_wrong: int
    """In wrong runs."""

    @property
    def precision(self) -> float:
        """Ratio of its alarms that are true."""
        return self.true / self.alarms


class MeasuredRuns(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A set of runs."""

    name: str
    right: int
    """Runs whose trajectory is right …"""
    wrong: int
    """… and those whose is not."""
    kinds: dict[FindingKind, Alarms]

    def words(self, kind: FindingKind) -> str:
        """What it says of a kind."""
        runs = self.right + self.wrong
        found = self.kinds.get(kind)
        if found is None:
            return f"no alarm in {runs} runs ({self.name})"
        text = f"{found.alarms} alarms in {runs} runs, {100.0 * found.precision:.0f} % of them true"
        return f"{text}, in {found.of_wrong} of {self.wrong} wrong runs ({self.name})"


class _Measured(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    sources: tuple[MeasuredRuns, ...]


@cache
def sources() -> tuple[MeasuredRuns, ...]:
    """All sources, the largest first."""
    text = resources.files("recon4.findings").joinpath("measured.toml").read_text("utf-8")
    return msgspec.convert(tomllib.loads(text), _Measured).sources
