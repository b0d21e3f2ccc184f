"""Rigid fit of a map to control points, and Baarda's test of each point (data snooping).

With a target at ``p`` in the map, surveyed at ``s``, a measured direction ``d`` of the map and the
pose ``T`` of the site in the map, the residual is ``v = d · (p - T s)``. Least squares over all
directions gives ``T``. In residuals divided by their standard deviation, with the design matrix
``A`` (Baarda 1968; Teunissen 2006, Testing theory, eq. 4.60):

    H = A (AᵀA)⁻¹ Aᵀ      redundancy of a row r = 1 - H_rr,  smallest error found = δ₀ σ / √r
    point i:  b = (I - H_ii)⁻¹ v_i  (the blunder),   T_i = v_iᵀ b  ~  χ²(rows of i)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from recon4.errors import GeoreferenceError
from recon4.geometry.se3 import SE3, Array, align_points, skew
from recon4.georeference.tuning_control import CONTROL_FIT
from recon4.locales.coded import CodedText


@dataclass(frozen=True, slots=True, eq=False)
class MeasuredTarget:
    """A surveyed point that was found in the map."""

    id: str
    p_site: Array
    """As surveyed: east, north, up [m], (3,)."""
    p_map: Array
    """As found in the map [m], (3,)."""
    along: Array
    """Measured directions in the map, orthonormal rows, (1..3, 3)."""
    cov: Array
    """Covariance of survey, pick and map together, in axes of the map [m²], (3, 3)."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TargetTest:
    """What the other points say of one."""

    id: str
    redundancy: tuple[float, ...]
    """Redundancy number of each measured direction, 0 = nothing controls it, 1 = all others do."""
    least_found_m: float
    """Smallest error that the test finds in every measured direction [m]; infinite = none."""
    least_found_h_m: float
    least_found_v_m: float
    """The same horizontally and in height [m]; NaN = not measured."""
    w: float
    """Normalized residual: 1 is usual, 3.3 and more is not."""
    limit: float
    """From there on ``w`` is a blunder at 0.1 %."""
    single_handed: bool
    """Whether no other point controls it."""
    blunder_m: tuple[float, float, float]
    """Error of the survey, if it is the only one: surveyed minus fitted by the others, east, north,
    up [m]."""

    @property
    def fails(self) -> bool:
        """Whether the point contradicts the others."""
        return self.w > self.limit


@dataclass(frozen=True, slots=True, eq=False)
class ControlFit:
    """A map laid on control points."""

    T_map_site: SE3
    freedom: int
    """6, or 4 on a leveled map: turn about the vertical and shift."""
    scale: float
    """Length in the survey over length in the map; reported, never applied."""
    scale_sd: float
    sd0: float
    """Root of the variance factor: 1 = residuals are as stated; NaN = no redundancy."""
    rmse_m: float
    """Root mean square of the measured coordinates [m]."""
    tests: tuple[TargetTest, ...]

    @property
    def worst(self) -> TargetTest | None:
        """The point that contradicts the others most; None = none does."""
        failed = [test for test in self.tests if test.fails]
        return max(failed, key=lambda test: test.w / test.limit, default=None)


def fit_control(targets: Sequence[MeasuredTarget], *, leveled: bool) -> ControlFit:
    """Lay a map on control points.

    A leveled map is turned about the vertical only, unless the points determine the tilt to
    `CONTROL_FIT.tilt_sd_rad` and it is one that leveling may have left.

    Args:
        targets: Control points, found in the map.
        leveled: Whether the map's z axis is vertical.

    Raises:
        GeoreferenceError: With fewer than three points, two in one place, or if they leave a turn
            of the map open.
    """
    _check(targets)
    whole = _RigidFit.of(targets, freedom=6, start=None)
    # Flat points of a survey with exchanged axes fit a map that lies on its back.
    on_its_back = leveled and whole.tilt_rad > CONTROL_FIT.most_tilt_rad
    limit_rad = CONTROL_FIT.tilt_sd_rad if leveled else CONTROL_FIT.turn_sd_rad
    if on_its_back or whole.tilt_sd_rad > limit_rad:
        if not leveled:
            raise GeoreferenceError(CodedText("control-one-line", targets=_names(targets)))
        whole = _RigidFit.of(targets, freedom=4, start=None)
    if not whole.heading_sd_rad < CONTROL_FIT.turn_sd_rad:
        raise GeoreferenceError(CodedText("control-too-close", targets=_names(targets)))
    return whole.judged()


def without(targets: Sequence[MeasuredTarget], name: str) -> list[MeasuredTarget]:
    """All targets but one."""
    return [one for one in targets if one.id != name]


def snoop(targets: Sequence[MeasuredTarget], *, leveled: bool) -> tuple[ControlFit, list[str]]:
    """Fit, and leave out the point that contradicts the others most, until none does.

    Returns:
        The fit of those that agree, and the ids of the others, the worst first.

    Raises:
        GeoreferenceError: As `fit_control`, of all points.
    """
    left, failed = list(targets), list[str]()
    fit = fit_control(left, leveled=leveled)
    while fit.worst is not None and len(left) > CONTROL_FIT.least_points:
        try:
            fewer = without(left, fit.worst.id)
            next_fit = fit_control(fewer, leveled=leveled)
        except GeoreferenceError:
            break  # what remains places no map
        failed.append(fit.worst.id)
        fit, left = next_fit, fewer
    return fit, failed


@dataclass(frozen=True, slots=True, eq=False)
class _RigidFit:
    targets: Sequence[MeasuredTarget]
    T_map_site: SE3
    freedom: int
    roots: list[Array]
    """Inverse root of the covariance of each point's measured directions."""
    A: Array
    """Design matrix in standard deviations, (rows, freedom); turn first, about the middle."""
    v: Array
    """Residuals in standard deviations, (rows,)."""

    @staticmethod
    def of(targets: Sequence[MeasuredTarget], *, freedom: int, start: SE3 | None) -> _RigidFit:
        roots = [_inverse_root(one) for one in targets]
        T = start or _start(targets, freedom=freedom)
        for _ in range(CONTROL_FIT.iterations):
            A, v, middle = _linear(targets, T, roots=roots, freedom=freedom)
            step = np.linalg.lstsq(A, v, rcond=None)[0]
            turn = step[:3] if freedom == 6 else np.array([0.0, 0.0, step[0]])
            R = SE3.exp(np.r_[turn, 0.0, 0.0, 0.0]).R
            T = SE3(R @ T.R, R @ (T.t - middle) + middle + step[-3:])
            if np.abs(step).max() < 1e-12:
                break
        A, v, _ = _linear(targets, T, roots=roots, freedom=freedom)
        return _RigidFit(targets, T, freedom, roots, A, v)

    @property
    def cov(self) -> Array:
        """Covariance of the parameters; infinite where they are not determined."""
        values, V = np.linalg.eigh(self.A.T @ self.A)
        inverse = np.where(values > 1e-9, 1.0 / np.maximum(values, 1e-9), np.inf)
        with np.errstate(invalid="ignore"):
            return np.asarray(np.nansum(V[:, None, :] * V[None, :, :] * inverse, axis=2))

    @property
    def tilt_sd_rad(self) -> float:
        """Standard deviation of the worse tilt."""
        return 0.0 if self.freedom == 4 else float(np.sqrt(np.diag(self.cov)[:2].max()))

    @property
    def tilt_rad(self) -> float:
        """Angle between the verticals of map and site."""
        return float(np.arccos(np.clip(self.T_map_site.R[2, 2], -1.0, 1.0)))

    @property
    def heading_sd_rad(self) -> float:
        return float(np.sqrt(np.diag(self.cov)[self.freedom - 4]))

    def judged(self) -> ControlFit:
        """The fit with the test of each point."""
        H = self.A @ np.linalg.pinv(self.A)
        free = len(self.v) - self.freedom
        total = float(self.v @ self.v)
        off = _residuals(self.targets, self.T_map_site)
        seen = np.concatenate([one.along @ d for one, d in zip(self.targets, off, strict=True)])
        scale, scale_sd = _scale(self)
        return ControlFit(
            T_map_site=self.T_map_site,
            freedom=self.freedom,
            scale=scale,
            scale_sd=scale_sd,
            sd0=float(np.sqrt(total / free)) if free > 0 else float("nan"),
            rmse_m=float(np.sqrt(np.mean(seen**2))),
            tests=tuple(self._test(k, H, total=total, free=free) for k in range(len(self.targets))),
        )

    def _test(self, k: int, H: Array, *, total: float, free: int) -> TargetTest:
        target, root = self.targets[k], self.roots[k]
        first = sum(len(one.along) for one in self.targets[:k])
        rows = slice(first, first + len(target.along))
        left = np.eye(len(target.along)) - H[rows, rows]
        values, V = np.linalg.eigh(left)
        alone = bool(values.min() < CONTROL_FIT.controlled)
        usable = values > 1e-6
        part = (V.T @ self.v[rows])[usable]
        blunder = V[:, usable] @ (part / values[usable])
        statistic = float(self.v[rows] @ blunder)
        others = free - len(target.along)
        sd = np.sqrt(max((total - statistic) / others, 0.0)) if others > 0 else 1.0
        map_m = target.along.T @ np.linalg.solve(root, blunder)
        sd_of = np.linalg.inv(root)
        # The smallest error that is found in a direction of the map, through the whole block.
        least = CONTROL_FIT.noncentrality * max(sd, 1.0)
        found = target.along.T @ sd_of
        return TargetTest(
            id=target.id,
            redundancy=tuple(np.clip(np.diag(left), 0.0, 1.0).tolist()),
            least_found_m=least * _least(values, float(np.linalg.norm(sd_of, ord=2))),
            least_found_h_m=least * _along(found, left, (0, 1)),
            least_found_v_m=least * _along(found, left, (2,)),
            w=float(np.sqrt(max(statistic, 0.0))) / max(float(sd), 1.0),
            limit=_limit(len(target.along), others if sd > 1.0 else 0),
            single_handed=alone,
            blunder_m=_tuple3(-self.T_map_site.R.T @ map_m),
        )


def _least(values: Array, sd_m: float) -> float:
    return float(sd_m / np.sqrt(values.min())) if values.min() > 1e-6 else float("inf")


def _along(found: Array, left: Array, axes: tuple[int, ...]) -> float:
    """Worst over some axes of the map: deviation over the root of the redundancy there."""
    worst = 0.0
    for axis in axes:
        sd = float(np.linalg.norm(found[axis]))
        if sd < 1e-9:
            return float("nan")
        unit = found[axis] / sd
        r = float(unit @ left @ unit)
        worst = max(worst, sd / np.sqrt(r) if r > 1e-6 else float("inf"))
    return worst


def _limit(rows: int, others: int) -> float:
    """Root of the limit of the statistic; ``others`` = degrees of freedom of an estimated σ."""
    from scipy.special import chdtri, fdtri  # slow to import

    if others > 0:
        return float(np.sqrt(rows * fdtri(rows, others, 1.0 - CONTROL_FIT.significance)))
    return float(np.sqrt(chdtri(rows, CONTROL_FIT.significance)))


def _scale(fit: _RigidFit) -> tuple[float, float]:
    """Length in the survey over length in the map, and its deviation: one more unknown."""
    p_map = np.array([one.p_map for one in fit.targets])
    arm = p_map - p_map.mean(axis=0)
    column = np.concatenate(
        [-root @ one.along @ d for root, one, d in zip(fit.roots, fit.targets, arm, strict=True)]
    )
    A = np.c_[fit.A, column]
    step = np.linalg.lstsq(A, fit.v, rcond=None)[0][-1]
    left = column - fit.A @ np.linalg.lstsq(fit.A, column, rcond=None)[0]
    length = float(np.linalg.norm(left))
    return 1.0 + float(step), 1.0 / length if length > 1e-9 else float("inf")


def _inverse_root(one: MeasuredTarget) -> Array:
    cov = one.along @ one.cov @ one.along.T
    return np.asarray(np.linalg.inv(np.linalg.cholesky(cov)), np.float64)


def _residuals(targets: Sequence[MeasuredTarget], T_map_site: SE3) -> Array:
    """Map minus survey, in axes of the map [m], (N, 3)."""
    p_site = np.array([one.p_site for one in targets])
    return np.array([one.p_map for one in targets]) - T_map_site @ p_site


def _linear(
    targets: Sequence[MeasuredTarget], T: SE3, *, roots: list[Array], freedom: int
) -> tuple[Array, Array, Array]:
    placed = T @ np.array([one.p_site for one in targets])
    middle = placed.mean(axis=0)
    v, A = [], []
    for one, root, p in zip(targets, roots, placed, strict=True):
        J = np.c_[-skew(p - middle), np.eye(3)]
        rows = root @ one.along
        A.append(rows @ (J if freedom == 6 else J[:, 2:]))
        v.append(rows @ (one.p_map - p))
    return np.concatenate(A), np.concatenate(v), middle


def _start(targets: Sequence[MeasuredTarget], *, freedom: int) -> SE3:
    p_map = np.array([one.p_map for one in targets])
    p_site = np.array([one.p_site for one in targets])
    flat = np.array([1.0, 1.0, 1.0 if freedom == 6 else 0.0])
    R = align_points(p_map * flat, p_site * flat).R
    if freedom == 4:
        R = SE3.from_rpy(0.0, 0.0, float(np.arctan2(R[1, 0], R[0, 0])), t=[0.0] * 3).R
    return SE3(R, p_map.mean(axis=0) - R @ p_site.mean(axis=0))


def _check(targets: Sequence[MeasuredTarget]) -> None:
    if len(targets) < CONTROL_FIT.least_points:
        raise GeoreferenceError(
            CodedText(
                "control-few",
                least=CONTROL_FIT.least_points,
                got=len(targets),
                names=f" ({_names(targets)})" if targets else "",
            )
        )
    _check_unit(targets)
    for place, where in (("p_site", "in the survey"), ("p_map", "in the map")):
        p = np.array([getattr(one, place) for one in targets])
        apart = np.linalg.norm(p[:, None] - p, axis=2) + np.eye(len(p)) * 1e9
        i, j = divmod(int(apart.argmin()), len(p))
        if apart[i, j] < CONTROL_FIT.apart_m:
            raise GeoreferenceError(
                CodedText(
                    "control-same-place",
                    name=targets[i].id,
                    other=targets[j].id,
                    where=where,
                    apart_m=100 * CONTROL_FIT.apart_m,
                )
            )


def _check_unit(targets: Sequence[MeasuredTarget]) -> None:
    """Check that distances of the survey are of the size of those of the map."""
    i, j = np.triu_indices(len(targets), 1)
    lengths = [
        np.linalg.norm(p[i] - p[j], axis=1)
        for p in (
            np.array([one.p_site[:2] for one in targets]),
            np.array([one.p_map[:2] for one in targets]),
        )
    ]
    site_m, map_m = (np.maximum(one, 1e-9) for one in lengths)
    most = CONTROL_FIT.other_unit
    if (site_m > most * map_m).all() or (site_m * most < map_m).all():
        raise GeoreferenceError(
            CodedText("control-unit", site_m=float(site_m.max()), map_m=float(map_m.max()))
        )


def _names(targets: Sequence[MeasuredTarget]) -> str:
    shown = [one.id for one in targets[:5]]
    return ", ".join(shown) + (" …" if len(targets) > len(shown) else "")


def _tuple3(v: Array) -> tuple[float, float, float]:
    x, y, z = v.tolist()
    return x, y, z


def with_sites(targets: Sequence[MeasuredTarget], p_site: Array) -> list[MeasuredTarget]:
    """The same targets, surveyed elsewhere (N, 3)."""
    return [replace(one, p_site=p) for one, p in zip(targets, p_site, strict=True)]
