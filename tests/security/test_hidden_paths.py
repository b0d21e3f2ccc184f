"""No route takes or lists a path to the server's own files, to hidden or to system files.

Figure: every field of every route that names a file of this computer x every way to a hidden
file (direct, over ``..``, over links to the file and to its folder): 0 accepted, 0 listed.
"""

import itertools
import os
import sqlite3
from pathlib import Path

import pytest

from recon4_app.errors import NotFound, Refused
from recon4_app.main import create_app
from recon4_app.projects.import_folders import ImportFolders
from recon4_app.settings import ServerSettings
from tests.project_builder import build_project
from tests.served import served
from tests.service.running import SLOW, recording_with_gate

FIELDS = {"path", "folder", "rig", "imu", "gnss", "recordings", "file", "filename"}
"""What a field that names a file of this computer is called."""
TAKING = {
    ("GET", "/api/recordings", "folder"),
    ("GET", "/api/look", "path"),
    ("POST", "/api/jobs", "recordings"),
    ("POST", "/api/jobs", "rig"),
    ("POST", "/api/jobs", "imu"),
    ("POST", "/api/jobs", "gnss"),
    ("POST", "/api/live", "rig"),
    ("POST", "/api/projects/{project_id}/slices/references", "path"),
    ("POST", "/api/projects/{project_id}/slices/references/preview", "path"),
}
"""Every route and field that takes a path; a new one is added here and attacked."""
NO_PATHS = {
    ("POST", "/api/rigs/check", "imu"),
    ("POST", "/api/rigs/check", "gnss"),
    ("POST", "/api/projects/{project_id}/calibration/rig", "rig"),
    ("POST", "/api/projects/{project_id}/exports", "file"),
    ("POST", "/api/projects/{project_id}/exports/estimate", "file"),
}
"""Fields of such a name that hold something else: parts of a rig, the name of one, a kind of file
of a closed list."""
RIG = '[rig]\nname = "secret rig"\n\n[[sensor]]\nname = "secret"\nmodel = "VLP-16"\n'


def projects(root):
    build_project(root / "office", points=100)
    state = root / ".recon4"
    state.mkdir()
    (root / ".ssh").mkdir()
    for folder in (state, root / ".ssh"):
        (folder / "signing.key").write_text("the secret")
        (folder / "secret.toml").write_text(RIG)
        (folder / "walk.csv").write_text("1 2 3\n" * 50)
    (root / "shortcut").symlink_to(state)
    (root / "chain").symlink_to(root / "shortcut")
    (root / "walk.xyz").symlink_to(state / "walk.csv")
    (root / "key.toml").symlink_to(state / "secret.toml")
    (root / ".hidden.toml").write_text(RIG)
    os.mkfifo(root / "pipe.pcap")


server = served(projects, worker_module=SLOW)


def hidden_paths(root):
    folders = (root / ".recon4", root / ".ssh")
    names = ("signing.key", "secret.toml", "walk.csv", "")
    direct = [str(folder / name) for folder, name in itertools.product(folders, names)]
    around = [f"{root}/office/../.recon4/signing.key", f"{root}//.recon4/./secret.toml"]
    links = [str(root / "shortcut" / name) for name in names]
    links += [str(root / "chain" / name) for name in names]
    links += [str(root / "walk.xyz"), str(root / "key.toml"), str(root / ".hidden.toml")]
    return direct + around + links + [str(root / "pipe.pcap"), "/proc/self/environ", "/dev/zero"]


def send(server, method, path, field, hidden):
    if method == "GET":
        return server.get(path, params={field: hidden})
    bodies = {
        "/api/jobs": {"project": "stolen", "recordings": [str(server.root / "office")]},
        "/api/live": {"project": "stolen", "rig": hidden},
        "/api/projects/office/slices/references": {"name": "stolen"},
        "/api/projects/office/slices/references/preview": {},
    }
    value = [hidden] if field == "recordings" else hidden
    return server.post(path, json={**bodies[path], field: value})


def taking(app):
    """Route and field of everything that takes the path of a file, by the API's description."""
    schema = app.openapi()
    for path, operations in schema["paths"].items():
        for method, operation in operations.items():
            names = {one["name"] for one in operation.get("parameters", []) if one["in"] == "query"}
            content = operation.get("requestBody", {}).get("content", {})
            reference = content.get("application/json", {}).get("schema", {}).get("$ref", "")
            body = schema["components"]["schemas"].get(reference.rpartition("/")[2], {})
            for name in names | set(body.get("properties", {})):
                if name in FIELDS:
                    yield method.upper(), path, name


def test_every_route_that_takes_a_path_is_attacked_here(tmp_path):
    app = create_app(ServerSettings(root=tmp_path))

    uploads = {one for one in taking(app) if one[1].startswith("/api/uploads")}
    assert set(taking(app)) - uploads == TAKING | NO_PATHS


@pytest.mark.parametrize(("method", "path", "field"), sorted(TAKING))
def test_no_route_takes_a_hidden_path(server, method, path, field):
    target = path.replace("{project_id}", "office")
    answers = {
        hidden: send(server, method, target, field, hidden) for hidden in hidden_paths(server.root)
    }

    expected = {403, 422} if path == "/api/live" else {403}  # 422: no name of a shipped rig
    statuses = {hidden: answer.status_code for hidden, answer in answers.items()}
    assert {hidden: one for hidden, one in statuses.items() if one not in expected} == {}
    assert [hidden for hidden, answer in answers.items() if "secret rig" in answer.text] == []
    assert not (server.root / "stolen").exists()


def test_nothing_hidden_is_listed_nor_what_leads_there(server):
    root = server.root

    listed = {entry["name"] for entry in server.get(f"/api/recordings?folder={root}").json()}

    assert listed == {"office"}
    rigs = server.get("/api/live/choices").json()["rigs"]
    assert [one for one in rigs if "secret" in str(one)] == []


def test_a_job_that_was_accepted_before_is_checked_again(server):
    root = server.root
    recording = recording_with_gate(root / "later")
    job = server.start("later-job", recording)
    assert server.post(f"/api/jobs/{job}/cancel").status_code == 200
    server.wait(job, lambda view: view["job"]["state"] == "cancelled")
    changed = sqlite3.connect(root / ".recon4" / "jobs.sqlite")
    with changed:
        changed.execute(
            "update jobs set inputs = replace(inputs, ?, ?)",
            (str(recording), str(root / ".recon4" / "walk.csv")),
        )
    changed.close()

    assert server.post(f"/api/jobs/{job}/retry").status_code == 403


@pytest.mark.parametrize(
    "path", ["/proc/self/environ", "/dev/zero", "/etc/shadow", "/sys/kernel", "/run"]
)
def test_the_system_is_never_a_recording_even_where_the_whole_disk_may_be_browsed(path):
    everything = ImportFolders([Path("/")])

    with pytest.raises((Refused, NotFound)):
        everything.checked(path)
    assert path.split("/")[1] not in {entry.name for entry in everything.entries("/")}


def test_a_folder_named_on_purpose_may_lie_in_a_hidden_one(tmp_path):
    folder = tmp_path / ".cache" / "recordings"
    folder.mkdir(parents=True)
    walk = folder / "walk.pcap"
    walk.write_bytes(b"")
    secret = folder / "private"
    secret.mkdir()

    named = ImportFolders([folder], private=[secret])

    assert named.checked(str(walk)) == walk
    assert [entry.name for entry in named.entries(str(folder))] == ["walk.pcap"]
    with pytest.raises(Refused, match="belongs to the server"):
        named.checked(str(secret))
