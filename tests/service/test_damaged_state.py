"""Damaged files of the server's own: put aside, restored from the last copy, and said."""

import os
import subprocess
import sys
from datetime import date
from pathlib import Path

import pytest

from recon4.archive.backup import back_up
from recon4.archive.listing import newest, read_list
from recon4.cli.main import main
from recon4.progress import Silent
from recon4_app.access.login.login_service import open_access
from recon4_app.access.restoring import access_copies
from recon4_app.metrics_routes import TOKEN_FILE, make_metrics_token
from recon4_app.network.certificate import made_certificate
from tests.deadlines import HANG_S
from tests.service.running import wait_for
from tests.service.secure import secure_server


def halve(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def wipe_the_middle(path):
    data = bytearray(path.read_bytes())
    data[1024:-1024] = os.urandom(len(data) - 2048)
    path.write_bytes(data)


DAMAGES = {
    "half": halve,
    "empty": lambda path: path.write_bytes(b""),
    "missing": Path.unlink,
    "text": lambda path: path.write_text("people: anna, rita\n" * 100),
    "middle": wipe_the_middle,
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_people_are_restored_from_the_last_copy_without_any_session(tmp_path, damage):
    state = tmp_path / ".recon4"
    file = state / "access.sqlite"
    with secure_server(tmp_path) as server, server.signed_in("anna") as anna:
        cookies = dict(anna.cookies)
        access_copies(state).make(renew=True)
    DAMAGES[damage](file)

    with secure_server_of_these_people(tmp_path) as server:
        with server.client(cookies=cookies) as stranger:
            assert stranger.get("/api/projects").status_code == 401
        with server.signed_in("anna") as anna:
            notice = anna.get("/api/server").json()["notices"][0]  # perhaps the disk is full, too
            rows = anna.get("/api/audit").json()

    assert "access.sqlite, was damaged" in notice
    assert f"The copy of {date.today()} replaces it" in notice
    assert "everybody has to sign in again" in notice
    assert [row for row in rows["entries"] if row["action"] == "restore people"]
    assert file.stat().st_mode & 0o777 == 0o600
    assert bool(list(state.glob("access.sqlite.damaged-*"))) == (damage != "missing")


def secure_server_of_these_people(root):
    """As `secure_server`, which would open the damaged file to add people."""
    from contextlib import contextmanager
    from unittest.mock import patch

    from recon4_app.access.login import passwords
    from tests.service.running import server_thread
    from tests.service.secure import CHEAP, Secure

    @contextmanager
    def running():
        with patch.object(passwords, "HASHER", CHEAP), server_thread(root, lan=True) as found:
            yield Secure(found)

    return running()


@pytest.mark.parametrize(
    ("damage", "options"),
    [
        pytest.param("half", [], marks=pytest.mark.study),
        ("text", ["--lan"]),
        pytest.param("middle", ["--lan"], marks=pytest.mark.study),
    ],
)
def test_without_a_copy_the_server_does_not_start_and_says_why(tmp_path, damage, options, capsys):
    state = tmp_path / ".recon4"
    state.mkdir()
    access = open_access(state, login=True)
    access.close()
    DAMAGES[damage](state / "access.sqlite")
    before = (state / "access.sqlite").read_bytes()

    done = subprocess.run(
        [sys.executable, "-m", "recon4", "serve", str(tmp_path), "--port", "0", *options],
        capture_output=True,
        text=True,
        timeout=HANG_S,
        cwd=tmp_path,
    )
    listed = main(["users", "list", "--root", str(tmp_path)])

    assert (done.returncode, listed) == (1, 1)
    assert "Serving" not in done.stdout
    for said in (done.stderr, capsys.readouterr().err):
        assert "is damaged" in said and "there is no intact copy of it" in said
        assert "the link for a first admin" in said
        assert "Traceback" not in said
    assert (state / "access.sqlite").read_bytes() == before


def test_a_running_server_keeps_copies_of_the_people_private_and_without_sessions(tmp_path):
    with secure_server(tmp_path) as server, server.signed_in("anna"):
        copies = access_copies(tmp_path / ".recon4")
        (copy,) = wait_for(copies.all, "a copy of the people")
        copies.make(renew=True)

    assert copy.stat().st_mode & 0o777 == 0o600
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "access.sqlite").write_bytes(copy.read_bytes())
    restored = open_access(tmp_path / "other", login=True)
    assert [one.name for one in restored.accounts.all()] == ["anna", "otto", "rita", "vera"]
    assert not restored.sessions.all()
    restored.close()


def test_backups_without_keys_have_no_copy_of_secrets(tmp_path):
    state = tmp_path / "root" / ".recon4"
    (state / "backups").mkdir(parents=True)
    open_access(state, login=True).close()
    access_copies(state).make()
    make_metrics_token(state)
    (state / "access.sqlite.damaged-20261126T100000").write_bytes(b"people")
    (state / "jobs.sqlite").write_bytes(b"")

    for keys in (False, True):
        back_up(tmp_path / "root", tmp_path / f"{keys}", with_keys=keys, progress=Silent())

    without, with_keys = (set(read_list(newest(tmp_path / f"{k}")).files) for k in (False, True))
    assert without == {".recon4/jobs.sqlite"}
    assert {".recon4/metrics.token", ".recon4/access.sqlite"} < with_keys


@pytest.mark.parametrize("content", [b"", b"\n", b"\xff\xfe" * 30, b"short", b"x" * 1000])
def test_a_damaged_metrics_token_fits_nothing_and_is_made_again(tmp_path, content):
    with secure_server(tmp_path) as server, server.client() as client:
        file = tmp_path / ".recon4" / TOKEN_FILE
        file.write_bytes(content)
        for given in filter(None, (content.strip(), b"x")):
            answer = client.get("/metrics", headers={b"Authorization": b"Bearer " + given})
            assert answer.status_code == 401
        token = make_metrics_token(tmp_path / ".recon4")
        answer = client.get("/metrics", headers={"Authorization": f"Bearer {token}"})

    assert answer.status_code == 200


@pytest.mark.parametrize("name", ["certificate.pem", "key.pem"])
@pytest.mark.parametrize("damage", ["half", "empty", "missing"])
def test_a_damaged_certificate_is_kept_and_a_new_one_is_announced(tmp_path, caplog, name, damage):
    names = frozenset({"localhost"})
    before = made_certificate(tmp_path / "tls", names).fingerprint()
    assert made_certificate(tmp_path / "tls", names).fingerprint() == before
    assert not caplog.messages

    DAMAGES[damage](tmp_path / "tls" / name)
    made = made_certificate(tmp_path / "tls", names)

    made.context()
    assert made.fingerprint() != before
    assert "its fingerprint is another" in caplog.text
    assert list((tmp_path / "tls").glob("*.damaged-*"))
