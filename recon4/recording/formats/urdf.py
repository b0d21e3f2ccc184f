"""Joints of a robot description (URDF), read without a library that fetches anything.

Links and joints of a URDF are children of ``robot``; only ``parent``, ``child``, ``origin``,
``axis`` and ``mimic`` of joints are read, and no mesh, no entity and no document type.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from xml.parsers import expat

import numpy as np

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText

MAX_URDF_BYTES = 4 << 20
MAX_DEPTH = 64
MAX_JOINTS = 10_000


KINDS = ("fixed", "revolute", "continuous", "prismatic")
"""Joints whose pose follows from one position at most."""


@dataclass(slots=True)
class UrdfJoint:
    """A joint: pose of the child link in the parent link, at position 0 if it moves."""

    kind: str
    """One of `KINDS`."""
    name: str = ""
    parent: str = ""
    child: str = ""
    xyz_m: tuple[float, ...] = (0.0, 0.0, 0.0)
    rpy_rad: tuple[float, ...] = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw: ``Rz(yaw) Ry(pitch) Rx(roll)``."""
    axis: tuple[float, ...] = (1.0, 0.0, 0.0)
    """In the frame of the child, of any length."""
    mimics: str = ""
    """Name of the joint whose position moves it; empty = its own."""
    factor: float = 1.0
    offset: float = 0.0
    """Its position is ``factor`` times that of the other one plus ``offset`` [rad or m]."""


def urdf_joints(text: str) -> list[UrdfJoint]:
    """The joints of a robot description of one of `KINDS`.

    Raises:
        CorruptFile: If it is no sound, plain XML, too large or too deep, or a number is none.
    """
    size = len(text.encode("utf-8", "replace"))
    if size > MAX_URDF_BYTES:
        raise CorruptFile(CodedText("urdf-large", max_urdf_bytes=MAX_URDF_BYTES, size=size))
    found = _Joints()
    parser = expat.ParserCreate()
    parser.StartDoctypeDeclHandler = _refuse_doctype
    parser.StartElementHandler, parser.EndElementHandler = found.begin, found.end
    try:
        parser.Parse(_without_declaration(text.encode("utf-8", "replace")), True)
    except expat.ExpatError as error:
        raise CorruptFile(CodedText("xml-unsound", why=str(error))) from None
    return found.joints


def _without_declaration(xml: bytes) -> bytes:
    """The XML in UTF-8, whatever encoding its declaration names."""
    head = xml.lstrip()
    if head.startswith(b"<?xml"):
        return head[head.find(b"?>") + 2 :]
    return head


def _refuse_doctype(*_: object) -> None:
    raise CorruptFile(CodedText("xml-doctype"))


@dataclass(slots=True)
class _Joints:
    """Receives the elements of the XML."""

    joints: list[UrdfJoint] = field(default_factory=list)
    depth: int = 0
    _joint: UrdfJoint | None = None

    def begin(self, name: str, attributes: dict[str, str]) -> None:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise CorruptFile(CodedText("xml-deep", max_depth=MAX_DEPTH))
        if name == "joint" and self.depth == 2:
            kind, called = attributes.get("type", ""), attributes.get("name", "")
            self._joint = UrdfJoint(kind, called) if kind in KINDS else None
        elif self._joint is not None and self.depth == 3:
            self._fill(self._joint, name, attributes)

    def end(self, name: str) -> None:
        if self.depth == 2 and self._joint is not None:
            if len(self.joints) >= MAX_JOINTS:
                raise CorruptFile(CodedText("urdf-joints", max_joints=MAX_JOINTS))
            self.joints.append(self._joint)
            self._joint = None
        self.depth -= 1

    def _fill(self, joint: UrdfJoint, name: str, attributes: dict[str, str]) -> None:
        if name == "parent":
            joint.parent = attributes.get("link", "")
        elif name == "child":
            joint.child = attributes.get("link", "")
        elif name == "origin":
            joint.xyz_m = _three(attributes.get("xyz", "0 0 0"), "xyz")
            joint.rpy_rad = _three(attributes.get("rpy", "0 0 0"), "rpy")
        elif name == "axis":
            joint.axis = _three(attributes.get("xyz", "1 0 0"), "axis")
        elif name == "mimic":
            joint.mimics = attributes.get("joint", "")
            (joint.factor,) = _numbers(attributes.get("multiplier", "1"), "multiplier", count=1)
            (joint.offset,) = _numbers(attributes.get("offset", "0"), "offset", count=1)


def _three(text: str, what: str) -> tuple[float, ...]:
    return _numbers(text, what, count=3)


def _numbers(text: str, what: str, *, count: int) -> tuple[float, ...]:
    words = text[:200].split()
    try:
        numbers = tuple(float(word) for word in words)
    except ValueError:
        numbers = ()
    if len(numbers) != count or not np.all(np.isfinite(numbers)):
        raise CorruptFile(CodedText("urdf-numbers", what=what, count=count, text=text[:80]))
    return numbers
