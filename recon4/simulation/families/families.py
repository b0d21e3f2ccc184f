"""The families of LiDARs that are simulated, one row each."""

from __future__ import annotations

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.lidars import LIDARS, lidar_model
from recon4.simulation.families.family import SimulatedFamily
from recon4.simulation.families.hesai import HESAIS
from recon4.simulation.families.livox import LIVOX
from recon4.simulation.families.ouster import OUSTERS
from recon4.simulation.families.robosense import ROBOSENSE
from recon4.simulation.families.velodyne import VELODYNES
from recon4.simulation.patterns import FiringPattern

FAMILIES: tuple[SimulatedFamily, ...] = (VELODYNES, OUSTERS, HESAIS, ROBOSENSE, LIVOX)
"""By name as in `recon4.recording.packets.families`."""


def family_of(model: str) -> SimulatedFamily:
    """The family that simulates a model.

    Raises:
        ConfigError: If none does; names those that are simulated.
    """
    maker = lidar_model(model).maker if model in LIDARS else ""
    for family in FAMILIES:
        if family.name == maker and family.pattern(model) is not None:
            return family
    raise ConfigError(
        CodedText("simulate-model", model=model[:80], value=", ".join(simulated_models()))
    )


def pattern_of(model: str) -> FiringPattern:
    """How a model fires.

    Raises:
        ConfigError: If it is not simulated.
    """
    pattern = family_of(model).pattern(model)
    assert pattern is not None
    return pattern


def simulated_models() -> list[str]:
    """Names of the models that are simulated."""
    makers = {family.name: family for family in FAMILIES}
    return [
        name
        for name, facts in LIDARS.items()
        if facts.maker in makers and makers[facts.maker].pattern(name) is not None
    ]
