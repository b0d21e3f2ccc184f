"""Code that others put where this user's processes load some: caches of kernels, working folders.

Figures held: 0 planted modules imported; each cache that others may write is refused by name.
"""

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

from recon4.sandbox.private_cache import (
    KERNELS,
    LINKS,
    cached_elsewhere,
    mark_compiled,
    planted,
    private_cache,
)
from recon4.sandbox.private_cache import _numba_name as numba_name
from recon4_app.jobs.supervisor import _spawn
from tests.source_trees import sources, trees_with

ROOT = Path(__file__).parents[2]
PLANTED = ("numpy.py", "json.py", "logging.py", "recon4.py", "recon4_app.py", "signal.py")
OTHER_USER = 65534
needs_root = pytest.mark.skipif(os.geteuid() != 0, reason="gives a file to another user")


@pytest.fixture
def working_folder(tmp_path, monkeypatch):
    """A folder with modules of the names of ours; what imports one leaves a mark."""
    folder = tmp_path / "stick"
    folder.mkdir()
    for name in PLANTED:
        (folder / name).write_text(f"open({str(tmp_path / 'ran')!r}, 'w').close()\n")
    monkeypatch.chdir(folder)
    return folder


def ran(tmp_path):
    return (tmp_path / "ran").exists()


def test_a_worker_imports_nothing_from_the_working_folder(working_folder, tmp_path):
    job = tmp_path / "job"
    job.mkdir()
    with (tmp_path / "lock").open("wb") as lock:
        worker = _spawn(("recon4_app.jobs.worker",), job, lock.fileno())
        worker.wait(60.0)

    assert not ran(tmp_path), (job / "log.txt").read_text()
    assert "request.json" in (job / "log.txt").read_text()  # it came as far as its own work


def test_the_command_imports_nothing_from_the_working_folder(working_folder, tmp_path):
    program = (
        "import sys; from recon4.__main__ import main; sys.argv = ['recon4', 'doctor']; main()"
    )
    command = [sys.executable, "-P", "-c", program]  # as the installed script: not its folder
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)

    assert not ran(tmp_path) and "seccomp" in done.stdout


def python_commands(path, tree):
    """The literal words behind ``sys.executable`` in each list or call of a file."""
    for node in ast.walk(tree):
        items = getattr(node, "elts", None) or []
        if items and ast.unparse(items[0]) == "sys.executable":
            words = [one.value for one in items[1:] if isinstance(one, ast.Constant)]
            yield f"{path.relative_to(ROOT)}:{node.lineno}", words


def test_every_child_is_started_without_the_working_folder():
    starts = trees_with(r"sys\.executable", sources("recon4", "app"))
    found = [one for path, tree in starts for one in python_commands(path, tree)]
    started = {place: words for place, words in found if {"-m", "-c"} & set(words)}

    assert len(started) >= 7, started
    assert [place for place, words in started.items() if not {"-P", "-I"} & set(words)] == []


def command(cache, *words):
    """A command in a process of its own, with a cache of its own."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
    return subprocess.run(
        [sys.executable, "-m", "recon4", *words],
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def kernels_of(cache):
    folder = cache / numba_name(KERNELS)
    folder.mkdir(parents=True)
    (folder / "deskew.place_sensor_points-10.py311.nbi").write_bytes(b"planted")
    return folder


@pytest.mark.parametrize("which", ["cache", "folder", "file"])
def test_a_cache_that_everybody_may_write_is_refused(tmp_path, which):
    cache = tmp_path / "numba"
    folder = kernels_of(cache)
    bad = {"cache": cache, "folder": folder, "file": next(folder.iterdir())}[which]
    bad.chmod(0o777)

    done = command(cache, "info", "nothing.pcap")
    doctor = command(cache, "doctor")

    assert done.returncode == 1 and "Traceback" not in done.stderr
    assert "compiled kernels are code, and others may have put some there" in done.stderr
    assert f"{bad}: its mode" in done.stderr
    assert "lets others write it" in doctor.stdout and "unsafe" in doctor.stdout


@needs_root
@pytest.mark.parametrize("which", ["cache", "folder", "file"])
def test_a_cache_with_a_file_of_another_user_is_refused(tmp_path, which):
    cache = tmp_path / "numba"
    folder = kernels_of(cache)
    bad = {"cache": cache, "folder": folder, "file": next(folder.iterdir())}[which]
    os.chown(bad, OTHER_USER, OTHER_USER)

    done = command(cache, "info", "nothing.pcap")

    assert done.returncode == 1 and f"it belongs to user {OTHER_USER}" in done.stderr


@needs_root
def test_a_confined_child_links_no_kernel_of_another_user(tmp_path, monkeypatch):
    cache = tmp_path / "numba"
    folder = kernels_of(cache)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(cache))
    private_cache(tmp_path / "before")
    os.chown(next(folder.iterdir()), OTHER_USER, OTHER_USER)
    private_cache(tmp_path / "after")

    assert folder in cached_elsewhere(tmp_path / "before")
    assert folder not in cached_elsewhere(tmp_path / "after")


def test_a_confined_child_of_another_reads_the_kernels_themselves(tmp_path, monkeypatch):
    folder = kernels_of(tmp_path / "numba")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "numba"))
    monkeypatch.setenv("NUMBA_CACHE_DIR", private_cache(tmp_path / "outer")["NUMBA_CACHE_DIR"])
    private_cache(tmp_path / "inner")

    assert folder in cached_elsewhere(tmp_path / "inner")


def test_private_caches_share_the_links_that_were_made_at_the_installation(tmp_path, monkeypatch):
    (kernel,) = kernels_of(tmp_path / "numba").iterdir()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "numba"))
    mark_compiled()
    first, second = (
        Path(private_cache(tmp_path / name)["NUMBA_CACHE_DIR"], kernel.parent.name, kernel.name)
        for name in ("first", "second")
    )

    assert first.readlink() == second.readlink() == kernel
    assert first.lstat().st_ino == second.lstat().st_ino


@pytest.mark.parametrize("kind", ["file", "link"])
def test_a_shared_link_to_something_else_is_not_used(tmp_path, monkeypatch, kind):
    (kernel,) = kernels_of(tmp_path / "numba").iterdir()
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "numba"))
    mark_compiled()
    shared = kernel.parent / LINKS / kernel.name
    shared.unlink()
    if kind == "file":
        shared.write_text("planted")
    else:
        shared.symlink_to(tmp_path / "planted")
    folder = private_cache(tmp_path / "private")["NUMBA_CACHE_DIR"]

    assert Path(folder, kernel.parent.name, kernel.name).readlink() == kernel


def test_a_cache_of_the_user_and_a_private_group_is_fine(tmp_path):
    folder = kernels_of(tmp_path / "numba")
    os.chown(folder, -1, os.getuid() if os.geteuid() == 0 else -1)
    folder.chmod(0o755)

    assert planted(folder) == ""
