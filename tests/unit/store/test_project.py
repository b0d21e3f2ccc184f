"""A project folder is locked by one process and never partial."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from recon4.errors import StoreError
from recon4.store.project import Project, is_project, read_artifacts, read_description, read_stages
from tests.unit.store.small_pipeline import run_all

HOLDER = """
import sys
from pathlib import Path
from recon4.store.project import Project
with Project.open(Path(sys.argv[1])):
    print("open", flush=True)
    sys.stdin.readline()
"""


def test_a_missing_folder_becomes_a_project(tmp_path):
    with Project.open(tmp_path / "deep" / "walk") as project:
        assert is_project(project.root)

    assert read_description(tmp_path / "deep" / "walk")["name"] == "walk"


def test_a_second_process_is_refused_until_the_first_is_dead(tmp_path):
    command = [sys.executable, "-c", HOLDER, str(tmp_path / "p")]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as holder:
        assert holder.stdout.readline() == b"open\n"

        with pytest.raises(StoreError, match="in use by another"):
            Project.open(tmp_path / "p")
        holder.kill()
        holder.wait()

        Project.open(tmp_path / "p").close()


def test_reading_needs_no_lock(tmp_path):
    run_all(tmp_path / "p")

    with Project.open(tmp_path / "p"):
        stages = [row.stage for row in read_stages(tmp_path / "p")]
        artifacts = read_artifacts(tmp_path / "p")

    assert sorted(stages) == ["count", "scale", "total"]
    assert (artifacts["total"] / "total.txt").is_file()


def test_a_folder_of_something_else_is_refused_and_untouched(tmp_path):
    (tmp_path / "holiday.jpg").write_bytes(b"photo")

    with pytest.raises(StoreError, match=r"not a recon4 project \(it contains 'holiday.jpg'\)"):
        Project.open(tmp_path)

    assert [p.name for p in tmp_path.iterdir()] == ["holiday.jpg"]


def test_a_file_in_place_of_the_folder_is_refused(tmp_path):
    (tmp_path / "p").write_text("a file")

    with pytest.raises(StoreError, match="cannot use"):
        Project.open(tmp_path / "p")


@pytest.mark.parametrize("text", ["", "{", "[]", '{"format": 99}'])
def test_a_damaged_description_is_refused(tmp_path, text):
    Project.open(tmp_path / "p").close()
    (tmp_path / "p" / "project.json").write_text(text)

    with pytest.raises(StoreError, match=r"project\.json"):
        Project.open(tmp_path / "p")


def test_only_our_own_orphans_are_swept(tmp_path):
    Project.open(tmp_path / "p").close()
    artifacts = tmp_path / "p" / "artifacts"
    orphan = artifacts / f".tmp-{'0' * 12}-abc"
    strangers = [artifacts / ".tmp-mine", artifacts / "notes", tmp_path / "p" / "photos"]
    for folder in [orphan, *strangers]:
        folder.mkdir()
        (folder / "file").write_text("x")

    Project.open(tmp_path / "p").close()

    assert not orphan.exists()
    assert all((folder / "file").exists() for folder in strangers)


def test_fields_of_a_description_are_added_not_replaced(tmp_path):
    with Project.open(tmp_path / "p") as project:
        project.describe(preset="indoor")
        project.describe(name="Office")

    found = json.loads((tmp_path / "p" / "project.json").read_text())
    assert (found["name"], found["preset"], found["format"]) == ("Office", "indoor", 1)


def test_a_moved_project_is_still_finished(tmp_path):
    run_all(tmp_path / "here")
    (tmp_path / "here").rename(tmp_path / "there")

    again = run_all(tmp_path / "there")

    assert all(run.reused for run in again.runs.values())


def test_reading_a_folder_that_is_not_a_project_raises_an_error(tmp_path):
    with pytest.raises(StoreError, match="is not a recon4 project"):
        read_stages(Path(tmp_path))
