"""The families of LiDARs whose packets are read: one of each maker in the table of models.

The family of a maker is ``FAMILY`` of the module here that is named after it in small letters, or
of ``family.py`` in such a folder. A maker without one sends clouds only.
"""

from __future__ import annotations

from importlib import import_module
from importlib.machinery import ModuleSpec
from importlib.util import find_spec

from recon4.model.lidars import LIDARS
from recon4.recording.packets.family import PacketFamily


def _families() -> tuple[PacketFamily, ...]:
    makers = dict.fromkeys(facts.maker for facts in LIDARS.values() if facts.maker)
    found = [find_spec(f"{__package__}.{maker.lower()}") for maker in makers]
    return tuple(_family(spec) for spec in found if spec is not None)


def _family(spec: ModuleSpec) -> PacketFamily:
    is_folder = spec.submodule_search_locations is not None
    family: PacketFamily = import_module(f"{spec.name}.family" if is_folder else spec.name).FAMILY
    return family


FAMILIES = _families()
"""In the order of `recon4.model.lidars.LIDARS`."""
