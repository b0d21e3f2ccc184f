"""Verifies a delivery or a signed report on any computer, without its project."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from recon4.delivery.hostile_zip import blocks_of, open_zip, unsafe_name
from recon4.delivery.manifest import MANIFEST, DeliveryManifest, read_manifest
from recon4.delivery.pdf_signature import SignedBy, signatures_in
from recon4.delivery.tuning import DELIVERIES
from recon4.errors import CorruptFile, StoreError, UnknownFormat
from recon4.locales.coded import CodedText
from recon4.progress import Progress, Silent
from recon4.review.signature import fingerprint
from recon4.review.trusted_keys import TrustedKeys, UnknownSigner, trusted_for
from recon4.untrusted.bounded import open_regular
from recon4.untrusted.names import visible

_ZIP, _PDF = b"PK\x03\x04", b"%PDF"


@dataclass(frozen=True, slots=True, kw_only=True)
class CheckedFile:
    """What was found of a delivery or a signed report."""

    intact: tuple[str, ...] = ()
    altered: tuple[str, ...] = ()
    missing: tuple[str, ...] = ()
    added: tuple[str, ...] = ()
    """Files that the sender did not list."""
    says: str = ""
    """What it says of itself: project and state of the approval."""
    signer: str = ""
    """Whose signature it is; empty = no signature counts."""
    doubt: str = ""
    """Why a signature does not count, or that there is none; empty = it counts."""

    @property
    def whole(self) -> bool:
        """Whether everything is as it was sent, and the signature counts."""
        return not (self.altered or self.missing or self.added or self.doubt)


def check_file(
    path: Path, trusted: TrustedKeys | None = None, *, progress: Progress | None = None
) -> CheckedFile:
    """Verify a delivery (ZIP, or the folder that it was unpacked to) or a PDF.

    Args:
        path: The file or folder.
        trusted: Whose signatures count; None = of the place where it lies (`trusted_for`).
        progress: Counts the bytes that are read.

    Raises:
        ConfigError: If a PDF is given and the extra ``pdf`` is not installed.
        CorruptFile: If it is damaged, or hostile: see `open_zip`.
        StoreError: If its manifest is damaged or was changed after it was signed.
        UnknownFormat: If it is something else.
    """
    trusted, watch = trusted or trusted_for(path), progress or Silent()
    if path.is_dir():
        return _check_folder(path, trusted, watch)
    with open_regular(path) as file:
        head = file.read(len(_ZIP))
    if head == _PDF:
        return _check_pdf(path, trusted)
    if head == _ZIP:
        return _check_zip(path, trusted, watch)
    raise UnknownFormat(CodedText("check-unknown", file=path.name))


def _check_zip(path: Path, trusted: TrustedKeys, progress: Progress) -> CheckedFile:
    with open_zip(path) as (archive, entries):
        if MANIFEST not in entries:
            raise CorruptFile(CodedText("check-no-manifest", file=path.name, manifest=MANIFEST))
        limit = DELIVERIES.max_manifest_bytes
        blocks = blocks_of(archive, entries[MANIFEST], most=limit, where=path.name)
        manifest = read_manifest(b"".join(blocks))
        found: dict[str, str | None] = {}
        _start(progress, manifest)
        for name, listed in manifest.files.items():
            if name in entries:
                stored = blocks_of(archive, entries[name], most=listed.bytes, where=path.name)
                found[name] = _hash(stored, progress)
        return _judged(manifest, found, set(entries), trusted=trusted)


def _check_folder(folder: Path, trusted: TrustedKeys, progress: Progress) -> CheckedFile:
    """An unpacked delivery; links are files that do not belong there."""
    with open_regular(folder / MANIFEST) as file:
        manifest = read_manifest(file.read(DELIVERIES.max_manifest_bytes))
    there = {
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*")
        if path.is_symlink() or not path.is_dir()
    }
    found: dict[str, str | None] = {}
    _start(progress, manifest)
    for name in manifest.files:
        if name in there and not unsafe_name(name) and not (folder / name).is_symlink():
            found[name] = _hash(_blocks(folder / name), progress)
    return _judged(manifest, found, there, trusted=trusted)


def _start(progress: Progress, manifest: DeliveryManifest) -> None:
    progress.start("compare", sum(one.bytes for one in manifest.files.values()), "B")


def _judged(
    manifest: DeliveryManifest,
    found: Mapping[str, str | None],
    there: set[str],
    *,
    trusted: TrustedKeys,
) -> CheckedFile:
    """Compare the files with the manifest, and its signer with the trusted keys."""
    names = [name for name in manifest.files if name in there]
    same = {name for name in names if found.get(name) == manifest.files[name].sha256}
    signer, doubt = _signer(manifest.signature, trusted)
    return CheckedFile(
        intact=tuple(visible(name) for name in names if name in same),
        altered=tuple(visible(name) for name in names if name not in same),
        missing=tuple(visible(name) for name in manifest.files if name not in there),
        added=tuple(visible(name) for name in sorted(there - {MANIFEST} - manifest.files.keys())),
        says=visible(f"{manifest.project}: {manifest.approval}"),
        signer=signer,
        doubt=doubt,
    )


def _check_pdf(path: Path, trusted: TrustedKeys) -> CheckedFile:
    signatures = signatures_in(path)
    if not signatures:
        return CheckedFile(doubt=CodedText("check-pdf-not-signed"))
    broken = [one for one in signatures if not one.intact]
    if broken or len(signatures) > 1:
        why = broken[0].why if broken else "it is signed more than once"
        return CheckedFile(altered=(f"{path.name}: {why}",))
    signer, doubt = _pdf_signer(signatures[0], trusted)
    return CheckedFile(intact=(path.name,), signer=signer, doubt=doubt)


def _pdf_signer(one: SignedBy, trusted: TrustedKeys) -> tuple[str, str]:
    if one.public_key:
        return _named(one.public_key, trusted)
    return "", CodedText("check-pdf-certificate", name=one.name, sha256=one.certificate)


def _signer(signature: Mapping[str, str] | None, trusted: TrustedKeys) -> tuple[str, str]:
    if signature is None:
        return "", CodedText("check-not-signed")
    return _named(signature["public_key"], trusted)


def _named(public_key: str, trusted: TrustedKeys) -> tuple[str, str]:
    """Whose key it is, or why it does not count."""
    try:
        key = trusted.signer(public_key)
    except UnknownSigner as error:
        return "", str(error)
    return f"{visible(key.name)}, key {fingerprint(public_key)}", ""


def _hash(blocks: Iterator[bytes], progress: Progress) -> str | None:
    """SHA-256; None if the file cannot be read, or is longer than it was."""
    digest = hashlib.sha256()
    try:
        for block in blocks:
            digest.update(block)
            progress.advance(len(block))
    except (CorruptFile, StoreError):
        return None
    return digest.hexdigest()


def _blocks(path: Path) -> Iterator[bytes]:
    with open_regular(path) as file:
        while block := file.read(DELIVERIES.block_bytes):
            yield block
