"""Drawings of a delivery: each plan is fitted once."""

import pytest

from recon4.delivery import package
from recon4.delivery.package import DeliveryWish, deliver
from recon4.errors import StoreError
from recon4.progress import Silent
from tests.project_builder import build_project


def test_the_drawings_of_a_delivery_share_their_plans(tmp_path, monkeypatch):
    build_project(tmp_path / "room", points=2_000)
    given = []

    def write_kind(project, kind, path, *, wanted, progress):
        given.append(wanted.plans)
        if kind.name == "plan.geojson":
            raise StoreError("stop here")
        path.touch()

    monkeypatch.setattr(package, "write_kind", write_kind)
    wish = DeliveryWish(files=("plan.dxf", "plan.geojson"))
    with pytest.raises(StoreError, match="stop here"):
        deliver(tmp_path / "room", tmp_path / "a.zip", wish, progress=Silent())

    assert given[0] is given[1]
