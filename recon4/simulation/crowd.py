"""What moves around the carrier: how many people and vehicles."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.simulation.companions import Companions
from recon4.simulation.degradation import KINDS, PEOPLE, VEHICLES
from recon4.simulation.vehicles import Vehicles


@dataclass(frozen=True, slots=True)
class Crowd:
    """Numbers of people who walk along and of vehicles that move."""

    people: int = 0
    vehicles: int = 0

    @staticmethod
    def of(degradations: Mapping[str, float]) -> Crowd:
        """The crowd of a recording, by its degradations."""
        return Crowd(int(degradations.get(PEOPLE, 0)), int(degradations.get(VEHICLES, 0)))

    def check(self) -> None:
        """Check the numbers.

        Raises:
            ConfigError: If one is negative or too large.
        """
        most_people, most_vehicles = KINDS[PEOPLE].largest, KINDS[VEHICLES].largest
        if not 0 <= self.people <= most_people:
            raise ConfigError(
                CodedText("simulate-people", most_people=most_people, people=self.people)
            )
        if not 0 <= self.vehicles <= most_vehicles:
            raise ConfigError(
                CodedText("simulate-vehicles", most_vehicles=most_vehicles, vehicles=self.vehicles)
            )

    def drawn(self, seed: int) -> tuple[Companions | None, Vehicles | None]:
        """The people and vehicles of a seed; None = there are none."""
        people, cars = (np.random.default_rng([seed, purpose]) for purpose in (6, 11))
        return (
            Companions.drawn(self.people, people) if self.people else None,
            Vehicles.drawn(self.vehicles, cars) if self.vehicles else None,
        )


ALONE = Crowd()
