"""Every flipped bit is found."""

import json

import pytest

from recon4.errors import StoreError
from recon4.progress import Silent
from recon4.store.hashing import hash_file
from recon4.store.verify import verify_files
from tests.unit.store.small_pipeline import run_all


def test_an_untouched_project_is_whole(tmp_path):
    run_all(tmp_path / "p")

    found = verify_files(tmp_path / "p", Silent())

    assert (found.checked, found.damaged, found.unknown) == (
        8,
        (),
        (),
    )  # 3 artifacts; project.json, ledger, 3 manifests


def test_one_flipped_bit_is_found_and_named(tmp_path):
    runner = run_all(tmp_path / "p")
    path = runner.runs["scale"].artifact.folder / "2.txt"
    data = bytearray(path.read_bytes())
    data[0] ^= 1
    path.write_bytes(data)

    (damage,) = verify_files(tmp_path / "p", Silent()).damaged

    assert damage.startswith("scale ")
    assert damage.endswith(": 2.txt has other bytes")


def test_missing_and_added_files_and_artifacts_are_found(tmp_path):
    runner = run_all(tmp_path / "p")
    scale = runner.runs["scale"].artifact.folder
    (scale / "0.txt").unlink()
    (scale / "new.txt").write_text("x")
    total = runner.runs["total"].artifact.folder
    total.rename(tmp_path / "taken away")

    damaged = " ".join(verify_files(tmp_path / "p", Silent()).damaged)

    assert "0.txt is missing" in damaged
    assert "new.txt does not belong here" in damaged
    assert damaged.count("is missing") == 2


def test_a_result_that_was_edited_is_found(tmp_path):
    run_all(tmp_path / "p")
    result = tmp_path / "p" / "trajectory.tum"
    result.write_text("0 0 0 0 0 0 0 1\n")
    hashes = {"hashes": {"results": {"trajectory.tum": hash_file(result)}}}
    (tmp_path / "p" / "summary.json").write_text(json.dumps(hashes))
    assert verify_files(tmp_path / "p", Silent()).damaged == ()

    result.write_text("0 0 0 0 0 0 0 -1\n")

    assert verify_files(tmp_path / "p", Silent()).damaged == ("trajectory.tum has other bytes",)


def test_an_unknown_folder_is_reported_but_not_as_damage(tmp_path):
    run_all(tmp_path / "p")
    (tmp_path / "p" / "artifacts" / "notes").mkdir()

    found = verify_files(tmp_path / "p", Silent())

    assert (found.damaged, found.unknown) == ((), ("notes",))


def test_a_folder_that_is_no_project_is_refused(tmp_path):
    with pytest.raises(StoreError, match="not a recon4 project"):
        verify_files(tmp_path, Silent())
