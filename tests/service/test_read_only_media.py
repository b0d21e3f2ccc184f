"""Projects on media that cannot be written: everything that only reads works, and it is said."""

import os
import shutil
import sqlite3
import subprocess
import sys
from contextlib import contextmanager

import httpx
import pytest

from tests.deadlines import HANG_S
from tests.first_variants import all_but_first_are_studies
from tests.project_builder import add_multiframes, approve_project, build_project
from tests.service.viser_client import camera, viewing

POINTS = 5_000
NOBODY = 65534


@contextmanager
def mounted_read_only(folder, place):
    """The folder as read-only media."""
    place.mkdir()
    subprocess.run(["mount", "--bind", folder, place], check=True)
    try:
        subprocess.run(["mount", "-o", "remount,bind,ro", place], check=True)
        yield place
    finally:
        subprocess.run(["umount", place], check=True)


def may_mount(tmp_path):
    (tmp_path / "from").mkdir()
    try:
        with mounted_read_only(tmp_path / "from", tmp_path / "to") as place:
            return not os.access(place, os.W_OK)
    except (OSError, subprocess.CalledProcessError):
        return False


@pytest.fixture
def media(tmp_path):
    """Projects on read-only media: one as it was closed, one copied while it was in use."""
    root = tmp_path / "root"
    project = root / "office"
    (root / ".recon4").mkdir(parents=True)
    build_project(project, points=POINTS)
    add_multiframes(project)
    approve_project(project, root / ".recon4" / "signing.key")
    used = shutil.copytree(project, tmp_path / "used")
    in_use = [sqlite3.connect(used / name) for name in ("ledger.sqlite", "decisions.sqlite")]
    for database in in_use:
        database.execute("PRAGMA journal_mode = WAL")
        database.execute("CREATE TABLE extra (x)")
        database.execute("DROP TABLE extra")
        database.commit()
    shutil.copytree(used, root / "in-use", ignore=shutil.ignore_patterns("*-shm"))
    for database in in_use:
        database.close()
    assert (root / "in-use" / "decisions.sqlite-wal").stat().st_size
    if may_mount(tmp_path):
        with mounted_read_only(root, tmp_path / "media") as place:
            yield place
        return
    if os.geteuid() == 0:
        pytest.skip("root can write everywhere, and may not mount here")
    for path in (root, *root.rglob("*")):
        path.chmod(path.stat().st_mode & ~0o222)
    yield root
    for path in (root, *root.rglob("*")):
        path.chmod(path.stat().st_mode | 0o200)


def command(*words):
    return subprocess.run(
        [sys.executable, "-m", "recon4", *map(str, words)],
        capture_output=True,
        text=True,
        timeout=120,
    )


@pytest.mark.parametrize("name", all_but_first_are_studies(["in-use", "office"]))
def test_commands_read_a_project_on_read_only_media(media, tmp_path, name):
    out = tmp_path / "out"
    out.mkdir()

    verified = command("verify", media / name)
    exported = command("export", media / name, out / "map.laz")
    sliced = command("slice", media / name, out / "slice.png", "--z", "1.5")

    assert verified.returncode == 0, verified.stdout
    assert " 0 damaged" in verified.stdout
    for done in (exported, sliced):
        assert done.returncode == 0, done.stderr
        assert "Checked" in done.stdout or "Eva" in done.stdout
    assert (out / "map.laz").stat().st_size and (out / "slice.png").stat().st_size


def test_processing_into_read_only_media_is_refused_with_words(media):
    done = command("process", __file__, "--out", media / "new")

    assert done.returncode == 1
    assert "Read-only" in done.stderr or "Permission denied" in done.stderr
    assert "Traceback" not in done.stderr


@contextmanager
def serving(root, *options):
    process = subprocess.Popen(
        [sys.executable, "-m", "recon4", "serve", str(root), "--port", "0", *options],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    with process:
        try:
            yield process
        finally:
            process.terminate()


@pytest.mark.study
def test_a_server_shows_read_only_media_and_changes_nothing(media):
    with serving(media) as process:
        first = process.stdout.readline()
        assert first.startswith("Serving at "), process.stderr.read()
        note = process.stdout.readline()
        url = first.split()[2].rstrip("/")
        with httpx.Client(base_url=url, timeout=HANG_S) as client:
            cards = client.get("/api/projects").json()
            notices = client.get("/api/server").json()["notices"]
            thumbnail = client.get("/api/projects/office/thumbnail")
            slices = client.get("/api/projects/in-use/slices")
            refused = [
                client.post("/api/jobs", json={"project": "new", "recordings": [str(media)]}),
                client.post("/api/rigs", json={"id": "field", "copy_of": "4recon"}),
                client.delete("/api/projects/office"),
            ]
        with viewing(url) as browser:
            browser.send(camera((8.0, 3.0, 1.5)))
            browser.until(lambda c: c.shown == POINTS)
        process.terminate()
        _, errors = process.communicate(timeout=HANG_S)

    assert {card["id"]: card["problem"] for card in cards} == {"office": "", "in-use": ""}
    assert "cannot be written" in note and "cannot be written" in notices[0]
    assert thumbnail.status_code == 200
    assert slices.json()["points"] == POINTS
    assert slices.json()["approval"] != "Not approved"
    for answer in refused:
        assert answer.status_code == 403
        assert "cannot be written" in answer.json()["detail"]
    assert process.returncode == 0
    assert "Traceback" not in errors


@pytest.mark.study
def test_a_server_with_login_does_not_start_on_read_only_media(media):
    done = command("serve", media, "--lan", "--port", "0")

    assert done.returncode == 1
    assert "nobody can sign in" in done.stderr and "Traceback" not in done.stderr
