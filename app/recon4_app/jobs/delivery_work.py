"""The work of an export that is a delivery: chosen files, report and license in one signed ZIP."""

from __future__ import annotations

from pathlib import Path

from recon4.delivery.kinds import DELIVERY, ExportedFile
from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.progress import Progress
from recon4.review.trusted_keys import SIGNING_KEY, STATE
from recon4.store.atomic import write_text
from recon4.store.project import read_artifacts
from recon4_app.jobs.folder import JobFolder
from recon4_app.jobs.model import DeliveryOrder, ExportOrder, PackedExport


def pack(
    folder: JobFolder, order: ExportOrder, asked: DeliveryOrder, *, progress: Progress
) -> ExportedFile:
    """Pack the delivery that a job orders; that of an approved map is signed.

    Raises:
        Recon4Error: As `recon4.delivery.package.deliver`.
    """
    from recon4.delivery.made_files import MadeFile
    from recon4.delivery.package import DeliveryWish, deliver
    from recon4.delivery.report_files import server_key

    project = folder.request().project
    made = [
        MadeFile(path=_path(folder, one), kind=one.file, options=one.options, made=one.made)
        for one in asked.exports
    ]
    wish = DeliveryWish(
        files=asked.files,
        made=made,
        crs=order.options.crs,
        license=_license(folder, asked.license),
        key=server_key(project),
        language=asked.language,
    )
    out = folder.made / f"{project.name}-{DELIVERY.name}"
    before = read_artifacts(project).get("map")
    found = deliver(project, out, wish, progress=progress)
    if before is None or read_artifacts(project).get("map") != before:
        raise StoreError(CodedText("deliver-map-changed"))
    text = f"{len(found.files)} files, {'signed' if found.signed else 'not signed'}"
    return ExportedFile.of(out, text, found.approval, map_key=before.name, progress=progress)


def readable(folder: JobFolder, asked: DeliveryOrder) -> tuple[Path, ...]:
    """What its worker reads besides the project: the signing key, and the files that it packs.

    The worker that writes the report for the client may read the key, too.
    """
    key = folder.request().project.parent / STATE / SIGNING_KEY
    return (key, *(_path(folder, one) for one in asked.exports))


def _path(folder: JobFolder, one: PackedExport) -> Path:
    name = Path(one.made.name).name  # a worker that a file took over may name any
    return JobFolder(folder.path.parent / one.id).made / name


def _license(folder: JobFolder, text: str) -> Path | None:
    if not text.strip():
        return None
    path = folder.path / "license.txt"
    write_text(path, text.rstrip() + "\n")
    return path
