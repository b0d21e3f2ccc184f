"""The newest message of each kind: what is known of a capture now."""

from __future__ import annotations

from dataclasses import dataclass

from recon4.live import protocol


@dataclass(slots=True)
class Newest:
    """The newest message of each kind; None if there was none."""

    status: protocol.Status | None = None
    stopped: protocol.Stopped | None = None
    pose: protocol.Pose | None = None
    plan: protocol.Plan | None = None
    gaps: protocol.Gaps | None = None
    loop: protocol.Loop | None = None
    motion: protocol.Motion | None = None
    fix: protocol.Fix | None = None
    notes: protocol.Notes | None = None
    done: protocol.Done | None = None

    def take(self, message: protocol.Message) -> bool:
        """Keep a message; False if only its sum counts (points, path, mark, written)."""
        kind = protocol.kind_of(message)
        if kind not in self.__slots__:
            return False
        setattr(self, kind, message)
        return True
