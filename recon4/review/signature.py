"""Ed25519 signatures of the server (the only importer of cryptography outside of TLS)."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path

from cryptography.exceptions import InvalidSignature
from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey
from cryptography.hazmat.primitives.serialization import (
    Encoding,
    NoEncryption,
    PrivateFormat,
    PublicFormat,
    load_pem_private_key,
)

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.store.atomic import make_folders, write_private

ALGORITHM = "Ed25519"


def sign(value: object, key_file: Path) -> dict[str, str]:
    """Sign a JSON value.

    Args:
        value: What is signed, as `canonical` bytes.
        key_file: The private key, PEM; created if missing, readable by its owner only.

    Returns:
        ``algorithm``, ``public_key`` and ``value`` (hexadecimal), ``key`` (fingerprint).

    Raises:
        StoreError: If the key cannot be read or created.
    """
    ensure_key(key_file)
    private = _load(key_file)
    public = _public_half(private)
    return {
        "algorithm": ALGORITHM,
        "public_key": public.hex(),
        "key": fingerprint(public.hex()),
        "value": private.sign(canonical(value)).hex(),
    }


def has_valid_signature(value: object, signature: Mapping[str, str]) -> bool:
    """Verify the signature of a value with the public key inside the signature.

    Whether that key counts is for `recon4.review.trusted_keys` to say.
    """
    try:
        public = Ed25519PublicKey.from_public_bytes(bytes.fromhex(signature["public_key"]))
        public.verify(bytes.fromhex(signature["value"]), canonical(value))
    except (InvalidSignature, KeyError, TypeError, ValueError):
        return False
    return signature.get("algorithm") == ALGORITHM


def fingerprint(public_key: str) -> str:
    """Short name of a public key (hexadecimal): the first 16 digits of its SHA-256."""
    return hashlib.sha256(bytes.fromhex(public_key)).hexdigest()[:16]


def canonical(value: object) -> bytes:
    """The bytes of a JSON value: keys sorted, no spaces, no NaN."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return text.encode()


def public_key_of(path: Path) -> str:
    """The public half of a private key, hexadecimal.

    Raises:
        StoreError: If the key cannot be read.
    """
    return _public_half(_load(path)).hex()


def ensure_key(path: Path) -> None:
    """Create the private key if missing, so that signing needs no write access to its folder."""
    if not path.exists():
        _make(path)


def _public_half(key: Ed25519PrivateKey) -> bytes:
    return key.public_key().public_bytes(Encoding.Raw, PublicFormat.Raw)


def _load(path: Path) -> Ed25519PrivateKey:
    try:
        key = load_pem_private_key(path.read_bytes(), password=None)
    except (OSError, ValueError) as error:
        raise StoreError(
            CodedText("signing-key-unreadable", file=str(path), why=str(error))
        ) from error
    if not isinstance(key, Ed25519PrivateKey):
        raise StoreError(
            CodedText(
                "signing-key-kind", file=str(path), algorithm=ALGORITHM, kind=type(key).__name__
            )
        )
    return key


def _make(path: Path) -> None:
    pem = Ed25519PrivateKey.generate().private_bytes(
        Encoding.PEM, PrivateFormat.PKCS8, NoEncryption()
    )
    make_folders(path.parent, 0o700)
    write_private(path, pem)
