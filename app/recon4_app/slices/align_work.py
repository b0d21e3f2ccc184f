"""Alignment of references in child processes."""

from __future__ import annotations

import base64
from dataclasses import replace
from pathlib import Path

import numpy as np

from recon4.errors import ConfigError
from recon4.evaluation.reference_mesh import SurfacePoints
from recon4.geometry.se3 import SE3, Array
from recon4.locales.coded import CodedText, text_of
from recon4.mapping.tiles import TileSet
from recon4.slices.align import align_by_icp, align_by_pairs, align_level_pairs, floor_offset
from recon4.slices.reference import Reference, ReferenceFacts
from recon4.slices.reference_fit import fit_of, sample_reference, sample_tiles
from recon4.slices.reference_import import set_alignment, undo_alignment
from recon4_app.slices.model import AlignPoints, AlignRequest
from recon4_app.slices.slice_work import reference_of, tiles_of
from recon4_app.slices.tuning import ALIGN_VIEW


def align_reference(map_folder: str, reference: str, ask: AlignRequest) -> ReferenceFacts:
    """Align a reference with the map; its earlier alignment can be returned to."""
    folder = Path(reference)
    if ask.how == "undo":
        return undo_alignment(folder)
    if ask.how == "none":
        return set_alignment(folder, SE3.identity())
    tiles, against = tiles_of(map_folder), reference_of(reference, "plane")
    assert against is not None
    if ask.how == "pairs":
        return _by_pairs(tiles, against, ask)
    if ask.pose is not None:
        against = replace(against, T_map_reference=_motion(ask.pose))
    fit = align_by_icp(tiles, against, rng=np.random.default_rng(1))
    before = () if ask.pose is None else (CodedText("alignment-by-hand"),)
    return set_alignment(
        folder, fit.T_map_reference, steps=(*before, fit.description), fit=fit.text
    )


def align_points(map_folder: str, reference: str) -> AlignPoints:
    """Points of map and reference to be laid on each other, each about its middle."""
    against = reference_of(reference, "plane")
    assert against is not None
    ours = _shown(sample_tiles(tiles_of(map_folder), 4 * ALIGN_VIEW.shown))
    theirs = _shown(sample_reference(against, np.random.default_rng(1)))
    if not len(ours) or not len(theirs):
        raise ConfigError(CodedText("align-no-surface"))
    middle, other = _middle(ours), _middle(theirs)
    T = against.T_map_reference
    T_i_j = SE3(T.R, T @ other - middle)
    if not _near(ours - middle, T_i_j @ (theirs - other)):
        T_i_j = SE3.identity()
    return AlignPoints(
        p_map=_packed(ours - middle),
        p_reference=_packed(theirs - other),
        middle_map=(middle[0], middle[1], middle[2]),
        middle_reference=(other[0], other[1], other[2]),
        pose=tuple([*T_i_j.t.tolist(), *T_i_j.quat_xyzw().tolist()]),
    )


def _by_pairs(tiles: TileSet, against: Reference, ask: AlignRequest) -> ReferenceFacts:
    p_map = np.array(ask.p_map, dtype=np.float64).reshape(-1, 3)
    p_reference = np.array(ask.p_reference, dtype=np.float64).reshape(-1, 3)
    rng = np.random.default_rng(1)
    if ask.level:
        up_m = (
            floor_offset(tiles, against, p_map, p_reference=p_reference, rng=rng)
            if len(p_map) == len(p_reference) > 0
            else 0.0
        )
        T, left_m = align_level_pairs(p_map, p_reference, up_m=up_m)
    else:
        T, left_m = align_by_pairs(p_map, p_reference)
    paired = CodedText(
        "alignment-pairs",
        pairs=len(left_m),
        largest_m=float(left_m.max()),
        each_cm=" ".join(f"{100.0 * d:.1f}" for d in left_m[:10]),
    )
    laid = replace(against, T_map_reference=T)
    if not ask.refine:
        fit = fit_of(tiles, laid, rng=rng)
        return set_alignment(against.folder, T, steps=(paired,), fit=fit.text)
    try:
        found = align_by_icp(tiles, laid, rng=rng)
    except ConfigError as error:
        fit = fit_of(tiles, laid, rng=rng)
        steps = (paired, CodedText("alignment-not-refined"), text_of(error))
        return set_alignment(against.folder, T, steps=steps, fit=fit.text)
    return set_alignment(
        against.folder,
        found.T_map_reference,
        steps=(paired, found.description),
        fit=found.text,
    )


def _motion(pose: tuple[float, ...]) -> SE3:
    quat = np.array(pose[3:])
    length = float(np.linalg.norm(quat))
    if not 0.5 < length < 2.0:
        raise ConfigError(CodedText("align-bad-pose"))
    return SE3.from_quat(quat / length, np.array(pose[:3]))


def _shown(surface: SurfacePoints) -> Array:
    """Upright surfaces first: from above, floors and ceilings would cover them."""
    level = np.abs(surface.normals[:, 2]) > ALIGN_VIEW.upright
    upright = surface.p[~level]
    chosen = upright if len(upright) > len(surface.p) // 10 else surface.p
    return chosen[:: max(1, -(-len(chosen) // ALIGN_VIEW.shown))]


def _middle(p: Array) -> Array:
    low, high = np.percentile(p, [2.0, 98.0], axis=0)
    out: Array = (low + high) / 2.0
    return out


def _near(p: Array, q: Array) -> bool:
    """Whether the boxes of two clouds meet."""
    return bool(np.all(p.min(axis=0) <= q.max(axis=0)) and np.all(q.min(axis=0) <= p.max(axis=0)))


def _packed(p: Array) -> str:
    return base64.b64encode(p.astype("<f4").tobytes()).decode()
