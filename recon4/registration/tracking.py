"""Whether an odometry knows where it is: a state machine with one table of transitions."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum, auto

from recon4.registration.lost import LostLimits
from recon4.registration.tuning_motion import TRACKING
from recon4.settings import OdometrySettings


class Mode(Enum):
    """What the pose of the last multiframe rests on."""

    TRACKING = auto()
    """It lies on the local map."""
    LOST = auto()
    """It does not; the predicted pose is kept."""
    BRIDGED = auto()
    """Only a registration to the scans before a gap says where it is."""
    PLACED = auto()
    """Only fixes say where it is."""
    RESTARTED = auto()
    """The local map was given up; the next multiframe begins another one."""


class Seen(Enum):
    """What a multiframe, or a gap before it, shows."""

    FITS = auto()
    MISSES = auto()
    CROSSES_GAP = auto()
    """A scan after a gap surely lies on those before it."""
    PLACED = auto()
    """A scan of which the map says too little, and fixes enough."""
    GAP = auto()
    """The motion since the last multiframe is not known."""
    LOST_FOR_LONG = auto()
    """An IMU has predicted the motion since, and the map no longer shows the place."""
    SURE_AGAIN = auto()
    """Without an IMU: the scans since tracking was lost are sure of their motion."""


NEXT: Mapping[tuple[Mode, Seen], Mode] = {
    (Mode.TRACKING, Seen.FITS): Mode.TRACKING,
    (Mode.TRACKING, Seen.MISSES): Mode.LOST,
    (Mode.TRACKING, Seen.CROSSES_GAP): Mode.BRIDGED,
    (Mode.TRACKING, Seen.PLACED): Mode.PLACED,
    (Mode.TRACKING, Seen.GAP): Mode.RESTARTED,
    (Mode.LOST, Seen.FITS): Mode.TRACKING,
    (Mode.LOST, Seen.MISSES): Mode.LOST,
    (Mode.LOST, Seen.CROSSES_GAP): Mode.BRIDGED,
    (Mode.LOST, Seen.PLACED): Mode.PLACED,
    (Mode.LOST, Seen.GAP): Mode.RESTARTED,
    (Mode.LOST, Seen.LOST_FOR_LONG): Mode.RESTARTED,
    (Mode.LOST, Seen.SURE_AGAIN): Mode.RESTARTED,
    (Mode.BRIDGED, Seen.FITS): Mode.TRACKING,
    (Mode.BRIDGED, Seen.MISSES): Mode.LOST,
    (Mode.BRIDGED, Seen.CROSSES_GAP): Mode.BRIDGED,
    (Mode.BRIDGED, Seen.PLACED): Mode.PLACED,
    (Mode.BRIDGED, Seen.GAP): Mode.RESTARTED,
    (Mode.PLACED, Seen.FITS): Mode.TRACKING,
    (Mode.PLACED, Seen.MISSES): Mode.LOST,
    (Mode.PLACED, Seen.CROSSES_GAP): Mode.BRIDGED,
    (Mode.PLACED, Seen.PLACED): Mode.PLACED,
    (Mode.PLACED, Seen.GAP): Mode.RESTARTED,
    (Mode.RESTARTED, Seen.FITS): Mode.TRACKING,
    (Mode.RESTARTED, Seen.CROSSES_GAP): Mode.BRIDGED,
    (Mode.RESTARTED, Seen.GAP): Mode.RESTARTED,
}
"""The only transitions. The first multiframe of a map fits, whatever it shows."""


class TrackingState:
    """The only owner of what is lost, which piece this is, and how often the map began again."""

    def __init__(self, settings: OdometrySettings) -> None:
        self.mode = Mode.RESTARTED
        self.limits = LostLimits(settings)
        self.piece = 0
        """Number of the piece of the walk; the motion from one to the next is not known."""
        self.lost_frames = 0
        """Lost in a row."""
        self._tracked_frames = self._resets = 0

    @property
    def is_velocity_known(self) -> bool:
        """Whether the two frames before were tracked in this piece."""
        return self._tracked_frames >= 2 and not self.lost_frames

    def next(self, seen: Seen) -> Mode:
        """Go on to the next mode.

        Raises:
            KeyError: If there is no such transition.
        """
        self.mode = NEXT[self.mode, seen]
        match self.mode:
            case Mode.TRACKING | Mode.BRIDGED | Mode.PLACED:
                self.lost_frames = 0
                self._tracked_frames += 1
            case Mode.LOST:
                self.lost_frames += 1
            case Mode.RESTARTED:
                self._restart(seen)
        return self.mode

    def _restart(self, seen: Seen) -> None:
        """Count a reset of the map; another piece begins unless the IMU knows the motion.

        It does not if the map before was lost soon, too: then the state itself is wrong.
        """
        trusted = self._tracked_frames >= TRACKING.trusted_frames or not self._resets + self.piece
        if seen is Seen.LOST_FOR_LONG:
            self._resets += 1
        if not (seen is Seen.LOST_FOR_LONG and trusted):
            self.piece += 1
        self.lost_frames = self._tracked_frames = 0
