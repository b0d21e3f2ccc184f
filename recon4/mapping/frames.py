"""What a map is made of."""

from __future__ import annotations

from typing import Protocol

from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig


class Frames(Protocol):
    """Multiframes read one at a time; a `recon4.store.frames.FrameStore` is one."""

    @property
    def rig(self) -> Rig:
        """The sensors and where they are."""

    def __len__(self) -> int: ...
    def __getitem__(self, k: int) -> Multiframe: ...
