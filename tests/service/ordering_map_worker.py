"""A worker that makes a small map with the workers of its job, once or until it is stopped."""

from __future__ import annotations

import sys
from itertools import count, takewhile
from pathlib import Path

from recon4.model.events import StageChanged
from recon4.orders.confined import workers_of_this_process
from recon4.progress import Progress
from recon4.system.stopping import end_process
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.worker import main
from tests.ordered_maps import full_inputs, make_map

AGAIN = "again and again"
"""Title of a job that makes the map until it is stopped."""


def work(folder: JobFolder, progress: Progress) -> None:
    request = folder.request()
    project, inputs = request.project, request.inputs
    progress.event(StageChanged(stage="map", state="running"))
    walk = full_inputs()
    for _ in takewhile(lambda k: k == 0 or inputs.title == AGAIN, count()):
        make_map(project, workers_of_this_process(), inputs=walk, progress=progress)


if __name__ == "__main__":
    end_process(lambda _: main(Path(sys.argv[1]), work))
