"""What an approval says about the bytes it was given for: compared before anything is stamped."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from recon4.mapping.tiles import TileSet
from recon4.review.stamp import Stamp
from recon4.store.checked import Altered, CheckedArtifact

FRAME_FILE = "georeference.json"
"""Of the artifact of the stage ``level``: says where the map lies on Earth."""


@dataclass(frozen=True, slots=True)
class Evidence:
    """The words of an approval, and the hashes of the manifests it was signed over."""

    stamp: Stamp
    artifacts: Mapping[str, str]
    """Stage -> key of the artifact."""
    manifests: Mapping[str, str]
    """Stage -> SHA-256 of the manifest of its artifact. Empty text = the approval is of an earlier
    version of recon4, which did not name it: then the manifest itself is trusted."""

    def artifact(self, stage: str, folder: Path) -> CheckedArtifact:
        """The artifact of a stage, to be compared as it is read.

        Raises:
            Altered: If the approval is of another artifact, or the manifest was changed.
        """
        if stage not in self.manifests:
            raise Altered(f"version {self.stamp.version} has no artifact of the stage {stage}")
        try:
            return CheckedArtifact.open(folder, self.manifests[stage])
        except Altered as error:
            raise Altered(f"{self.refusal}: {error}") from error

    def open_map(self, folder: Path) -> TileSet:
        """The approved map; every tile is compared before it is used.

        Raises:
            Altered: If it was changed.
            StoreError: If it cannot be read.
        """
        return TileSet.open(folder, self.artifact("map", folder))

    def check_frame(self, artifacts: Mapping[str, Path]) -> None:
        """Compare what says where the map lies.

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
        """Why nothing is written."""
        return f"this is not what {self.stamp.who} approved as version {self.stamp.version}"
