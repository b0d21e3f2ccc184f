"""Deliveries among the exports of a project: what is chosen, and how they are verified."""

from __future__ import annotations

from recon4.delivery.kinds import DELIVERY, KINDS
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText, said
from recon4.locales.languages import checked as checked_language
from recon4.review.trusted_keys import TRUSTED_KEYS, ensure_own_key
from recon4.untrusted.names import visible
from recon4_app.compute_pool.model import FileAccess, Lane, Terms
from recon4_app.deps import ServerParts
from recon4_app.errors import Conflict, NotFound
from recon4_app.exports import export_work
from recon4_app.exports.model import DeliveryCheck, NewDelivery, NewExport
from recon4_app.exports.tuning import KEPT_EXPORTS
from recon4_app.jobs.model import DeliveryOrder, ExportOrder, Job, JobKind, PackedExport
from recon4_app.jobs.orders import find_order, latest_map_key
from recon4_app.network.request_caller import Caller


def order_of(server: ServerParts, project_id: str, new: NewExport, *, language: str) -> ExportOrder:
    """What is ordered; the exports that a delivery packs are looked up.

    Raises:
        ConfigError: If the choice for a delivery is given for another kind of file or not at all,
            or names what cannot be in one.
        Conflict: If an export that is packed is of an earlier map.
        NotFound: If an export that is packed has no file.
    """
    if (new.file == DELIVERY.name) != (new.delivery is not None):
        raise ConfigError(CodedText("deliver-choice", file=visible(new.file)))
    if new.delivery is None:
        return ExportOrder(file=new.file, options=new.options)
    ensure_own_key(server.settings.state)
    asked = _delivery(server, project_id, new.delivery, language=new.delivery.language or language)
    return ExportOrder(file=new.file, options=new.options, delivery=asked)


def _delivery(
    server: ServerParts, project_id: str, asked: NewDelivery, *, language: str
) -> DeliveryOrder:
    if not (asked.files or asked.exports):
        raise ConfigError(CodedText("deliver-no-file"))
    for name in asked.files:
        if name not in KINDS:
            known = ", ".join(KINDS)
            raise ConfigError(CodedText("deliver-kind", kinds=known, name=visible(name)))
    map_key = latest_map_key(server, project_id)
    ids = dict.fromkeys(asked.exports)
    exports = (_packed(server, project_id, one, map_key=map_key) for one in ids)
    return DeliveryOrder(
        files=tuple(dict.fromkeys(asked.files)),
        exports=tuple(exports),
        license=asked.license.strip(),
        language=checked_language(language),
    )


def _packed(server: ServerParts, project_id: str, export_id: str, *, map_key: str) -> PackedExport:
    job = find_order(server, project_id, export_id, kind=JobKind.EXPORT)
    order = job.inputs.export
    if order is None or order.file not in KINDS or job.made is None or not server.exports.path(job):
        raise NotFound(CodedText("export-gone"))
    if job.made.map_key != map_key:
        raise Conflict(CodedText("deliver-made-earlier", file=job.made.name))
    return PackedExport(id=job.id, file=order.file, options=order.options, made=job.made)


async def checked(server: ServerParts, job: Job, *, caller: Caller) -> DeliveryCheck:
    """Verify the file of a delivery, in a process that reads nothing else.

    Raises:
        NotFound: If it is no delivery, or its file was removed.
        Recon4Error: If it is damaged.
    """
    path = server.exports.path(job)
    if path is None or job.inputs.export is None or job.inputs.export.delivery is None:
        raise NotFound(CodedText("export-gone"))
    keys = server.settings.state / TRUSTED_KEYS
    terms = Terms(
        person=caller.name,
        access=FileAccess(read=(path, keys)),
        limit_s=KEPT_EXPORTS.check_limit_s,
        large=True,
    )
    run = server.compute_pool.run_background
    work = export_work.check_delivery
    found = await caller.wait(run(Lane.EXPORT, terms, work, str(path), str(keys.parent)))
    return DeliveryCheck(
        intact=list(found.intact),
        altered=list(found.altered),
        missing=list(found.missing),
        added=list(found.added),
        signer=found.signer,
        doubt=said(found.doubt, caller.language),
    )
