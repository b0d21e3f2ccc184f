r"""Upload a recording to a recon4 server, process it and download the map.

    python examples/http_client.py http://127.0.0.1:8000 walk.pcap --project office
    python examples/http_client.py https://backpack.local:8000 walk.pcap --project office \
        --name anna --certificate certificate.pem

Call it again to continue an interrupted upload. The password is read from RECON4_PASSWORD or from
the terminal; ``certificate.pem`` is a copy of ROOT/.recon4/tls/certificate.pem.
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
    """Open a connection that trusts the given certificate, or the usual authorities."""
    trust = ssl.create_default_context(cafile=certificate)
    return httpx.Client(base_url=url, verify=trust, timeout=120.0)


def sign_in(server: httpx.Client, name: str) -> None:
    """Sign in; the client then sends the session's cookie and its token with every request."""
    password = os.environ.get("RECON4_PASSWORD") or getpass.getpass(f"Password of {name}: ")
    me = content_of(server.post("/api/login", json={"name": name, "password": password}))
    server.headers["X-Recon4-Token"] = me["token"]


def upload(server: httpx.Client, file: Path) -> str:
    """Upload a file, or the rest of it, and return its path on the server."""
    size = file.stat().st_size
    fingerprint = f"{file.name} {size} {file.stat().st_mtime_ns}"
    uploads = content_of(server.get("/api/uploads"))
    begun = [one for one in uploads if one["fingerprint"] == fingerprint]
    new = {"name": file.name, "files": 1, "bytes": size, "fingerprint": fingerprint}
    upload = begun[0] if begun else content_of(server.post("/api/uploads", json=new))
    if not upload["finished"]:
        send_bytes(server, file, announce(server, upload["id"], file.name, size), size)
    return str(content_of(server.get(f"/api/uploads/{upload['id']}"))["recording"])


def announce(server: httpx.Client, upload_id: str, name: str, size: int) -> str:
    """Announce a file of an upload and return the URL for its bytes; may be repeated."""
    fields = {"upload": upload_id, "relativePath": name}
    metadata = ",".join(f"{k} {base64.b64encode(v.encode()).decode()}" for k, v in fields.items())
    headers = TUS | {"Upload-Length": str(size), "Upload-Metadata": metadata}
    made = server.post("/api/uploads/files", headers=headers)
    made.raise_for_status()
    return str(made.url.join(made.headers["Location"]))


def send_bytes(server: httpx.Client, file: Path, url: str, size: int) -> None:
    """Send the bytes that the server lacks; each chunk is on its disk when it responds."""
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
    """Start a job with the settings that suit the recording, follow it, return its last state."""
    found = content_of(server.get("/api/look", params={"path": recording}))
    job = {name: found[name] for name in ("preset", "rig", "imu", "gnss")}
    job |= {"project": project, "recordings": [recording]}
    started = content_of(server.post("/api/jobs", json=job))["job"]["id"]
    with server.stream("GET", "/api/events", timeout=None) as events:
        view = content_of(server.get(f"/api/jobs/{started}"))  # the stream omits finished jobs
        lines = events.iter_lines()
        while view["job"]["state"] in ("queued", "running"):
            line = next(lines, None)
            if line is None:
                raise SystemExit("the server ended; the job continues, see /api/jobs later")
            event = json.loads(line[5:]) if line.startswith("data:") else None
            if event and event["job"]["id"] == started:
                view = event
                progress = f"{view['status']['what']} {view['run_progress']:.0%}"
                print(f"\r{progress:40}", end="", file=sys.stderr)
    return dict(view["job"])


def content_of(response: httpx.Response) -> Any:
    """Return the JSON of a response, or exit with the detail of its error."""
    if response.is_error:
        raise SystemExit(f"error of the server: {response.json()['detail']}")
    return response.json()


def main() -> int:
    """Upload a recording, process it, download a result."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("server")
    parser.add_argument("recording", type=Path)
    parser.add_argument("--project", required=True)
    parser.add_argument("--result", default="map.laz")
    parser.add_argument("--name", help="name to sign in with, if the server needs a login")
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
