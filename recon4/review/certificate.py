"""A certificate for the Ed25519 key that signs approvals, so that readers of PDF can check it.

It is signed by the key itself. Whether the key counts is for `recon4.review.trusted_keys` to say.
"""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    PublicFormat,
    load_pem_private_key,
)
from cryptography.x509.oid import NameOID

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.review.signature import fingerprint, public_key_of
from recon4.review.tuning import CERTIFICATES


def certificate_of(key_file: Path) -> tuple[bytes, bytes]:
    """A certificate of a signing key, and the key, both as DER.

    Args:
        key_file: Ed25519 private key, PEM.

    Raises:
        StoreError: If the key cannot be read.
    """
    public_key = public_key_of(key_file)
    key = load_pem_private_key(key_file.read_bytes(), password=None)
    assert isinstance(key, Ed25519PrivateKey)
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, f"recon4 {fingerprint(public_key)}")])
    begin = datetime.now(UTC) - timedelta(days=1)
    made = (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(begin)
        .not_valid_after(begin + timedelta(days=CERTIFICATES.days))
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(_usage(), critical=True)
        .sign(key, None)
    )
    private = key.private_bytes(Encoding.DER, PrivateFormat.PKCS8, NoEncryption())
    return made.public_bytes(Encoding.DER), private


def ed25519_key_in(certificate: bytes) -> str:
    """The public key of a certificate, hexadecimal; empty if it is of another kind.

    Raises:
        StoreError: If it is no certificate.
    """
    try:
        key = x509.load_der_x509_certificate(certificate).public_key()
    except ValueError as error:
        raise StoreError(CodedText("certificate-unreadable", why=str(error))) from error
    if not isinstance(key, Ed25519PublicKey):
        return ""
    return key.public_bytes(Encoding.Raw, PublicFormat.Raw).hex()


def _usage() -> x509.KeyUsage:
    names = (
        "key_encipherment",
        "data_encipherment",
        "key_agreement",
        "key_cert_sign",
        "crl_sign",
        "encipher_only",
        "decipher_only",
    )
    return x509.KeyUsage(
        digital_signature=True, content_commitment=True, **dict.fromkeys(names, False)
    )
