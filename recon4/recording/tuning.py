"""Tuning of the readers."""

from __future__ import annotations

from dataclasses import dataclass

from msgspec import Struct

from recon4.settings import IngestSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class IngestTuning(IngestSettings):
    """Reading a recording: times of packets and messages (docs/reference/recordings.md)."""

    reorder_window_s: float = 0.2
    """Packets out of order by at most this are sorted [s]."""
    gap_s: float = 0.2
    """A jump of the clock larger than this is reported as a gap [s]."""


class RecipeTuning(Struct, frozen=True, kw_only=True):
    """What the points of a recipe must be like (`recon4/recording/recipes`)."""

    nearest_m: float = 0.2
    """Half of the points of a cloud are farther away [m]; a unit that is wrong is so by 10 and
    more."""
    farthest_m: float = 150.0
    """Half of them are nearer [m]; LiDARs of backpacks measure 100 to 300 m at most."""
    angle_tolerance_rad: float = 0.1
    """By which angles may be beyond a turn, or beyond the zenith [rad]."""
    cloud_periods: tuple[float, float] = (0.1, 5.0)
    """Duration of a cloud in those from cloud to cloud: part of a turn, or clouds that were not
    recorded; units differ by 1000."""
    coarsest: float = 0.02
    """Largest step of the times in durations from cloud to cloud, as in `PointClock`."""
    cone_rad: float = 0.005
    """Median spread of the elevations of a ring [rad], 0.3°, as for rings of clouds."""
    turn_rad: float = 2.0
    """Points that turn to the left by more are mirrored [rad]; a scan to and fro turns less in one
    direction for all of its rings."""
    fewest_points: int = 20
    """A list with fewer is none of a LiDAR."""
    latest_ns: int = 1 << 61
    """No clock shows more before 2043; a sum of three is below the largest number of 64 bits."""


RECIPES = RecipeTuning()


class SharedTopicTuning(Struct, frozen=True, kw_only=True):
    """How topics that several LiDARs share are known (`formats/shared_topics.py`)."""

    head: int = 12
    """Messages from which the sensors of a topic are known, at least."""
    packets: int = 600
    """Of packets, which may come one a message: this many, too; about half a second of a LiDAR."""
    often: int = 2
    """Parts of messages of a sensor among them; a driver that changes its frame once is one
    sensor."""
    rare: float = 0.05
    """A smaller ratio of all parts is no sensor: packets with damaged bytes."""


SHARED_TOPICS = SharedTopicTuning()


class ListedTuning(Struct, frozen=True, kw_only=True):
    """How much of one kind a message names; the rest is counted."""

    names: int = 20
    """Topics, files, gaps."""
    streams: int = 10
    """Senders of a capture, each with a line."""
    few: int = 5
    """Examples within a sentence."""
    characters: int = 300
    """Of a line of a file."""
    sizes: int = 3
    """Sizes of the packets of a sender."""


LISTED = ListedTuning()


class ProbeTuning(Struct, frozen=True, kw_only=True):
    """How much of a recording tells what it holds."""

    messages: int = 50
    """Messages of a topic."""
    stamps: int = 9
    """Messages whose stamps and times of recording tell the time from one to the next."""
    packets: int = 4500
    """Packets at the beginning of a topic from which its sensor is known: more than a second, as
    some send their angles once a second."""
    whole_bytes: int = 64 << 20
    """Files up to this size are read completely."""
    whole_packets: int = 100_000
    """Above this number of datagrams the counts of a small capture file are estimates too."""
    head_packets: int = 4000
    """Datagrams of a larger file from which its counts are estimated."""
    head_items: int = 40
    """Batches of points of a recording that `info` decodes."""
    head_ns: int = 1_000_000_000
    scan_datagrams: int = 20_000
    """Datagrams at the head of a file from which its streams of scans are known, …"""
    scan_batches: int = 16
    """… and batches of them."""
    head_step_ns: int = 5_000_000
    """Lines of a table that are looked at are this far apart [ns]."""
    files: int = 3
    """Files of a folder of points."""


PROBE = ProbeTuning()
