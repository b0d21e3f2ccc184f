"""Tuning of clocks: stamps of messages, times of points, order."""

from __future__ import annotations

from msgspec import Struct


class ClockCompareTuning(Struct, frozen=True, kw_only=True):
    """Whether the clocks of two sensors differ (`clock_compare.py`)."""

    other_s: float = 1.0
    """Clocks that differ by less may be messages that travel for longer [s]."""
    steady_s: float = 0.5
    """Messages recorded long after they were sent (a converted bag) say nothing of clocks [s]."""
    travel_s: float = 0.1
    """Messages of sensors on one clock lag behind by amounts that differ by less [s]."""
    lidars_s: float = 0.25
    """Messages of two LiDARs travel for times that differ by less [s]."""
    joint_s: float = 0.25
    """Messages of a joint and of its sensor travel for times that differ by less [s]."""
    least: int = 3
    """Messages of a sensor."""


CLOCK_COMPARE = ClockCompareTuning()


class ClockNameTuning(Struct, frozen=True, kw_only=True):
    """Differences of clocks that have a name (`clock_names.py`)."""

    within_s: float = 0.4
    """A measured difference is this near to the known one [s]."""
    dates_s: float = 1e8
    """A larger one is a date against a time since power-on [s]."""


CLOCK_NAMES = ClockNameTuning()


class ClockJumpTuning(Struct, frozen=True, kw_only=True):
    """Clocks that were set ahead while a recording ran (`clock_jumps.py`)."""

    known_ns: int = 50_000_000
    """A jump as measured between two points is this near to the known difference of clocks [ns]."""
    within: tuple[float, float] = (0.1, 0.9)
    """Samples in this part of a jump have a clock that was not set."""


CLOCK_JUMPS = ClockJumpTuning()


class PointClockTuning(Struct, frozen=True, kw_only=True):
    """Points with times of a clock of their own (`exact_times.py`)."""

    same_clock_ns: int = 500_000_000
    """Points this near to their stamp are on its clock."""
    jump_ns: int = 1_000_000_000
    """A stamp farther from where the points' clock says is wrong, or that clock has jumped."""
    confirm: int = 3
    """Clouds that must agree on a jump."""
    far_ns: int = 1_000_000_000
    """Points farther from the others of their cloud are damaged."""
    many_points: int = 100
    """Fewer points may have one time, intensity or ring."""


POINT_CLOCK = PointClockTuning()


class PointTimeTuning(Struct, frozen=True, kw_only=True):
    """The unit and the meaning of the times of points (`point_times.py`)."""

    units_ns: tuple[float, ...] = (1.0, 1e3, 1e6, 1e9)
    """Units that are tried [ns]."""
    dates: tuple[tuple[float, float], ...] = ((1e17, 1.0), (1e14, 1e3), (1e11, 1e6), (1e8, 1e9))
    """From this value on a time is a date; nanoseconds of one unit."""
    float_units: tuple[tuple[float, float], ...] = ((2.0, 1e9), (2e3, 1e6), (2e6, 1e3), (2e9, 1.0))
    """Largest span -> unit of a fractional time [ns]."""
    turn_s: tuple[float, float] = (0.01, 0.6)
    """Duration of a revolution, from and to [s]; determines the unit of integer times."""
    part_ns: float = 1e8
    """A cloud that is part of a revolution may be timed from the start of the revolution [ns]."""
    counter: int = 1 << 32
    """Where a counter of 32 bits starts again."""
    shortest_cycle_ns: int = 60_000_000_000
    """A cycle of a few seconds would fit any stamp [ns]."""
    bulk: float = 6.0
    """Times within this multiple of the distance of 60 % of them from the middle one are the bulk:
    all of an even revolution, without up to two fifths that are damaged."""
    largest_ns: float = 2.0**62
    """Larger values are no times [ns]."""
    most_damaged: float = 0.2
    """With a larger ratio of damaged times the field is not used."""
    revolutions: float = 2.0
    """Times farther from the others are damaged."""
    part_ratio: tuple[float, float] = (0.2, 1.5)
    """Duration of a cloud that is part of a revolution, from and to, in those from cloud to
    cloud."""
    part_ends: float = 0.05
    """Times from 0 to 1 begin no earlier than this before 0."""
    part: float = 0.5
    """Times from 0 to 1 are spread over at least this much."""
    steps: float = 50.0
    """A revolution is resolved in at least this many steps, or the times are too coarse."""


POINT_TIMES = PointTimeTuning()


class StampTuning(Struct, frozen=True, kw_only=True):
    """Stamps of messages: wrong ones, another clock, late ones (`stamps.py`, `stamp_order.py`)."""

    other_ns: int = 10_000_000_000
    """A stamp that is farther from its place among the others is wrong [ns]."""
    confirm: int = 3
    """Stamps in a row that must agree on another clock: fewer are wrong ones."""
    same_jump_ns: int = 500_000_000
    """Jumps of two topics that differ by less are one: messages travel for different times [ns]."""
    travel_ns: int = 500_000_000
    """A message is recorded within this after its stamp [ns]."""
    step_ns: int = 100_000_000
    """Stamps that step by more between messages that arrive evenly are of a clock that was set."""
    even_ns: int = 50_000_000
    """Messages that arrive evenly are later than usual by less than this [ns]."""
    usual_ns: float = 3e9
    """The usual time between stamp and recording follows a change within this [ns]."""
    strays_ratio: float = 0.05
    """A larger ratio of stamps that are far from their neighbors is no set of wrong ones."""
    head: int = 120
    """Messages at the begin of a bag whose stamps tell whether it was recorded backward."""
    ahead: int = 6
    """Messages that are held back: one that is recorded after this many later ones is too late."""
    most_ahead: int = 14
    """As many are held back until it is certain that no clock was set."""
    set_back: int = 3
    """This many messages with earlier stamps, and no later one among them, are a clock set back."""


STAMPS = StampTuning()


class EvenStampTuning(Struct, frozen=True, kw_only=True):
    """Clouds that follow each other evenly, with stamps that do not (`even_stamps.py`)."""

    least: int = 6
    """Stamps that show a scatter."""
    most: int = 60
    """Stamps through which a line is fitted: a motor keeps its rate for some seconds."""
    gap: float = 10.0
    """Stamps farther apart than this many usual ones are not counted together."""
    near: float = 3.0
    """Those farther off than this many times their scatter do not count."""
    right_ns: float = 1e6
    """Stamps that scatter by no more are right: packets last for about a millisecond [ns]."""
    clouds: int = 3
    """Clouds that show whether their points have times of their own."""
    again: float = 0.5
    """Part of it that is right once stamps were not."""
    than_points: float = 4.0
    """Stamps scatter this many times as much as the points after them, or the clouds are uneven."""
    most_of_period: float = 0.12
    """Stamps that scatter by more of the time from one to the next cannot be numbered."""
    follows: float = 0.3
    """Part of the way to a stamp that the even time goes while they are numbered."""


EVEN_STAMPS = EvenStampTuning()


class SetBackTuning(Struct, frozen=True, kw_only=True):
    """Clocks that were set back (`set_back.py`)."""

    around: int = 7
    """Times before and after that show it. Of 8 million made-up ones that scatter by up to 1.6
    steps none seem set back then; with 6 of them 9 do."""
    least: float = 0.25
    """A shorter way back, of the usual step, is not seen …"""
    least_ns: int = 20_000_000
    """… nor one shorter than this [ns]: messages arrive in order to within it."""
    between: float = 0.75
    """Times nearer to earlier ones than this ratio of a step lie between them …"""
    fewest: int = 2
    """… and fewer such times are no clock that was set back."""
    joined_steps: float = 2.5
    """Parts nearer than this many steps are one recording, given in another order."""
    most: int = 16
    """Times that go back more often are in no order."""
    recent: int = 64
    """Times before that are kept of what arrives one by one, for the usual step."""


SET_BACK = SetBackTuning()


class RecorderStepTuning(Struct, frozen=True, kw_only=True):
    """Recorders of bags that were set back (`formats/bag_clock.py`)."""

    least_ns: int = 20_000_000
    """Messages are written in the order of their times to within this [ns]."""
    joined_ns: int = 500_000_000
    """Parts of a file that are nearer are one recording, joined in another order [ns]."""
    whole_bytes: int = 64 << 20
    """Smaller files are looked at as a whole: a chunk of theirs may last for seconds."""
    messages: int = 4
    """A topic tells it with this many messages on both sides."""
    window: int = 1000
    """Messages before a step that are looked at for the next one."""
    most: int = 32
    """More steps are none of a clock."""


RECORDER_STEPS = RecorderStepTuning()


class FrameTimeTuning(Struct, frozen=True, kw_only=True):
    """Times of files of points (`frame_times.py`, `folders.py`)."""

    assumed_ns: int = 100_000_000
    """Interval of frames without times [ns]."""
    shortest_ns: int = 20_000_000
    longest_ns: int = 250_000_000
    """Plausible intervals of frames [ns]; outside them each frame counts as one revolution."""
    even_ratio: float = 0.5
    """A step between sorted times that is shorter than this ratio of the usual one is uneven …"""
    uneven_ratio: float = 0.02
    """… and a larger ratio of such steps is none of a walk whose files are in another order."""
    run_ratio: float = 0.25
    """Times that go back in fewer of their steps go on in runs."""
    alike_ratio: float = 0.9
    """Files whose names are not of the kind of this ratio of them are looked at one by one."""
    fewest_numbers: int = 5
    """Fewer numbers are no row."""
    row_ratio: float = 0.5
    """Numbers are a row if this ratio of their steps is the same one, and the others are multiples
    of it."""
    earliest_ns: int = 300_000_000 * 1_000_000_000
    """Times before 1979 do not count from 1970."""
    pair_ratio: float = 0.25
    """Two steps that are the usual one together, within this ratio of it: frames of two clocks."""
    fewest_between: int = 2
    """Fewer pairs of such steps in a row are frames that came unevenly."""
    alone_ratio: float = 0.1
    """With a larger ratio of short steps that are no pair, frames are missing all along."""
    more_frames: float = 0.7
    """Two clocks have more frames than fit into the time: at least this ratio of the second's."""
    smaller_ratio: float = 0.75
    """Twice as many frames that are smaller than this ratio of the others: a faster rotation."""
    phase_frames: int = 8
    """The phase of a clock is that of this many frames."""
    missing_steps: int = 3
    """Stretches of two clocks are one, if no more steps are between them: a frame is missing."""
    skipped_cost: float = 0.1
    """A frame that is missing counts as much as this ratio of a step off the phase."""
    between_ratio: float = 0.75
    """Times nearer to earlier ones than this ratio of a step lie between them."""
    joined_steps: float = 2.5
    """Parts nearer than this many steps are one recording, given in another order."""
    pause_ratio: float = 0.9
    """A clock that pauses for this ratio of the length of another was set to it, and back."""
    most_set_back: int = 16
    """A folder has no more of them."""
    even_steps: float = 1.6
    """With a usual step that is longer than the median by this, frames are missing."""
    long_step_percent: float = 90.0
    """Where most frames lie between others, the usual step is among the longest."""


FRAME_TIMES = FrameTimeTuning()
