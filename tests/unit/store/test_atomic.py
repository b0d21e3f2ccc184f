"""Files are written completely or not at all."""

import json
import resource
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from recon4.errors import NoSpace, StoreError
from recon4.model.plain import to_plain
from recon4.store.atomic import (
    atomic_file,
    atomic_folder,
    copy_file,
    sweep,
    write_json,
    write_private,
    write_text,
)

ROOT = Path(__file__).parents[3]


@pytest.fixture
def small_disk(tmp_path):
    """A real file system of 512 KB, where the machine lets us mount one."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=512k", "tmpfs", str(folder)]
    if shutil.which("mount") is None or subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("this user may not mount a small file system")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


def test_a_file_appears_with_all_its_bytes(tmp_path):
    write_text(tmp_path / "a.txt", "čau")

    assert (tmp_path / "a.txt").read_text("utf-8") == "čau"
    assert len(list(tmp_path.iterdir())) == 1


def test_the_temporary_name_keeps_the_suffix_that_writers_go_by(tmp_path):
    with atomic_file(tmp_path / "x.npz") as temporary:
        np.savez(temporary, a=np.arange(3))

    assert np.load(tmp_path / "x.npz")["a"].tolist() == [0, 1, 2]


def test_a_failed_write_leaves_the_old_file(tmp_path):
    write_text(tmp_path / "a.txt", "old")

    with pytest.raises(ValueError, match="stop"), atomic_file(tmp_path / "a.txt") as temporary:
        temporary.write_text("new, but only ha")
        raise ValueError("stop")

    assert (tmp_path / "a.txt").read_text() == "old"
    assert len(list(tmp_path.iterdir())) == 1


def test_a_failed_folder_leaves_nothing(tmp_path):
    with pytest.raises(ValueError, match="stop"), atomic_folder(tmp_path / "f") as temporary:
        (temporary / "half").write_text("x")
        raise ValueError("stop")

    assert list(tmp_path.iterdir()) == []


def test_a_path_that_cannot_be_written_raises_a_store_error(tmp_path):
    (tmp_path / "file").write_text("x")

    with pytest.raises(StoreError, match="cannot write"):
        write_text(tmp_path / "file" / "a.txt", "x")
    with pytest.raises(StoreError, match="cannot write"), atomic_folder(tmp_path / "no" / "f"):
        pass


def test_only_its_owner_may_read_a_private_file_also_one_that_all_could_read(tmp_path):
    path = tmp_path / "key.pem"
    path.write_bytes(b"old")
    path.chmod(0o644)

    write_private(path, b"secret")

    assert path.read_bytes() == b"secret"
    assert stat.S_IMODE(path.stat().st_mode) == 0o600


def test_json_refuses_nan(tmp_path):
    with pytest.raises(ValueError, match="JSON"):
        write_json(tmp_path / "a.json", {"x": float("nan")})

    assert list(tmp_path.iterdir()) == []


def test_what_is_not_a_number_becomes_null():
    assert to_plain({"a": [float("nan"), 1.5, (float("inf"), "x")], "b": 0}) == {
        "a": [None, 1.5, [None, "x"]],
        "b": 0,
    }


def test_sweep_removes_only_temporary_files_and_folders(tmp_path):
    (tmp_path / f".tmp-{'a1' * 6}-x.txt").write_text("x")
    (tmp_path / f".tmp-{'b2' * 6}-key").mkdir()
    (tmp_path / ".tmp-thesis.txt").write_text("keep")

    removed = sweep(tmp_path)

    assert len(removed) == 2
    assert [p.name for p in tmp_path.iterdir()] == [".tmp-thesis.txt"]


def test_a_full_disk_is_reported_and_leaves_no_partial_file(small_disk):
    write_text(small_disk / "a.txt", "old")

    with pytest.raises(NoSpace, match="no space left"):
        write_text(small_disk / "a.txt", "x" * 2_000_000)

    assert (small_disk / "a.txt").read_text() == "old"
    assert [p.name for p in small_disk.iterdir()] == ["a.txt"]


def test_a_full_disk_is_recognized_in_numpy_errors_without_a_number(small_disk):
    with pytest.raises(NoSpace), atomic_folder(small_disk / "key") as folder:
        np.save(folder / "a.npy", np.zeros(1_000_000))

    assert list(small_disk.iterdir()) == []


def test_a_copy_to_a_full_disk_is_reported(small_disk, tmp_path):
    (tmp_path / "large").write_bytes(b"\x00" * 1_000_000)

    with pytest.raises(NoSpace):
        copy_file(tmp_path / "large", small_disk / "copy")

    assert list(small_disk.iterdir()) == []


def test_a_stage_on_a_full_disk_leaves_nothing_and_can_resume(small_disk):
    from recon4.progress import Silent
    from recon4.settings import Settings
    from recon4.settings.reads import ReadsNothing
    from recon4.store.project import Project
    from recon4.store.stage import Stage, StageRunner

    def fills(context):
        (context.out / "large").write_bytes(b"\x01" * 300_000)

    ballast = small_disk / "ballast"
    ballast.write_bytes(b"\x00" * 250_000)
    with Project.open(small_disk / "p") as project:
        runner = StageRunner(project, Settings(), Silent())
        with pytest.raises(NoSpace, match="make room and start again"):
            runner.run(Stage("fills", 1, ReadsNothing, fills))
        assert list(project.artifacts.iterdir()) == []
        ballast.unlink()

        artifact = runner.run(Stage("fills", 1, ReadsNothing, fills))

    assert (
        json.loads((artifact.folder / "manifest.json").read_text())["files"]["large"]["bytes"]
        == 300_000
    )


def test_a_limit_on_file_size_counts_as_no_space(tmp_path):
    program = (
        "import sys; from pathlib import Path; from recon4.errors import NoSpace\n"
        "from recon4.store.atomic import write_text\n"
        "try: write_text(Path(sys.argv[1]), 'x' * 100_000)\n"
        "except NoSpace: print('no space')"
    )

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, 50_000))

    found = subprocess.run(
        [sys.executable, "-B", "-c", program, str(tmp_path / "a")],
        preexec_fn=limit,
        capture_output=True,
        cwd=ROOT,
        check=True,
    )

    assert found.stdout == b"no space\n"
    assert list(tmp_path.iterdir()) == []
