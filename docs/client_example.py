r"""Send a recording to a recon4 server, process it, fetch the map: ``python client_example.py``.

    python docs/client_example.py http://127.0.0.1:8000 walk.pcap --project office
    python docs/client_example.py https://backpack.local:8000 walk.pcap --project office \
        --name anna --certificate certificate.pem

An upload that was cut goes on where it was when this is called again. The password is asked for,
or taken from RECON4_PASSWORD; ``certificate.pem`` is a copy of ROOT/.recon4/tls/certificate.pem.
"""

from __future__ import annotations

import argparse
import base64
import getpass
import json
import os
import ssl
import sys
from pathlib import Path
from typing import Any

import httpx

CHUNK_BYTES = 8 << 20
TUS = {"Tus-Resumable": "1.0.0"}
BYTES = TUS | {"Content-Type": "application/offset+octet-stream"}


def connect(url: str, certificate: Path | None) -> httpx.Client:
    """A connection that trusts the server's own certificate, or those every browser trusts."""
    trust = ssl.create_default_context(cafile=certificate)
    return httpx.Client(base_url=url, verify=trust, timeout=120.0)


def sign_in(server: httpx.Client, name: str) -> None:
    """Keep the cookie of a session, and send its token with whatever changes something."""
    password = os.environ.get("RECON4_PASSWORD") or getpass.getpass(f"Password of {name}: ")
    me = answer(server.post("/api/login", json={"name": name, "password": password}))
    server.headers["X-Recon4-Token"] = me["token"]


def upload(server: httpx.Client, file: Path) -> str:
    """Send a file, or the rest of it; its path on the server."""
    size = file.stat().st_size
    mark = f"{file.name} {size} {file.stat().st_mtime_ns}"
    begun = [one for one in answer(server.get("/api/uploads")) if one["fingerprint"] == mark]
    new = {"name": file.name, "files": 1, "bytes": size, "fingerprint": mark}
    upload = begun[0] if begun else answer(server.post("/api/uploads", json=new))
    if not upload["finished"]:
        send_bytes(server, file, announce(server, upload["id"], file.name, size), size)
    return str(answer(server.get(f"/api/uploads/{upload['id']}"))["recording"])


def announce(server: httpx.Client, upload_id: str, name: str, size: int) -> str:
    """Name a file of an upload; where its bytes go. Named twice, it is the same file."""
    words = {"upload": upload_id, "relativePath": name}
    metadata = ",".join(f"{k} {base64.b64encode(v.encode()).decode()}" for k, v in words.items())
    headers = TUS | {"Upload-Length": str(size), "Upload-Metadata": metadata}
    made = server.post("/api/uploads/files", headers=headers)
    made.raise_for_status()
    return str(made.headers["Location"])


def send_bytes(server: httpx.Client, file: Path, url: str, size: int) -> None:
    """Send what the server does not have yet; each piece is on its disk when it answers."""
    offset = int(server.head(url, headers=TUS).headers["Upload-Offset"])
    with file.open("rb") as source:
        while offset < size:
            source.seek(offset)
            headers = BYTES | {"Upload-Offset": str(offset)}
            sent = server.patch(url, headers=headers, content=source.read(CHUNK_BYTES))
            sent.raise_for_status()
            offset = int(sent.headers["Upload-Offset"])
            print(f"\rsent {offset / size:.0%}", end="", file=sys.stderr)


def process(server: httpx.Client, recording: str, project: str) -> dict[str, Any]:
    """Start a job with what suits the recording and follow it; its last state."""
    found = answer(server.get("/api/look", params={"path": recording}))
    job = {name: found[name] for name in ("preset", "rig", "imu", "gnss")}
    job |= {"project": project, "recordings": [recording]}
    started = answer(server.post("/api/jobs", json=job))["job"]["id"]
    with server.stream("GET", "/api/events", timeout=None) as events:
        view = answer(server.get(f"/api/jobs/{started}"))  # what is over is not told again
        lines = events.iter_lines()
        while view["job"]["state"] in ("queued", "running"):
            line = next(lines, None)
            if line is None:
                raise SystemExit("the server ended; the job goes on, ask /api/jobs later")
            told = json.loads(line[5:]) if line.startswith("data:") else None
            if told and told["job"]["id"] == started:
                view = told
                words = f"{view['status']['what']} {view['overall']:.0%}"
                print(f"\r{words:40}", end="", file=sys.stderr)
    return dict(view["job"])


def answer(response: httpx.Response) -> Any:
    """The JSON of an answer; a refusal in the server's own words."""
    if response.is_error:
        raise SystemExit(f"the server says: {response.json()['detail']}")
    return response.json()


def main() -> int:
    """Upload, process, download."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("server")
    parser.add_argument("recording", type=Path)
    parser.add_argument("--project", required=True)
    parser.add_argument("--result", default="map.laz")
    parser.add_argument("--name", help="who signs in, where the server asks")
    parser.add_argument("--certificate", type=Path, help="the server's own certificate")
    given = parser.parse_args()
    with connect(given.server, given.certificate) as server:
        if given.name:
            sign_in(server, given.name)
        job = process(server, upload(server, given.recording), given.project)
        print(f"\n{job['state']} {job['note']}", file=sys.stderr)
        if job["state"] != "succeeded":
            return 1
        with server.stream("GET", f"/api/projects/{given.project}/files/{given.result}") as file:
            file.raise_for_status()
            with Path(given.result).open("wb") as out:
                out.writelines(file.iter_bytes())
    print(given.result)
    return 0


if __name__ == "__main__":
    sys.exit(main())
