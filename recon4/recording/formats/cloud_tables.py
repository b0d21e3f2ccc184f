"""Messages of points as tables: fields of a ``PointCloud2``, lists of points of other types."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.formats.cloud_files import Table
from recon4.recording.formats.limits import clean_name
from recon4.recording.formats.message_limits import MAX_CLOUD_POINTS, require_apart_fields
from recon4.recording.formats.point_messages import POINTS, PointMessage
from recon4.recording.tuning import LISTED

_FIELD_TYPES = {
    **{1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"},
    **{9: "i8", 10: "u8", 11: "u1"},  # by PCL first (``PCLPointField``), then by ROS 2
}


def cloud_lists(cloud: Any) -> Mapping[str, Table]:
    """All lists of points of a message, by name, for recipes.

    Raises:
        CorruptFile: If the data are shorter than the layout.
    """
    return cloud.lists if isinstance(cloud, PointMessage) else {POINTS: cloud_table(cloud)}


def unread_fields(cloud: Any) -> list[str]:
    """Fields of a ``PointCloud2`` whose types nobody has defined, with these types."""
    if isinstance(cloud, PointMessage):
        return []
    unread = [f for f in cloud.fields if f.datatype not in _FIELD_TYPES]
    return [f"{clean_name(f.name)} ({f.datatype})" for f in unread]


def says_other_order(cloud: Any) -> bool:
    """Whether only in the other order of bytes the coordinates of a ``PointCloud2`` are lengths.

    Raises:
        CorruptFile: If the data are shorter than the layout.
    """
    if isinstance(cloud, PointMessage):
        return False
    known, data = _known_fields(cloud), _packed(cloud)
    x = [f for f in known if f.name.lower() == "x" and _FIELD_TYPES[f.datatype] in ("f4", "f8")]
    if not x:
        return False
    said, other = (
        _lengths(data.view(_point_dtype(x[:1], int(cloud.point_step), order))[x[0].name])
        for order in _orders(cloud)
    )
    return other > max(4 * said, 10)


def _orders(cloud: Any) -> str:
    """The order of bytes that a cloud states, and the other one."""
    return "><" if cloud.is_bigendian else "<>"


def _lengths(x: NDArray[np.floating[Any]]) -> int:
    """How many are coordinates, also on the earth; bytes in another order mostly are none."""
    return int(np.count_nonzero((np.abs(x) > 1e-4) & (np.abs(x) < 1e7)))


def cloud_table(cloud: Any, *, other_order: bool | None = None) -> Table:
    """Fields of a ``PointCloud2``, or of another message of points, by lower-case name.

    Args:
        cloud: The message.
        other_order: What `says_other_order` says of it; None = it is asked.

    Raises:
        CorruptFile: If the data are shorter than the layout.
    """
    if isinstance(cloud, PointMessage):
        return cloud.table
    known, data = _known_fields(cloud), _packed(cloud)
    require_apart_fields([(int(f.offset), int(_FIELD_TYPES[f.datatype][1])) for f in known])
    is_other = says_other_order(cloud) if other_order is None else other_order
    order = _orders(cloud)[is_other]
    points = data.view(_point_dtype(known, int(cloud.point_step), order))
    return {
        field.name.lower(): points[field.name].astype(points[field.name].dtype.newbyteorder("="))
        for field in known
    }


def _known_fields(cloud: Any) -> list[Any]:
    known = [f for f in cloud.fields if f.datatype in _FIELD_TYPES]
    if {f.name.lower() for f in cloud.fields if f not in known} & {"x", "y", "z"}:
        fields = ", ".join(unread_fields(cloud)[: LISTED.few])
        raise CorruptFile(CodedText("cloud-types", fields=fields, most=max(_FIELD_TYPES)))
    return known


def _packed(cloud: Any) -> NDArray[np.uint8]:
    """The bytes of all points, one after the other."""
    step, width, height = int(cloud.point_step), int(cloud.width), int(cloud.height)
    data: NDArray[np.uint8] = np.asarray(cloud.data, np.uint8)
    # Some drivers leave the length of a row as it was: their data have no room for any other.
    is_packed = not cloud.row_step or len(data) == step * width * height
    row_step = step * width if is_packed else int(cloud.row_step)
    if step <= 0 or row_step < step * width or len(data) < row_step * height:
        raise CorruptFile(
            CodedText(
                "message-cloud-size",
                width=width,
                height=height,
                step=step,
                row_step=row_step,
                count=len(data),
            )
        )
    if width * height > MAX_CLOUD_POINTS:
        raise CorruptFile(
            CodedText(
                "message-cloud-large", width=width, height=height, max_cloud_points=MAX_CLOUD_POINTS
            )
        )
    rows = data[: row_step * height].reshape(height, row_step)[:, : step * width]
    return np.ascontiguousarray(rows).reshape(-1)


def _point_dtype(fields: Sequence[Any], step: int, order: str) -> np.dtype[np.void]:
    try:
        return np.dtype(
            {
                "names": [f.name for f in fields],
                "formats": [order + _FIELD_TYPES[f.datatype] for f in fields],
                "offsets": [int(f.offset) for f in fields],
                "itemsize": step,
            }
        )
    except ValueError as error:
        raise CorruptFile(CodedText("message-cloud-fields", step=step, why=str(error))) from error
