"""Paths with characters that mean something elsewhere: in URIs, options, formats and markup."""

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from recon4.errors import ConfigError, RecordingError
from recon4.progress import Silent
from recon4.store.inputs import input_file
from recon4.store.ledger import Ledger
from recon4_app.settings import ServerSettings
from tests.first_variants import all_but_first_are_studies
from tests.made_once import made_once
from tests.project_builder import add_multiframes, approve_project, build_project
from tests.service.running import server_thread
from tests.service.viser_client import camera, viewing

POINTS = 5_000
NAMES = [
    "/".join(["100%", "site%20A", "a#b", "a?mode=ro&b=1", "%(here)s %s {0} $HOME"]),
    "/".join(["-rf", "q'uo\"te;", "two\nlines", "back\\slash:", "<b>&amp;", " spaces "]),
    "Brno, Veveří 2. patro 🚶",
]
"""Paths of several folders: what fails in one of them fails in all."""
NO_UTF8 = os.fsdecode(b"caf\xe9")


def make(folder):
    build_project(folder, points=POINTS)
    add_multiframes(folder)


@pytest.fixture(scope="session")
def project(tmp_path_factory):
    return made_once(tmp_path_factory, "project-for-odd-paths", make)


def command(*words):
    return subprocess.run(
        [sys.executable, "-m", "recon4", *map(str, words)], capture_output=True, timeout=120
    )


def is_alone(folder, above):
    """Whether nothing else is in the folders from one above to this one, under no other name."""
    return all(
        os.listdir(one.parent) == [one.name]
        for one in (folder, *folder.parents)
        if above in one.parents
    )


@pytest.mark.parametrize("name", all_but_first_are_studies(NAMES))
def test_a_server_works_on_a_folder_of_any_name(tmp_path, project, name):
    root = tmp_path / "served" / name
    root.mkdir(parents=True)
    shutil.copytree(project, root / "office")
    approve_project(root / "office", tmp_path / "key.pem")
    (root / "empty.pcap").write_bytes(b"")
    with server_thread(root, recording_folders=(root,)) as server:
        view = server.get("/api/projects/office").json()
        listed = server.get("/api/recordings", params={"folder": str(root)}).json()
        rig = server.post("/api/rigs", json={"id": "field", "copy_of": "4recon"})
        path = server.get("/api/rigs/field").json()["versions"][0]["path"]
        job = server.start("other", root / "empty.pcap")
        slices = server.get("/api/projects/office/slices")
        server.wait_state(job, "failed")
        with viewing(server.url) as client:
            client.send(camera((8.0, 3.0, 1.5)))
            client.until(lambda c: c.shown == POINTS)

    assert not view["problem"] and view["has_map"]
    assert str(root / "empty.pcap") in [entry["path"] for entry in listed]
    assert rig.status_code == 201 and Path(path).is_file()
    assert slices.json()["points"] == POINTS
    assert is_alone(root, tmp_path / "served")


@pytest.mark.parametrize("name", all_but_first_are_studies([NO_UTF8, *NAMES]))
def test_commands_work_on_a_project_of_any_name(tmp_path, project, name):
    folder = tmp_path / "projects" / name
    shutil.copytree(project, folder)
    target = tmp_path / "out" / f"{name}.laz"
    target.parent.mkdir(parents=True)

    verified = command("verify", folder)
    exported = command("export", folder, target)

    assert verified.returncode == 0 and b" 0 damaged" in verified.stdout
    assert exported.returncode == 0, exported.stderr
    assert target.stat().st_size > POINTS
    assert is_alone(folder, tmp_path / "projects") and is_alone(target, tmp_path / "out")


def test_a_root_that_no_request_can_name_is_refused_with_words(tmp_path):
    root = tmp_path / NO_UTF8
    root.mkdir()

    with pytest.raises(ConfigError, match=r"caf<U.DCE9> is no UTF-8 text.*rename the folder"):
        ServerSettings(root=root)


def test_a_recording_without_a_utf8_name_is_refused_with_words(tmp_path):
    (tmp_path / NO_UTF8).mkdir()
    for inside in ("walk.pcap", f"{NO_UTF8}.pcap"):
        (tmp_path / NO_UTF8 / inside).write_bytes(bytes(100))

    with Ledger(tmp_path / "ledger.sqlite") as ledger:
        for wrong in (tmp_path / NO_UTF8, tmp_path / NO_UTF8 / f"{NO_UTF8}.pcap"):
            with pytest.raises(RecordingError, match=r"caf<U.DCE9>.*no UTF-8 text: rename it"):
                input_file(wrong, ledger, Silent())
        found = input_file(tmp_path / NO_UTF8 / "walk.pcap", ledger, Silent())
        again = input_file(tmp_path / NO_UTF8 / "walk.pcap", ledger, Silent())

    assert found.key == again.key == hashlib.sha256(bytes(100)).hexdigest()


def test_names_that_no_request_can_have_are_listed_with_what_to_do(tmp_path, project):
    recordings = tmp_path / "recordings"
    (recordings / "walk").mkdir(parents=True)
    (recordings / f"{NO_UTF8}.pcap").write_bytes(b"")
    (recordings / f"{NO_UTF8}.toml").write_text('[[sensor]]\nname = "a"\n')
    (recordings / "walk" / NO_UTF8).write_bytes(b"")
    (recordings / "link").symlink_to(recordings / f"{NO_UTF8}.pcap")
    with server_thread(tmp_path, recording_folders=(recordings,)) as server:
        listed = server.get("/api/recordings", params={"folder": str(recordings)}).json()
        inspected = server.get("/api/look", params={"path": str(recordings / "walk")})
        linked = server.get("/api/look", params={"path": str(recordings / "link")})
        rigs = server.get("/api/live/choices")

    names = [entry["name"] for entry in listed]
    assert "caf<U+DCE9>.pcap (rename it: its name is no UTF-8 text)" in names
    assert inspected.status_code == 422
    assert linked.status_code == 403
    assert "rename it: its name is no UTF-8 text" in linked.json()["detail"]
    assert rigs.status_code == 200


def test_projects_that_the_server_cannot_name_are_announced(tmp_path, project):
    for name in ("Brno, Veveří 2. patro", NO_UTF8, "fine"):
        shutil.copytree(project, tmp_path / name)
    with server_thread(tmp_path) as server:
        listed = [card["id"] for card in server.get("/api/projects").json()]
        notice = server.get("/api/server").json()["notices"][0]  # perhaps the disk is full, too
        german = server.get("/api/server", headers={"Accept-Language": "de"}).json()["notices"]

    assert listed == ["fine"]
    assert "(insgesamt 2)" in german[0]
    assert "Brno, Veveří 2. patro, caf<U+DCE9> (2 in all)" in notice
    assert "rename the folder" in notice


@pytest.mark.parametrize("name", ["rigs", "recordings"])
def test_a_project_cannot_have_the_name_of_a_folder_of_the_server(tmp_path, name):
    (tmp_path / "walk.pcap").write_bytes(b"")
    with server_thread(tmp_path) as server:
        recording = str(tmp_path / "walk.pcap")
        job = server.post("/api/jobs", json={"project": name, "recordings": [recording]})
        capture = server.post("/api/live", json={"project": name, "rig": "single-vlp16"})

    for answer in (job, capture):
        assert answer.status_code == 409
        assert f"{name} is a folder of the server" in answer.json()["detail"]
