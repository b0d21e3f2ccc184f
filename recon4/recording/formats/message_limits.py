"""Size limits of messages to decode: a list of objects takes many times its bytes."""

from __future__ import annotations

import struct
from collections.abc import Sequence

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.packets.messages import DATA_MESSAGES

MAX_SAMPLE_BYTES = 64 << 10
"""One message of an IMU, a GNSS receiver or a pose has less than 1 kB."""
MAX_SCAN_BYTES = 8 << 20
"""Raw packets of one revolution; the largest have 1 MB."""
MAX_TRANSFORMS_BYTES = 2 << 20
"""One message of the frames of a robot; a transform has about 100 bytes."""
MAX_TEXT_BYTES = 4 << 20
"""A text, as the description of a robot."""
MAX_FIELDS = 100
MAX_CLOUD_POINTS = 5_000_000
"""128 beams x 4096 columns are 524 288."""
_CLOUD = "sensor_msgs/msg/PointCloud2"
_MOST_BYTES = {
    **dict.fromkeys(DATA_MESSAGES, MAX_SCAN_BYTES),
    "tf2_msgs/msg/TFMessage": MAX_TRANSFORMS_BYTES,
    "tf/msg/tfMessage": MAX_TRANSFORMS_BYTES,
    "std_msgs/msg/String": MAX_TEXT_BYTES,
}
"""Of other types `MAX_SAMPLE_BYTES`."""


def check_message(kind: str, data: bytes, *, ros1: bool) -> None:
    """Refuse a message that needs far more memory than its bytes.

    Raises:
        CorruptFile: If it is too large for its type, or is a cloud with too many fields.
    """
    if kind == _CLOUD:
        count = _fields_of_cloud(data, ros1=ros1)
        if count > MAX_FIELDS:
            raise CorruptFile(CodedText("message-fields-many", max_fields=MAX_FIELDS, count=count))
        return
    most = _MOST_BYTES.get(kind, MAX_SAMPLE_BYTES)
    if len(data) > most:
        raise CorruptFile(CodedText("message-large", kind=kind, most=most, count=len(data)))


def require_apart_fields(fields: Sequence[tuple[int, int]]) -> None:
    """Check that the fields of a point do not share bytes: each becomes a column of its own.

    Args:
        fields: Offset and size of each [bytes].

    Raises:
        CorruptFile: If two overlap.
    """
    end = 0
    for offset, size in sorted(fields):
        if offset < end:
            raise CorruptFile(CodedText("message-field-place", end=end, offset=offset))
        end = offset + size


def _fields_of_cloud(data: bytes, *, ros1: bool) -> int:
    """The length of the list of fields, behind header, height and width.

    Raises:
        CorruptFile: If the message ends before.
    """
    order = "<" if ros1 or data[1:2] != b"\0" else ">"
    base = 0 if ros1 else 4
    try:
        at = base + (12 if ros1 else 8)
        (name,) = struct.unpack_from(f"{order}I", data, at)
        at += 4 + name
        if not ros1:
            at += -(at - base) % 4
        return int(struct.unpack_from(f"{order}I", data, at + 8)[0])
    except struct.error as error:
        raise CorruptFile(CodedText("message-header-cut", why=str(error))) from error
