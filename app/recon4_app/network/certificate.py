"""The server's certificate: the user's own, or one made at the first start."""

from __future__ import annotations

import ipaddress
import logging
import ssl
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.store.atomic import write_private, write_text

log = logging.getLogger(__name__)

VALID = timedelta(days=820)
"""Phones refuse more than 825 days."""
RENEWED_BEFORE_END = timedelta(days=14)


@dataclass(frozen=True, slots=True)
class Certificate:
    """Files of a certificate and its key, PEM."""

    chain: Path
    key: Path
    own: bool
    """Whether it is the user's own."""

    def context(self) -> ssl.SSLContext:
        """The TLS context of a server: TLS 1.2 and later.

        Raises:
            ConfigError: If the files are no certificate and the key that fits it.
        """
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
        context.minimum_version = ssl.TLSVersion.TLSv1_2
        context.options |= ssl.OP_NO_RENEGOTIATION | ssl.OP_NO_COMPRESSION
        try:
            context.load_cert_chain(self.chain, self.key, password=_no_password)
        except (OSError, ssl.SSLError) as error:
            raise ConfigError(
                CodedText("tls-no-pair", chain=str(self.chain), key=str(self.key), why=str(error))
            ) from error
        return context

    def fingerprint(self) -> str:
        """SHA-256 of the certificate, as browsers show it."""
        digest = _read(self.chain).fingerprint(hashes.SHA256())
        return ":".join(f"{byte:02X}" for byte in digest)

    def names(self) -> frozenset[str]:
        """Host names and addresses of the certificate, lower case."""
        return _names(_read(self.chain))


def own_certificate(chain: Path, key: Path) -> Certificate:
    """The user's certificate.

    Raises:
        ConfigError: If the files are not what they should be.
    """
    for path in (chain, key):
        if not path.is_file():
            raise ConfigError(CodedText("tls-no-file", file=str(path)))
    found = Certificate(chain, key, own=True)
    found.context()
    return found


def made_certificate(folder: Path, names: frozenset[str]) -> Certificate:
    """The certificate in a folder, made when there is none or it ends soon.

    Args:
        folder: Where it is kept; made with mode 0700, the key with 0600.
        names: Host names and addresses to put in a new one.
    """
    found = Certificate(folder / "certificate.pem", folder / "key.pem", own=False)
    damage = _damage(found)
    if damage:
        _put_aside(found, damage)
    if damage or not _lasts(found):
        folder.mkdir(mode=0o700, exist_ok=True)
        _make(found, names)
    return found


def _lasts(certificate: Certificate) -> bool:
    if not certificate.chain.exists():
        return False
    end = _read(certificate.chain).not_valid_after_utc
    return end - datetime.now(UTC) > RENEWED_BEFORE_END


def _damage(certificate: Certificate) -> str:
    """Why a made certificate cannot be used; empty = it can, or there is none yet."""
    if not certificate.chain.exists() and not certificate.key.exists():
        return ""
    try:
        _read(certificate.chain)
        certificate.context()
    except (OSError, ValueError, ConfigError) as error:
        return str(error)
    return ""


def _put_aside(certificate: Certificate, damage: str) -> None:
    stamp = f"{datetime.now(UTC):%Y%m%dT%H%M%S%f}"
    for path in (certificate.chain, certificate.key):
        if path.exists():
            path.rename(path.with_name(f"{path.name}.damaged-{stamp}"))
    log.error(
        "the certificate was damaged (%s); it is kept as *.damaged-%s, and a new one was made: "
        "its fingerprint is another, and every browser asks again",
        damage,
        stamp,
    )


def _make(certificate: Certificate, names: frozenset[str]) -> None:
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, "recon4")])
    now = datetime.now(UTC)
    made = (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(hours=1))  # clocks differ
        .not_valid_after(now + VALID)
        .add_extension(_alternatives(names), critical=False)
        .add_extension(x509.BasicConstraints(ca=False, path_length=None), critical=True)
        .add_extension(x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH]), critical=False)
        .sign(key, hashes.SHA256())
    )
    secret = key.private_bytes(
        serialization.Encoding.PEM,
        serialization.PrivateFormat.PKCS8,
        serialization.NoEncryption(),
    )
    write_private(certificate.key, secret)
    write_text(certificate.chain, made.public_bytes(serialization.Encoding.PEM).decode())


def _alternatives(names: frozenset[str]) -> x509.SubjectAlternativeName:
    found: list[x509.GeneralName] = []
    for name in sorted(names):
        try:
            found.append(x509.IPAddress(ipaddress.ip_address(name)))
        except ValueError:
            found.append(x509.DNSName(name))
    return x509.SubjectAlternativeName(found)


def _read(path: Path) -> x509.Certificate:
    return x509.load_pem_x509_certificate(path.read_bytes())


def _names(certificate: x509.Certificate) -> frozenset[str]:
    try:
        found = certificate.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
    except x509.ExtensionNotFound:
        return frozenset()
    names = found.get_values_for_type(x509.DNSName)
    addresses = found.get_values_for_type(x509.IPAddress)
    return frozenset(name.lower() for name in (*names, *(str(one) for one in addresses)))


def _no_password() -> str:
    return ""  # else OpenSSL asks on the terminal
