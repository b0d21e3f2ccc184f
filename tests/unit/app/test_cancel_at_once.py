"""A job canceled while it is being started: no traceback, and it stops."""

import pytest

from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.model import Inputs, Job, JobState
from recon4_app.jobs.store import JobStore
from recon4_app.jobs.supervisor import Supervisor
from recon4_app.settings import ServerSettings


@pytest.fixture
def store(tmp_path):
    store = JobStore(tmp_path / "jobs.sqlite")
    yield store
    store.close()


@pytest.fixture
def supervisor(tmp_path, store):
    supervisor = Supervisor(
        store, ServerSettings(root=tmp_path, worker_module="tests.no_such_worker")
    )
    yield supervisor
    supervisor.close()


def queued(store, name):
    inputs = Inputs(recordings=("/walk.pcap",))
    return store.add(Job(id=name, project=name, inputs=inputs, created="2026-01-01"))


def test_a_job_cancelled_while_it_is_being_started_is_not_started(store, supervisor, monkeypatch):
    job, prepare = queued(store, "a"), JobFolder.prepare

    def cancelled_meanwhile(folder, *arguments):
        prepare(folder, *arguments)
        supervisor.cancel(job)

    monkeypatch.setattr(JobFolder, "prepare", cancelled_meanwhile)

    supervisor.step()

    assert store.get("a").state is JobState.CANCELLED
    assert not supervisor.folder("a").alive()


def test_a_job_started_while_it_is_being_cancelled_is_asked_to_stop(store, supervisor):
    seen = queued(store, "a")
    store.change(seen, seen.to(JobState.RUNNING))
    supervisor.folder("a").path.mkdir(parents=True)

    supervisor.cancel(seen)

    assert supervisor.folder("a").stop_requested_s() is not None
