"""Relocalization in the map after tracking was lost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from recon4.geometry.se3 import SE3, Array
from recon4.live.mapper.last_known import Reach
from recon4.live.mapper.place_index import PlaceIndex
from recon4.live.mapper.tuning import RECOVERY


@dataclass(slots=True)
class _Hypothesis:
    """A possible pose of the odometry frame in the map."""

    T_map_odom: SE3
    score: float


class Recovery:
    """Collects pose hypotheses; every following view raises or lowers their scores."""

    def __init__(self, places: PlaceIndex, reach: Reach, *, expected: SE3 | None = None) -> None:
        """Start a relocalization.

        Args:
            places: The place index of the map so far.
            reach: Where the body can be.
            expected: ``T_map_odom`` if the body has not moved; it is accepted before all other
                places were tried.
        """
        self._places = places
        self._reach = reach
        self._to_try = places.near(
            reach.from_m, most=RECOVERY.places_tried, apart_m=RECOVERY.places_apart_m
        )
        self._tried = 0
        self._expected = None if expected is None else _Hypothesis(expected, 1.0)
        self._hypotheses = [] if self._expected is None else [self._expected]

    @property
    def is_expected(self) -> bool:
        """Whether the body is expected to be where tracking was lost."""
        return self._expected is not None

    def search(self, source: Array, T_odom_body: SE3) -> SE3 | None:
        """Pose of the odometry frame in the map, ``T_map_odom``; None = undecided.

        Args:
            source: Segment midpoints of a view in the body frame [m], (N, 3).
            T_odom_body: Pose of the view by an odometry that began after tracking was lost; roll
                and pitch are taken from it.
        """
        for hypothesis in self._hypotheses:
            self._examine(hypothesis, source, T_odom_body)
        self._hypotheses = [one for one in self._hypotheses if one.score > 0.0]
        place = self._to_try[self._tried % len(self._to_try)]
        self._tried += 1
        found = self._places.relocate(source, T_odom_body.R, place, heading=self._reach.heading())
        for T_map_body, match_ratio in found:
            T_map_odom = T_map_body @ T_odom_body.inverse()
            if self._is_possible(source, T_map_body, T_map_odom) and not any(
                _same(g.T_map_odom @ T_odom_body, T_map_body) for g in self._hypotheses
            ):
                self._hypotheses.append(_Hypothesis(T_map_odom, match_ratio))
        return self._decide()

    def _examine(self, hypothesis: _Hypothesis, source: Array, T_odom_body: SE3) -> None:
        expected = hypothesis.T_map_odom @ T_odom_body
        found = self._places.locate(source, expected, self._places.near(expected.t, most=1)[0])
        if found is None:
            hypothesis.score -= RECOVERY.missed if hypothesis is self._expected else 1.0
            return
        through = self._places.seen_through(source, found.T_target_source)
        if through > RECOVERY.max_seen_through or not _same(found.T_target_source, expected):
            hypothesis.score -= 1.0
            return
        hypothesis.score = min(hypothesis.score + found.match_ratio, RECOVERY.max_score)
        hypothesis.T_map_odom = found.T_target_source @ T_odom_body.inverse()

    def _is_possible(self, source: Array, T_map_body: SE3, T_map_odom: SE3) -> bool:
        """Whether the body can be there: by its motion, and because no view sees through a wall."""
        if not self._reach.contains(T_map_odom):
            return False
        return self._places.seen_through(source, T_map_body) <= RECOVERY.max_seen_through

    def _decide(self) -> SE3 | None:
        ranked = sorted(self._hypotheses, key=lambda one: -one.score)
        if not ranked:
            return None
        is_expected = ranked[0] is self._expected
        if ranked[0].score < (RECOVERY.sure_expected if is_expected else RECOVERY.sure_score):
            return None
        if self._tried < len(self._to_try) and not is_expected:
            return None
        rival = ranked[1].score if len(ranked) > 1 else 0.0
        return ranked[0].T_map_odom if ranked[0].score - rival >= RECOVERY.lead else None


def _same(T_a: SE3, T_b: SE3) -> bool:
    apart = T_a.inverse() @ T_b
    return bool(
        float(np.linalg.norm(apart.t)) < RECOVERY.same_m
        and float(apart.angle()) < RECOVERY.same_rad
    )
