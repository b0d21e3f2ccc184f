"""What takes the space of a project, and freeing what can be made again."""

import json
import os
import shutil

import pytest

from recon4.archive.backup import back_up
from recon4.archive.listing import read_list
from recon4.archive.space import Freeable, free_space, stored_parts
from recon4.archive.verify import verify
from recon4.cli.main import main
from recon4.errors import StoreError
from recon4.progress import Silent
from recon4.store.checked import Altered
from recon4.store.project import Project, read_artifacts
from recon4_app.jobs.space import size_below
from tests.project_builder import add_multiframes, approve_project, build_project


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    root = tmp_path_factory.mktemp("space") / "office"
    build_project(root, points=2000)
    add_multiframes(root)
    return root


@pytest.fixture
def office(built, tmp_path):
    return shutil.copytree(built, tmp_path / "office")


def freeable(root):
    return {part.what: part.freeable for part in stored_parts(root) if part.freeable}


def test_parts_add_up_to_all_files_and_shared_ones_count_once(office):
    map_ = read_artifacts(office)["map"]
    os.link(map_ / "tiles.json", office / "again.json")
    files = [path for path in office.rglob("*") if path.is_file()]
    sizes = {path.stat().st_ino: path.stat().st_size for path in files}

    parts = stored_parts(office)

    assert sum(part.bytes for part in parts) == sum(sizes.values())
    assert [part.bytes for part in parts] == sorted((p.bytes for p in parts), reverse=True)


def test_the_storage_page_counts_a_file_with_two_names_once(tmp_path):
    (tmp_path / "map.laz").write_bytes(bytes(1000))
    (tmp_path / "artifact").mkdir()
    os.link(tmp_path / "map.laz", tmp_path / "artifact" / "map.laz")
    (tmp_path / "other").write_bytes(bytes(10))

    assert size_below(tmp_path) == 1010
    assert size_below(tmp_path / "artifact" / "map.laz") == 1000
    assert size_below(tmp_path / "missing") == 0


def test_frames_map_and_what_is_damaged_can_be_freed(office):
    (office / "artifacts" / "damaged-0123456789ab-abcdef").mkdir()
    (office / "artifacts" / "mine").mkdir()

    assert freeable(office) == {
        "frames": Freeable.FRAMES,
        "map": Freeable.MAP,
        "damaged artifact": Freeable.EARLIER,
    }


def test_what_a_run_writes_stays(office):
    (office / "artifacts" / ".tmp-0123456789ab-map").mkdir()

    (part,) = (part for part in stored_parts(office) if part.what == "unfinished artifact")

    assert (part.freeable, part.why) == (None, "a run writes it")


def test_what_a_killed_run_left_can_be_freed_and_is_not_backed_up(office, tmp_path):
    left = office / "unfinished" / "map-0123456789ab"
    left.mkdir(parents=True)
    (left / "tiles").write_bytes(bytes(1000))

    made = back_up(office, tmp_path / "backups", with_keys=False, progress=Silent())
    freed = free_space(office, [Freeable.EARLIER])

    assert not [name for name in read_list(made.path).files if "unfinished" in name]
    assert [(part.name, part.bytes) for part in freed] == [("unfinished", 1000)]
    assert not (office / "unfinished").exists() and verify(office, Silent()).damaged == ()


def test_an_artifact_of_an_earlier_run_can_be_freed(office):
    with Project.open(office) as project:
        project.ledger.clear_current("level")

    assert freeable(office)["level"] == Freeable.EARLIER


def test_what_is_freed_is_gone_and_the_rest_is_whole(office):
    before = read_artifacts(office)

    freed = free_space(office, [Freeable.FRAMES])

    assert [part.what for part in freed] == ["frames"]
    assert not before["frames"].exists()
    assert read_artifacts(office) == {k: v for k, v in before.items() if k != "frames"}
    assert verify(office, Silent()).damaged == ()
    with pytest.raises(StoreError, match=r"stage frames: it was freed.*Process the recording"):
        read_artifacts(office)["frames"]


def test_freeing_that_was_killed_leaves_nothing_of_the_artifact(office, monkeypatch):
    frames = read_artifacts(office)["frames"]

    def killed(path):
        raise KeyboardInterrupt

    monkeypatch.setattr("recon4.archive.space.shutil.rmtree", killed)
    with pytest.raises(KeyboardInterrupt):
        free_space(office, [Freeable.FRAMES])
    monkeypatch.undo()

    with Project.open(office):
        pass
    assert not frames.exists() and not list((office / "artifacts").glob(".tmp-*"))
    assert verify(office, Silent()).damaged == ()


def test_nothing_that_an_approval_names_is_freed(office, tmp_path):
    approval = approve_project(office, tmp_path / "signing.key")
    made = read_artifacts(office)

    free_space(office, list(Freeable))

    assert "map" in approval.artifacts
    assert all(made[stage].is_dir() for stage in approval.artifacts)
    assert verify(office, Silent()).damaged == ()
    assert {part.why for part in stored_parts(office) if part.what == "map"} == {
        "approved, version 1"
    }


def test_nothing_is_freed_while_an_approval_cannot_be_read(office, tmp_path):
    approve_project(office, tmp_path / "signing.key")
    path = office / "versions" / "1" / "approval.json"
    path.chmod(0o644)
    path.write_text("{}")

    with pytest.raises(Altered, match="what it needs is not known"):
        free_space(office, [Freeable.FRAMES])
    assert read_artifacts(office)["frames"].is_dir()


def test_the_command_lists_frees_and_refuses_unknown_words(office, capsys):
    assert main(["storage", str(office)]) == 0
    assert "--free frames" in capsys.readouterr().out

    assert main(["storage", str(office), "--free", "map", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [part["what"] for part in found["freed"]] == ["map"]
    assert "map" not in read_artifacts(office)

    assert main(["storage", str(office), "--free", "all"]) == 1
    assert "command: --free 'all': expected one of earlier" in capsys.readouterr().err
