"""The worker process: ``python -m app.jobs.worker JOB_FOLDER`` runs one job to its end.

It knows no server: it may outlive the one that started it and be adopted by the next.
"""

from __future__ import annotations

import logging
import os
import sys
import threading
from collections.abc import Callable
from pathlib import Path

from app.jobs.events import EventWriter
from app.jobs.folder import JobFolder, Outcome
from recon4.errors import Cancelled, Recon4Error
from recon4.progress import Progress

log = logging.getLogger("recon4.job")


Work = Callable[[JobFolder, Progress], None]


def main(path: Path, work: Work) -> None:
    """Run the job of a folder and write its outcome."""
    folder = JobFolder(path)
    (path / "pid").write_text(str(os.getpid()))
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(message)s", datefmt="%H:%M:%S")
    over = threading.Event()
    threading.Thread(target=_beat, args=(path / "heartbeat", over), daemon=True).start()
    outcome = run(folder, work)
    log.info("%s %s", outcome.state, outcome.note)
    folder.finish(outcome)
    over.set()


def run(folder: JobFolder, work: Work) -> Outcome:
    """Do the work; what happened in words."""
    events = EventWriter(folder.path / "events.jsonl", folder.path / "cancel")
    try:
        work(folder, events)
    except Cancelled as stop:
        return Outcome(state="cancelled", note=str(stop))
    except Recon4Error as error:
        return Outcome(state="failed", note=str(error))
    except MemoryError:
        return Outcome(state="failed", note="out of memory; close other programs and retry")
    except Exception as error:
        log.exception("unexpected")
        note = f"{type(error).__name__} in the program; the log says where"
        return Outcome(state="failed", note=note)
    finally:
        events.close()
    return Outcome(state="succeeded")


def process(folder: JobFolder, progress: Progress) -> None:
    """Call the pipeline as ``recon4 process`` does."""
    from recon4.model.rig import load_rig
    from recon4.pipeline import process as run_pipeline
    from recon4.settings import override, preset

    project, inputs = folder.request()
    run_pipeline(
        [Path(recording) for recording in inputs.recordings],
        project,
        settings=override(preset(inputs.preset), list(inputs.settings)),
        preset=inputs.preset,
        rig=load_rig(inputs.rig) if inputs.rig else None,
        imu=Path(inputs.imu) if inputs.imu else None,
        gnss=Path(inputs.gnss) if inputs.gnss else None,
        progress=progress,
    )


def _beat(heartbeat: Path, over: threading.Event) -> None:
    while True:
        heartbeat.touch()
        if over.wait(1.0):
            return


if __name__ == "__main__":
    main(Path(sys.argv[1]), process)
