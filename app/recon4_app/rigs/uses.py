"""Which projects used a rig."""

from __future__ import annotations

import hashlib
import re
from functools import cache
from pathlib import Path

from recon4.errors import StoreError
from recon4.model.limits import RIG_LIMITS
from recon4.model.rig import format_rig, load_rig, rig_presets
from recon4.untrusted.bounded import read_bytes_limited
from recon4_app.jobs.store import JobStore
from recon4_app.projects.store import ProjectStore
from recon4_app.rigs.model import RigUse, SavedRig
from recon4_app.rigs.store import RigStore
from recon4_app.rigs.tuning import RIG_USES

_STORED = re.compile(r"/([^/]+)/([0-9]{1,3})/\1-v\2\.toml$")


class RigUses:
    """Compares the rigs of recordings with those of the server, by the hash of their content.

    A recording keeps its rig in the artifact of the stage ``frames``. If that was changed since,
    for example by a detected topic, the path that its newest job named decides.
    """

    def __init__(self, rigs: RigStore, projects: ProjectStore, jobs: JobStore) -> None:
        self._rigs, self._projects, self._jobs = rigs, projects, jobs
        self._digests: dict[Path, str] = {}

    def of_rig(self, rig_id: str) -> list[RigUse]:
        """Projects that used any version of a rig, the newest first."""
        known = self._known()
        found = []
        for card in self._projects.all():
            rig = self._of(card.id, known)
            if rig is not None and rig.id == rig_id:
                found.append(RigUse(project=card.id, name=card.name, version=rig.version))
        return found

    def of_project(self, project_id: str) -> SavedRig | None:
        """The rig of a project's recording; None = it is none of this server."""
        return self._of(project_id, self._known())

    def with_file(self, path: Path) -> SavedRig | None:
        """The newest version whose file equals a rig file; None = there is none."""
        digest = _sha256(path)
        for rig_id in self._rigs.ids():
            for version in self._rigs.versions(rig_id):
                if version.sha256 == digest:
                    return SavedRig(id=rig_id, version=version.number)
        return None

    def _known(self) -> dict[str, SavedRig]:
        """Digest -> rig; of equal versions the newest."""
        known = {digest: SavedRig(id=name, version=0) for name, digest in _shipped().items()}
        for rig_id in self._rigs.ids():
            for version in reversed(self._rigs.versions(rig_id)):
                known[version.digest] = SavedRig(id=rig_id, version=version.number)
        return known

    def _of(self, project_id: str, known: dict[str, SavedRig]) -> SavedRig | None:
        frames = self._projects.artifact(project_id, "frames")
        digest = self._digest(frames / "rig.toml") if frames else ""
        return known.get(digest) or self._named(project_id, known)

    def _named(self, project_id: str, known: dict[str, SavedRig]) -> SavedRig | None:
        """The rig that the newest job of a project named."""
        jobs = [job for job in self._jobs.of_project(project_id) if job.inputs.recordings]
        rig = jobs[0].inputs.rig if jobs else ""
        if rig in rig_presets():
            return SavedRig(id=rig, version=0)
        found = _STORED.search(rig)
        named = SavedRig(id=found[1], version=int(found[2])) if found else None
        return named if named in known.values() else None

    def _digest(self, path: Path) -> str:
        """Hash of a file of an artifact, which never changes; empty = it cannot be read."""
        if path not in self._digests:
            if len(self._digests) >= RIG_USES.max_cached:
                self._digests.clear()
            self._digests[path] = _sha256(path)
        return self._digests[path]


@cache
def _shipped() -> dict[str, str]:
    """Name of each shipped rig -> its digest."""
    texts = {name: format_rig(load_rig(name)) for name in rig_presets()}
    return {name: hashlib.sha256(text.encode("utf-8")).hexdigest() for name, text in texts.items()}


def _sha256(path: Path) -> str:
    try:
        data = read_bytes_limited(path, RIG_LIMITS.file_bytes, failure=StoreError)
    except StoreError:
        return ""
    return hashlib.sha256(data).hexdigest()
