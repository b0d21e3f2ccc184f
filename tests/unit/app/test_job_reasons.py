"""Why a job ended is stored as code and values, and said in the language of who reads it."""

import signal
import sqlite3
from dataclasses import replace

import pytest

from recon4.errors import Cancelled, ConfigError, NoSpace
from recon4.export.options import ExportOptions
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH, ROOT
from recon4.locales.texts import messages_of
from recon4.store.atomic import raise_if_full, write_text
from recon4_app.jobs.folder import JobFolder, Limits
from recon4_app.jobs.model import ExportOrder, Inputs, Job, JobState
from recon4_app.jobs.status import JobStatus, StageStatus
from recon4_app.jobs.store import JobStore
from recon4_app.jobs.supervisor import exit_reason
from recon4_app.jobs.worker import run
from tests.full_disk import files_end_at

DIED = {"how": "SIGKILL", "number": 9, "stage": "odometry", "what": "Odometry"}


def running(name="a"):
    inputs = Inputs(recordings=("/walk.pcap",))
    return Job(id=name, project=name, inputs=inputs, created="2026-01-01", state=JobState.RUNNING)


def test_a_reason_is_stored_with_its_code_and_said_in_each_language(tmp_path):
    store = JobStore(tmp_path / "jobs.sqlite")
    before = store.add(running())
    store.change(before, before.to(JobState.QUEUED, note=CodedText("worker-continues", **DIED)))
    store.close()

    again = JobStore(tmp_path / "jobs.sqlite")
    job = again.get("a")
    again.close()

    assert (job.reason.code, job.reason.values) == ("worker-continues", DIED)
    assert job.said(ENGLISH).note == job.note
    assert "[SIGKILL], in stage odometry (Odometry); it continues" in job.note
    assert "[SIGKILL], in der Stufe Odometrie (Odometrie); es geht" in job.said("de").note


def test_a_job_of_an_earlier_version_is_quoted_in_english(tmp_path):
    store = JobStore(tmp_path / "jobs.sqlite")
    before = store.add(running())
    store.change(before, before.to(JobState.FAILED, note="walk.pcap holds no points"))
    job = store.get("a")
    store.close()

    assert job.reason is None and job.said(ENGLISH).note == "walk.pcap holds no points"
    assert job.said("de").note == "Meldung auf Englisch: walk.pcap holds no points"
    assert replace(job, note="").said("de").note == ""


def test_the_queue_of_an_earlier_version_is_read(tmp_path):
    path = tmp_path / "jobs.sqlite"
    store = JobStore(path)
    store.add(running())
    store.close()
    with sqlite3.connect(path) as db:
        db.execute("ALTER TABLE jobs DROP COLUMN reason")
        db.execute("UPDATE alembic_version SET version_num = '0003'")
        db.execute("UPDATE jobs SET note = 'stopped on request', state = 'cancelled'")
    db.close()

    store = JobStore(path)
    job = store.get("a")
    store.close()

    assert job.state is JobState.CANCELLED and job.said(ENGLISH).note == "stopped on request"


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (Cancelled(CodedText("job-stopped")), "job-stopped"),
        (MemoryError(), "job-out-of-memory"),
        (ZeroDivisionError(), "job-program-error"),
        (NoSpace(CodedText("export-disk-full", reserve_bytes=2, free_bytes=1)), "export-disk-full"),
        (OSError(28, "no space"), "job-disk-full"),
        (ConfigError("voxel_m"), "kind-configuration"),
    ],
)
def test_a_worker_hands_over_code_and_values(tmp_path, error, code):
    folder = JobFolder(tmp_path / "job")
    folder.prepare(
        Inputs(recordings=()), tmp_path / "walk", Limits(memory_bytes=1 << 30, reserve_bytes=0)
    )

    def work(_folder, _progress):
        raise error

    folder.finish(run(folder, work))
    outcome = folder.outcome()

    assert outcome.reason and outcome.reason.code == code
    assert outcome.note and type(outcome.note) is str


@pytest.mark.parametrize(
    ("file", "named"),
    [("job/made/walk-map.laz", "walk-map.laz"), ("walk/artifacts/tiles", "walk/artifacts/tiles")],
)
def test_a_full_disk_of_a_job_names_the_file_and_no_path_of_this_computer(tmp_path, file, named):
    folder = JobFolder(tmp_path / "job")
    limits = Limits(memory_bytes=1 << 30, reserve_bytes=0)
    folder.prepare(Inputs(recordings=()), tmp_path / "walk", limits)
    (tmp_path / file).parent.mkdir(parents=True)

    def work(_folder, _progress):
        with files_end_at(100):
            write_text(tmp_path / file, "x" * 1_000)

    outcome = run(folder, work)

    assert outcome.no_space and f"while writing {named}; make room" in outcome.note
    assert outcome.reason.values == {"file": named}


def test_a_full_disk_names_the_file(tmp_path):
    with pytest.raises(NoSpace, match=r"while writing .*tiles; make room and start again"):
        raise_if_full(OSError(28, "no space"), tmp_path / "tiles")


def test_how_a_worker_ended_is_said_with_the_name_of_a_signal():
    how, number = exit_reason(-signal.SIGSEGV)
    hung = {"how": "silent", "number": 3, "stage": "", "what": "Compiling"}

    assert (how, number) == ("SIGSEGV", 11)
    assert exit_reason(None) == ("unseen", 0) and exit_reason(1) == ("code", 1)
    assert exit_reason(-signal.SIGHUP)[0] == "SIGHUP" and exit_reason(-99) == ("signal", 99)
    text = CodedText("worker-died", attempts=3, **hung)
    assert text.startswith("the worker died 3 times: last it made no progress for 3 s and was")
    assert ", in Compiling; perhaps" in text
    other = CodedText("worker-continues", how="SIGHUP", number=1, stage="", what="")
    assert other.startswith("the worker was ended [SIGHUP], before it began;")


@pytest.mark.parametrize(
    ("order", "kept"),
    [({}, True), ({"export": ExportOrder(file="map.laz", options=ExportOptions())}, False)],
)
def test_only_what_is_processed_in_stages_is_kept_when_a_job_is_stopped(tmp_path, order, kept):
    folder = JobFolder(tmp_path / "job")
    limits = Limits(memory_bytes=1 << 30, reserve_bytes=0)
    folder.prepare(Inputs(recordings=(), **order), tmp_path / "walk", limits)

    def work(_folder, _progress):
        raise Cancelled(CodedText("job-stopped"))

    outcome = run(folder, work)

    assert outcome.state == "cancelled" and ("finished is kept" in outcome.note) is kept


def test_the_stage_of_a_job_is_the_one_that_runs():
    done = StageStatus(stage="frames", state="done")
    now = StageStatus(stage="odometry", state="running")

    assert JobStatus(stages=(done, now)).stage == "odometry"
    assert JobStatus(stages=(done,)).stage == ""


def test_every_signal_with_words_exists():
    names = messages_of(ROOT / ENGLISH / "endings.ftl")
    named = [name.removeprefix("word-exit-") for name in names if "-SIG" in name]

    assert [one for one in named if one not in signal.Signals.__members__] == [] and named
