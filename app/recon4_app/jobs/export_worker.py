"""The worker of an export: ``python -m recon4_app.jobs.export_worker JOB_FOLDER``.

It may read its project only, and write its own folder only; see `policy`.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from recon4.delivery.kinds import ExportedFile
from recon4.errors import ConfigError, NoSpace, Recon4Error
from recon4.locales.coded import CodedText
from recon4.progress import Progress
from recon4.review.newest_approval import judging_folders
from recon4.review.trusted_keys import STATE
from recon4.sandbox import Policy
from recon4.store.atomic import make_folders
from recon4.system.stopping import end_process
from recon4_app.jobs.delivery_work import pack, readable
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.tuning import WORKER_LIMITS
from recon4_app.jobs.worker import main


def export(folder: JobFolder, progress: Progress) -> ExportedFile:
    """Make the file that a job orders.

    Raises:
        ConfigError: If it cannot be made of this map.
        NoSpace: If the disk is full.
        Recon4Error: If the memory is too small.
    """
    from recon4.delivery.exports import export_file

    request = folder.request()
    order = request.inputs.export
    if order is None:
        raise ConfigError(CodedText("export-no-order"))
    free, reserve = shutil.disk_usage(folder.path).free, request.limits.reserve_bytes
    if free < reserve:
        raise NoSpace(CodedText("export-disk-full", reserve_bytes=reserve, free_bytes=free))
    make_folders(folder.made)
    try:
        if order.delivery is not None:
            return pack(folder, order, order.delivery, progress=progress)
        return export_file(
            request.project, order.file, folder.made, options=order.options, progress=progress
        )
    except MemoryError as error:
        raise Recon4Error(CodedText("export-out-of-memory")) from error


def policy(folder: JobFolder) -> Policy:
    """The sandbox policy: read the project and who may approve it, write the job's folder.

    The worker of a delivery also reads the signing key, and the files that it packs.
    """
    request = folder.request()
    order = request.inputs.export
    packed = readable(folder, order.delivery) if order and order.delivery else ()
    free = shutil.disk_usage(folder.path).free - request.limits.reserve_bytes
    return Policy(
        read=(request.project, *judging_folders(request.project.parent / STATE), *packed),
        write=(folder.path,),
        temporary=folder.temporary,
        memory_bytes=request.limits.memory_bytes,
        cpu_s=WORKER_LIMITS.max_cpu_s,
        file_bytes=max(WORKER_LIMITS.min_file_bytes, free),
        open_files=WORKER_LIMITS.max_files,
    )


if __name__ == "__main__":
    end_process(lambda _: main(Path(sys.argv[1]), export, policy))
