"""Notes of people on a map as BCF 3.0, the BIM Collaboration Format of buildingSMART.

A file is a ZIP: ``bcf.version``, ``extensions.xml``, ``project.bcfp``, and for each note a folder
with ``markup.bcf`` (the topic), ``viewpoint.bcfv`` (the camera) and, with a photo, its snapshot.
Coordinates are those of exports: of the map's CRS or site grid, else of the map frame [m].
"""

from __future__ import annotations

import io
import re
import uuid
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np

from recon4.export.geojson import MapSystem
from recon4.export.tuning import BCF
from recon4.geometry.se3 import Array
from recon4.georeference.crs_file import read_crs
from recon4.slices.map_crs import jacobian
from recon4.store.project import read_artifacts

Vector = tuple[float, float, float]
STATUSES = {"open": "Open", "done": "Closed"}
"""Status of a note -> topic status."""
TOPIC_TYPE = "Remark"
UNKNOWN = "unknown"
"""Author of a note that names none."""
_NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")


@dataclass(frozen=True, slots=True)
class NoteCamera:
    """Where the author of a note looked from."""

    eye_m: Vector
    """In the map frame [m]."""
    ahead: Vector
    """Direction of view."""
    up: Vector
    parallel: bool = False
    height_m: float = 0.0
    """Height of the image in the world, of a parallel projection [m]."""
    aspect: float = 1.0
    """Width of the image by its height."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BcfNote:
    """A note to write."""

    id: str
    text: str
    status: str
    who: str
    time: str
    """UTC, ISO 8601."""
    changed_by: str
    changed: str
    p_map: Vector
    """[m]"""
    camera: NoteCamera | None = None
    """None = obliquely from above."""
    photo: bytes | None = None
    """A JPEG file."""


def notes_bcf(project: Path, name: str, notes: Sequence[BcfNote]) -> bytes:
    """Notes as a BCF file, where the map of a project is now.

    Args:
        project: Its folder.
        name: Display name of the project.
        notes: In the order of the file.

    Raises:
        StoreError: If the georeference of the map is damaged.
    """
    artifacts = read_artifacts(project)
    place = read_crs(artifacts["level"]) if "level" in artifacts else None
    space = uuid.uuid5(uuid.NAMESPACE_URL, f"recon4:{project.name}")
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        _write(archive, "bcf.version", ET.Element("Version", VersionId="3.0"))
        _write(archive, "extensions.xml", _extensions(notes))
        _write(archive, "project.bcfp", _project(str(space), name))
        for index, note in enumerate(notes):
            topic = str(uuid.uuid5(space, note.id))
            view = str(uuid.uuid5(space, f"{note.id} view"))
            _write(archive, f"{topic}/markup.bcf", _markup(note, topic, view, index=index))
            _write(archive, f"{topic}/viewpoint.bcfv", _viewpoint(note, view, place))
            if note.photo is not None:
                archive.writestr(_entry(f"{topic}/{BCF.snapshot}"), note.photo)
    return out.getvalue()


def _extensions(notes: Sequence[BcfNote]) -> ET.Element:
    """The closed lists of values that topics may have."""
    lists = {
        ("TopicTypes", "TopicType"): [TOPIC_TYPE],
        ("TopicStatuses", "TopicStatus"): list(STATUSES.values()),
        ("Priorities", "Priority"): [],
        ("TopicLabels", "TopicLabel"): [],
        ("Users", "User"): _users(notes),
        ("SnippetTypes", "SnippetType"): [],
        ("Stages", "Stage"): [],
    }
    root = ET.Element("Extensions")
    for (many, single), values in lists.items():
        parent = ET.SubElement(root, many)
        for value in values:
            _text(parent, single, value)
    return root


def _users(notes: Sequence[BcfNote]) -> list[str]:
    """Who wrote or changed notes, by name; the schema has no empty names."""
    changed = {note.changed_by for note in notes if note.changed_by.strip()}
    return sorted(changed | {_author(note) for note in notes})


def _author(note: BcfNote) -> str:
    return note.who if note.who.strip() else UNKNOWN


def _project(guid: str, name: str) -> ET.Element:
    root = ET.Element("ProjectInfo")
    _text(ET.SubElement(root, "Project", ProjectId=guid), "Name", name)
    return root


def _markup(note: BcfNote, topic_guid: str, view_guid: str, *, index: int) -> ET.Element:
    root = ET.Element("Markup")
    topic = ET.SubElement(
        root,
        "Topic",
        Guid=topic_guid,
        TopicType=TOPIC_TYPE,
        TopicStatus=STATUSES.get(note.status, STATUSES["open"]),
    )
    first, *_ = note.text.strip().split("\n")
    _text(topic, "Title", first[: BCF.max_title] or "Note")
    _text(topic, "Index", str(index))
    _text(topic, "CreationDate", note.time)
    _text(topic, "CreationAuthor", _author(note))
    if note.changed != note.time:
        _text(topic, "ModifiedDate", note.changed)
        if note.changed_by.strip():
            _text(topic, "ModifiedAuthor", note.changed_by)
    if note.text.strip():
        _text(topic, "Description", note.text)
    views = ET.SubElement(topic, "Viewpoints")
    view = ET.SubElement(views, "ViewPoint", Guid=view_guid)
    _text(view, "Viewpoint", "viewpoint.bcfv")
    if note.photo is not None:
        _text(view, "Snapshot", BCF.snapshot)
    return root


def _viewpoint(note: BcfNote, guid: str, place: MapSystem | None) -> ET.Element:
    camera = note.camera or _from_above(note.p_map)
    turn, eye = _placed(camera, place)
    root = ET.Element("VisualizationInfo", Guid=guid)
    components = ET.SubElement(root, "Components")
    ET.SubElement(components, "Visibility", DefaultVisibility="true")
    kind = "OrthogonalCamera" if camera.parallel else "PerspectiveCamera"
    shown = ET.SubElement(root, kind)
    _vector(shown, "CameraViewPoint", eye)
    _vector(shown, "CameraDirection", _unit(turn @ np.array(camera.ahead)))
    _vector(shown, "CameraUpVector", _unit(turn @ np.array(camera.up)))
    if camera.parallel:
        _text(shown, "ViewToWorldScale", repr(float(camera.height_m)))
    else:
        _text(shown, "FieldOfView", repr(BCF.field_of_view_deg))
    _text(shown, "AspectRatio", repr(float(camera.aspect)))
    return root


def _placed(camera: NoteCamera, place: MapSystem | None) -> tuple[Array, Array]:
    """How the map's axes lie in the coordinates of the file (3, 3), and where the eye is (3,)."""
    eye = np.array(camera.eye_m, dtype=np.float64)
    return (np.eye(3), eye) if place is None else jacobian(place.to_crs, eye)


def _from_above(p_map: Vector) -> NoteCamera:
    """A camera that looks at a place obliquely from above, from the south."""
    away = np.array(BCF.eye_m)
    ahead = -_unit(away)
    right = _unit(np.cross(ahead, (0.0, 0.0, 1.0)))
    return NoteCamera(
        eye_m=_xyz(np.array(p_map) + away), ahead=_xyz(ahead), up=_xyz(np.cross(right, ahead))
    )


def _xyz(v: Array) -> Vector:
    x, y, z = v.tolist()
    return x, y, z


def _unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v), dtype=np.float64)


def _vector(parent: ET.Element, name: str, values: Array) -> None:
    place = ET.SubElement(parent, name)
    for axis, value in zip("XYZ", values.tolist(), strict=True):
        _text(place, axis, repr(float(value)))


def _text(parent: ET.Element, name: str, text: str) -> None:
    """An element with a text; what XML cannot hold is replaced visibly."""
    ET.SubElement(parent, name).text = _NOT_XML.sub("\N{REPLACEMENT CHARACTER}", text)


def _write(archive: zipfile.ZipFile, path: str, root: ET.Element) -> None:
    ET.indent(root)
    data = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    archive.writestr(_entry(path), data)


def _entry(path: str) -> zipfile.ZipInfo:
    """An entry without the time of writing: the same notes are the same bytes."""
    entry = zipfile.ZipInfo(path)
    entry.compress_type = zipfile.ZIP_DEFLATED
    return entry
