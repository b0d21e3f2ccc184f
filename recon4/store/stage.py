"""Run stages; equal inputs, settings and code version reuse the finished artifact."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Concatenate, Generic, TypedDict, TypeVar

import msgspec

from recon4.errors import StoreError
from recon4.locales.coded import CodedText, unreadable
from recon4.model.events import ArtifactDamaged, StageChanged
from recon4.model.figures import Figures
from recon4.model.plain import to_plain
from recon4.progress import Progress
from recon4.settings import Settings, to_json
from recon4.settings.reads import Reads, groups_of, part_of
from recon4.store.atomic import atomic_folder, write_json
from recon4.store.checked import Altered
from recon4.store.damage import other_names
from recon4.store.hashing import FileDigest, FileEntry, files_below, hash_file, hash_json
from recon4.store.json_files import read_object
from recon4.store.ledger import FinishedStage
from recon4.store.package_versions import versions
from recon4.store.project import Project
from recon4.store.resource_usage import Meter
from recon4.store.seal import changing, check_sealed
from recon4.store.unfinished import keeping
from recon4.untrusted.typed import as_type

SAVING = "save"
"""Name of the task in which an artifact is hashed and written to disk."""

OfStage = TypeVar("OfStage", bound=Figures)
"""Figures of a stage."""


@dataclass(frozen=True, slots=True)
class StageContext(Generic[Reads]):
    """What every stage is given besides its inputs."""

    out: Path
    """Folder of its artifact, empty at the start."""
    settings: Reads
    """The groups of settings that it declares."""
    progress: Progress


@dataclass(frozen=True, slots=True)
class Stage(Generic[Reads, OfStage]):
    """A stage: a pure function of its inputs and of some groups of settings."""

    name: str
    version: int
    """Increased whenever the same inputs give another result than before."""
    reads: type[Reads]
    """Record of `recon4.settings.reads` with the groups of settings it is given."""
    function: Callable[Concatenate[StageContext[Reads], ...], OfStage | None]
    """``function(context, **inputs)``. Writes into the empty folder ``context.out``; returns the
    figures for the manifest, None = it has none."""
    figures: type[OfStage] = Figures  # type: ignore[assignment]  # those of a stage without any
    """Record of its figures."""
    percent: float = 0.0
    """Its usual part of the time of a run [%]: of a simulated walk of five minutes with LiDARs, on
    two processors."""


@dataclass(frozen=True, slots=True)
class Input:
    """External input of a stage."""

    key: str
    """Hash of its content."""
    value: Any
    """Argument of the stage's function."""


class StageRecipe(TypedDict):
    """What the key of an artifact is the hash of, as JSON."""

    stage: str
    version: int
    settings: Mapping[str, Mapping[str, object]]
    """By group."""
    inputs: dict[str, str | None]
    """Keys of the inputs; None = there is none."""


class Manifest(TypedDict):
    """``manifest.json`` of an artifact, as JSON."""

    recipe: StageRecipe
    done: Mapping[str, object]
    """Fields of `FinishedStage`."""
    figures: object
    """Fields of the stage's figures."""
    versions: dict[str, str]
    files: dict[str, FileEntry]


@dataclass(frozen=True, slots=True)
class Artifact:
    """The result of a stage."""

    stage: str
    key: str
    folder: Path

    @property
    def value(self) -> Path:
        """Argument of a stage that reads it: its folder."""
        return self.folder

    def manifest(self) -> Manifest:
        """Read its manifest: recipe, versions, resources used and hashes of its files.

        Raises:
            StoreError: If it cannot be read.
        """
        return read_manifest(self.folder)


@dataclass(frozen=True, slots=True)
class StageRun(Generic[OfStage]):
    """Result of a stage in this run."""

    artifact: Artifact
    done: FinishedStage
    """Record of the run that made the artifact."""
    reused: bool
    """Whether a finished artifact was reused."""
    figures: OfStage
    """Return value of its function."""
    before: tuple[FinishedStage, ...] = ()
    """The same stage with other inputs earlier in this run: a rig that is calibrated repeats the
    odometry."""


class StageRunner:
    """Runs the stages of a project in the given order, each at most once for the same inputs."""

    def __init__(
        self, project: Project, settings: Settings, progress: Progress, *, is_latest: bool = True
    ) -> None:
        """Run nothing yet.

        Args:
            project: An open one.
            settings: All settings.
            progress: Who watches.
            is_latest: Whether readers of the project are to find the artifacts of this run.
        """
        self.runs: dict[str, StageRun[Any]] = {}
        """Stage name -> result, in order."""
        self._project = project
        self._settings = settings
        self._progress = progress
        self._is_latest = is_latest

    def run(self, stage: Stage[Any, Any], **inputs: Input | Artifact | None) -> Artifact:
        """Run a stage, or reuse its finished artifact.

        Args:
            stage: The stage.
            inputs: Keyword arguments of its function; None stays None.

        Raises:
            NoSpace: If the disk is full; no partial artifact remains.
            Recon4Error: An error of the stage.
        """
        key = stage_key(stage, self._settings, inputs)
        artifact = Artifact(stage.name, key, self._project.artifacts / key)
        self._tell(StageChanged(stage=stage.name, key=key, state="running"))
        done = self._finished(artifact)
        reused = done is not None
        if done is None:
            done = self._make(stage, artifact, inputs)
        return self._took(stage, artifact, done, reused=reused)

    def keep(self, stage: Stage[Any, Any]) -> Artifact:
        """Reuse the artifact of a stage in the latest run without a check of its recipe.

        Raises:
            StoreError: If there is none, or it is damaged.
        """
        key = self._project.ledger.current().get(stage.name, "")
        artifact = Artifact(stage.name, key, self._project.artifacts / key)
        done = self._finished(artifact) if key else None
        if done is None:
            raise StoreError(
                CodedText("stage-none-before", root=self._project.root.name, stage=stage.name)
            )
        return self._took(stage, artifact, done, reused=True)

    def _took(
        self, stage: Stage[Any, Any], artifact: Artifact, done: FinishedStage, *, reused: bool
    ) -> Artifact:
        name, key = artifact.stage, artifact.key
        if self._is_latest:
            self._project.ledger.set_current(name, key)
        figures = read_figures(artifact.folder, stage.figures)
        earlier = self.runs.get(name)
        before = (*earlier.before, earlier.done) if earlier else ()
        self.runs[name] = StageRun(artifact, done, reused, figures, before)
        state = "reused" if reused else "done"
        self._tell(StageChanged(stage=name, key=key, state=state, seconds=round(done.seconds, 3)))
        return artifact

    def _tell(self, event: StageChanged) -> None:
        """Report a stage of this run, not what goes on aside."""
        if self._is_latest:
            self._progress.event(event)

    def aside(self) -> StageRunner:
        """A runner that goes on from here: readers and watchers of this run see nothing of it."""
        other = StageRunner(self._project, self._settings, self._progress, is_latest=False)
        other.runs.update(self.runs)
        return other

    def skip(self, stage: Stage[Any, Any]) -> None:
        """Omit a stage in this run: an artifact of an earlier run does not belong to it."""
        self._project.ledger.clear_current(stage.name)

    def _finished(self, artifact: Artifact) -> FinishedStage | None:
        """Record of a complete artifact, or None; a damaged one is renamed, not deleted."""
        ledger = self._project.ledger
        row = ledger.find(artifact.key)
        if not artifact.folder.exists():
            if row is not None:
                ledger.forget(artifact.key)
            return None
        # No record: killed between rename and commit, or the ledger was lost. Check all hashes.
        damage = damage_of(artifact.folder, hashes=row is None)
        try:
            check_sealed(self._project.root, f"artifacts/{artifact.key}/manifest.json")
        except Altered as error:
            damage.append(str(error))
        if damage:
            self._set_aside(artifact, damage)
            return None
        if row is None:
            row = _finished_stage(artifact)
            ledger.add(row)
        return row

    def _set_aside(self, artifact: Artifact, damage: list[str]) -> None:
        aside = artifact.folder.with_name(f"damaged-{artifact.key[:12]}-{secrets.token_hex(3)}")
        with changing(self._project.root, f"artifacts/{artifact.key}", compared=False):
            artifact.folder.rename(aside)
        self._project.ledger.forget(artifact.key)
        moved_to, files = f"artifacts/{aside.name}", tuple(damage[:10])
        self._progress.event(ArtifactDamaged(stage=artifact.stage, moved_to=moved_to, files=files))

    def _make(
        self,
        stage: Stage[Any, Any],
        artifact: Artifact,
        inputs: Mapping[str, Input | Artifact | None],
    ) -> FinishedStage:
        values = {name: None if given is None else given.value for name, given in inputs.items()}
        settings = part_of(self._settings, stage.reads)
        meter, root = Meter(), self._project.root
        with keeping(root, stage.name, artifact.key), atomic_folder(artifact.folder) as folder:
            figures = stage.function(StageContext(folder, settings, self._progress), **values)
            done = FinishedStage(
                key=artifact.key,
                stage=stage.name,
                version=stage.version,
                finished=time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
                seconds=meter.seconds,
                cpu_seconds=meter.cpu_seconds,
                peak_bytes=meter.peak_bytes,
            )
            recipe = _recipe(stage, self._settings, inputs)
            files = _hash_files(folder, self._progress)
            _write_manifest(folder, done, recipe, figures=figures or Figures(), files=files)
        self._project.ledger.add(done)
        return done


def stage_key(
    stage: Stage[Any, Any], settings: Settings, inputs: Mapping[str, Input | Artifact | None]
) -> str:
    """Key of a stage: SHA-256 of its name and version, its settings and the keys of its inputs."""
    return hash_json(_recipe(stage, settings, inputs))


def read_manifest(folder: Path) -> Manifest:
    """Read ``manifest.json`` of an artifact.

    Raises:
        StoreError: If it is missing or damaged.
    """
    path = folder / "manifest.json"
    try:
        found = read_object(path)
        return {
            "recipe": found["recipe"],
            "done": found["done"],
            "figures": found["figures"],
            "versions": found["versions"],
            "files": found["files"],
        }
    except KeyError as error:
        raise StoreError(CodedText("stage-figures-lack", file=str(path), why=str(error))) from error


def read_figures(folder: Path, kind: type[OfStage]) -> OfStage:
    """Read the figures of an artifact; fields of other versions are ignored.

    Args:
        folder: The artifact.
        kind: Record of the stage that made it.

    Raises:
        StoreError: If they are missing or damaged.
    """
    try:
        return as_type(read_manifest(folder)["figures"], kind)
    except msgspec.ValidationError as error:
        manifest = str(folder / "manifest.json")
        raise StoreError(CodedText("stage-figures", folder=manifest, why=str(error))) from error


def figures_of(runs: Mapping[str, StageRun[Any]], stage: Stage[Any, OfStage]) -> OfStage:
    """The figures of a stage that ran."""
    figures: OfStage = runs[stage.name].figures
    return figures


def damage_of(folder: Path, *, hashes: bool) -> list[str]:
    """Messages about damage of an artifact; empty = no damage.

    Args:
        folder: The artifact.
        hashes: Also hash every byte; otherwise only names and sizes are compared.
    """
    try:
        found = read_manifest(folder)["files"].items()
        files = {str(name): FileDigest.from_json(value) for name, value in found}
    except StoreError as error:
        return [str(error)]
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        return [CodedText("damage-manifest", why=f"{error!r}")]
    there = set(files_below(folder)) - {"manifest.json"}
    damage = other_names(there, files)
    for name in sorted(files.keys() & there):
        if (folder / name).stat().st_size != files[name].size:
            damage.append(CodedText("damage-size", name=name))
        elif hashes and hash_file(folder / name) != files[name].sha256:
            damage.append(CodedText("damage-bytes", name=name))
    return damage


def _finished_stage(artifact: Artifact) -> FinishedStage:
    """The record in a manifest, for a ledger that lost it."""
    try:
        return as_type(artifact.manifest()["done"], FinishedStage)
    except msgspec.ValidationError as error:
        raise StoreError(unreadable(str(artifact.folder / "manifest.json"), error)) from error


def _recipe(
    stage: Stage[Any, Any], settings: Settings, inputs: Mapping[str, Input | Artifact | None]
) -> StageRecipe:
    return {
        "stage": stage.name,
        "version": stage.version,
        "settings": {group: to_json(getattr(settings, group)) for group in groups_of(stage.reads)},
        "inputs": {name: given.key if given else None for name, given in sorted(inputs.items())},
    }


def _hash_files(folder: Path, progress: Progress) -> dict[str, FileEntry]:
    """Name -> size and hash of every file of an artifact."""
    sizes = {name: (folder / name).stat().st_size for name in files_below(folder)}
    progress.start(SAVING, sum(sizes.values()), "B")
    return {name: FileDigest.of(folder / name, progress.advance).to_json() for name in sizes}


def _write_manifest(
    folder: Path,
    done: FinishedStage,
    recipe: StageRecipe,
    *,
    figures: Figures,
    files: dict[str, FileEntry],
) -> None:
    manifest: Manifest = {
        "recipe": recipe,
        "done": asdict(done),
        "figures": to_plain(figures),
        "versions": versions(),
        "files": files,
    }
    write_json(folder / "manifest.json", manifest)
