"""What each count of an import means: whether data was lost, and of how much.

Readers count what they find (`ImportReport.count`). Each name of a count is listed here,
and has its words in ``recon4/locales``; a test finds names without either.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

FREE_CLOCK = "clock_runs_freely_"
"""Count, followed by the name of a LiDAR whose stamps count from power-on."""
JUMPS_OF = "clock_jumps_of_"
"""Count of the jumps of one source's clock, followed by its name."""


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
class CountMeaning:
    """What one count means. Its words are the message ``count-NAME`` of ``counts.ftl``.

    They say what is counted (`READ`), or what became of it; their part ``noun`` says what is
    counted where there is no count `of`, and of a `READ` what it is a part of.
    """

    kind: CountKind
    of: str = ""
    """Name of the count of all of them; empty = none."""
    apart: bool = False
    """Whether the count `of` leaves these out."""
    stated: bool = False
    """Whether the reader itself warns, with the place."""


_READ = CountMeaning(CountKind.READ)


def _usual(of: str = "") -> CountMeaning:
    return CountMeaning(CountKind.USUAL, of)


def _repaired(of: str = "") -> CountMeaning:
    return CountMeaning(CountKind.REPAIRED, of)


def _lost(of: str, *, apart: bool = False, stated: bool = False) -> CountMeaning:
    return CountMeaning(CountKind.LOST, of, apart, stated)


_STATED = CountMeaning(CountKind.LOST, stated=True)

_CAPTURES = {
    "records": _READ,
    "records_not_udp": _usual("records"),
    "records_fragment": _lost("records"),
    "records_cut": _lost("records"),
    "records_damaged": _lost("records", apart=True),
    "records_of_unknown_device": _lost("records", apart=True),
    "records_without_time": _lost("records", apart=True),
    "files_cut": _STATED,
    "captures_joined": _repaired(),
}
_PACKETS = {
    "packets": _READ,
    "packets_wrong_length": _lost("packets", apart=True),
    "packets_wrong_flag": _lost("packets"),
    "packets_hdl64": _lost("packets"),
    "packets_wrong_azimuth": _lost("packets"),
    "packets_other_product": _lost("packets"),
    "packets_wrong_header": _lost("packets"),
    "packets_wrong_stamp": _lost("packets"),
    "packets_wrong_speed": _lost("packets"),
    "packets_wrong_crc": _lost("packets"),
    "packets_of_another_sensor": _lost("packets", stated=True),
    "packets_wrong_columns": _lost("packets"),
    "packets_without_columns": _usual("packets"),
    "packets_wrong_clock": _lost("packets"),
    "packets_late": _lost("packets"),
    "packets_missing": _lost("packets", apart=True),
    "packets_past_hour": _repaired("packets"),
    "packets_duplicate": _repaired("packets"),
    "packets_out_of_order": _repaired("packets"),
    "azimuth_jumps": _usual("packets"),
    "positions": _READ,
    "positions_wrong_time": _lost("positions"),
    "positions_out_of_order": _lost("positions"),
    "positions_duplicate": _repaired("positions"),
    FREE_CLOCK: _usual(),
    "clock_jumps": _repaired(),
    JUMPS_OF: _usual(),
    "clock_jumps_back": _repaired(),
}
_POINTS = {
    "points": _READ,
    "points_no_return": _usual(),
    "points_near": _usual(),
    "points_blind": _usual(),
    "points_far": _usual(),
    "points_noise": _usual(),
    "points_invalid": _usual(),
    "points_wrong_time": _lost("points", apart=True),
    "points_without_time": _lost("points", apart=True),
    "points_of_lidars_not_in_rig": _usual(),
    "points_without_joint": _lost("points", apart=True),
    "points_late": _lost("points"),
    "points_of_beams_without_correction": _usual("points"),
    "points_of_incomplete_frames": _usual("points"),
    "intensity_wrong": _repaired("points"),
    "intensity_clipped": _repaired("points"),
    "rings_wrong": _repaired("points"),
    "frames_empty": _usual(),
    "frames_incomplete_dropped": _usual(),
    "frames_moved": _repaired(),
    "frames_without_": _usual(),
    "packets_missing_": _usual(),
    "gaps": _STATED,
    "files": _READ,
    "files_absent": _lost("files", apart=True),
    "files_corrupt": _lost("files", stated=True),
    "files_damaged": _STATED,
    "files_out_of_order": _repaired("files"),
    "status_files_damaged": _repaired(),
    "imu_files_missing": _STATED,
    "files_missing": _STATED,
}
_MESSAGES = {
    "messages": _READ,
    "messages_corrupt": _lost("messages", stated=True),
    "messages_of_no_lidar": _lost("messages", apart=True),
    "messages_missing": _lost("messages", apart=True, stated=True),
    "messages_salvaged": _usual(),
    "chunks_damaged": _STATED,
    "transforms_invalid": _STATED,
    "transforms_beyond_limit": _STATED,
    "transforms_contradictory": _usual(),
    "robot_descriptions_refused": _STATED,
    "clouds": _READ,
    "clouds_duplicate": _repaired("clouds"),
    "clouds_evened": _repaired("clouds"),
    "clouds_other_order": _repaired("clouds"),
    "clouds_late": _lost("clouds", apart=True),
    "clouds_wrong_times": CountMeaning(CountKind.REPLACED, "clouds"),
    "clouds_untimed": _usual("clouds"),
    "stamps_missing": _repaired("clouds"),
    "stamps_wrong": _repaired("clouds"),
    "remarks_more": _usual(),
}
_SAMPLES = {
    "imu_samples": _READ,
    "imu_samples_not_read": _READ,
    "imu_kept": _READ,
    "imu_nan": _lost("imu_kept", apart=True),
    "imu_without_stamp": _repaired("imu_kept"),
    "imu_wrong_time": _lost("imu_kept", apart=True),
    "imu_lines_damaged": _lost("imu_kept", apart=True),
    "imu_duplicate": _lost("imu_kept", apart=True),
    "imu_copies": _usual(),
    "imu_repeated": _lost("imu_kept", apart=True, stated=True),
    "imu_unsorted": _repaired("imu_kept"),
    "imu_in_bursts": _repaired("imu_kept"),
    "imu_jumps_back": _repaired(),
    "imu_jumps_ahead": _repaired(),
    "imu_accel_interpolated": _repaired("imu_kept"),
    "imu_accel_missing": _lost("imu_kept", apart=True, stated=True),
    "imu_accel_scaled": _repaired("imu_kept"),
    "imu_gyro_scaled": _repaired("imu_kept"),
    "imu_gyro_assumed": _usual("imu_kept"),
    "gnss_samples": _READ,
    "gnss_kept": _READ,
    "gnss_nan": _lost("gnss_kept", apart=True),
    "gnss_at_zero": _lost("gnss_kept", apart=True),
    "gnss_constant": _lost("gnss_kept", apart=True, stated=True),
    "gnss_no_fix": _usual(),
    "gnss_without_stamp": _repaired("gnss_kept"),
    "gnss_wrong_time": _lost("gnss_kept", apart=True),
    "gnss_lines_damaged": _lost("gnss_kept", apart=True),
    "gnss_messages_damaged": _lost("gnss_kept", apart=True),
    "gnss_duplicate": _lost("gnss_kept", apart=True),
    "gnss_copies": _usual(),
    "gnss_unsorted": _repaired("gnss_kept"),
    "gnss_heights_unstated": _usual(),
    "gnss_heights_orthometric": _usual(),
    "nmea_damaged": _lost("gnss_samples", apart=True),
    "nmea_no_fix": _usual(),
    "sample_datagrams": _READ,
    "samples_damaged": _lost("sample_datagrams"),
    "samples_out_of_order": _lost("sample_datagrams"),
    "poses": _READ,
    "poses_damaged": _lost("poses", apart=True),
    "poses_without_stamp": _repaired("poses"),
    "poses_wrong_time": _lost("poses", apart=True),
}
_SCANS = {
    "scans": _READ,
    "scans_damaged": _lost("scans", apart=True),
    "scans_out_of_order": _lost("scans", apart=True, stated=True),
    "scans_unsorted": _repaired("scans"),
    "scans_duplicate": _lost("scans", apart=True),
    "scans_repeated": _usual(),
    "scans_of_another_message": _lost("scans", apart=True, stated=True),
    "scans_without_angles": _lost("scans", apart=True),
    "scans_of_the_rear_laser": _usual(),
    "scans_without_returns": _usual("scans"),
    "scans_of_another_last_angle": _repaired("scans"),
    "scans_of_wrong_beam_times": _repaired("scans"),
    "scans_mirrored": _repaired("scans"),
    "scans_converted": _repaired("scans"),
    "beams": _READ,
    "beams_off_grid": _lost("beams"),
    "ranges_not_numbers": _STATED,
    "scans_wrong_time": _repaired("scans"),
    "rows": _READ,
    "rows_damaged": _lost("rows", apart=True),
    "rows_wrong_time": _lost("rows", apart=True),
    "lines": _READ,
    "lines_wrong_time": _repaired("lines"),
    "lines_converted": _repaired("lines"),
    "lines_empty": _usual(),
    "lines_missing": _lost("lines", apart=True),
    "lines_out_of_order": _lost("lines", apart=True),
    "lines_without_angle": _lost("lines", stated=True),
    "head_angles_invalid": _lost("messages"),
    "joint_positions_invalid": _lost("messages", apart=True),
    "joint_poses_wrong_time": _lost("messages"),
    "joint_poses_repeated": _usual(),
    "joint_poses_beyond_limit": _lost("messages"),
    "head_stands": _STATED,
}
COUNT_MEANINGS: dict[str, CountMeaning] = {
    **_CAPTURES,
    **_PACKETS,
    **_POINTS,
    **_MESSAGES,
    **_SAMPLES,
    **_SCANS,
}
"""Name of a count -> what it means; a name that ends with ``_`` is followed by that of a sensor."""
