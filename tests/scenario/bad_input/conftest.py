"""Runs of ``recon4 process`` on bad input."""

import html
import json

import pytest

from recon4.cli.main import main
from tests.builders import (
    write_room_pcap,
)
from tests.scenario.bad_input.inputs import FEW


@pytest.fixture(scope="session")
def pcap(tmp_path_factory):
    return write_room_pcap(tmp_path_factory.mktemp("pcap") / "room.pcap", seconds=0.8)


@pytest.fixture
def process(tmp_path, capsys):
    """Run ``recon4 process`` on an input; returns the summary with the text of the report."""

    def run(recording, *more, out="project"):
        capsys.readouterr()
        code = main(["process", str(recording), "--out", str(tmp_path / out), *FEW, *more])
        said = capsys.readouterr().err
        assert code == 0, said
        summary = json.loads((tmp_path / out / "summary.json").read_text())
        summary["report"] = html.unescape((tmp_path / out / "report.html").read_text("utf-8"))
        return summary

    return run


@pytest.fixture
def refuse(tmp_path, capsys):
    """Run a command that must fail; returns its error line."""

    def run(*arguments, command="process", out="project"):
        capsys.readouterr()
        more = ["--out", str(tmp_path / out), *FEW] if command == "process" else []
        code = main([command, *map(str, arguments), *more])
        said = capsys.readouterr().err
        assert code == 1, said
        assert said.count("recon4: ") == 1
        assert "Traceback" not in said
        line = said.splitlines()[-1]
        assert line.startswith("recon4: ")
        return line

    return run


@pytest.fixture(scope="session")
def whole(pcap, tmp_path_factory):
    """Points in the map of the unharmed recording."""
    out = tmp_path_factory.mktemp("whole") / "project"
    assert main(["process", str(pcap), "--out", str(out), *FEW]) == 0
    return json.loads((out / "summary.json").read_text())["points"]
