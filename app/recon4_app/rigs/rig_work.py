"""Reading of rig files; runs in confined children of the compute pool, because users wrote them."""

from __future__ import annotations

import hashlib
from pathlib import Path

from pydantic import BaseModel

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.limits import RIG_LIMITS
from recon4.model.rig import format_rig, parse_rig
from recon4.model.serial_device import parse_serial_device
from recon4.untrusted.bounded import read_text_limited
from recon4.untrusted.names import visible
from recon4_app.rigs.content import content_of
from recon4_app.rigs.model import RigContent


class CheckedRig(BaseModel):
    """A rig file that was read."""

    toml: str
    """Its text, unchanged."""
    name: str
    """Display name of the rig."""
    sensors: list[str]
    digest: str
    """SHA-256 of the rig as a project stores it."""


def check_rig(text: str) -> CheckedRig:
    """Read the text of a rig file that is to be stored.

    Raises:
        ConfigError: If it is no rig, or its receiver is on something else than a serial line.
    """
    size = len(text.encode("utf-8", "replace"))
    if size > RIG_LIMITS.file_bytes:
        raise ConfigError(CodedText("rig-file-too-large", limit=RIG_LIMITS.file_bytes, size=size))
    rig = parse_rig(text, where="the rig file")
    if rig.gnss_serial:
        parse_serial_device(rig.gnss_serial)
    return CheckedRig(
        toml=text,
        name=visible(rig.name),
        sensors=[visible(sensor.name) for sensor in rig.sensors],
        digest=hashlib.sha256(format_rig(rig).encode("utf-8")).hexdigest(),
    )


def check_rig_in(path: Path) -> CheckedRig:
    """Read a rig file.

    Raises:
        ConfigError: If it cannot be read or is no rig.
    """
    return check_rig(read_text_limited(path, RIG_LIMITS.file_bytes, failure=ConfigError))


def read_content(path: Path) -> RigContent:
    """Read a rig file for display.

    Raises:
        ConfigError: If it cannot be read or is no rig.
    """
    text = read_text_limited(path, RIG_LIMITS.file_bytes, failure=ConfigError)
    return content_of(parse_rig(text, where=path.name))
