"""What the surfaces of a simulated world reflect."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Reflectivities:
    """Diffuse reflectivity of each material, as `WorldMesh.reflectivity` has it."""

    plaster: float = 0.55
    ceiling: float = 0.65
    linoleum: float = 0.3
    wood: float = 0.4
    dark: float = 0.12
    """Dark plastic, rubber, upholstery."""
    steel: float = 0.35
    lamp: float = 0.95
    pane: float = 0.015
    """A window, which is a `SURFACES.glass`."""
    paper: float = 0.8
    ink: float = 0.06
    """Black sectors of survey targets."""
    retro: float = 2.2
    """Retro-reflective paint of markers, signs and number plates."""
    leaves: float = 0.45
    asphalt: float = 0.15
    grass: float = 0.35
    concrete: float = 0.3
    people: float = 0.45
    """Clothes of those who walk along."""
    vehicle: float = 0.3
    """Paint of what drives."""


MATERIAL = Reflectivities()
