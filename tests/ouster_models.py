"""Sensors of Ouster as they are sold: metadata without a calibration, for encoded packets."""

from __future__ import annotations

import numpy as np

from recon4.errors import ConfigError
from recon4.model.lidars import LIDARS, lidar_model
from recon4.recording.packets.ouster.facts import STAGGER_DEG, STAGGER_OS2_DEG
from recon4.recording.packets.ouster.layouts import PROFILES, PacketLayout
from recon4.recording.packets.ouster.metadata import (
    OusterMetadata,
    usual_beam_origin_m,
    usual_mount,
)


def nominal_metadata(
    model: str,
    *,
    profile: str = "RNG19_RFL8_SIG16_NIR16",
    columns_per_turn: int = 1024,
    rotation_hz: float = 10.0,
    serial: str = "122300000001",
) -> OusterMetadata:
    """Metadata of a sensor whose beams lie evenly in its field of view.

    Raises:
        ConfigError: If there is no such model or profile.
    """
    facts = lidar_model(model)
    if facts.maker != "Ouster" or not facts.beams or profile not in PROFILES:
        known = ", ".join(name for name, one in LIDARS.items() if one.maker == "Ouster")
        raise ConfigError(
            f"no Ouster {model!r} with the profile {profile!r}; models: {known}; "
            f"profiles: {', '.join(PROFILES)}"
        )
    kind, _, beams = model.partition("-")
    product = f"OS-{kind[2:].upper()}-{beams}"
    stagger_deg = np.array(STAGGER_DEG.get(kind, STAGGER_OS2_DEG))
    lowest, highest = facts.elevation_deg
    return OusterMetadata(
        name=model,
        likeness=0,
        product=product,
        serial=serial,
        init_id=1,
        layout=PacketLayout(PROFILES[profile], facts.beams, fusa=PROFILES[profile].fusa),
        columns_per_turn=columns_per_turn,
        rotation_hz=rotation_hz,
        elevation_rad=np.deg2rad(np.linspace(highest, lowest, facts.beams)),
        azimuth_rad=np.deg2rad(stagger_deg[np.arange(facts.beams) % len(stagger_deg)]),
        p_lidar_beam_m=usual_beam_origin_m(product),
        T_sensor_lidar=usual_mount(product),
        R_sensor_imu=np.eye(3),
        port=7502,
        imu_port=7503,
        assumed=(),
    )
