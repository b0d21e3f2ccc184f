"""Calls of the review API."""

import json
from dataclasses import dataclass
from pathlib import Path

from tests.service.running import Running

WRONG = {"frame_i": 20, "frame_j": 90}
RIGHT = {"frame_i": 17, "frame_j": 77}


@dataclass(frozen=True)
class Reviewing:
    """A project of its own on a server all tests share: its helper processes start once."""

    running: Running
    root: Path

    def get(self, path="", **options):
        return self.running.get(self._url(path), **options)

    def post(self, path, **options):
        return self.running.post(self._url(path), **options)

    def report(self):
        """The report as the server shows it."""
        answer = self.running.get(f"/api/projects/{self.root.name}/report")
        assert answer.status_code == 200, answer.text
        return answer.text

    def _url(self, path):
        return f"/api/projects/{self.root.name}/review{path}"


def decide(server, kind, pair, **more):
    return server.post("/decisions", json={"kind": kind, **pair, **more})


def keys_of(root):
    summary = json.loads((root / "summary.json").read_text())
    return {stage["stage"]: stage["key"] for stage in summary["stages"]}


def make_a_new_map(server, root):
    """As the button does: neither the recording nor an earlier job is needed."""
    answer = server.running.post(f"/api/projects/{root.name}/remake")
    assert answer.status_code == 201
    server.running.wait_state(answer.json()["job"]["id"], "succeeded")
