"""Expected hashes of an approved map, checked before a file is stamped."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from recon4.locales.coded import CodedText, text_of
from recon4.review.stamp import Stamp
from recon4.store.checked import Altered, CheckedArtifact

if TYPE_CHECKING:
    from recon4.mapping.tiles import TileSet

FRAME_FILE = "georeference.json"
"""Georeference of the map, in the artifact of the stage ``level``."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """The stamp of an approval, and the manifest hashes it was signed over."""

    stamp: Stamp
    artifacts: Mapping[str, str]
    """Stage -> key of the artifact."""
    manifests: Mapping[str, str]
    """Stage -> SHA-256 of the manifest of its artifact. Empty text = the approval was made by an
    earlier version of recon4 that did not store it; the manifest is then trusted."""

    def artifact(self, stage: str, folder: Path) -> CheckedArtifact:
        """Open the artifact of a stage; its files are checked as they are read.

        Raises:
            Altered: If the approval is of another artifact, or the manifest was changed.
        """
        if stage not in self.manifests:
            raise Altered(
                CodedText("approved-no-artifact", version=self.stamp.version, stage=stage)
            )
        try:
            return CheckedArtifact.open(folder, self.manifests[stage])
        except Altered as error:
            raise Altered(
                CodedText("approved-refused", what=self.refusal, why=text_of(error))
            ) from error

    def open_map(self, folder: Path) -> TileSet:
        """Open the approved map; every tile is checked before it is used.

        Raises:
            Altered: If it was changed.
            StoreError: If it cannot be read.
        """
        # Here: it takes most of a second, and commands like `recon4 users` open no map.
        from recon4.mapping.tiles import TileSet

        return TileSet.open(folder, self.artifact("map", folder))

    def check_frame(self, artifacts: Mapping[str, Path]) -> None:
        """Check the georeference file.

        Raises:
            Altered: If it was changed.
        """
        if "level" not in artifacts:
            return
        level = self.artifact("level", artifacts["level"])
        if FRAME_FILE in level.files or (level.folder / FRAME_FILE).exists():
            level.check(FRAME_FILE)

    @property
    def refusal(self) -> str:
        """Start of the message when a check fails."""
        return CodedText("approved-not-this", who=self.stamp.who, version=self.stamp.version)
