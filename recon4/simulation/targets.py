"""Survey targets in a simulated walk: retro-reflective plates, black-white boards, spheres.

Plates and boards hang flat on what stands beside the path, spheres stand on poles between both.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import cycle
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError
from recon4.geometry.mesh import MeshBuilder, joined
from recon4.geometry.raycast import Scene
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText
from recon4.model.targets import TargetKind
from recon4.simulation.materials import MATERIAL
from recon4.simulation.setup import SimulationSetup
from recon4.simulation.world import WorldTarget


@dataclass(frozen=True, slots=True, kw_only=True)
class TargetPlan:
    """Measures of targets, and where they may be."""

    plate_m: float = 0.15
    """Edge of a retro-reflective plate."""
    board_m: float = 0.3
    """Edge of a black-white board."""
    radius_m: float = 0.1
    """Of a sphere."""
    before_m: float = 0.004
    """A plate or board is this far before its wall."""
    height_m: tuple[float, float] = (1.0, 1.8)
    """Above the floor."""
    away_m: tuple[float, float] = (0.6, 3.0)
    """From the path."""
    behind_m: float = 0.4
    """Free room behind a sphere, as seen from the path."""
    clear_m: float = 0.7
    """Nobody walks nearer by a sphere."""
    apart_m: float = 1.0
    """Between two targets."""
    open_m: float = 3.0
    """With as much free room behind it a plate or board stands on a pole, too."""
    uneven_m: float = 0.1
    """Largest step of the floor between path and pole."""
    pole_m: float = 0.012
    """Radius of the pole of a sphere."""
    tries: int = 400
    """Places that are looked at for each target."""
    control: int = 5
    """Of all targets as many are control points, the others check points."""
    survey_sd_m: float = 0.002
    """Standard deviation of a surveyed coordinate."""
    turn_rad: float = 0.7
    origin_m: tuple[float, float, float] = (51_230.0, 108_470.0, 203.0)
    """Of the map in the grid of the site, in which the survey is."""


TARGETS = TargetPlan()


def with_targets(setup: SimulationSetup, count: int) -> SimulationSetup:
    """The same walk in a world with targets along the path, one of each kind after the other.

    Raises:
        ConfigError: If the count is negative, or there is no room for as many.
    """
    if count < 0:
        raise ConfigError(CodedText("simulate-targets-count", count=count))
    if not count:
        return setup
    rng = np.random.default_rng([setup.seed, 31])
    path = setup.walk.poses(np.arange(0.0, setup.walk.seconds, 0.1)).t
    along = _Path(path, setup.surroundings.scene, rng)
    builder, targets = MeshBuilder(), list[WorldTarget]()
    for k, kind in zip(range(count), cycle(TargetKind), strict=False):
        about = (k + 0.5) / count * len(path)
        taken = [np.array(one.p_map) for one in targets]
        place = _place(kind, along, about=about, taken=taken)
        if place is None:
            raise ConfigError(CodedText("simulate-targets-room", k=k, count=count))
        _build(builder, kind, place)
        x, y, z = np.round(place.middle, 6).tolist()
        radius = TARGETS.radius_m if kind is TargetKind.SPHERE else 0.0
        targets.append(WorldTarget(f"T{k + 1}", kind, (x, y, z), radius))
    mesh = joined(setup.world.mesh, builder.mesh())
    return replace(
        setup,
        world=replace(setup.world, mesh=mesh, targets=tuple(targets)),
        surroundings=replace(setup.surroundings, mesh=mesh, scene=Scene(mesh)),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _TargetPlace:
    middle: Array
    """Of the target [m], (3,)."""
    normal: Array
    """Out of the wall towards the path, (3,)."""
    floor_m: float
    """Height of the floor below."""
    stands: bool = False
    """On a pole, not on a wall."""


@dataclass(frozen=True, slots=True, eq=False)
class _Path:
    """What targets are placed along."""

    path: Array
    """Positions of the body [m], (N, 3)."""
    scene: Scene
    rng: np.random.Generator


def _place(
    kind: TargetKind, along: _Path, *, about: float, taken: list[Array]
) -> _TargetPlace | None:
    """A free place near a part of the path; None if none was found."""
    (low, high), path, rng = TARGETS.away_m, along.path, along.rng
    for once in range(TARGETS.tries):
        spread = len(path) * (0.05 + once / TARGETS.tries)
        row = int(np.clip(about + spread * rng.normal(), 0, len(path) - 1))
        place = _tried(kind, path[row], along)
        if place is None:
            continue
        off = np.linalg.norm(path[:, :2] - place.middle[:2], axis=1)
        clear = TARGETS.clear_m if kind is TargetKind.SPHERE else low
        apart = [np.linalg.norm(place.middle - one) for one in taken]
        if clear <= off.min() <= high and min(apart, default=9.0) >= TARGETS.apart_m:
            return place
    return None


def _tried(kind: TargetKind, eye: Array, along: _Path) -> _TargetPlace | None:
    """A place in a random direction from a place of the path."""
    scene, rng = along.scene, along.rng
    floor = _cast(scene, eye[None], np.array([[0.0, 0.0, -1.0]]))[0][0]
    turn = rng.uniform(0.0, 2.0 * np.pi)
    ahead = np.array([np.cos(turn), np.sin(turn), 0.0])
    start = np.array([*eye[:2], floor[2] + rng.uniform(*TARGETS.height_m)])
    if not np.isfinite(start).all():
        return None
    (wall,), (normal,) = _cast(scene, start[None], ahead[None])
    reach = float(np.linalg.norm(wall - start))
    away = rng.uniform(TARGETS.clear_m, TARGETS.away_m[1])
    open_ = reach > away + TARGETS.open_m
    if kind is TargetKind.SPHERE or open_:
        middle = start + away * ahead
        below = _cast(scene, middle[None], np.array([[0.0, 0.0, -1.0]]))[0][0]
        # Not above a table: the pole stands on the floor.
        on_floor = bool(abs(below[2] - floor[2]) < TARGETS.uneven_m)
        free = reach > away + TARGETS.behind_m and _free_around(scene, middle)
        stands = _TargetPlace(middle, -ahead, float(below[2]), stands=True)
        return stands if free and on_floor else None
    if not np.isfinite(wall).all() or abs(normal[2]) > 1e-3:
        return None
    normal = normal if normal @ ahead < 0.0 else -normal
    if -(normal @ ahead) < 0.5 or not _flat(scene, start, (wall, normal)):
        return None
    return _TargetPlace(wall + TARGETS.before_m * normal, normal, float(floor[2]))


def _cast(scene: Scene, origins: Array, directions: Array) -> tuple[Array, Array]:
    """Where rays end and the normals there, (N, 3) each; infinite = nowhere."""
    hits = scene.cast(np.hstack([origins, directions]).astype(np.float32))
    reach = hits.range_m.astype(np.float64)[:, None]
    with np.errstate(invalid="ignore"):
        ends = np.where(np.isfinite(reach), origins + reach * directions, np.inf)
    return ends, hits.normal.astype(np.float64)


def _free_around(scene: Scene, middle: Array) -> bool:
    return bool(scene.distance(middle[None])[0] > TARGETS.radius_m + TARGETS.behind_m / 2.0)


def _flat(scene: Scene, eye: Array, at: tuple[Array, Array]) -> bool:
    """Whether the wall around a place is seen, flat, and large enough for a board."""
    wall, normal = at
    along = np.cross([0.0, 0.0, 1.0], normal)
    half = np.linspace(-0.75, 0.75, 7) * TARGETS.board_m
    u, v = (grid.ravel()[:, None] for grid in np.meshgrid(half, half))
    places = wall + u * along + v * np.array([0.0, 0.0, 1.0])
    toward = places - eye
    toward /= np.linalg.norm(toward, axis=1)[:, None]
    ends, _ = _cast(scene, np.tile(eye, (len(places), 1)), toward)
    return bool(np.isfinite(ends).all() and np.abs((ends - wall) @ normal).max() < 1e-3)


def _build(builder: MeshBuilder, kind: TargetKind, place: _TargetPlace) -> None:
    up, along = np.array([0.0, 0.0, 1.0]), np.cross([0.0, 0.0, 1.0], place.normal)
    if place.stands:
        half = TARGETS.radius_m if kind is TargetKind.SPHERE else 0.5 * TARGETS.board_m
        behind = 0.0 if kind is TargetKind.SPHERE else 0.02
        foot = np.array([*place.middle[:2], place.floor_m]) - behind * place.normal
        top = foot + (place.middle[2] - 0.98 * half - place.floor_m) * up
        builder.tube(foot, top, TARGETS.pole_m, reflectivity=MATERIAL.steel)
    if kind is TargetKind.SPHERE:
        radii = np.full(3, TARGETS.radius_m)
        builder.ball(place.middle, radii, MATERIAL.paper, bumps=np.ones((33, 48)))
        return
    edge = TARGETS.plate_m if kind is TargetKind.PLATE else TARGETS.board_m
    if kind is TargetKind.PLATE:
        corner = place.middle - 0.5 * edge * (along + up)
        builder.quad(corner, edge * along, edge * up, reflectivity=MATERIAL.retro)
        return
    for u, v in ((0, 0), (0, 1), (1, 0), (1, 1)):
        corner = place.middle + 0.5 * edge * ((u - 1) * along + (v - 1) * up)
        paint = MATERIAL.paper if u == v else MATERIAL.ink
        builder.quad(corner, 0.5 * edge * along, 0.5 * edge * up, reflectivity=paint)


def write_targets(folder: Path, targets: Iterable[WorldTarget], seed: int) -> None:
    """Write ``targets.csv``, the truth in the map, and ``survey.csv``, as a surveyor measured them.

    Args:
        folder: Of the recording.
        targets: Of the world; none = nothing is written.
        seed: Draws the errors of the survey, which is in a grid of the site.
    """
    given = list(targets)
    if not given:
        return
    true = "".join(
        f"{one.name},{one.kind},{one.p_map[0]:.4f},{one.p_map[1]:.4f},{one.p_map[2]:.4f},"
        f"{one.radius_m:.4f}\n"
        for one in given
    )
    head = "id,kind,x_m,y_m,z_m,radius_m\n"
    (folder / "targets.csv").write_text(head + true, "ascii")
    rng = np.random.default_rng([seed, 32])
    T_site_map = SE3.from_rpy(0.0, 0.0, TARGETS.turn_rad, t=list(TARGETS.origin_m))
    surveyed = T_site_map @ np.array([one.p_map for one in given])
    surveyed += TARGETS.survey_sd_m * rng.normal(size=surveyed.shape)
    placing = _control_rows(len(given))
    rows = "".join(
        f"{one.name},{p[0]:.4f},{p[1]:.4f},{p[2]:.4f},{'control' if k in placing else 'check'},"
        f"{one.radius_m:.4f}\n"
        for k, (one, p) in enumerate(zip(given, surveyed, strict=True))
    )
    head = "id,easting_m,northing_m,height_m,role,radius_m\n"
    (folder / "survey.csv").write_text(head + rows, "ascii")


def _control_rows(count: int) -> set[int]:
    rows: NDArray[np.intp] = np.linspace(0, count - 1, TARGETS.control).round().astype(np.intp)
    return set(rows.tolist())
