"""Packs a delivery: chosen files of a map, its report, license, hashes and signature in one ZIP."""

from __future__ import annotations

import shutil
import stat
import tempfile
import zipfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from glob import escape
from pathlib import Path

import recon4
from recon4.delivery.check import CheckedFile, check_file
from recon4.delivery.exports import WantedFile, write_kind
from recon4.delivery.hostile_zip import unsafe_name
from recon4.delivery.kinds import KINDS
from recon4.delivery.made_files import MadeFile, copy_made, named, refuse_other_maps
from recon4.delivery.manifest import MANIFEST, DeliveredFile, DeliveryManifest, manifest_text
from recon4.delivery.pdf_signature import Organization
from recon4.delivery.readme import classes_line, crs_line, file_line, spaced
from recon4.delivery.report_files import (
    ReportWish,
    checked_approval,
    said_state,
    write_client_html,
    write_pdf,
)
from recon4.delivery.tuning import DELIVERIES
from recon4.errors import ConfigError, StoreError
from recon4.export.map_files import MapToExport, map_to_export
from recon4.export.options import ExportOptions
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.model.height_system import height_system
from recon4.products.fitted_plans import FittedPlans
from recon4.progress import Progress
from recon4.report.client import Row
from recon4.report.client_words import Words, words
from recon4.report.pdf import require_pdf
from recon4.review.approval_state import ApprovalState
from recon4.review.approved import Approval
from recon4.review.signature import public_key_of
from recon4.review.state import read_summary
from recon4.store.atomic import atomic_file, is_temporary, raise_if_full, write_text
from recon4.store.formats import FORMATS
from recon4.store.hashing import hash_shown
from recon4.store.json_files import read_object
from recon4.store.locks import is_abandoned, locked_folder
from recon4.store.project import read_artifacts
from recon4.untrusted.limits import LIMITS
from recon4.untrusted.names import visible

CHOICES = tuple(KINDS)
"""Files that a delivery may hold, by name."""
USUAL = ("map.copc.laz", "findings.csv")
REPORT_PDF, REPORT_HTML = "report.pdf", "report.html"
README, LICENSE = "README.txt", "LICENSE.txt"


@dataclass(frozen=True, slots=True, kw_only=True)
class DeliveryWish:
    """What is packed, and how."""

    files: Sequence[str] = USUAL
    """Names, of `CHOICES`; they are made now."""
    made: Sequence[MadeFile] = ()
    """Files that were exported before."""
    crs: str = ""
    """Code of the CRS of maps; empty = that of the map."""
    license: Path | None = None
    """Text of the license of the data; None = all rights reserved, which the README says."""
    key: Path | None = None
    """Ed25519 key that signs manifest and report of an approved map; None = not signed."""
    certificate: Organization | None = None
    """Signs the report in place of the key."""
    language: str = ENGLISH


@dataclass(frozen=True, slots=True)
class Delivered:
    """What was packed."""

    files: tuple[str, ...]
    bytes: int
    """Of the ZIP file."""
    signed: bool
    approval: ApprovalState


@dataclass(frozen=True, slots=True)
class _Map:
    """The map that is delivered, whose approval was compared."""

    project: Path
    state: ApprovalState
    approval: Approval | None
    export: MapToExport
    made: Mapping[str, MadeFile]
    """Files that were exported before, by their names in the delivery."""
    plans: FittedPlans = field(default_factory=FittedPlans)


def deliver(project: Path, out: Path, wish: DeliveryWish, *, progress: Progress) -> Delivered:
    """Pack a delivery; the file gets its name when all of it was read again and compared.

    A map that is not approved is delivered as a draft: it says so, and nothing is signed.

    Args:
        project: The project folder.
        out: ZIP file to write.
        wish: Files, CRS, license, keys.
        progress: Counts points of exports.

    Raises:
        Altered: If the map was approved and is not what was approved; nothing is written.
        ConfigError: If a file cannot be chosen, or the extra ``pdf`` is not installed.
        GeoreferenceError: If a CRS is requested and the map is not georeferenced.
        StoreError: If there is no map yet, or a file cannot be written or reads back wrong.
    """
    _refuse(out, wish)
    map_ = _open(project, wish, progress)
    signed = map_.approval is not None and wish.key is not None
    with _folder_beside(out) as folder:
        listed = _write_files(folder, map_, wish, progress=progress)
        texts = words(wish.language)
        _refuse_changed(map_)
        _write_readme(folder, map_, wish, texts=texts, name=out.name)
        names = sorted(path.name for path in folder.iterdir())
        listed = {one: listed.get(one) or _digest(folder / one, progress) for one in names}
        key = wish.key if signed else None
        text = manifest_text(_manifest(map_, listed), key)
        write_text(folder / MANIFEST, text)
        with atomic_file(out) as temporary:
            packed = [README, MANIFEST, *(n for n in names if n != README)]
            _pack(folder, packed, temporary, progress=progress)
            _compare(check_file(temporary, progress=progress), listed)
    return Delivered(tuple(names), out.stat().st_size, signed, map_.state)


def chosen_files(given: Sequence[str]) -> tuple[str, ...]:
    """Names of files as people give them: ``map.e57``, or its ending ``e57``; with commas.

    Raises:
        ConfigError: If one is not known.
    """
    out = []
    for word in (part.strip() for text in given for part in text.split(",")):
        fitting = [name for name in CHOICES if word in (name, name.partition(".")[2])]
        if len(fitting) != 1:
            known = ", ".join(fitting or CHOICES)
            raise ConfigError(CodedText("deliver-files", word=visible(word), known=known))
        out.append(fitting[0])
    return tuple(dict.fromkeys(out)) or USUAL


def _refuse(out: Path, wish: DeliveryWish) -> None:
    """Refuse what cannot work before the long work begins."""
    require_pdf()
    if out.suffix.lower() != ".zip" or unsafe_name(out.name):
        raise ConfigError(CodedText("deliver-zip", out=visible(out.name)))
    if wish.license is not None and not wish.license.is_file():
        raise ConfigError(CodedText("deliver-license", license=wish.license.name))


def _open(project: Path, wish: DeliveryWish, progress: Progress) -> _Map:
    artifacts = read_artifacts(project)
    if "map" not in artifacts:
        raise StoreError(CodedText("deliver-no-map", project=str(project)))
    state, approval = checked_approval(project, draft=False, progress=progress)
    refuse_other_maps(wish.made, artifacts["map"].name, state.text)
    evidence = approval.evidence if approval else None
    options = ExportOptions(crs=wish.crs)
    export = map_to_export(artifacts, evidence, options)
    return _Map(project, state, approval, export, named(wish.files, wish.made))


@contextmanager
def _folder_beside(out: Path) -> Iterator[Path]:
    """A folder for the files of a delivery, which is removed whatever happens: that of a killed
    process by the next delivery of this name.

    Raises:
        NoSpace: If the disk is full.
        StoreError: If it cannot be made, or a file in it cannot be written.
    """
    try:
        _sweep_killed(out)
        beside = tempfile.TemporaryDirectory(prefix=f".{out.name}.", dir=out.parent)
        with beside as name, locked_folder(Path(name)):
            yield Path(name)
    except Exception as error:
        raise_if_full(error, out)  # also if a file in it says so: its path means nothing to people
        if isinstance(error, OSError):
            raise StoreError(CodedText("deliver-failed", out=str(out), why=str(error))) from error
        raise


def _sweep_killed(out: Path) -> None:
    """Remove what killed processes left of a delivery of this name, unless one is packed now."""
    folders = [one for one in out.parent.glob(f".{escape(out.name)}.????????") if one.is_dir()]
    if not all(map(is_abandoned, folders)):
        return
    for folder in folders:
        shutil.rmtree(folder, ignore_errors=True)
    for file in out.parent.glob(f".tmp-*-{escape(out.name)}"):
        if is_temporary(file.name):
            file.unlink(missing_ok=True)


def _refuse_changed(map_: _Map) -> None:
    """Refuse to pack exports of one map with the report of another, made meanwhile."""
    if dict(read_artifacts(map_.project)) != dict(map_.export.artifacts):
        raise StoreError(CodedText("deliver-map-changed"))


def _write_files(
    folder: Path, map_: _Map, wish: DeliveryWish, *, progress: Progress
) -> dict[str, DeliveredFile]:
    """Write the exports, each compared with the map, and the reports that list them.

    Returns:
        The exports.
    """
    draft = map_.approval is None
    listed = {}
    for name in wish.files:
        _write_export(name, folder / name, map_, crs=wish.crs, progress=progress)
        listed[name] = _digest(folder / name, progress)
    for name, made in map_.made.items():
        copy_made(made, folder / name, progress=progress)
        listed[name] = DeliveredFile(made.made.bytes, made.made.sha256)  # compared by the copy
    rows = [Row(name, one.sha256) for name, one in listed.items()]
    if wish.license is not None:
        shutil.copyfile(wish.license, folder / LICENSE)
    key = wish.certificate or wish.key
    progress.start("report", 0, "files")
    progress.advance(0)  # a request to stop counts before the long work
    report = ReportWish(language=wish.language, draft=draft, key=key, files=rows)
    write_pdf(map_.project, folder / REPORT_PDF, report)
    write_client_html(map_.project, folder / REPORT_HTML, report)
    return listed


def _write_export(name: str, path: Path, map_: _Map, *, crs: str, progress: Progress) -> None:
    """Write a file of the delivery."""
    kind = KINDS[name]
    options = ExportOptions(crs=crs if "crs" in kind.takes else "", draft=map_.approval is None)
    evidence = map_.approval.evidence if map_.approval else None
    wanted = WantedFile(map_.export.artifacts, evidence, options, map_.plans)
    write_kind(map_.project, kind, path, wanted=wanted, progress=progress)


def _manifest(map_: _Map, listed: dict[str, DeliveredFile]) -> DeliveryManifest:
    summary = read_summary(map_.project) or {}
    return DeliveryManifest(
        format=FORMATS.delivery,
        kind="recon4 delivery",
        project=visible(str(summary.get("name", map_.project.name))),
        made=datetime.now(UTC).isoformat(timespec="seconds"),
        recon4=recon4.__version__,
        approval=map_.state.text,
        crs=map_.export.output.crs or "",
        files=listed,
        signature=None,
    )


def _digest(path: Path, progress: Progress) -> DeliveredFile:
    return DeliveredFile(path.stat().st_size, hash_shown(path, progress))


def _heights(project: Path, wish: DeliveryWish, texts: Words) -> str:
    """What the heights of the exports are above."""
    crs = wish.crs or str((read_summary(project) or {}).get("crs") or "")
    level = read_artifacts(project).get("level")
    record = level / "georeference.json" if level is not None else None
    controlled = False
    if record is not None and record.exists():
        controlled = "control" in read_object(record, max_bytes=LIMITS.findings_bytes)
    return texts(f"heights.{height_system(crs, controlled=controlled)}", crs=visible(crs))


def _write_readme(folder: Path, map_: _Map, wish: DeliveryWish, *, texts: Words, name: str) -> None:
    """What is in the delivery and how it is checked, in plain words."""
    summary = read_summary(map_.project) or {}
    tiles = map_.export.tiles
    lines = [texts("readme.title", title=visible(str(summary.get("name", "")))), ""]
    today = datetime.now(UTC).date().isoformat()
    lines.append(texts("readme.made", day=today, version=recon4.__version__))
    lines.append(texts("readme.state", state=said_state(map_.state, texts)))
    lines.append(crs_line(wish.crs or str(summary.get("crs") or ""), texts))
    lines.append(texts("readme.heights", heights=_heights(map_.project, wish, texts)))
    lines += ["", texts("readme.what"), ""]
    others = sorted(path.name for path in folder.iterdir())
    for one in sorted(others, key=lambda one: (one != REPORT_PDF, one != REPORT_HTML)):
        made = map_.made.get(one)
        kind, count = (made.kind, made.made.points) if made else (one, len(tiles))
        chosen = texts("readme.chosen", options=made.chosen) if made and made.chosen else ""
        lines.append(f"{file_line(one, kind, points=count, texts=texts)} {chosen}".rstrip())
    lines.append(file_line(MANIFEST, MANIFEST, points=0, texts=texts))
    if any(one.startswith("map") for one in others):
        lines += ["", classes_line(tiles.class_counts(), texts)]
        if tiles.strays:
            lines.append(texts("readme.left_out", points=spaced(tiles.strays)))
    lines += ["", texts("readme.check", name=name), "", texts("readme.check_by_hand"), ""]
    if map_.approval is not None and wish.key is not None:
        lines.append(texts("readme.signed", key=public_key_of(wish.key)))
    else:
        lines.append(texts("readme.unsigned"))
    if wish.license is None:
        lines += ["", texts("readme.no_license")]
    write_text(folder / README, "\n".join(lines) + "\n")


def _pack(folder: Path, names: Sequence[str], out: Path, *, progress: Progress) -> None:
    """Write the ZIP, streaming; compressed formats are stored as they are."""
    progress.start("pack", sum((folder / name).stat().st_size for name in names), "B")
    with zipfile.ZipFile(out, "w", allowZip64=True) as archive:
        for name in names:
            path = folder / name
            entry = zipfile.ZipInfo(name, datetime.now(UTC).timetuple()[:6])
            entry.external_attr = (stat.S_IFREG | 0o644) << 16
            packed = name.endswith((".laz", ".pdf", ".e57"))
            entry.compress_type = zipfile.ZIP_STORED if packed else zipfile.ZIP_DEFLATED
            entry.file_size = path.stat().st_size
            with path.open("rb") as source, archive.open(entry, "w") as target:
                while block := source.read(DELIVERIES.block_bytes):
                    target.write(block)
                    progress.advance(len(block))


def _compare(found: CheckedFile, listed: dict[str, DeliveredFile]) -> None:
    """Refuse a delivery that does not read back as it was packed."""
    wrong = (*found.altered, *found.missing, *found.added)
    if wrong or set(found.intact) != set(listed):
        raise StoreError(
            CodedText(
                "delivery-wrong", files=", ".join(wrong) or CodedText("delivery-files-missing")
            )
        )
