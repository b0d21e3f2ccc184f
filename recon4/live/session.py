"""The files of one capture in its project, shared by recorder, mapper and server.

PROJECT/recordings/walk.pcap    every datagram as received
PROJECT/recordings/rig.toml     the sensors of the backpack
PROJECT/recordings/marks.jsonl  points of interest, pauses, name of the place
PROJECT/live/session.json       parameters of the capture
PROJECT/live/outcome.json       written last by the recorder: why it ended
"""

from __future__ import annotations

import hashlib
import math
from dataclasses import asdict, dataclass
from pathlib import Path

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, unreadable
from recon4.store.atomic import make_folders, write_json
from recon4.store.json_files import read_object
from recon4.system.runtime_folder import runtime_folder
from recon4.units import DAY_NS
from recon4.untrusted.limits import LIMITS

_TYPES: dict[str, tuple[type, ...]] = {
    "preset": (str,),
    "address": (str,),
    "least_free_bytes": (int,),
    "speed": (int, float),
}
"""JSON types of the fields of a session."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CaptureSession:
    """Parameters and file paths of a capture."""

    project: Path
    preset: str = "indoor"
    address: str = "0.0.0.0"
    """Address of the network card to listen on."""
    least_free_bytes: int = 1 << 30
    """Recording stops in order before the disk has less free space than this."""

    speed: float = 1.0
    """Speed factor of a replay; 1 with real sensors."""

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
        """Marks of the operator, one JSON object per line."""
        return self.project / "recordings" / "marks.jsonl"

    @property
    def folder(self) -> Path:
        """Folder of the session files."""
        return self.project / "live"

    @property
    def outcome(self) -> Path:
        """Written by the recorder when it ends; missing if it was killed."""
        return self.folder / "outcome.json"

    def socket(self, name: str) -> Path:
        """Socket path of a process of this capture; short, because socket paths are limited."""
        digest = hashlib.sha256(str(self.project.resolve()).encode()).hexdigest()[:16]
        return runtime_folder() / f"{digest}.{name}"

    def save(self) -> None:
        """Write ``session.json``."""
        make_folders(self.folder)
        fields = {k: v for k, v in asdict(self).items() if k != "project"}
        write_json(self.folder / "session.json", fields)


def stretched(t_ns: int, speed: float) -> int:
    """A time scaled by ``speed`` since midnight UTC [ns].

    Recorder and replay compute it independently; at speed 1 it is the time itself.
    """
    midnight_ns = t_ns // DAY_NS * DAY_NS
    return midnight_ns + round((t_ns - midnight_ns) * speed)


def loopback_address(address: str) -> str:
    """The address from which a replay on this computer sends what came from an address.

    Every address of 127/8 is local, so senders stay apart.
    """
    return f"127.{address.split('.', 1)[1]}" if "." in address else address


def load_session(project: Path) -> CaptureSession:
    """Load the session of a project.

    Raises:
        StoreError: If the project has no session, or the file is damaged.
    """
    path = project / "live" / "session.json"
    facts = read_object(path, max_bytes=LIMITS.session_bytes)
    try:
        session = CaptureSession(**facts | {"project": project})
    except TypeError as error:
        raise StoreError(unreadable(str(path), error)) from error
    for name, kind in _TYPES.items():
        if type(getattr(session, name)) not in kind:
            raise StoreError(f"{path}: {name}: got {getattr(session, name)!r:.80}")
    if not (0.0 < session.speed < math.inf and 0 <= session.least_free_bytes < 1 << 63):
        raise StoreError(
            CodedText(
                "session-numbers",
                file=str(path),
                speed=repr(session.speed)[:80],
                least_free_bytes=repr(session.least_free_bytes)[:80],
            )
        )
    return session
