"""Progress on the terminal while a run is in progress."""

import io
import re

import pytest

from recon4.cli.terminal import Bars, PlainLines, describe_event, describe_progress, watcher
from recon4.locales.languages import ENGLISH, ENVIRONMENT
from recon4.locales.texts import Texts
from recon4.model.events import ArtifactDamaged, NodesPlaced, Remarked, StageChanged, Warned
from recon4.model.finding_kinds import FindingKind
from recon4.progress import track
from recon4.recording.report import warning
from tests.source_trees import sources

STEP = re.compile(r'\bprogress\.start\(\s*"([^"]+)"|\bwhat="([^"]+)",\s*unit=')
UNIT = re.compile(r'\bwhat="[^"]+",\s*unit="([^"]+)"')
"""Of `track`, or of `Progress.start`."""


class Tty(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_line_has_percent_count_rate_with_unit_and_time_left():
    line = describe_progress("odometry", 200, 800, unit="multiframes", seconds=5.0)

    assert line.split() == (
        [
            "odometry",
            "25",
            "%",
            "200/800",
            "multiframes",
            "40.0",
            "multiframes/s",
            "15",
            "s",
            "left",
        ]
    )


def test_bytes_are_shown_in_units_a_person_reads():
    line = describe_progress("hash walk.pcap", 1_500_000, 3_000_000_000, unit="B", seconds=1.0)

    assert line.startswith("hash walk.pcap  ")
    assert "2 MB/3.0 GB" in line
    assert "2 MB/s" in line


@pytest.mark.parametrize(("done", "total"), [(0, 0), (0, 10), (5, 0)])
def test_an_unknown_total_or_no_progress_does_not_divide_by_zero(done, total):
    assert describe_progress("x", done, total, unit="y", seconds=0.0)


def test_not_at_a_terminal_there_are_plain_lines_one_when_each_piece_ends():
    out = io.StringIO()

    with watcher(out) as progress:
        list(track(range(3), progress, what="Reading", unit="packets"))
        list(track(range(2), progress, what="matching", unit="pairs"))

    first, second = out.getvalue().splitlines()
    assert isinstance(progress, PlainLines)
    assert first.startswith("Reading")
    assert "100 %  3/3  packets" in first
    assert second.startswith("matching")


def test_progress_and_events_are_in_the_language_of_the_terminal(monkeypatch):
    monkeypatch.setenv(ENVIRONMENT, "de")
    missing = warning(FindingKind.SENSOR_NOT_RECORDED, sensor="vertical")

    line = describe_progress("place points", 200, 800, unit="tiles", seconds=5.0)

    assert line.split("  ")[0] == "Punkte platzieren"
    assert line.endswith("200/800  Kacheln  40,0 Kacheln/s  noch 15 s")
    assert describe_progress("hash a.pcap", 1, 2, unit="B", seconds=0.0).startswith(
        "Prüfsumme von a.pcap"
    )
    assert describe_event(StageChanged(stage="map", state="done", seconds=1.5)) == (
        "Karte: fertig in 1,5 s"
    )
    assert describe_event(Remarked(finding=missing)).startswith("Warnung: Der Sensor vertical")


def test_each_piece_of_work_and_its_unit_have_words():
    code = "".join(path.read_text("utf-8") for path in sources("recon4", "app"))
    words = Texts(ENGLISH, "projects", "shared")

    steps = {one for pair in STEP.findall(code) for one in pair if one}
    units = set(UNIT.findall(code)) - {"B", "s", "m"}

    assert len(steps) > 30 and len(units) > 10
    assert [one for one in steps if f"step-{slug(one)}" not in words] == []
    assert [one for one in units if f"unit-{slug(one)}" not in words] == []


def slug(name: str) -> str:
    return name.lower().replace(" ", "-")


def test_at_a_terminal_there_are_bars_with_the_same_figures():
    out = Tty()

    with watcher(out) as progress:
        list(track(range(3), progress, what="reading", unit="packets"))
        progress.event(StageChanged(stage="frames", state="done", seconds=1.5))

    assert isinstance(progress, Bars)
    assert "reading" in out.getvalue()
    assert "3/3" in out.getvalue()
    assert "frames: done in 1.5 s" in out.getvalue()


def test_stages_and_damage_are_printed_but_not_every_edge():
    damaged = ArtifactDamaged(stage="map", moved_to="artifacts/d-1", files=("a is missing",))

    assert describe_event(StageChanged(stage="map", state="reused")) == "map: already there"
    assert describe_event(StageChanged(stage="map", state="running")) == ""
    assert describe_event(NodesPlaced(t_m=())) == ""
    assert describe_event(Warned(text="no vertical LiDAR")) == "warning: no vertical LiDAR"
    missing = warning(FindingKind.SENSOR_NOT_RECORDED, sensor="vertical")
    assert describe_event(Remarked(finding=missing)) == (
        "warning: Sensor vertical of the rig is not in the recording."
        " Correct its topic in the rig file."
    )
    assert describe_event(damaged) == (
        "an artifact of the stage map was damaged and is made again; "
        "the damaged one is artifacts/d-1: a is missing"
    )
