"""The worker process: ``python -m recon4_app.jobs.worker JOB_FOLDER`` runs one job to its end.

It is independent of the server: it may outlive the one that started it and be adopted by the next.
"""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from recon4.delivery.kinds import ExportedFile
from recon4.errors import Cancelled, ConfigError, NoSpace, Recon4Error, RecordingError
from recon4.locales.coded import CodedText, coded, text_of
from recon4.progress import Progress
from recon4.sandbox import Policy
from recon4.store.atomic import raise_if_full
from recon4.store.project import Project, discard_unbegun, is_project
from recon4.system.stopping import end_process
from recon4_app.jobs.events import EventWriter
from recon4_app.jobs.folder import JobFolder, Outcome, failure
from recon4_app.jobs.limits import prepare_worker, worker_policy
from recon4_app.jobs.model import JobKind
from recon4_app.jobs.reason import reason_of
from recon4_app.jobs.space import refuse_if_full

log = logging.getLogger("recon4.job")

Work = Callable[[JobFolder, Progress], ExportedFile | None]
"""Does the work of a job; returns the file of an export."""


def main(path: Path, work: Work, policy_of: Callable[[JobFolder], Policy] = worker_policy) -> int:
    """Run the job of a folder, confined to a policy, and write its outcome; returns 0.

    A signal breaks it off without an outcome: the job goes on in the next worker.
    """
    folder = JobFolder(path)
    (path / "pid").write_text(str(os.getpid()))
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(message)s", datefmt="%H:%M:%S")
    prepare_worker(folder, policy_of(folder))
    outcome = run(folder, work)
    folder.finish(outcome)
    log.info("%s %s", outcome.state, outcome.note)
    return 0


def run(folder: JobFolder, work: Work) -> Outcome:
    """Do the work and return its outcome."""
    events: EventWriter | None = None
    try:
        folder.keep_room()
        events = EventWriter(folder.path)
        made = work(folder, events)
    except Cancelled as stop:
        processes = folder.request().inputs.kind is JobKind.PROCESS
        note = coded(stop) if processes else CodedText("job-stopped-early")
        return Outcome(state="cancelled", note=str(note), reason=reason_of(note))
    except (RecordingError, ConfigError) as error:
        return failure(text_of(error), startable=is_project(folder.request().project))
    except Recon4Error as error:
        return failure(_to_people(error, folder), no_space=isinstance(error, NoSpace))
    except MemoryError:
        return failure(CodedText("job-out-of-memory"))
    except Exception as error:
        if (full := _full(error, folder)) is not None:
            return failure(full, no_space=True)
        log.exception("unexpected")
        return failure(CodedText("job-program-error", error=type(error).__name__))
    finally:
        if events is not None:
            events.close()
    return Outcome(state="succeeded", made=made)


def process(folder: JobFolder, progress: Progress) -> None:
    """Call the pipeline as ``recon4 process`` does, or only what depends on decisions."""
    from recon4.model.rig import load_rig
    from recon4.pipeline import process as run_pipeline
    from recon4.pipeline import remake
    from recon4.recording.sources import Sources
    from recon4.settings import override, preset

    request = folder.request()
    project, inputs, limits = request.project, request.inputs, request.limits
    if inputs.remake:
        refuse_if_full(project, [], reserve_bytes=limits.reserve_bytes)
        remake(project, progress=progress)
        return
    sources = Sources(
        tuple(Path(recording) for recording in inputs.recordings),
        rig=load_rig(inputs.rig) if inputs.rig else None,
        imu=Path(inputs.imu) if inputs.imu else None,
        gnss=Path(inputs.gnss) if inputs.gnss else None,
        near=request.near,
    )
    settings = override(preset(inputs.preset), list(inputs.settings))
    refuse_if_full(project, sources.paths, reserve_bytes=limits.reserve_bytes)
    with titled(project, inputs.title):
        run_pipeline(sources, project, settings=settings, preset=inputs.preset, progress=progress)


@contextmanager
def titled(project: Path, title: str) -> Iterator[None]:
    """Give a new project its title before the work; an existing project keeps its own.

    Like the pipeline, it removes a new project that the recording or the rig keeps from its first
    stage.
    """
    if not title or is_project(project):
        yield
        return
    with Project.open(project) as opened:
        opened.describe(name=title)
    try:
        yield
    except (RecordingError, ConfigError):
        discard_unbegun(project)
        raise


def _full(error: Exception, folder: JobFolder) -> str | None:
    """The message about a full disk, if that caused an error."""
    try:
        raise_if_full(error, folder.request().project)
    except NoSpace as full:
        return _to_people(full, folder)
    return None


def _to_people(error: Recon4Error, folder: JobFolder) -> str:
    """The message of an error, with names of files in place of paths of this computer.

    Who may only look at a project reads it, too.
    """
    text = text_of(error)
    for hidden in (folder.made, folder.request().project.parent):
        text = _without(f"{hidden}{os.sep}", text)
    return text


def _without(path: str, text: str) -> str:
    if not isinstance(text, CodedText):
        return text.replace(path, "")
    values = {
        name: _without(path, value) if isinstance(value, str) else value
        for name, value in text.values.items()
    }
    return CodedText(text.code, **values)


if __name__ == "__main__":
    end_process(lambda _: main(Path(sys.argv[1]), process))
