"""The folder of one capture, inside its project: what both processes and the server know of it.

PROJECT/recordings/walk.pcap    every datagram, as it came
PROJECT/recordings/rig.toml     what was on the backpack
PROJECT/recordings/marks.jsonl  points of interest, pauses, the place's name
PROJECT/live/session.json       how it was started
PROJECT/live/outcome.json       written last by the recorder: how it ended
"""

from __future__ import annotations

import hashlib
from dataclasses import asdict, dataclass
from pathlib import Path

from recon4.errors import StoreError
from recon4.runtime_folder import runtime_folder
from recon4.store.atomic import make_folders, write_json
from recon4.store.json_files import read_object

_DAY_NS = 86_400_000_000_000


MOST_JSON_BYTES = 1 << 20


@dataclass(frozen=True, slots=True, kw_only=True)
class CaptureSession:
    """How a capture was started."""

    project: Path
    preset: str = "indoor"
    address: str = "0.0.0.0"
    """Of the network card to listen on."""
    least_free_bytes: int = 1 << 30
    """Recording stops, in good order, before the disk has less than this left."""

    speed: float = 1.0
    """Only for trials: the sensors are replayed so many times as fast as they were."""

    @property
    def capture(self) -> Path:
        """The capture file."""
        return self.project / "recordings" / "walk.pcap"

    @property
    def rig(self) -> Path:
        """The rig file."""
        return self.project / "recordings" / "rig.toml"

    @property
    def marks(self) -> Path:
        """What the operator noted."""
        return self.project / "recordings" / "marks.jsonl"

    @property
    def folder(self) -> Path:
        """Of our own files."""
        return self.project / "live"

    @property
    def outcome(self) -> Path:
        """Written when the recorder ended by itself."""
        return self.folder / "outcome.json"

    def socket(self, name: str) -> Path:
        """Where a process of this capture listens: short, as a socket's path must be."""
        name_of_us = hashlib.sha256(str(self.project.resolve()).encode()).hexdigest()[:16]
        return runtime_folder() / f"{name_of_us}.{name}"

    def save(self) -> None:
        """Write ``session.json``."""
        make_folders(self.folder)
        message = {k: v for k, v in asdict(self).items() if k != "project"}
        write_json(self.folder / "session.json", message)


def stretched(t_ns: int, speed: float) -> int:
    """The time it would be if the day ran ``speed`` times as fast since midnight UTC [ns].

    Recorder and replay agree on it without a word; at speed 1 it is the time.
    """
    midnight_ns = t_ns // _DAY_NS * _DAY_NS
    return midnight_ns + round((t_ns - midnight_ns) * speed)


def load_session(project: Path) -> CaptureSession:
    """The session of a project.

    Raises:
        StoreError: If it has none, or the file is damaged.
    """
    path = project / "live" / "session.json"
    try:
        return CaptureSession(project=project, **read_object(path, most_bytes=MOST_JSON_BYTES))
    except TypeError as error:
        raise StoreError(f"{path} cannot be read: {error}") from error
