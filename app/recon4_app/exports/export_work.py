"""Work of the list of exports in child processes. Arguments and results are plain values."""

from __future__ import annotations

from pathlib import Path

from recon4.delivery.check import CheckedFile
from recon4.delivery.kinds import DELIVERY, KINDS, ExportEstimate
from recon4.model.classes import CLASSES
from recon4.model.plain import to_plain
from recon4.products.storeys import find_storeys
from recon4.review.evidence import Evidence
from recon4.review.trusted_keys import read_keys
from recon4.store.atomic import write_json
from recon4_app.exports.model import ClassChoice, ExportChoices, StoreyChoice
from recon4_app.jobs.model import ExportOrder
from recon4_app.slices.slice_work import Artifacts, map_frame, map_of


def estimate(artifacts: Artifacts, order: ExportOrder) -> ExportEstimate:
    """About how large an export will be.

    Raises:
        ConfigError: If it cannot be made of this map.
        GeoreferenceError: If it cannot be put into the CRS.
    """
    from recon4.delivery.estimates import estimate_delivery, estimate_export  # brings all formats

    folders = {k: Path(folder) for k, folder in artifacts.items()}
    asked = order.delivery
    if asked is None:
        return estimate_export(folders, order.file, order.options)
    packed = [one.made.bytes for one in asked.exports]
    return estimate_delivery(folders, asked.files, order.options, packed_bytes=sum(packed))


def check_delivery(path: str, state: str) -> CheckedFile:
    """Verify a delivery by the keys of a server.

    Raises:
        CorruptFile, StoreError: If it is damaged.
    """
    from recon4.delivery.check import check_file

    return check_file(Path(path), read_keys(Path(state), server=True))


def _class_choices(counts: dict[int, int]) -> list[ClassChoice]:
    """The classes that a map has, in the order of their table."""
    total = sum(counts.values())
    return [
        ClassChoice(
            code=int(code),
            title=facts.title,
            points=counts[code],
            percent=round(100.0 * counts[code] / total, 2),
            delivered=facts.delivered,
        )
        for code, facts in CLASSES.items()
        if counts.get(code)
    ]


def write_choices(artifacts: Artifacts, out: str, *, evidence: Evidence | None) -> None:
    """Write what can be chosen of the exports of a map as JSON."""
    tiles = map_of(artifacts, evidence)
    storeys = find_storeys(tiles)
    choices = ExportChoices(
        kinds=[*KINDS.values(), DELIVERY],
        classes=_class_choices(tiles.class_counts()),
        storeys=[StoreyChoice(name=one.name, floor_m=round(one.floor_m, 2)) for one in storeys],
        crs=map_frame(artifacts).crs,
    )
    write_json(Path(out), to_plain(choices))
