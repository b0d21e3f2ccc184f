"""Tuning of the choice of topics and of the contents of clouds."""

from __future__ import annotations

import numpy as np
from msgspec import Struct


class TopicContentTuning(Struct, frozen=True, kw_only=True):
    """What a topic of a bag measures (`topic_contents.py`)."""

    probed_messages: int = 200
    probed_clouds: int = 5
    """Clouds and scans of packets are large."""
    probed_ns: int = 60_000_000_000
    """From the first of their messages on; a topic that begins later does not cover the bag."""
    covered: float = 0.8
    """A topic with less of the time of the bag is said to be incomplete."""
    slow_hz: float = 50.0
    """A slower IMU does not follow the steps of a walker."""
    wide_deg: float = 90.0
    """A LiDAR that sees less is said to be narrow [°]."""


TOPIC_CONTENTS = TopicContentTuning()


class LidarChoiceTuning(Struct, frozen=True, kw_only=True):
    """Which topics are LiDARs, and which are copies of others (`lidar_choice.py`,
    `topic_choice.py`).
    """

    wide_deg: float = 180.0
    """A LiDAR that sees more comes first [°]."""
    widest_camera_rad: float = float(np.deg2rad(65.0))
    """Half of the widest view of a depth camera."""
    fewer: float = 0.9
    """A cloud with fewer than this ratio of the points of another one is made of it."""
    same_stamps: float = 0.5
    """Ratio of equal stamps of two topics with the same clouds."""
    same_step_m: float = 2e-3
    same_steps: float = 0.99
    """Steps from point to point of a copied cloud are the same, also when it was turned [m]; ratio
    of them."""
    copies_within: int = 4
    """Messages of a topic among which a copy of a cloud is looked for."""
    assumed_period_ns: int = 100_000_000
    """From one message to the next, where their stamps do not tell [ns]."""


LIDAR_CHOICE = LidarChoiceTuning()


class CloudTuning(Struct, frozen=True, kw_only=True):
    """Beams and units of clouds (`cloud_points.py`, `extent.py`)."""

    bands: int = 64
    """Bands of elevation that stand for the beams of a cloud without rings."""
    one_beam_rad: float = float(np.deg2rad(5.0))
    """A tilted beam spreads over less elevation."""
    middle: tuple[float, float] = (5.0, 95.0)
    """Percentiles of the coordinates: single damaged points do not count."""
    outside: float = 3.0
    """An origin that is farther from the middle of the points than this multiple of their extent is
    that of a coordinate system, not of a sensor."""
    millimeters_m: float = 300.0
    """No LiDAR of a backpack measures half of its points farther away [m]; in millimeters they are
    in all but the narrowest places."""


CLOUDS = CloudTuning()


class BinFileTuning(Struct, frozen=True, kw_only=True):
    """Files of numbers without a header (`formats/bin_layout.py`)."""

    widths: tuple[int, ...] = (4, 5, 6)
    """Numbers in a row: of KITTI, nuScenes (with rings), Boreas (with rings and times)."""
    clearer: float = 0.2
    """Numbers below each other are more alike by this than in rows of four, of -2..2; of 54
    simulated clouds, in and out of order, the right width leads by 0.59 and more."""
    fewest_rows: int = 20
    """Fewer tell nothing: four in a row are taken."""
    looked_at: int = 1600
    """What tells such a file [bytes]."""
    largest: float = 1e5
    """Of a number in it."""


BIN_FILES = BinFileTuning()


class BagImuTuning(Struct, frozen=True, kw_only=True):
    """Samples of bags."""

    batch: int = 500
    """Delivered at a time."""


BAG_IMU = BagImuTuning()
