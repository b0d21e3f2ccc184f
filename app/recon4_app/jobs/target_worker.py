"""The worker of a search for targets: ``python -m recon4_app.jobs.target_worker JOB_FOLDER``.

It may read its project only, and write its own folder only.
"""

from __future__ import annotations

import sys
from pathlib import Path

from recon4.delivery.kinds import ExportedFile
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.progress import Progress
from recon4.review.approval_state import latest_state
from recon4.store.atomic import make_folders
from recon4.system.stopping import end_process
from recon4_app.jobs.export_worker import policy
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.worker import main


def search(folder: JobFolder, progress: Progress) -> ExportedFile:
    """Look for survey targets in the whole map of a project; they have no names yet.

    Raises:
        ConfigError: If the job orders none.
        NoSpace: If the disk is full.
        StoreError: If the project has no map, or it cannot be read.
    """
    from recon4.mapping.tiles import TileSet
    from recon4.model.plain import to_plain
    from recon4.slices.targets.named import listed
    from recon4.slices.targets.search import find_targets
    from recon4.store.atomic import write_json
    from recon4.store.project import read_artifacts

    request = folder.request()
    order = request.inputs.targets
    if order is None:
        raise ConfigError(CodedText("targets-no-order"))
    make_folders(folder.made)
    map_folder = read_artifacts(request.project)["map"]
    tiles = TileSet.open(map_folder)
    found = listed(find_targets(tiles, radii_m=order.radii_m, progress=progress))
    path = folder.made / "targets.json"
    write_json(path, to_plain(found))
    text = f"{len(found.rows)} places like survey targets"
    state = latest_state(request.project)
    return ExportedFile.of(path, text, state, map_key=map_folder.name, progress=progress)


if __name__ == "__main__":
    end_process(lambda _: main(Path(sys.argv[1]), search, policy))
