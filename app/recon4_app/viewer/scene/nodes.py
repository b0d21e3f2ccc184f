"""Nodes of the scene as plain records; `show` draws them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4_app.viewer.cloud.palette import Rgb


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Node:
    """An object on screen."""

    path: str
    position_m: Array
    """Origin of its coordinates in the map [m], float64 (3,)."""
    visible: bool = True


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PointsNode(Node):
    """Points."""

    p_node: NDArray[np.float32]
    """(N, 3)"""
    rgb: NDArray[np.uint8]
    """(N, 3)"""
    size_m: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LinesNode(Node):
    """Line segments."""

    segments: NDArray[np.float32]
    """Start and end of each, (N, 2, 3)."""
    rgb: Rgb | NDArray[np.uint8]
    """One color, or one a segment (N, 3)."""
    width_px: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AxesNode(Node):
    """Coordinate axes: x red, y green, z blue."""

    p_node: NDArray[np.float32]
    """(N, 3)"""
    quat_wxyz: Array
    """(N, 4)"""
    length_m: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ImageNode(Node):
    """A horizontal image with x to the right and y up, around its position."""

    rgba: NDArray[np.uint8]
    """The first row has the largest y, (H, W, 4)."""
    width_m: float
    height_m: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class GridNode(Node):
    """A horizontal grid around its position."""

    width_m: float
    cell_m: float
    rgb: Rgb


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LabelNode(Node):
    """A text label in space."""

    text: str


def alike(before: Node, node: Node) -> bool:
    """Whether two nodes differ at most in being visible."""
    if type(before) is not type(node):
        return False
    names = [name for kind in type(node).__mro__ for name in getattr(kind, "__slots__", ())]
    return all(
        _same(getattr(before, name), getattr(node, name)) for name in names if name != "visible"
    )


def _same(a: Any, b: Any) -> bool:
    return a is b or np.array_equal(a, b)
