"""Files of a delivery that were exported before: their names, and which are refused."""

from dataclasses import replace
from pathlib import Path

import pytest

from recon4.delivery.kinds import ExportedFile
from recon4.delivery.made_files import MadeFile, copy_made, named, refuse_other_maps
from recon4.errors import Cancelled, StoreError
from recon4.export.options import ExportOptions
from recon4.locales.coded import CodedText
from recon4.progress import Silent
from recon4.store.hashing import hash_file

MADE = ExportedFile(
    name="office-map.copc.laz",
    bytes=3,
    sha256="",
    text="",
    approval="Approved v1",
    map_key="a1",
    recon4="0.2.0",
)
PART = MadeFile(
    path=Path("office-map.copc.laz"),
    kind="map.copc.laz",
    options=ExportOptions(thin_m=0.05),
    made=MADE,
)


def test_each_file_has_a_name_of_its_own_with_all_its_endings():
    found = named(("map.copc.laz", "map.laz"), [PART, PART])

    assert list(found) == ["map-2.copc.laz", "map-3.copc.laz"]
    assert found["map-3.copc.laz"].chosen == "thin_m 0.05"


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"map_key": "b2"}, "was made of an earlier map"),
        ({"approval": "Draft: not approved"}, "says “Draft: not approved” of the approval"),
    ],
)
def test_a_file_of_another_map_or_state_is_refused(changes, says):
    refuse_other_maps([PART], "a1", "Approved v1")

    other = replace(PART, made=replace(MADE, **changes))
    with pytest.raises(StoreError, match=f"^office-map.copc.laz {says}"):
        refuse_other_maps([PART, other], "a1", "Approved v1")


def test_a_copy_stops_when_it_is_cancelled(tmp_path):
    class Stopping(Silent):
        def advance(self, done=1):
            raise Cancelled(CodedText("job-stopped"))

    source = tmp_path / "map.laz"
    source.write_bytes(b"abc")
    one = replace(PART, path=source, made=replace(MADE, sha256=hash_file(source)))
    copy_made(one, tmp_path / "copy.laz", progress=Silent())

    assert (tmp_path / "copy.laz").read_bytes() == b"abc"
    with pytest.raises(Cancelled):
        copy_made(one, tmp_path / "other.laz", progress=Stopping())
