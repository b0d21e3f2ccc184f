"""Types of messages that are decoded with definitions from here, never with those in a bag."""

from __future__ import annotations

from functools import cache
from typing import Any

from recon4.recording.packets.messages import DEFINITIONS

TRANSFORMS = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
"""Of ROS 2 and late ROS 1, of early ROS 1."""
_DEFINITIONS = {
    **dict.fromkeys(TRANSFORMS, "geometry_msgs/TransformStamped[] transforms\n"),
}


@cache
def typestore(*, ros1: bool) -> Any:
    """The types of ROS 1 or ROS 2 and those of packets, as `rosbags` decodes them."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    for name, text in {**DEFINITIONS, **_DEFINITIONS}.items():
        if name not in store.types:
            store.register(get_types_from_msg(text, name))
    return store
