"""Sensors of Ouster as they are sold: metadata without a calibration, for encoded packets."""

from __future__ import annotations

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.model.lidars import LIDARS, lidar_model
from recon4.recording.packets.ouster.layouts import PROFILES, PacketLayout
from recon4.recording.packets.ouster.metadata import (
    OusterMetadata,
    usual_beam_origin_m,
    usual_mount,
)

STAGGER_DEG = {"OS0": (10.9, 3.6, -3.7, -11.0), "OS1": (4.2, 1.4, -1.4, -4.2)}
"""Azimuth of four beams that follow each other, as in metadata of real sensors."""
STAGGER_OS2_DEG = (2.1, 0.7, -0.7, -2.1)


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


def beams_in_turn(metadata: OusterMetadata) -> tuple[Array, Array]:
    """How the beams leave at each column of a revolution, in the sensor frame.

    Returns:
        Origins [m] and directions, (W, B, 3) each; a point lies at ``origin + r * direction`` of
        the range r that is sent. Column w of W is fired at w / W of the revolution.
    """
    columns = metadata.columns_per_turn
    encoder = -2.0 * np.pi / columns * np.arange(columns)
    angle = encoder[:, None] - metadata.azimuth_rad
    elevation = metadata.elevation_rad + 0.0 * angle
    direction = np.stack(
        [np.cos(elevation) * np.cos(angle), np.cos(elevation) * np.sin(angle), np.sin(elevation)],
        axis=-1,
    )
    x_m, z_m = metadata.p_lidar_beam_m.tolist()
    leaves = np.stack([x_m * np.cos(encoder), x_m * np.sin(encoder), z_m + 0.0 * encoder], axis=-1)
    origin = leaves[:, None] - np.hypot(x_m, z_m) * direction
    R_sensor_lidar, p_sensor_lidar = np.split(metadata.T_sensor_lidar[:3], [3], axis=1)
    return (
        origin @ R_sensor_lidar.T + p_sensor_lidar[:, 0],
        direction @ R_sensor_lidar.T,
    )
