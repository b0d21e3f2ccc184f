"""Fixed joints of a robot description (URDF), read without a library that fetches anything.

Links and joints of a URDF are children of ``robot``; only ``parent``, ``child`` and ``origin`` of
joints are read, and no mesh, no entity and no document type.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from xml.parsers import expat

import numpy as np

from recon4.errors import CorruptFile

MAX_URDF_BYTES = 4 << 20
MAX_DEPTH = 64
MAX_JOINTS = 10_000


@dataclass(slots=True)
class FixedJoint:
    """A joint that does not move: pose of the child link in the parent link."""

    parent: str = ""
    child: str = ""
    xyz_m: tuple[float, ...] = (0.0, 0.0, 0.0)
    rpy_rad: tuple[float, ...] = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw: ``Rz(yaw) Ry(pitch) Rx(roll)``."""


def fixed_joints(text: str) -> list[FixedJoint]:
    """The fixed joints of a robot description.

    Raises:
        CorruptFile: If it is no sound, plain XML, too large or too deep, or a number is none.
    """
    size = len(text.encode("utf-8", "replace"))
    if size > MAX_URDF_BYTES:
        raise CorruptFile(f"expected at most {MAX_URDF_BYTES} bytes, got {size}")
    found = _Joints()
    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = _refuse_doctype
    parser.StartElementHandler, parser.EndElementHandler = found.begin, found.end
    try:
        parser.Parse(_without_declaration(text.encode("utf-8", "replace")), True)
    except expat.ExpatError as error:
        raise CorruptFile(f"no sound XML: {error}") from None
    return found.fixed


def _without_declaration(xml: bytes) -> bytes:
    """The XML in UTF-8, whatever encoding its declaration names."""
    head = xml.lstrip()
    if head.startswith(b"<?xml"):
        return head[head.find(b"?>") + 2 :]
    return head


def _refuse_doctype(*_: object) -> None:
    raise CorruptFile("it has a document type (DOCTYPE), which a reader would fetch")


@dataclass(slots=True)
class _Joints:
    """Receives the elements of the XML."""

    fixed: list[FixedJoint] = field(default_factory=list)
    depth: int = 0
    _joint: FixedJoint | None = None

    def begin(self, name: str, attributes: dict[str, str]) -> None:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise CorruptFile(f"elements nested deeper than {MAX_DEPTH}")
        if name == "joint" and self.depth == 2:
            self._joint = FixedJoint() if attributes.get("type") == "fixed" else None
        elif self._joint is not None and self.depth == 3:
            self._fill(self._joint, name, attributes)

    def end(self, name: str) -> None:
        if self.depth == 2 and self._joint is not None:
            if len(self.fixed) >= MAX_JOINTS:
                raise CorruptFile(f"more than {MAX_JOINTS} fixed joints")
            self.fixed.append(self._joint)
            self._joint = None
        self.depth -= 1

    def _fill(self, joint: FixedJoint, name: str, attributes: dict[str, str]) -> None:
        if name == "parent":
            joint.parent = attributes.get("link", "")
        elif name == "child":
            joint.child = attributes.get("link", "")
        elif name == "origin":
            joint.xyz_m = _three(attributes.get("xyz", "0 0 0"), "xyz")
            joint.rpy_rad = _three(attributes.get("rpy", "0 0 0"), "rpy")


def _three(text: str, what: str) -> tuple[float, ...]:
    words = text[:200].split()
    try:
        numbers = tuple(float(word) for word in words)
    except ValueError:
        numbers = ()
    if len(numbers) != 3 or not np.all(np.isfinite(numbers)):
        raise CorruptFile(f"{what} of a joint: expected three numbers, got {text[:80]!r}")
    return numbers
