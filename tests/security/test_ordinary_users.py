"""Everything works for users other than root: with a home, without one, without a name.

Figures held: 0 tracebacks; a file of root that such a user may not read is named.
"""

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import httpx
import pytest

from tests.deadlines import HANG_S
from tests.project_builder import build_project
from tests.security import ordinary_user

USERS = {
    "with a home": (65534, {"HOME": "home"}),
    "without a home": (65534, {"HOME": "/nonexistent"}),
    "without a name": (54321, {}),
}
PASSWORD = "three green owls dance slowly"

pytestmark = pytest.mark.skipif(
    os.geteuid() != 0 or not ordinary_user.possible(), reason="needs to become another user"
)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    root = tmp_path_factory.mktemp("ordinary") / "maps"
    build_project(root / "office", points=20_000)
    return root


@pytest.fixture(
    params=[
        pytest.param("with a home", marks=pytest.mark.study),
        pytest.param("without a home", marks=pytest.mark.study),
        "without a name",
    ]
)
def user(request, made):
    """Runs commands as a user who owns a folder with a project; that of pytest is closed to it."""
    number, environment = USERS[request.param]
    place = Path(tempfile.mkdtemp(prefix="r4-user-"))
    try:
        place.chmod(0o755)
        shutil.copytree(made, place / "maps")
        for name in ("home", "stash"):
            (place / name).mkdir()
        for path in (place, *place.rglob("*")):
            os.chown(path, number, number)
        if environment.get("HOME") == "home":
            environment = {"HOME": str(place / "home")}
        yield User(number, environment, place)
    finally:
        shutil.rmtree(place)
        shutil.rmtree(Path(tempfile.gettempdir()) / f"recon4-{number}", ignore_errors=True)


class User:
    def __init__(self, number, environment, place):
        self.number, self.environment, self.place = number, environment, place

    def command(self, *words):
        return ordinary_user.command_as(
            self.number,
            [str(word) for word in words],
            environment=self.environment,
            stash=self.place / "stash",
        )

    def run(self, *words, text=None):
        done = subprocess.run(
            self.command(*words),
            cwd=self.place,
            input=text,
            capture_output=True,
            text=True,
            timeout=240,
            check=False,
        )
        assert "Traceback" not in done.stderr + done.stdout, done.stderr
        return done


def test_commands_work(user):
    for words in (
        ("export", "maps/office", "map.ply"),
        ("slice", "maps/office", "cut.csv", "--z", "1.5"),
        ("keys", "list"),
    ):
        done = user.run(*words)
        assert done.returncode == 0, (words, done.stderr)
    assert (user.place / "map.ply").stat().st_uid == user.number
    doctor = user.run("doctor", "maps")
    assert "compiled loops kept" in doctor.stdout


def test_people_and_keys_are_written_or_the_reason_is_said(user):
    add = user.run("users", "add", "anna", "--role", "admin", "--root", "maps", text=PASSWORD)
    audit = user.run("users", "audit", "--root", "maps")
    key = user.run("keys", "add", "Brno", "ab" * 32)

    assert (add.returncode, audit.returncode) == (0, 0), add.stderr
    assert "add person: anna, admin" in audit.stdout
    if user.environment.get("HOME", "").startswith(str(user.place)):
        assert key.returncode == 0, key.stderr
    else:
        assert key.returncode == 1 and "cannot write" in key.stderr


def test_what_only_root_may_read_is_named(user):
    closed = user.place / "closed.pcap"
    closed.write_bytes(b"\0" * 64)
    closed.chmod(0o600)
    state = user.place / "maps" / ".recon4"
    state.mkdir(exist_ok=True)
    os.chown(state, 0, 0)
    state.chmod(0o700)

    info = user.run("info", "closed.pcap")
    people = user.run("users", "list", "--root", "maps")

    assert info.returncode != 0 and "closed.pcap" in info.stderr
    assert "not readable" in info.stderr
    assert people.returncode == 1 and ".recon4" in people.stderr, people.stderr


def test_a_server_serves(user):
    command = user.command("serve", "maps", "--port", "0")
    with subprocess.Popen(
        command, cwd=user.place, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as server:
        try:
            line = server.stdout.readline()
            assert "Serving at" in line, server.stderr.read()
            url = line.split()[2].rstrip("/")
            (card,) = httpx.get(f"{url}/api/projects", timeout=HANG_S).json()
            image = httpx.get(f"{url}/api/projects/office/thumbnail", timeout=120.0)
        finally:
            server.terminate()
        _, errors = server.communicate(timeout=60)

    assert card["approval"]["text"] == "Draft: not approved"
    assert image.status_code == 200 and image.content.startswith(b"\x89PNG")
    assert "Traceback" not in errors
