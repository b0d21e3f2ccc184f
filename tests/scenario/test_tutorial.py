"""Every command of the tutorial, in its order, on a simulated walk; signed as on its page."""

import re
import shlex

import httpx
import pytest

from recon4.cli.main import main
from tests.service.running import ROOT, server_thread

pytestmark = pytest.mark.study

TUTORIAL = (ROOT / "docs" / "tutorial" / "first-map.md").read_text("utf-8")
CHAPTERS = re.split(r"^## ", TUTORIAL, flags=re.MULTILINE)[1:]
DOUBLES_FOUND = 1
"""Exit code of ``recon4 doubles`` if there are any, as the tutorial says."""


def commands(chapter):
    """The commands in the blocks of a chapter."""
    blocks = re.findall(r"^```sh\n(.*?)^```", chapter, re.MULTILINE | re.DOTALL)
    return [shlex.split(line) for block in blocks for line in block.splitlines()]


def run(command):
    program, *arguments = command
    assert program == "recon4"
    code = main(arguments)
    assert code == 0 or (arguments[0], code) == ("doubles", DOUBLES_FOUND), command


def sign(server):
    """What *Approve map* sends."""
    state = server.get("/api/projects/walk/review").json()
    answer = httpx.post(
        f"{server.url}/api/projects/walk/review/approve",
        json={
            "why": "checked against the plan",
            "confirmed": True,
            "after_seq": state["seq"],
            "graph": state["graph"],
        },
        headers={"Origin": server.url},
        timeout=60.0,
    )
    assert answer.status_code == 201, answer.text


def test_the_tutorial_leads_from_a_recording_to_a_signed_map(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    seen = []
    for chapter in CHAPTERS:
        for command in commands(chapter):
            seen.append(command[1])
            if command[1] == "serve":  # it runs until a person ends it; `sign` has one of its own
                assert (tmp_path / command[2] / "walk" / "map.laz").is_file()
            else:
                run(command)
        if chapter.startswith("6. Sign"):
            with server_thread(tmp_path / "projects") as server:
                sign(server)

    shown = capsys.readouterr().out
    assert seen[:3] == ["simulate", "info", "process"] and seen[-3:] == ["verify", *["export"] * 2]
    assert "Approved v1" in shown.replace("approved v1", "Approved v1")
    for made in ("plan.dxf", "plan.png", "map.ply", "findings.csv"):
        assert (tmp_path / made).stat().st_size > 100
