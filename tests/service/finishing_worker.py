"""A worker that makes a small finished project of whatever it is given, at once."""

from __future__ import annotations

import sys
from pathlib import Path

from recon4.progress import Progress
from recon4.system.stopping import end_process
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.worker import main
from tests.project_builder import build_project


def work(folder: JobFolder, progress: Progress) -> None:
    project = folder.request().project
    progress.start("Everything", 1, "project")
    build_project(project, points=1000)
    progress.advance()


if __name__ == "__main__":
    end_process(lambda _: main(Path(sys.argv[1]), work))
