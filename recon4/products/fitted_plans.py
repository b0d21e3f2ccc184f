"""Floor plans of a map, fitted once for all files that draw them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from recon4.mapping.tiles import TileSet
    from recon4.products.floor_plan import FloorPlan


class FittedPlans:
    """The floor plans of one map, each fitted once however many files draw it."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[FloorPlan, ...]] = {}

    def of(self, tiles: TileSet, storey: str) -> tuple[FloorPlan, ...]:
        """The plans of a storey; of all storeys if its name is empty.

        Args:
            tiles: The map, the same one in all calls.
            storey: Name of the storey.

        Raises:
            ConfigError: If the map has no storey of this name.
        """
        from recon4.products.floor_plan import draw_plan
        from recon4.products.storeys import find_storeys, level_surfaces, storey_named

        if storey not in self._known:
            levels = level_surfaces(tiles)
            storeys = find_storeys(tiles, levels)
            chosen = (storey_named(storeys, storey),) if storey or not storeys else storeys
            self._known[storey] = tuple(draw_plan(tiles, one, levels) for one in chosen)
        return self._known[storey]
