"""Events, status and the queue on disk."""

import json
import sqlite3

import pytest

from recon4.errors import Cancelled
from recon4.model.events import NodesPlaced, Remarked, RunStarted, StageChanged
from recon4.model.finding_kinds import FindingKind
from recon4.recording.report import warning
from recon4_app.errors import Conflict, IllegalTransition, NotFound
from recon4_app.jobs.events import EventWriter, event_of, read_events
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.model import TRANSITIONS, Inputs, Job, JobState
from recon4_app.jobs.status import JobStatus, after
from recon4_app.jobs.store import JobStore


@pytest.fixture
def store(tmp_path):
    store = JobStore(tmp_path / "jobs.sqlite")
    yield store
    store.close()


def job(name="a", project="office", **changes):
    inputs = Inputs(recordings=("/walk.pcap",), settings=("map.voxel_m=0.02",))
    return Job(id=name, project=project, inputs=inputs, created="2026-01-01", **changes)


def test_a_job_comes_back_as_it_was_stored(store):
    store.add(job())

    assert store.get("a") == job()
    assert store.latest() == {"office": job()}


def test_a_project_has_one_job_that_waits_or_runs(store):
    first = store.add(job())

    with pytest.raises(Conflict, match="already has a job"):
        store.add(job("b"))
    store.change(first, first.to(JobState.CANCELLED))

    store.add(job("b"))
    assert [one.id for one in store.of_project("office")] == ["b", "a"]


def test_of_two_changes_from_one_state_the_second_is_refused(store):
    first = store.add(job())
    store.change(first, first.to(JobState.RUNNING))

    with pytest.raises(Conflict, match="no longer queued"):
        store.change(first, first.to(JobState.CANCELLED))


def test_the_queue_survives_reopening_and_is_durable(tmp_path):
    store = JobStore(tmp_path / "jobs.sqlite")
    store.add(job())
    store.close()

    again = JobStore(tmp_path / "jobs.sqlite")

    assert again.get("a") == job()
    again.close()
    connection = sqlite3.connect(tmp_path / "jobs.sqlite")
    assert connection.execute("PRAGMA journal_mode").fetchone() == ("wal",)
    connection.close()


def test_an_unknown_job_is_not_found(store):
    with pytest.raises(NotFound):
        store.get("nothing")


@pytest.mark.parametrize("state", [s for s, after in TRANSITIONS.items() if not after])
def test_what_is_over_stays_over(state):
    done = job(state=state)

    assert done.over
    for other in JobState:
        with pytest.raises(IllegalTransition):
            done.to(other)


def test_rate_and_remaining_time_follow_from_an_event():
    event = {"kind": "progress", "what": "odometry", "done": 25, "total": 100, "unit": "frames"}

    status = after(JobStatus(), event_of({**event, "seconds": 5.0}))

    assert status.fraction == 0.25
    assert status.rate_per_s == 5.0
    assert status.eta_s == 15.0


def test_a_new_worker_begins_with_nothing_done():
    status = after(JobStatus(), StageChanged(stage="frames", state="done", seconds=1.0))

    assert len(status.stages) == 1
    assert after(status, RunStarted()) == JobStatus()


def test_other_events_change_nothing():
    assert after(JobStatus(), NodesPlaced(t_m=())) == JobStatus()


@pytest.mark.parametrize(
    "fields",
    [
        {},
        {"kind": "new"},
        {"kind": ["run"]},
        {"kind": "edge", "i": 1},
        {"kind": "progress", "what": "a", "done": "1", "total": 2, "seconds": 1.0},
        {"kind": "poses", "t_ns": [1], "t_m": [[0.0, 0.0]], "quat_xyzw": [[0.0, 0.0, 0.0, 1.0]]},
    ],
)
def test_malformed_and_unknown_events_have_no_record(fields):
    assert event_of(fields) is None


def test_an_event_of_a_later_version_is_read_without_its_new_fields():
    fields = {"kind": "stage", "stage": "map", "state": "done", "seconds": 2, "new": 1, "t": 5}

    assert event_of(fields) == StageChanged(stage="map", state="done", seconds=2.0, t=5.0)


def test_events_are_read_as_they_come_and_a_line_cut_by_a_kill_is_skipped(tmp_path):
    path = tmp_path / "events.jsonl"
    first = EventWriter(tmp_path)
    first.event(NodesPlaced(t_m=((0.0, 0.0, 0.0),)))
    first.close()
    events, offset = read_events(path, 0)
    with path.open("ab") as file:
        file.write(b'{"kind": "progr')
    half, offset = read_events(path, offset)
    second = EventWriter(tmp_path)
    second.close()
    rest, _ = read_events(path, offset)

    assert [event.kind for event in events] == ["run", "nodes"]
    assert half == []
    assert [event.kind for event in rest] == ["run"]


def test_a_warning_of_a_reader_is_a_record_in_the_events_and_words_in_the_log(tmp_path, caplog):
    caplog.set_level("INFO")
    writer = EventWriter(tmp_path)
    writer.event(Remarked(finding=warning(FindingKind.RATE_UNFIT, requested_hz=7, rotation_hz=10)))
    writer.close()

    kept = json.loads((tmp_path / "events.jsonl").read_text().splitlines()[-1])
    assert (kept["kind"], kept["finding"]["kind"]) == ("remark", "RATE-UNFIT")
    assert "warning rate_hz = 7 does not fit the rotation of 10 Hz" in caplog.text


def test_a_run_stops_once_asked(tmp_path):
    writer = EventWriter(tmp_path)
    writer.start("Odometry", 3, "frames")
    (tmp_path / "cancel").touch()

    with pytest.raises(Cancelled):
        writer.advance(3)

    writer.close()


def test_nothing_temporary_is_left_of_a_worker_that_was_killed(tmp_path):
    folder = JobFolder(tmp_path)
    folder.temporary.mkdir()
    (folder.temporary / "part").write_bytes(b"half")
    folder.keep_room()
    (tmp_path / ".tmp-597a407518c9-request.json").write_text("{")

    folder.sweep()

    assert list(tmp_path.iterdir()) == []
