"""Whether packets can be those of a sensor of a rig: of its maker, in a format of its model."""

from __future__ import annotations

from collections.abc import Sequence

from recon4.model.lidars import lidar_model
from recon4.model.rig import Sensor
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.family import Companion, Recognized


def can_be_of(
    sensor: Sensor, found: Recognized | None, *, head: Datagrams, companions: Sequence[Companion]
) -> bool:
    """Whether a sensor's model can read some packets; it may be another one than they say.

    Args:
        sensor: Of a rig.
        found: What the packets are; None = not known.
        head: The first of them.
        companions: Files beside the recording.
    """
    maker = lidar_model(sensor.model).maker
    family = next((family for family in FAMILIES if family.name == maker), None)
    if family is None or found is None:
        return True
    if found.family == maker:
        return not found.readable_as or sensor.model in found.readable_as
    answer = family.recognize(head, companions)
    return answer is not None and answer.kind == "data"
