"""Send a recording to a recon4 server, process it, fetch the map: ``python client_example.py``.

    python docs/client_example.py http://127.0.0.1:8000 walk.pcap --project office

An upload that was cut goes on where it was when this is called again.
"""

from __future__ import annotations

import argparse
import base64
import json
import sys
from pathlib import Path
from typing import Any

import httpx

CHUNK_BYTES = 8 << 20
TUS = {"Tus-Resumable": "1.0.0"}
BYTES = TUS | {"Content-Type": "application/offset+octet-stream"}


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
    view = answer(server.post("/api/jobs", json=job))
    with server.stream("GET", "/api/events", timeout=None) as events:
        for line in events.iter_lines():
            if line.startswith("data:"):
                told = json.loads(line[5:])
                view = told if told["job"]["id"] == view["job"]["id"] else view
                print(
                    f"\r{view['status']['what']} {view['overall']:.0%}  ", end="", file=sys.stderr
                )
            if view["job"]["state"] not in ("queued", "running"):
                return dict(view["job"])
    raise ConnectionError("the server ended; the job goes on, ask /api/jobs later")


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
    given = parser.parse_args()
    with httpx.Client(base_url=given.server, timeout=120.0) as server:
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
