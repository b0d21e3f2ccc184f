"""From waypoints to the motion of a walking body: path, speed, turns, steps."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.simulation.person import GAIT
from recon4.simulation.rides import Ride
from recon4.simulation.walk import Walk
from recon4.simulation.world import Waypoint, World

_RATE_HZ = 4.0 / Walk.KNOT_S
"""Of the samples from which the splines are made."""


@dataclass(slots=True)
class _Timeline:
    """Corners of piecewise linear functions of time, while they are being laid out."""

    t_s: list[float] = field(default_factory=list)
    place: list[tuple[float, float, float]] = field(default_factory=list)
    heading_t_s: list[float] = field(default_factory=list)
    heading_rad: list[float] = field(default_factory=list)
    rides_s: list[tuple[float, float]] = field(default_factory=list)
    """Begin and end of each ride in an elevator [s]."""

    def stay(self, seconds: float) -> None:
        self.move(self.place[-1], seconds)

    def move(self, place: tuple[float, float, float], seconds: float) -> None:
        self.t_s.append(self.t_s[-1] + seconds)
        self.place.append(place)

    def ride(self, place: tuple[float, float, float]) -> None:
        """Be carried straight up or down, with a course of the fifth degree over time."""
        (x, y, z), begin_s = self.place[-1], self.t_s[-1]
        rise = place[2] - z
        for s in np.linspace(0.0, 1.0, max(2, round(abs(rise) / GAIT.ride_m_s / GAIT.ride_step_s)))[
            1:
        ]:
            self.t_s.append(begin_s + float(s) * abs(rise) / GAIT.ride_m_s)
            done = float(s**3 * (10.0 - 15.0 * s + 6.0 * s**2))
            self.place.append((x, y, z + done * rise))
        self.rides_s.append((begin_s, self.t_s[-1]))

    def turn(self, angle_rad: float, start_s: float, seconds: float) -> None:
        start = max(start_s, self.heading_t_s[-1])
        self.heading_t_s += [start, start + seconds]
        self.heading_rad += [self.heading_rad[-1], self.heading_rad[-1] + angle_rad]


def plan_walk(world: World, *, seconds: float, rng: np.random.Generator) -> Walk:
    """Plan rounds through a world of a given duration, ending at the start.

    A longer walk is more rounds, each by another way; their number and the places visited are
    chosen so that the person walks at 1.0 to 1.4 m/s. Only a walk too short for the shortest
    round is cut off on its way.
    """
    legs, speed_m_s = _fit(world, seconds, rng)
    timeline = _lay_out(legs, speed_m_s)
    count = 4 * round(seconds / Walk.KNOT_S) + 1
    t_s = np.arange(count) / _RATE_HZ
    walk = Walk.through(_body(timeline, t_s, rng)[::4])
    return replace(walk, ride=_ride(timeline, t_s)) if timeline.rides_s else walk


def _ride(line: _Timeline, t_s: Array) -> Ride:
    """Where the car is: with the person during rides, else at the storey of the last one."""
    riding = _riding(line, t_s)
    corners = np.array(line.place)
    begins = np.array([begin for begin, _ in line.rides_s])
    # Between two rides the person stays on one storey: that of the end of the last ride.
    known_s = np.array(line.t_s)
    inside = _riding(line, known_s)
    first_m = np.interp(begins[0], known_s, corners[:, 2])
    height_m = np.interp(t_s, known_s[inside], corners[inside, 2], left=first_m)
    return Ride(1.0 / _RATE_HZ, _smooth(height_m, GAIT.path_sigma_s), riding)


def _riding(line: _Timeline, t_s: Array) -> NDArray[np.bool_]:
    rides = [(t_s >= begin) & (t_s <= end) for begin, end in line.rides_s]
    return np.logical_or.reduce(rides) if rides else np.zeros(len(t_s), np.bool_)


def _fit(world: World, seconds: float, rng: np.random.Generator) -> tuple[list[Waypoint], float]:
    """Waypoints of all rounds, and the speed that fits them into the duration [m/s]."""
    full = _duration(world.route(np.random.default_rng(0), world.stops), GAIT.speed_m_s)
    rounds = max(1, math.ceil(seconds / (GAIT.longest * full)))
    routes: list[Waypoint] = []
    for _ in range(rounds):
        route = _round(world, seconds / rounds, rng)
        routes += route[1:] if routes else route
    low, high = GAIT.slowest_m_s, GAIT.fastest_m_s
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _duration(routes, middle) > seconds else (low, middle)
    return routes, 0.5 * (low + high)


def _round(world: World, seconds: float, rng: np.random.Generator) -> list[Waypoint]:
    """One round of about a given duration, and at most that at the fastest speed."""
    seeds = rng.integers(1 << 62, size=world.stops)
    plans = [
        world.route(np.random.default_rng(seed), stops + 1) for stops, seed in enumerate(seeds)
    ]
    fitting = [plan for plan in plans if _duration(plan, GAIT.fastest_m_s) <= seconds]
    if not fitting:
        return min(plans, key=lambda plan: _duration(plan, GAIT.speed_m_s))
    return min(fitting, key=lambda plan: abs(_duration(plan, GAIT.speed_m_s) - seconds))


def _duration(route: list[Waypoint], speed_m_s: float) -> float:
    return _lay_out(route, speed_m_s).t_s[-1]


def _lay_out(route: list[Waypoint], speed_m_s: float) -> _Timeline:
    """Position and heading of the person over time."""
    points = np.array([[w.x_m, w.y_m, w.z_m] for w in route])
    steps = np.diff(points, axis=0)
    directions = np.arctan2(steps[:, 1], steps[:, 0])
    for step, waypoint in enumerate(route[1:-1]):
        if waypoint.ride:
            directions[step] = directions[step + 1]  # a person looks at the door
    line = _Timeline([0.0], [tuple(points[0])], [0.0], [float(directions[0])])
    line.stay(GAIT.stand_s)
    for k, waypoint in enumerate(route[1:]):
        if waypoint.ride:
            line.ride(tuple(points[k + 1]))
        else:
            line.move(tuple(points[k + 1]), _length(steps[k]) / (speed_m_s * waypoint.pace))
        following = directions[k + 1] if k + 1 < len(directions) else directions[0]
        angle = _wrap(following - line.heading_rad[-1])
        _turn(line, waypoint, angle, at_end=k + 1 == len(directions))
    line.stay(GAIT.stand_s)
    return line


def _turn(line: _Timeline, waypoint: Waypoint, angle_rad: float, *, at_end: bool) -> None:
    if not waypoint.stop and not at_end:
        # Without a stop: half of the turn before the corner, half after it.
        seconds = abs(angle_rad) / np.deg2rad(130.0)
        line.turn(angle_rad, line.t_s[-1] - 0.5 * seconds, seconds)
        return
    look = np.deg2rad(waypoint.look_deg)
    for angle in [look, _wrap(angle_rad - look)] if look else [angle_rad]:
        # The larger the turn, the faster, as people do: 60 deg/s for small, 240 for 180 degrees.
        rate = np.deg2rad(np.clip(60.0 + np.rad2deg(abs(angle)), 60.0, GAIT.fastest_turn_deg_s))
        seconds = abs(angle) / rate
        line.stay(0.15)
        line.turn(angle, line.t_s[-1], seconds)
        line.stay(seconds + 0.15)


def _body(line: _Timeline, t_s: Array, rng: np.random.Generator) -> Array:
    """x, y, z, roll, pitch, yaw of the body, (N,) -> (N, 6)."""
    corners = np.array(line.place)
    place = np.stack([np.interp(t_s, line.t_s, corners[:, k]) for k in range(3)], axis=1)
    place = _smooth(place, GAIT.path_sigma_s)
    yaw = _smooth(np.interp(t_s, line.heading_t_s, line.heading_rad), GAIT.heading_sigma_s)
    steps = np.gradient(place, t_s, axis=0)
    speed = np.hypot(steps[:, 0], steps[:, 1])
    climb = np.abs(steps[:, 2]) * ~_riding(line, t_s)
    turning = np.abs(np.gradient(yaw, t_s))
    effort = _smooth(
        np.clip(np.maximum(speed + climb, 0.3 * turning) / GAIT.speed_m_s, 0, 1.15), 0.3
    )
    # Step frequency 1.6 to 2.0 Hz; phase in steps.
    phase = np.cumsum((1.4 + 0.5 * effort) * (1 + 0.05 * _wander(rng, t_s, 2.0)) / _RATE_HZ)
    calm = _calm_ends(t_s)
    step, stride = 2.0 * np.pi * phase, np.pi * phase
    side = effort * 0.022 * np.sin(stride) + calm * 0.012 * _wander(rng, t_s, 1.5)
    ahead = effort * 0.012 * np.sin(step + 0.8)
    bounce = effort * (0.024 * np.cos(step) + 0.002 * np.cos(2 * step + 0.4))
    c, s = np.cos(yaw), np.sin(yaw)
    sway = [c * ahead - s * side, s * ahead + c * side, GAIT.body_height_m + bounce]
    degrees = [
        effort * 2.0 * np.sin(stride + 0.3) + calm * 0.8 * _wander(rng, t_s, 1.0),
        2.0 + effort * 1.5 * np.sin(step + 1.1) + calm * 1.2 * _wander(rng, t_s, 1.0),
        effort * 2.5 * np.sin(stride + 1.2) + calm * 1.5 * _wander(rng, t_s, 1.0),
    ]
    angles = np.deg2rad(np.stack(degrees, axis=1))
    angles[:, 2] += yaw
    return np.hstack([place + np.stack(sway, axis=1), angles])


def _smooth(values: Array, sigma_s: float) -> Array:
    from scipy.ndimage import gaussian_filter1d

    return np.asarray(gaussian_filter1d(values, sigma_s * _RATE_HZ, axis=0, mode="nearest"))


def _wander(rng: np.random.Generator, t_s: Array, sigma_s: float) -> Array:
    """Slow random motion of standard deviation 1 without steps."""
    # White noise smoothed by a Gaussian has the variance 1 / (2 sqrt(pi) sigma) a sample.
    scale = np.sqrt(2.0 * np.sqrt(np.pi) * sigma_s * _RATE_HZ)
    return scale * _smooth(rng.standard_normal(len(t_s)), sigma_s)


def _calm_ends(t_s: Array) -> Array:
    """0 while the person stands at the start and the end, 1 between."""
    rest = np.minimum(t_s, t_s[-1] - t_s)
    x = np.clip((rest - 0.7 * GAIT.stand_s) / 2.0, 0.0, 1.0)
    return x**3 * (10.0 - 15.0 * x + 6.0 * x**2)


def _length(step: Array) -> float:
    """Of a leg on the ground [m]; a person climbs at the same horizontal pace."""
    return max(float(np.hypot(step[0], step[1])), 1e-6)


def _wrap(angle_rad: float) -> float:
    return float((angle_rad + np.pi) % (2.0 * np.pi) - np.pi)
