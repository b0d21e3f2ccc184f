"""What to say where a recording has other LiDARs than its rig."""

from __future__ import annotations

from recon4.locales.coded import CodedText, joined
from recon4.model.rig import Rig, Sensor
from recon4.recording.tuning import LISTED


def mismatch_text(rig: Rig, found: str) -> CodedText:
    """What a rig expects, what is there, and what to do.

    Args:
        rig: The rig that was given.
        found: The LiDARs of the recording, with their addresses and ports, or topics.
    """
    expected = joined(_expected(sensor) for sensor in rig.sensors[: LISTED.names])
    return CodedText(
        "rig-expects",
        rig=rig.name,
        sensors=expected,
        more="some" if len(rig.sensors) > LISTED.names else "none",
        found=found or CodedText("rig-no-packets"),
    )


def _expected(sensor: Sensor) -> CodedText:
    if sensor.topic:
        return CodedText(
            "rig-expects-topic", name=sensor.name, model=sensor.model, topic=sensor.topic
        )
    return CodedText(
        "rig-expects-port",
        name=sensor.name,
        model=sensor.model,
        address=sensor.address or "any",
        port=sensor.port,
    )
