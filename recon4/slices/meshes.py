"""Triangle meshes as references."""

from __future__ import annotations

import re
from pathlib import Path

from recon4.evaluation.reference_mesh import TriangleMesh, read_mesh
from recon4.recording.formats.cloud_headers import HEADER_BYTES
from recon4.untrusted.bounded import open_regular

_FACES = re.compile(rb"element\s+face\s+(\d{1,18})\b")


def is_mesh(path: Path) -> bool:
    """Whether a file is a mesh: OBJ, STL, or a PLY with faces."""
    if path.suffix.lower() in {".obj", ".stl"}:
        return True
    with open_regular(path) as file:
        head = file.read(HEADER_BYTES)
    faces = _FACES.search(head.split(b"end_header")[0]) if head[:3] == b"ply" else None
    return faces is not None and int(faces[1]) > 0


def load_mesh(path: Path) -> TriangleMesh:
    """Read a triangle mesh.

    Raises:
        CorruptFile: If bytes are missing, faces are not polygons, or corners do not exist.
        RecordingError: If it cannot be opened.
    """
    return read_mesh(path)
