"""The words of each count of an import: what it means, and whether data was lost.

Readers count what they find (`ImportReport.count`). Each name of a count is listed here; a test
finds names without words.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

FREE_CLOCK = "clock_runs_freely_"
"""Count, followed by the name of a LiDAR whose stamps count from power-on."""


class CountKind(StrEnum):
    """Meaning of a count."""

    READ = "read"
    """How much there was."""
    USUAL = "usual"
    """As expected of a good recording, or a part of another count."""
    REPAIRED = "repaired"
    """Damage that was repaired, or data that was converted: nothing is missing."""
    REPLACED = "replaced"
    """Data that could not be used, and what stands in for it is worse: a warning like a loss."""
    LOST = "lost"
    """Data that was in the recording, or should have been, and is not used."""


@dataclass(frozen=True, slots=True)
class CountWording:
    """One count in words."""

    kind: CountKind
    text: str
    """What is counted (`READ`), or what became of it."""
    of: str = ""
    """Name of the count of all of them; empty = none."""
    apart: bool = False
    """Whether the count `of` leaves these out."""
    stated: bool = False
    """Whether the reader itself warns, with the place."""
    noun: str = ""
    """What is counted, where there is no count `of`; of a `READ`: what it is a part of."""


def _read(text: str, *, noun: str = "") -> CountWording:
    return CountWording(CountKind.READ, text, noun=noun)


def _usual(of: str, text: str, *, noun: str = "") -> CountWording:
    return CountWording(CountKind.USUAL, text, of, noun=noun)


def _repaired(of: str, text: str, *, noun: str = "") -> CountWording:
    return CountWording(CountKind.REPAIRED, text, of, noun=noun)


def _lost(of: str, text: str, *, apart: bool = False, stated: bool = False) -> CountWording:
    return CountWording(CountKind.LOST, text, of, apart, stated)


def _stated(text: str, *, noun: str) -> CountWording:
    return CountWording(CountKind.LOST, text, stated=True, noun=noun)


_NO_STAMP = "without a stamp, the time of recording is used"
_CAPTURES = {
    "records": _read("captured packets"),
    "records_not_udp": _usual("records", "no UDP over IPv4, not read"),
    "records_fragment": _lost(
        "records", "IP fragments of datagrams whose other fragments are missing"
    ),
    "records_cut": _lost(
        "records", "cut when they were captured (snap length): capture again with tcpdump -s 0"
    ),
    "records_damaged": _lost(
        "records", "of no known type, with the rest of their frame", apart=True
    ),
    "records_of_unknown_device": _lost("records", "of devices that are not listed", apart=True),
    "records_without_time": _lost("records", "without a time of capture, dropped", apart=True),
    "files_cut": _stated("end inside a packet, or are damaged: read up to there", noun="files"),
}
_PACKETS = {
    "packets": _read("data packets"),
    "packets_wrong_length": _lost(
        "packets", "not as long as those of the sensor, dropped", apart=True
    ),
    "packets_wrong_flag": _lost("packets", "blocks without their flag, dropped"),
    "packets_hdl64": _lost("packets", "blocks of the lower lasers of an HDL-64E, dropped"),
    "packets_wrong_azimuth": _lost("packets", "an azimuth above 360°, dropped"),
    "packets_other_product": _lost("packets", "another product byte than the first ones, dropped"),
    "packets_wrong_header": _lost(
        "packets", "a version, type or length of another packet, dropped"
    ),
    "packets_wrong_stamp": _lost("packets", "a time stamp that is none, dropped"),
    "packets_wrong_speed": _lost(
        "packets", "a motor faster than 3600 revolutions a minute, dropped"
    ),
    "packets_wrong_crc": _lost("packets", "damaged by their CRC, dropped"),
    "packets_of_another_sensor": _lost("packets", "another serial number, dropped", stated=True),
    "packets_wrong_columns": _lost("packets", "columns that do not follow each other, dropped"),
    "packets_without_columns": _usual("packets", "without a measured column"),
    "packets_wrong_clock": _lost("packets", "a time more than 1 s off, dropped"),
    "packets_late": _lost("packets", "arrived after their place had passed, dropped"),
    "packets_missing": _lost("packets", "never arrived: check cable and recorder", apart=True),
    "packets_past_hour": _repaired("packets", "a time past the end of the hour, continued"),
    "packets_duplicate": _repaired("packets", "received twice, the copies dropped"),
    "packets_out_of_order": _repaired("packets", "out of order, sorted"),
    "azimuth_jumps": _usual("packets", "azimuth jumps, the step before is used"),
    "positions": _read("position packets"),
    "positions_wrong_time": _lost("positions", "a time more than 1 s off, dropped"),
    "positions_out_of_order": _lost("positions", "earlier than the one before, dropped"),
    FREE_CLOCK: _usual("", "run freely, shifted to the recorder's clock", noun="clocks"),
    "clock_jumps": _repaired("", "jumps, the times go on without them", noun="clocks"),
    "clock_jumps_back": _repaired("", "set back, the times go on", noun="clocks"),
}
_POINTS = {
    "points": _read("points"),
    "points_no_return": _usual("", "without an echo", noun="shots"),
    "points_near": _usual("", "nearer than ingest.min_range_m", noun="points"),
    "points_blind": _usual("", "nearer than their LiDAR measures well", noun="points"),
    "points_far": _usual("", "farther than ingest.max_range_m", noun="points"),
    "points_noise": _usual("", "noise of high confidence by their tag, left out", noun="points"),
    "points_invalid": _usual("", "not finite or at the origin: no echo", noun="points"),
    "points_wrong_time": _lost(
        "points", "a time more than two revolutions from the others, dropped", apart=True
    ),
    "points_without_time": _lost("points", "no time, dropped", apart=True),
    "points_of_lidars_not_in_rig": _usual(
        "", "of LiDARs that the rig does not list", noun="points"
    ),
    "points_without_joint": _lost(
        "points", "without a pose of the joint that moves their sensor, left out", apart=True
    ),
    "points_late": _lost(
        "points", "came after their frame was done, dropped: are the clocks of the sensors equal?"
    ),
    "points_of_beams_without_correction": _usual(
        "points", "of beams that the rig file does not correct"
    ),
    "points_of_incomplete_frames": _usual("points", "of the incomplete first or last frame"),
    "intensity_wrong": _repaired("points", "an intensity that is no number, 0 is stored"),
    "intensity_clipped": _repaired("points", "an intensity outside 0..65535, clipped"),
    "rings_wrong": _repaired("points", "a ring that is no number from 0 to 255, from elevation"),
    "frames_empty": _usual("", "without points, left out", noun="frames"),
    "frames_incomplete_dropped": _usual("", "incomplete, at the start or end", noun="frames"),
    "frames_moved": _repaired("", "not later than the one before, moved behind it", noun="frames"),
    "frames_without_": _usual("", "without points of this sensor", noun="frames"),
    "packets_missing_": _usual("", "never arrived of this sensor", noun="data packets"),
    "gaps": _stated("gaps in the data", noun="times"),
    "files": _read("files"),
    "files_corrupt": _lost("files", "cannot be read, left out", stated=True),
    "files_damaged": _stated("damaged, left out", noun="files"),
    "files_out_of_order": _repaired("files", "numbers in another order than their times, sorted"),
    "imu_files_missing": _stated("missing: no IMU samples there", noun="files imu*.csv"),
    "files_missing": _stated("named in metadata.yaml, not there", noun="files"),
}
_MESSAGES = {
    "messages": _read("messages"),
    "messages_corrupt": _lost("messages", "cannot be decoded, left out", stated=True),
    "messages_of_no_lidar": _lost(
        "messages", "(or parts) of none of the LiDARs in their topic, not read", apart=True
    ),
    "messages_missing": _lost("messages", "missing of those listed", apart=True, stated=True),
    "messages_salvaged": _usual("", "salvaged from a damaged file", noun="messages"),
    "chunks_damaged": _stated("damaged, left out", noun="chunks of a bag"),
    "transforms_invalid": _stated("make no sense, left out", noun="transforms (tf)"),
    "transforms_beyond_limit": _stated("more than are read, left out", noun="transforms (tf)"),
    "transforms_contradictory": _usual(
        "", "stated in different ways or against others", noun="transforms (tf)"
    ),
    "robot_descriptions_refused": _stated("not read", noun="descriptions of a robot (URDF)"),
    "clouds": _read("clouds"),
    "clouds_duplicate": _repaired("clouds", "recorded twice, the copies dropped"),
    "clouds_late": _lost("clouds", "recorded after many later ones, left out", apart=True),
    "clouds_wrong_times": CountWording(
        CountKind.REPLACED,
        "the times of their points make no sense, they are taken from the azimuth or the stamp",
        "clouds",
    ),
    "clouds_untimed": _usual("clouds", "without times of their points"),
    "stamps_missing": _repaired("clouds", _NO_STAMP),
    "stamps_wrong": _repaired("clouds", "a stamp of another time, the time of recording is used"),
    "remarks_more": _usual("", "left out here", noun="different remarks"),
}
_SAMPLES = {
    "imu_samples": _read("IMU samples received"),
    "imu_samples_not_read": _read("samples of the IMUs of other LiDARs"),
    "imu_kept": _read("IMU samples used", noun="IMU samples"),
    "imu_nan": _lost("imu_kept", "no numbers, dropped", apart=True),
    "imu_without_stamp": _repaired("imu_kept", _NO_STAMP),
    "imu_wrong_time": _lost("imu_kept", "a stamp of another time, dropped", apart=True),
    "imu_lines_damaged": _lost("imu_kept", "damaged lines of the file, dropped", apart=True),
    "imu_duplicate": _lost("imu_kept", "the time of another, dropped", apart=True),
    "imu_copies": _usual("", "copies of the one before, dropped", noun="IMU samples"),
    "imu_repeated": _lost("imu_kept", "repeated by the driver, dropped", apart=True, stated=True),
    "imu_unsorted": _repaired("imu_kept", "earlier than the one before, sorted"),
    "imu_jumps_back": _repaired("", "jumps back with the LiDARs", noun="times"),
    "imu_accel_interpolated": _repaired("imu_kept", "without an acceleration, interpolated"),
    "imu_accel_missing": _lost(
        "imu_kept", "without an acceleration for too long, dropped", apart=True, stated=True
    ),
    "imu_accel_scaled": _repaired("imu_kept", "accelerations in another unit, stored in m/s²"),
    "imu_gyro_scaled": _repaired("imu_kept", "angular rates in deg/s, stored in rad/s"),
    "imu_gyro_assumed": _usual("imu_kept", "angular rates that may be in deg/s, taken as rad/s"),
    "gnss_samples": _read("GNSS positions received"),
    "gnss_kept": _read("GNSS positions used", noun="GNSS positions"),
    "gnss_nan": _lost("gnss_kept", "no place on earth, dropped", apart=True),
    "gnss_at_zero": _lost("gnss_kept", "at latitude and longitude 0, dropped", apart=True),
    "gnss_constant": _lost("gnss_kept", "one position for all, dropped", apart=True, stated=True),
    "gnss_no_fix": _usual("", "without a fix", noun="GNSS positions"),
    "gnss_without_stamp": _repaired("gnss_kept", _NO_STAMP),
    "gnss_wrong_time": _lost("gnss_kept", "a stamp of another time, dropped", apart=True),
    "gnss_lines_damaged": _lost("gnss_kept", "damaged lines of the file, dropped", apart=True),
    "gnss_duplicate": _lost("gnss_kept", "the time of another, dropped", apart=True),
    "gnss_copies": _usual("", "copies of the one before, dropped", noun="GNSS positions"),
    "gnss_unsorted": _repaired("gnss_kept", "earlier than the one before, sorted"),
    "gnss_heights_unstated": _usual("", "with a height of unknown kind", noun="GNSS positions"),
    "gnss_heights_orthometric": _usual(
        "", "with a height above sea level alone", noun="GNSS positions"
    ),
    "nmea_damaged": _lost("gnss_samples", "damaged sentences, dropped", apart=True),
    "nmea_no_fix": _usual("", "without a fix", noun="NMEA sentences"),
    "sample_datagrams": _read("datagrams of IMU and GNSS"),
    "samples_damaged": _lost("sample_datagrams", "damaged samples, dropped"),
    "samples_out_of_order": _lost("sample_datagrams", "earlier than the one before, dropped"),
    "poses": _read("poses for comparison"),
    "poses_damaged": _lost("poses", "damaged lines of the file, dropped", apart=True),
    "poses_without_stamp": _repaired("poses", _NO_STAMP),
    "poses_wrong_time": _lost("poses", "a stamp of another time, dropped", apart=True),
}
_SCANS = {
    "scans": _read("scans of the 2-D laser"),
    "scans_damaged": _lost("scans", "cannot be decoded, left out", apart=True),
    "scans_out_of_order": _lost(
        "scans", "earlier than the one before, left out", apart=True, stated=True
    ),
    "scans_unsorted": _repaired("scans", "earlier than the one before, sorted"),
    "scans_duplicate": _lost("scans", "the time of another, left out", apart=True),
    "scans_repeated": _usual(
        "", "repeated in other messages, the copies are left out", noun="scans"
    ),
    "scans_of_another_message": _lost(
        "scans", "in messages of another kind, left out", apart=True, stated=True
    ),
    "scans_without_angles": _lost("scans", "without angles of their beams, left out", apart=True),
    "scans_of_the_rear_laser": _usual("", "of the rear laser, not used", noun="scans"),
    "scans_without_returns": _usual("scans", "without any return"),
    "scans_of_another_last_angle": _repaired(
        "scans", "a last angle that contradicts the step between beams, which counts"
    ),
    "scans_of_wrong_beam_times": _repaired(
        "scans", "times of beams below 0 or above 10 s, not undistorted"
    ),
    "scans_mirrored": _repaired("scans", "beams in the other direction, turned round"),
    "scans_converted": _repaired("scans", "ranges in millimeters, converted"),
    "beams": _read("beams"),
    "beams_off_grid": _lost("beams", "between the places of a scan, left out"),
    "ranges_not_numbers": _stated("negative or no numbers, left out", noun="ranges"),
    "scans_wrong_time": _repaired(
        "scans", "a stamp of another time or none, the time of recording is used"
    ),
    "rows": _read("rows of tables"),
    "rows_damaged": _lost("rows", "damaged lines of the file, dropped", apart=True),
    "rows_wrong_time": _lost("rows", "a time far from its neighbors, dropped", apart=True),
    "lines": _read("line scans"),
    "lines_wrong_time": _repaired(
        "lines", "a stamp of another time or none, the time of recording is used"
    ),
    "lines_converted": _repaired("lines", "ranges in another unit, converted"),
    "lines_empty": _usual("", "without a return", noun="line scans"),
    "lines_missing": _lost("lines", "never arrived", apart=True),
    "lines_out_of_order": _lost("lines", "earlier than the one before, left out", apart=True),
    "lines_without_angle": _lost(
        "lines", "without an angle or a pose of the head, left out", stated=True
    ),
    "head_angles_invalid": _lost("messages", "angles of the head that are no numbers, left out"),
    "joint_poses_wrong_time": _lost("messages", "poses of a joint of another time, left out"),
    "joint_poses_repeated": _usual("", "of a time that was there before", noun="poses of a joint"),
    "joint_poses_beyond_limit": _lost("messages", "poses of a joint beyond the limit, left out"),
    "head_stands": _stated("the head stands still", noun="times"),
}
COUNT_WORDINGS: dict[str, CountWording] = {
    **_CAPTURES,
    **_PACKETS,
    **_POINTS,
    **_MESSAGES,
    **_SAMPLES,
    **_SCANS,
}
"""Name of a count -> its words; a name that ends with ``_`` is followed by that of a sensor."""
