"""Signatures in PDF: PAdES baseline B-B, written and checked by pyhanko (the only importer)."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

from recon4.delivery.tuning import DELIVERIES
from recon4.errors import ConfigError, Recon4Error, StoreError
from recon4.locales.coded import CodedText
from recon4.report.pdf import require_pdf
from recon4.review.certificate import certificate_of, ed25519_key_in
from recon4.review.signature import fingerprint
from recon4.untrusted.bounded import read_bytes_limited
from recon4.untrusted.names import visible

FIELD = "recon4"


@dataclass(frozen=True, slots=True, kw_only=True)
class Organization:
    """The certificate of an organization, in place of the key of the server."""

    file: Path
    """PKCS#12: key, certificate, and its chain."""
    passphrase: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class SignedBy:
    """A signature in a PDF, as it was found."""

    intact: bool
    """Whether no byte that it covers was changed, and nothing was added after it."""
    why: str
    """Why it is not intact; empty if it is."""
    name: str
    """Subject of its certificate."""
    public_key: str
    """Ed25519, hexadecimal; empty for another kind of key."""
    certificate: str
    """SHA-256 of the certificate, hexadecimal."""
    time: str
    """As the signer's computer said, ISO 8601; empty = not said."""

    @property
    def key(self) -> str:
        """Fingerprint of the key; empty for the certificate of an organization."""
        return fingerprint(self.public_key) if self.public_key else ""


def sign_pdf(pdf: bytes, key: Path | Organization, *, reason: str) -> bytes:
    """A PDF with an invisible signature over all of its bytes, added at its end.

    Args:
        pdf: As laid out.
        key: The key file of the approvals, or the certificate of an organization.
        reason: What the signature states; PDF readers show it.

    Raises:
        ConfigError: If pyhanko is not installed, or the certificate cannot be opened.
        StoreError: If the key cannot be read.
    """
    require_pdf()
    from pyhanko.pdf_utils.incremental_writer import IncrementalPdfFileWriter
    from pyhanko.sign.fields import MDPPerm, SigSeedSubFilter
    from pyhanko.sign.signers import PdfSignatureMetadata
    from pyhanko.sign.signers import sign_pdf as write_signature

    signer = _of_organization(key) if isinstance(key, Organization) else _of_server(key)
    about = PdfSignatureMetadata(
        field_name=FIELD,
        reason=visible(reason),
        md_algorithm="sha512",
        subfilter=SigSeedSubFilter.PADES,
        certify=True,
        docmdp_permissions=MDPPerm.NO_CHANGES,
    )
    with _quiet():
        made = write_signature(IncrementalPdfFileWriter(BytesIO(pdf)), about, signer)
    return bytes(made.getbuffer())


def signatures_in(path: Path) -> list[SignedBy]:
    """The signatures of a PDF of unknown origin; empty = it is not signed.

    Raises:
        ConfigError: If pyhanko is not installed.
        CorruptFile: If it is larger than a report ever is.
        StoreError: If it is no PDF, or damaged.
    """
    require_pdf()
    from pyhanko.pdf_utils.reader import PdfFileReader

    data = read_bytes_limited(path, DELIVERIES.max_pdf_bytes)
    try:
        with _quiet():
            reader = PdfFileReader(BytesIO(data))
            return [_checked(one) for one in reader.embedded_signatures]
    except Recon4Error:
        raise
    except Exception as error:  # of a hostile file: whatever its parser raises
        text = visible(f"{type(error).__name__}: {error}", most=300)
        raise StoreError(CodedText("pdf-unreadable", file=path.name, text=text)) from error


def _checked(embedded: Any) -> SignedBy:
    """Judge one signature: its bytes, and what came after it."""
    from pyhanko.sign.validation import validate_pdf_signature
    from pyhanko.sign.validation.status import SignatureCoverageLevel
    from pyhanko_certvalidator import ValidationContext

    certificate = embedded.signer_cert
    offline = ValidationContext(trust_roots=[certificate], allow_fetching=False)
    status = validate_pdf_signature(embedded, signer_validation_context=offline)
    wrong = []
    if not status.intact:
        wrong.append("bytes were changed after it was signed")
    if not status.valid:
        wrong.append("the signature does not fit its key")
    if status.coverage < SignatureCoverageLevel.ENTIRE_FILE:
        wrong.append("something was added after it was signed")
    der = certificate.dump()
    time = embedded.self_reported_timestamp
    return SignedBy(
        intact=not wrong,
        why=", ".join(wrong),
        name=visible(certificate.subject.human_friendly),
        public_key=ed25519_key_in(der),
        certificate=certificate.sha256.hex(),
        time=time.isoformat(timespec="seconds") if time else "",
    )


def _of_server(key_file: Path) -> Any:
    from asn1crypto.keys import PrivateKeyInfo
    from asn1crypto.x509 import Certificate
    from pyhanko.sign.signers import SimpleSigner
    from pyhanko_certvalidator.registry import SimpleCertificateStore

    certificate, key = certificate_of(key_file)
    return SimpleSigner(
        signing_cert=Certificate.load(certificate),
        signing_key=PrivateKeyInfo.load(key),
        cert_registry=SimpleCertificateStore(),
    )


def _of_organization(given: Organization) -> Any:
    from pyhanko.sign.signers import SimpleSigner

    with _quiet():  # it logs what it cannot read
        signer = SimpleSigner.load_pkcs12(str(given.file), passphrase=given.passphrase)
    if signer is None:
        raise ConfigError(CodedText("pkcs12", file=given.file.name))
    return signer


@contextmanager
def _quiet() -> Iterator[None]:
    """Mute what is raised or returned anyway."""
    log = logging.getLogger("pyhanko")
    before = log.level
    log.setLevel(logging.CRITICAL + 1)
    others = logging.getLogger("pyhanko_certvalidator")
    earlier = others.level
    others.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        log.setLevel(before)
        others.setLevel(earlier)
