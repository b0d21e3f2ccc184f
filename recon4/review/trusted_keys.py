"""The keys whose signatures count: those of the server itself, and those that a person added.

A project in the folder of a server is judged by the keys of that server
(``ROOT/.recon4/trusted_keys``), any other project by the keys of the person at this computer
(``~/.config/recon4/trusted_keys``). Nothing inside a project makes a key trusted.

One file a key, named by its fingerprint. A removed key keeps its file, so that what it signed can
be refused with the name of the signer. The server's own keys are recorded when they are made: after
a renewal the earlier one still counts for what it signed.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

import msgspec

from recon4.errors import ConfigError, StoreError
from recon4.locales.coded import CodedText
from recon4.review.signature import ensure_key, fingerprint, public_key_of
from recon4.review.tuning import KEY_LIMITS
from recon4.store.atomic import make_folders, write_json
from recon4.store.checked import Altered
from recon4.store.formats import FORMATS
from recon4.store.json_files import read_object
from recon4.untrusted.names import visible
from recon4.untrusted.typed import as_type

STATE = ".recon4"
"""Folder of a server's own files, in its folder of projects."""
TRUSTED_KEYS = "trusted_keys"
SIGNING_KEY = "signing.key"
_PUBLIC_KEY = re.compile(r"[0-9a-f]{64}")
_OWN_NAME = "this server"


class UnknownSigner(Altered):
    """A signature is intact, and its key is not trusted here."""

    def __init__(self, message: str, key: str) -> None:
        super().__init__(message)
        self.key = key
        """Fingerprint."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TrustedKey:
    """A key that was added, and perhaps removed again."""

    public_key: str
    """Ed25519, 64 hexadecimal digits."""
    name: str
    """Whose it is."""
    own: bool
    """Whether this server made it."""
    added: str
    """UTC, ISO 8601."""
    by: str
    """Who added it."""
    removed: str = ""
    """When it was removed; empty = it counts."""
    removed_by: str = ""

    @property
    def fingerprint(self) -> str:
        """Short name of the key."""
        return fingerprint(self.public_key)


@dataclass(frozen=True, slots=True, kw_only=True)
class TrustedKeys:
    """The keys that one server, or one person, trusts."""

    folder: Path
    """The state of the server, or the configuration of the person."""
    server: bool
    """Whether they are those of a server."""
    keys: Mapping[str, TrustedKey]
    """By public key; removed ones as well."""
    damaged: tuple[str, ...] = ()
    """Files that cannot be read, and why."""

    def signer(self, public_key: str) -> TrustedKey:
        """The trusted key with this public key.

        Raises:
            UnknownSigner: If there is none, or it was removed.
        """
        key = self.keys.get(public_key)
        if key is None:
            raise UnknownSigner(self._unknown(public_key), fingerprint(public_key))
        if key.removed:
            raise UnknownSigner(
                CodedText(
                    "signer-removed",
                    key=key.fingerprint,
                    name=visible(key.name),
                    who=visible(key.removed_by),
                    date=key.removed[:10],
                ),
                key.fingerprint,
            )
        return key

    def _unknown(self, public_key: str) -> str:
        short = fingerprint(public_key)
        why = f" ({'; '.join(self.damaged)})" if self.damaged else ""
        if self.server:
            return (
                f"the signature is intact, but by the unknown key {short}: this server did not "
                f"sign it{why}; if that signer is to count here, an admin compares the key with "
                f"the signer and adds it on the page People, or with the command recon4 keys add "
                f"NAME {public_key} --root ROOT"
            )
        return (
            f"the signature is intact, but the signer is unknown on this computer (key {short})"
            f"{why}; if you know whose key it is, add it with the command recon4 keys add NAME "
            f"{public_key}"
        )


def trusted_for(project: Path) -> TrustedKeys:
    """The keys that judge a project: of the server it lies in, else of this person."""
    parent = project.resolve().parent
    if parent.name == "trash" and parent.parent.name == STATE:
        return read_keys(parent.parent, server=True)
    if (parent / STATE).is_dir():
        return read_keys(parent / STATE, server=True)
    return read_keys(personal_folder(), server=False)


def personal_folder() -> Path:
    """Folder of the keys of the person who runs this command; it may not be there.

    Of a user without a home it never is: the working folder is not searched for one.
    """
    base = os.environ.get("XDG_CONFIG_HOME", "")
    configuration = base if base.startswith("/") else os.path.expanduser("~/.config")
    return Path("/", configuration, "recon4")


def read_keys(folder: Path, *, server: bool) -> TrustedKeys:
    """The keys in a folder, with the public half of its signing key; damaged files are named."""
    keys: dict[str, TrustedKey] = {}
    damaged: list[str] = []
    for path in _key_files(folder, damaged):
        try:
            key = _read(path)
            keys[key.public_key] = key
        except StoreError as error:
            damaged.append(f"{TRUSTED_KEYS}/{path.name} cannot be used: {error}")
    own = _own_key(folder) if server else None
    if own is not None:
        keys.setdefault(own.public_key, own)
    return TrustedKeys(folder=folder, server=server, keys=keys, damaged=tuple(damaged))


def add_key(trusted: TrustedKeys, name: str, public_key: str, *, by: str) -> TrustedKey:
    """Trust a key from now on, also one that was removed.

    Raises:
        ConfigError: If the name or the key is not valid.
        StoreError: If it cannot be written.
    """
    public_key, name = public_key.strip().lower(), name.strip()
    if not _PUBLIC_KEY.fullmatch(public_key):
        raise ConfigError(CodedText("keys-public", public_key=visible(public_key, most=80)))
    if not name or len(name) > KEY_LIMITS.max_name_characters or visible(name) != name:
        raise ConfigError(
            CodedText("keys-name", max_name_characters=KEY_LIMITS.max_name_characters)
        )
    before = trusted.keys.get(public_key)
    own = before is not None and before.own
    key = TrustedKey(public_key=public_key, name=name, own=own, added=_now(), by=by)
    _write(trusted.folder, key)
    return key


def remove_key(trusted: TrustedKeys, wanted: str, *, by: str) -> TrustedKey:
    """Trust a key no longer, from whatever time its signatures are.

    Args:
        trusted: The keys as they are.
        wanted: Its name, fingerprint or public key.
        by: Who removes it.

    Raises:
        ConfigError: If no or several keys fit, or it is the one the server signs with.
        StoreError: If it cannot be written.
    """
    fitting = [
        key
        for key in trusted.keys.values()
        if not key.removed and wanted in (key.name, key.fingerprint, key.public_key)
    ]
    if len(fitting) != 1:
        found = f"{len(fitting)} keys are" if fitting else "no key is"
        raise ConfigError(CodedText("keys-several", found=found, wanted=visible(wanted, most=80)))
    key = fitting[0]
    own = _own_key(trusted.folder) if trusted.server else None
    if own is not None and own.public_key == key.public_key:
        raise ConfigError(CodedText("keys-own", fingerprint=key.fingerprint))
    key = replace(key, removed=_now(), removed_by=by)
    _write(trusted.folder, key)
    return key


def ensure_own_key(folder: Path) -> None:
    """Make the signing key of a server if it has none, and record its public half."""
    ensure_key(folder / SIGNING_KEY)
    record_own_key(folder)


def record_own_key(folder: Path) -> None:
    """Record the public half of the signing key, if there is one: children may not read the key.

    A key that was removed stays removed.
    """
    own = _own_key(folder)
    if own is not None and not _file_of(folder, own).exists():
        _write(folder, own)


def renew_own_key(folder: Path) -> TrustedKey:
    """Make another signing key; what the earlier one signed still counts.

    Raises:
        StoreError: If it cannot be written.
    """
    record_own_key(folder)
    made = folder / f".tmp-{SIGNING_KEY}"
    made.unlink(missing_ok=True)
    ensure_key(made)
    key = TrustedKey(
        public_key=public_key_of(made), name=_OWN_NAME, own=True, added=_now(), by=_OWN_NAME
    )
    _write(folder, key)  # first: whatever the new key signs is known
    made.replace(folder / SIGNING_KEY)
    return key


def _key_files(folder: Path, damaged: list[str]) -> Iterator[Path]:
    try:
        yield from sorted((folder / TRUSTED_KEYS).glob("*.json"))
        os.scandir(folder / TRUSTED_KEYS).close()  # glob is silent about a folder it may not read
    except (FileNotFoundError, NotADirectoryError):
        return
    except OSError as error:
        damaged.append(f"{TRUSTED_KEYS} cannot be read: {error.strerror}")


def _own_key(folder: Path) -> TrustedKey | None:
    """The public half of the signing key; None = there is none, or it may not be read."""
    path = folder / SIGNING_KEY
    with suppress(StoreError):
        if path.is_file() and os.access(path, os.R_OK):
            public_key = public_key_of(path)
            return TrustedKey(
                public_key=public_key, name=_OWN_NAME, own=True, added=_now(), by=_OWN_NAME
            )
    return None


def _read(path: Path) -> TrustedKey:
    record = read_object(path, max_bytes=KEY_LIMITS.max_key_file_bytes)
    if record.pop("format", None) != FORMATS.trusted_key:
        raise StoreError(CodedText("keys-format", trusted_key=FORMATS.trusted_key))
    try:
        key = as_type(record, TrustedKey)
    except msgspec.ValidationError as error:
        raise StoreError(str(error)) from error
    if not _PUBLIC_KEY.fullmatch(key.public_key) or path.stem != key.fingerprint:
        raise StoreError(CodedText("keys-other-name"))
    return key


def _write(folder: Path, key: TrustedKey) -> None:
    path = _file_of(folder, key)
    make_folders(path.parent, 0o700)
    write_json(path, {"format": FORMATS.trusted_key, **asdict(key)})


def _file_of(folder: Path, key: TrustedKey) -> Path:
    return folder / TRUSTED_KEYS / f"{key.fingerprint}.json"


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
