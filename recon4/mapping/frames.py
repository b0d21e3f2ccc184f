"""Interface of the multiframes a map is built from."""

from __future__ import annotations

from typing import Protocol

from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig


class Frames(Protocol):
    """Multiframes that are read one at a time, for example a `recon4.store.frames.FrameStore`."""

    @property
    def rig(self) -> Rig:
        """The sensors and their poses."""

    def __len__(self) -> int: ...
    def __getitem__(self, k: int) -> Multiframe: ...
