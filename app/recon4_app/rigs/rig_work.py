"""Reading of rig files; runs in confined children of the compute pool, because users wrote them."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path

from pydantic import BaseModel

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.limits import RIG_LIMITS
from recon4.model.rig import format_rig, load_rig, parse_rig
from recon4.model.serial_device import parse_serial_device
from recon4.untrusted.bounded import read_text_limited
from recon4.untrusted.names import visible
from recon4_app.rigs.content import content_of
from recon4_app.rigs.model import FileBeside, RigContent


class CheckedRig(BaseModel):
    """A rig file that was read."""

    toml: str
    """Its text, unchanged."""
    name: str
    """Display name of the rig."""
    sensors: list[str]
    digest: str
    """SHA-256 of the rig as a project stores it."""


def check_rig(text: str, beside: Sequence[FileBeside] = ()) -> CheckedRig:
    """Read the text of a rig file that is to be stored.

    Args:
        text: Of the file.
        beside: Files that describe its LiDARs; they go into the text.

    Raises:
        ConfigError: If it is no rig, its receiver is on something else than a serial line, or a
            file beside it describes none of its LiDARs.
    """
    text = _described(text, beside) if beside else text
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


def _described(text: str, beside: Sequence[FileBeside]) -> str:
    from recon4.recording.packets.companions import described_by
    from recon4.recording.packets.family import Companion

    files = [Companion(one.name, one.content) for one in beside]
    rig, used = described_by(parse_rig(text, where="the rig file"), files)
    if unused := sorted({one.name for one in files} - set(used.values())):
        raise ConfigError(CodedText("rig-files-unused", names=visible(", ".join(unused))))
    return format_rig(rig)


def described_rig(path: Path, beside: Sequence[Path]) -> str:
    """The text of a rig file with the files beside it that describe its LiDARs.

    Raises:
        ConfigError: If it is no rig, or too large with them.
    """
    from recon4.recording.packets.companions import with_descriptions

    return check_rig(format_rig(with_descriptions(load_rig(path), beside)[0])).toml


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
