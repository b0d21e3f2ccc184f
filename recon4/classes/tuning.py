"""Tuning of the classes of measured points. Study: docs/studies/classes.md."""

from __future__ import annotations

from msgspec import Struct

from recon4.kernels.seen_through import SightRules
from recon4.kernels.things import SpreadRules, ThingRules


class ViewTuning(Struct, frozen=True, kw_only=True):
    """Scans of the walk that points are compared with."""

    every_ns: int = 500_000_000
    """Time between two of them [ns]."""
    span_ns: int = 1_000_000_000
    """All points of so long a time are compared with the same ones [ns]."""
    part_ns: int = 20_000_000_000
    """A worker classifies so long a time at once [ns]; it has to make images of what is before and
    after."""
    apart_ns: int = 1_500_000_000
    reach_ns: int = 10_500_000_000
    """They are at least and at most this far away in time [ns]: after a second a person has left
    his place, and trajectories drift."""
    best_ns: int = 5_000_000_000
    """Those nearest to this far away are asked first [ns]: a car has left its place, too."""
    far_ns: int = 20_500_000_000
    """Whether the thing in a place left it, all up to this far away are asked: what stands for a
    while and drives off [ns]."""
    kept_ns: int = 4_000_000_000
    """Images are in memory for so much longer: threads may be that far apart [ns]."""
    rows_deg: float = 2.0
    """Height of a cell of their images [°]; more where the rings of a LiDAR are farther apart."""
    columns: int = 4
    """Columns of a cell of that height: along a ring there are more returns than across."""


VIEWS = ViewTuning()

SIGHT = SightRules(
    behind_m=0.15,
    behind_per_m=0.02,
    same_m=0.05,
    same_per_m=0.01,
    nearest_m=0.3,
    farthest_m=30.0,
    enough=2,
    surely_moved=5,
    surely_met=5,
    gone=2,
    least_ratio=0.5,
    place_m=0.15,
    confirmed=0.7,
)


class KnownPlaceTuning(Struct, frozen=True, kw_only=True):
    """What is known of places while the points of a second are compared."""

    bits: int = 18
    """Logarithm of the number of places that have room."""
    cubes: tuple[int, int, int] = (100, 100, 40)
    """Cubes of `SpreadRules.cube_m` around the body: 10 m to all sides, 4 m up and down."""


KNOWN_PLACES = KnownPlaceTuning()

SPREAD = SpreadRules(
    cube_m=0.2, few=3, most=1.0, stands=6.0, floor_m=0.1, feet_m=0.4, legs_m=1.5, above=5
)

THINGS = ThingRules(cube_m=SPREAD.cube_m, floor_m=0.25, around=2, few=10, surely=0.05, share=0.25)
PARTED = THINGS._replace(surely=0.2)
"""Of what some scan sees through: it stands close to what stands."""
TOUCHING = ThingRules(cube_m=SPREAD.cube_m, floor_m=0.25, around=2, few=10, surely=0.5, share=0.5)
"""Of what no scan meets: it is connected with nothing that stands, but may be a part of it."""


class CarrierVolumeTuning(Struct, frozen=True, kw_only=True):
    """The volume of the carrier in the body."""

    cube_m: float = 0.1
    radius_m: float = 1.0
    """It ends this far from the vertical axis of the body [m]."""
    low_m: float = -2.0
    high_m: float = 0.8
    """And so far below and above it [m]."""
    scans: int = 100
    """It is learned from this many scans of the walk …"""
    views_every_ns: int = 1_000_000_000
    """… which are compared with others this far apart [ns]."""
    occupied: float = 0.1
    """A cube is of the carrier if at least this part of the scans has points in it, three at least,
    and other scans see through more of them than they meet …"""
    least_scans: int = 3
    always: float = 0.9
    """… and it is connected with one that this part of the scans has points in. Of two walks with
    people it is at most 0.78 of those, and 1.0 of the carrier."""


VOLUME = CarrierVolumeTuning()


class CorrectionTuning(Struct, frozen=True, kw_only=True):
    """Corrections of classes by people."""

    slot_ns: int = 100_000_000
    """Times of points are kept this far apart [ns]."""
    anchors: int = 9
    """Most poses that lead a correction into another map."""
    cluster_anchors: int = 3
    """Most poses that lead a cluster: it is small, and a correction has hundreds of them."""
    still_m: float = 0.0005
    """A volume stays as it is if its points moved by less [m]."""
    apart_m: float = 0.10
    """It does not apply if its points moved against each other by more [m]: what was one wall is
    two."""
    wide_m: float = 0.5
    """The turn of a volume is taken from corners at least this far from its middle [m]."""


CORRECTIONS = CorrectionTuning()


class LikenessTuning(Struct, frozen=True, kw_only=True):
    """Clusters that are like one that a person picked."""

    cell_m: float = 0.1
    """Edge of the cells that clusters consist of [m]."""
    shift_m: float = 5e-5
    """Borders of cells lie this far from whole steps of stored coordinates [m]: no point is on
    one."""
    reach_m: float = 0.3
    """A point of the cluster is at most so far from the place that was picked [m]."""
    ground_m: float = 0.3
    """Edge of the cells of the ground [m]."""
    block: int = 1 << 19
    """Points that are read at once."""
    most_cells: int = 4_000_000
    """Cells of a class in a map: some 300 MB and 30 s."""
    beams: int = 300_000
    """Beams that are asked what they see through."""
    least_beams: int = 5
    """With fewer beams through or onto a cluster that is unknown."""
    margin_m: float = 0.3
    """Cells nearer to the end of a beam are not seen through [m]."""
    farthest_m: float = 30.0
    """Longer beams are not asked [m]."""
    cells_ratio: float = 2.5
    """Clusters with this many times the cells of the picked one have the difference 1."""
    length_ratio: float = 0.4
    least_length_m: float = 0.3
    """Extents that differ by such a part, and by as much at least [m], have the difference 1."""
    over_ground_m: float = 0.4
    """Heights above the ground with the difference 1 [m]."""
    planarity: float = 0.3
    seen_through: float = 0.3
    """Values with the difference 1."""


LIKENESS = LikenessTuning()
