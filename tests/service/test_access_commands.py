"""``recon4 serve`` and ``recon4 users`` as they are typed."""

import io
import os
import re
import signal
import ssl
import subprocess
import sys
from contextlib import contextmanager
from dataclasses import dataclass

import httpx
import pytest

from recon4.cli.main import main
from recon4_app.access.login.login_service import open_access
from tests.deadlines import HANG_S
from tests.service.running import ROOT
from tests.service.secure import PASSWORD


@dataclass(frozen=True)
class Ended:
    """What a command left behind."""

    returncode: int
    stdout: str
    stderr: str


@pytest.fixture
def recon4(capsys, monkeypatch):
    """Run a command in this process, with what is piped into it."""

    def run(*arguments, answer=""):
        capsys.readouterr()
        monkeypatch.setattr(sys, "stdin", io.StringIO(answer))
        return Ended(main([*map(str, arguments)]), *capsys.readouterr())

    return run


@contextmanager
def serving(root, *arguments):
    """A server as from the terminal, and its output at its start."""
    errors = root / "stderr.txt"
    with errors.open("w") as stderr:
        process = subprocess.Popen(
            [sys.executable, "-m", "recon4", "serve", str(root), "--port", "0", *arguments],
            stdout=subprocess.PIPE,
            stderr=stderr,
            text=True,
            cwd=ROOT,
        )
    with process, process.stdout as said:
        try:
            lines = []
            while not lines or not lines[-1].startswith("or on this computer"):
                lines.append(said.readline().strip())
                assert lines[-1], errors.read_text()
            yield process, lines
        finally:
            process.send_signal(signal.SIGINT)
            process.wait(20.0)


@pytest.mark.parametrize(
    "arguments",
    [
        ("--host", "0.0.0.0"),
        ("--host", "192.0.2.7"),
        ("--host", "::"),
        ("--host", "example.org"),
        ("--tls-cert", "x.pem", "--tls-key", "y.pem"),
        ("--lan", "--tls-cert", "x.pem"),
    ],
)
def test_a_network_without_tls_and_login_is_wrong_usage(recon4, tmp_path, arguments):
    ended = recon4("serve", tmp_path, *arguments)

    assert ended.returncode == 2
    assert "--lan" in ended.stderr or "--tls-key" in ended.stderr
    assert not (tmp_path / ".recon4").exists()


def test_an_invalid_certificate_is_reported(recon4, tmp_path):
    (tmp_path / "x.pem").write_text("nothing")
    pem = tmp_path / "x.pem"

    ended = recon4("serve", tmp_path, "--lan", "--tls-cert", pem, "--tls-key", pem, "--port", 0)

    assert ended.returncode == 1
    assert "not a certificate and its key" in ended.stderr


def test_the_first_start_shows_fingerprint_and_one_time_link_and_logs_no_secret(tmp_path):
    with serving(tmp_path, "--lan", "--host", "127.0.0.1") as (process, lines):
        url = re.search(r"https://[^ ]*", lines[0])[0]
        fingerprint = next(line for line in lines if re.fullmatch(r"([0-9A-F]{2}:){31}..", line))
        token = next(line for line in lines if "#setup=" in line).split("#setup=")[1]
        trust = ssl.create_default_context(cafile=tmp_path / ".recon4" / "tls" / "certificate.pem")
        with httpx.Client(base_url=url, verify=trust, timeout=HANG_S) as client:
            given = {"token": token, "name": "Anna", "password": PASSWORD}
            me = client.post("/api/setup", json=given).json()
            wrong = {"name": PASSWORD, "password": "typed in the wrong field"}
            client.post("/api/login", json=wrong, headers={"X-Recon4-Token": me["token"]})
            client.get(f"/no/such%0aline/{token}")
            session = client.cookies["__Host-sid"]
            browser = client.cookies["__Host-browser"]
            client.post("/api/logout", headers={"X-Recon4-Token": me["token"]})
        environment = (
            f"/proc/{process.pid}/environ" if os.path.exists("/proc/self/environ") else "/dev/null"
        )
        with open(environment, "rb") as file:
            surroundings = file.read()
    secrets = [one.encode() for one in (token, session, browser, PASSWORD, me["token"])]

    files = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert len(fingerprint) == 95
    for path in files:
        content = path.read_bytes()
        assert not [one for one in secrets if one in content], path
    assert not [one for one in secrets if one in surroundings]


def test_people_are_kept_from_the_command_line_and_the_log_is_checked(recon4, tmp_path):
    weak = recon4(
        "users", "add", "anna", "--role", "admin", "--root", tmp_path, answer="password1234\n"
    )
    added = recon4(
        "users", "add", "anna", "--role", "admin", "--root", tmp_path, answer=f"{PASSWORD}\n"
    )
    recon4("users", "add", "vera", "--role", "viewer", "--root", tmp_path, answer=f"{PASSWORD}\n")
    role = recon4("users", "role", "vera", "reviewer", "--root", tmp_path)
    disabled = recon4("users", "disable", "vera", "--root", tmp_path)
    last = recon4("users", "disable", "anna", "--root", tmp_path)
    listed = recon4("users", "list", "--root", tmp_path)
    log = recon4("users", "audit", "--root", tmp_path)

    codes = [one.returncode for one in (weak, added, role, disabled, last, listed, log)]
    assert codes == [1, 0, 0, 0, 1, 0, 0]
    assert "the password is found in about" in weak.stderr
    assert "last admin" in last.stderr
    assert re.search(r"^vera +reviewer +\d{4}-\d\d-\d\d disabled$", listed.stdout, re.MULTILINE)
    assert "add person: anna, admin" in log.stdout
    assert "4 entries, chain whole" in log.stdout
    assert PASSWORD not in log.stdout


def test_a_log_tampered_with_is_reported_with_exit_code_1(recon4, tmp_path):
    (tmp_path / ".recon4").mkdir()
    access = open_access(tmp_path / ".recon4", login=True)
    for what in ("office", "field"):
        access.log.add("anna", "?", action="delete project", what=what)
    with access.engine.begin() as connection:
        connection.exec_driver_sql("DROP TRIGGER audit_no_delete")
        connection.exec_driver_sql("DELETE FROM audit WHERE number = 1")
    access.close()

    ended = recon4("users", "audit", "--root", tmp_path)

    assert ended.returncode == 1
    assert "entry 2 does not follow" in ended.stdout


@pytest.mark.parametrize("role", ["nobody", "king", ""])
def test_an_unknown_role_is_wrong_usage(recon4, tmp_path, role):
    ended = recon4("users", "add", "anna", "--role", role, "--root", tmp_path, answer="x\n")

    assert ended.returncode == 2
    assert "viewer, operator, reviewer, admin" in ended.stderr
