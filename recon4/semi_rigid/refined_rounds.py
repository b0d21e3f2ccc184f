"""Rounds of the refinement and matched multiframes in logs, for a process that goes on with them.

A round is summed up in one order, so the plane map of a round that was begun is built once more;
what has been matched to it is not matched again.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from recon4.geometry.se3 import TRANSLATION, Array
from recon4.model.figures import RefineRound
from recon4.store.unfinished import RecordLog, unfinished_file


class MatchedFrame(NamedTuple):
    """Normal equations of a multiframe, mean distance [m] and match ratio."""

    H: Array
    """(12, 12)."""
    g: Array
    """(12,)."""
    mean_m: float
    match_ratio: float


class MatchedFrames:
    """Multiframes that were matched in one round."""

    def __init__(self, number: int) -> None:
        """Take up what an earlier process has matched in the round of this number."""
        self._log = RecordLog(unfinished_file(f"round-{number}"))
        found = (np.frombuffer(record, np.float64) for record in self._log)
        self._known = {int(values[0]): _matched(values[1:]) for values in found}

    def get(self, row: int) -> MatchedFrame | None:
        """What an earlier process found; None = nothing."""
        return self._known.get(row)

    def add(self, row: int, found: MatchedFrame) -> None:
        """Note what was found, in the order in which it is used."""
        if row not in self._known:
            figures = (found.mean_m, found.match_ratio)
            values = np.concatenate([[float(row)], found.H.ravel(), found.g, figures])
            self._log.append(values.tobytes())


class RefinedRounds:
    """Rounds that are finished."""

    def __init__(self) -> None:
        """Take up those of an earlier process."""
        self._log = RecordLog(unfinished_file("rounds"))

    def get(self, number: int) -> tuple[Array, RefineRound] | None:
        """Corrections of the knots (K, 6) and figures of a round; None = it was not finished."""
        if number >= len(self._log):
            return None
        values = np.frombuffer(self._log[number], np.float64)
        step = values[2:].reshape(-1, 6)
        return step, _figures(step, mean_m=float(values[0]), match_ratio=float(values[1]))

    def add(self, step: Array, *, mean_m: float, match_ratio: float) -> RefineRound:
        """Note a finished round; returns its figures."""
        self._log.append(np.concatenate([[mean_m, match_ratio], step.ravel()]).tobytes())
        return _figures(step, mean_m=mean_m, match_ratio=match_ratio)


def _matched(values: Array) -> MatchedFrame:
    H, g, figures = np.split(values, [144, 156])
    return MatchedFrame(H.reshape(12, 12), g, float(figures[0]), float(figures[1]))


def _figures(step: Array, *, mean_m: float, match_ratio: float) -> RefineRound:
    largest_m = float(np.linalg.norm(step[:, TRANSLATION], axis=1).max())
    return RefineRound(mean_m=mean_m, match_ratio=match_ratio, largest_step_m=largest_m)
