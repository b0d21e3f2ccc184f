"""Secrets never reach a log: passwords, session tokens, bearer tokens, one-time links.

Held: 0 of the secrets used in a session occur in any file below ``logs``, nor in the output.
"""

import re
import socket
import ssl
import subprocess
import sys

import httpx

from recon4_app.access.login.login_service import open_access
from recon4_app.access.people import Role
from recon4_app.metrics_routes import make_metrics_token
from tests.deadlines import HANG_S
from tests.service.running import ROOT
from tests.service.secure import PASSWORD

WRONG = "a wrong password of somebody"


def test_no_secret_reaches_a_log(tmp_path):
    state = tmp_path / ".recon4"
    state.mkdir()
    access = open_access(state, login=True)
    access.accounts.add("anna", Role.ADMIN, PASSWORD)
    access.close()
    token = make_metrics_token(state)
    with subprocess.Popen(
        [sys.executable, "-m", "recon4", "serve", str(tmp_path),
         "--lan", "--host", "127.0.0.1", "--port", "0"],
        cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    ) as process:  # fmt: skip
        url = re.search(r"https://\S+", process.stdout.readline())[0].rstrip("/")
        secrets = use(url, token)
        process.terminate()
        _, stderr = process.communicate(timeout=HANG_S)
    logs = [path.read_text("utf-8") for path in (state / "logs").rglob("*") if path.is_file()]
    everything = "\n".join([stderr, *logs])

    assert "malformed" in everything or "Invalid HTTP" in everything, "something was logged"
    assert [name for name, secret in secrets.items() if secret in everything] == []


def use(url, token):
    """Use every secret, in the right and in the wrong place; what they were."""
    with httpx.Client(base_url=url, verify=False, timeout=HANG_S) as client:
        client.post("/api/login", json={"name": "anna", "password": WRONG})
        client.post("/api/login", json={"name": WRONG, "password": PASSWORD})
        answer = client.post("/api/login", json={"name": "anna", "password": PASSWORD})
        form = answer.json()["token"]
        cookies = dict(client.cookies)
        bearer = {"Authorization": f"Bearer {token}"}
        for path in ("/metrics", f"/metrics?token={token}", f"/api/projects?password={PASSWORD}"):
            client.get(path, headers=bearer)
        client.post("/api/jobs", headers={"X-Recon4-Token": form}, content=PASSWORD)
        client.get("/api/projects", headers={"Host": token})
    malformed = httpx.URL(url)
    send_malformed(malformed, f"{token} {PASSWORD}".encode())
    return {"password": PASSWORD, "wrong": WRONG, "form token": form, "bearer": token, **cookies}


def send_malformed(url, sent):
    """A malformed request with secrets in it."""
    context = ssl._create_unverified_context()
    with (
        socket.create_connection((url.host, url.port), timeout=10.0) as plain,
        context.wrap_socket(plain) as connection,
    ):
        connection.sendall(sent + b"\r\n\r\n")
        connection.recv(1000)
