"""Points of a Livox as its drivers publish them, made of its packets."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from recon4.recording.packets.livox.models import MODELS, LivoxModel, header_of, layout_of
from recon4.simulation.bag_packets import Packet, PacketMessage, Types
from recon4.units import SECOND_NS

_HEAD = "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
_POINT = (
    "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\n"
    "uint8 reflectivity\nuint8 tag\nuint8 line\n"
)


def livox_message(name: str) -> PacketMessage:
    """``CustomMsg`` of the driver for the protocol of a model, ten a second."""
    model = MODELS[name]
    driver = "livox_ros_driver" if model.sdk == 1 else "livox_ros_driver2"
    definitions = {
        f"{driver}/msg/CustomPoint": _POINT,
        f"{driver}/msg/CustomMsg": f"{_HEAD}{driver}/CustomPoint[] points\n",
    }
    shots = 100 if model.lines == 1 else 96
    collected = round(0.1 * model.shots_hz / shots)
    make = partial(_custom, driver=driver, model=model)
    return PacketMessage(f"{driver}/msg/CustomMsg", collected, make, definitions)


def _custom(
    types: Types, header: Any, packets: Sequence[Packet], *, driver: str, model: LivoxModel
) -> Any:
    """A message; its stamp is the time of its first point, as with the drivers."""
    payloads = np.stack([data for _, data in packets])
    layout = layout_of(payloads[0])
    assert layout is not None and not layout.is_spherical and layout.returns == 1
    stamps_ns = np.ascontiguousarray(header_of(payloads, layout.sdk)["stamp"]).view("<u8")[:, 0]
    base_ns = int(stamps_ns[0])
    k = np.arange(layout.shots)
    since_ns = (stamps_ns - stamps_ns[0])[:, None] + np.rint(1e9 * model.shot_s * k).astype("<u8")
    body = np.ascontiguousarray(payloads[:, layout.header.itemsize :])
    returns = body.view(layout.record)["returns"][:, :, 0]
    xyz_m = (returns["xyz"] * layout.unit_m).reshape(-1, 3)
    tag = returns["tag"] if layout.is_tagged else np.zeros_like(returns["reflectivity"])
    line = np.broadcast_to(k % model.lines, since_ns.shape)
    columns = (
        since_ns.ravel(),
        *xyz_m.T,
        returns["reflectivity"].ravel(),
        tag.ravel(),
        line.ravel(),
    )
    point = types(f"{driver}/msg/CustomPoint")
    points = [point(*row) for row in zip(*(c.tolist() for c in columns), strict=True)]
    seconds, nanoseconds = divmod(base_ns, SECOND_NS)
    stamp = types("builtin_interfaces/msg/Time")(sec=seconds, nanosec=nanoseconds)
    return types(f"{driver}/msg/CustomMsg")(
        header=types("std_msgs/msg/Header")(stamp=stamp, frame_id=header.frame_id),
        timebase=base_ns,
        point_num=len(points),
        lidar_id=0,
        rsvd=np.zeros(3, np.uint8),
        points=points,
    )
