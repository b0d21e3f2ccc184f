"""Bags with messages of points that a driver of its own defines, for tests."""

from __future__ import annotations

import numpy as np
from rosbags.typesys import get_types_from_msg

from recon4.recording.assembly.shots import Shots
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS, Bag, bag_path, room_cloud

STEP_NS = 100_000_000
ROOM = room_cloud(columns_per_turn=90)
"""A revolution of few points."""


def register(store, kind, definition):
    types = {}
    first, *others = definition.split("===\n")
    for text in others:
        head, _, body = text.partition("\n")
        types |= get_types_from_msg(body, head.removeprefix("MSG:").strip().replace("/", "/msg/"))
    types |= get_types_from_msg(first, kind)
    store.register({name: made for name, made in types.items() if name not in store.types})


def header(store, t_ns, frame="livox_frame"):
    time = store.types["builtin_interfaces/msg/Time"](t_ns // 10**9, t_ns % 10**9)
    fields = {"stamp": time, "frame_id": frame}
    kind = store.types["std_msgs/msg/Header"]
    return kind(**({"seq": 3} if "seq" in kind.__dataclass_fields__ else {}), **fields)


def read(path, *, rig=None, **settings):
    report = ImportReport()
    recording = open_recording(OpenRequest((path,), rig, IngestSettings(**settings), report))
    shots = [item for item in recording.read() if isinstance(item, Shots)]
    return recording, shots, report


def write_points(folder, kind, definition, fill, *, frames=3, topic="/own"):
    """A bag whose messages `fill` makes of a header and the room, a revolution each."""
    path = bag_path(folder, kind)
    name = "my_driver/msg/Points"
    with Bag(path, kind) as bag:
        register(bag.store, name, definition)
        for k in range(frames):
            t_ns = T0_NS + k * STEP_NS
            values = fill(bag.store, ROOM, t_ns)
            bag.write(topic, name, t_ns, bag.store.types[name](header(bag.store, t_ns), *values))
    return path


def structures(store, kind, columns):
    """A list of structures of columns, in the order of their fields."""
    made = store.types[kind]
    return [made(*row) for row in zip(*(c.tolist() for c in columns), strict=True)]


def since_us(room):
    """Times of the points of a room since the stamp [us], uint32."""
    return np.rint(room["time"].astype(np.float64) * 1e6).astype(np.uint32)
