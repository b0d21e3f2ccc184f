"""How much of a recording is not used, over all reasons, and what the verdict says of it."""

import pytest

from recon4.findings.walk_record import WalkRecord
from recon4.findings.wording import text_of
from recon4.model.finding import Finding, Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.unused_data import unused_parts
from tests.said import found_in


def words_of(part):
    """What a map says of it."""
    found = Finding(kind=FindingKind.IMPORT_UNUSED, level=Level.CHECK, values=part.values)
    return text_of(found)


def levels(counts):
    """Levels of the findings about data that is not used."""
    found = found_in(WalkRecord(steps={}, imported={"counts": counts}))
    return [one.level for one in found if one.kind is FindingKind.IMPORT_UNUSED]


def test_all_reasons_count_together_and_are_named():
    counts = {"scans": 91, "scans_damaged": 500, "scans_out_of_order": 12, "beams": 9}

    (part,) = unused_parts(counts)

    assert (part.number, part.total) == (512, 603)
    assert words_of(part) == (
        "512 of 603 scans of the 2-D laser are not used (85 %): 500: cannot be decoded, left out; "
        "12: earlier than the one before, left out."
    )


def test_what_is_counted_where_it_is_used_has_its_plain_name():
    (part,) = unused_parts({"gnss_kept": 15, "gnss_nan": 10})

    assert words_of(part).startswith("10 of 25 GNSS positions are not used (40 %): ")


@pytest.mark.parametrize(
    ("counts", "expected"),
    [
        ({"packets": 1000, "packets_missing": 5000}, [Level.DO_NOT_USE]),
        ({"points": 1000, "points_wrong_time": 5000}, [Level.DO_NOT_USE]),
        ({"lines": 1000, "lines_missing": 5000}, [Level.DO_NOT_USE]),
        # Nobody warned of reasons that are rare one by one.
        ({"packets": 1000, "packets_late": 9, "packets_wrong_flag": 9}, [Level.CHECK]),
        # The reader warned of a single large reason already.
        ({"packets": 1000, "packets_late": 200}, []),
        ({"packets": 1000, "packets_late": 9}, []),
        # IMU and GNSS are judged by the stages that use them.
        ({"imu_kept": 10, "imu_nan": 1000}, []),
        ({"gnss_kept": 10, "gnss_wrong_time": 1000}, []),
        # Usual or repaired: nothing is missing.
        ({"points": 10, "points_far": 5000, "points_near": 5000, "points_no_return": 900}, []),
        ({"packets": 10, "packets_duplicate": 10, "scans": 5, "scans_repeated": 5}, []),
    ],
)
def test_the_verdict_says_what_is_not_used(counts, expected):
    assert levels(counts) == expected
