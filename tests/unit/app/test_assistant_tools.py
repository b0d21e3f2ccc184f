"""What assistants are offered, and what they are refused before a request is made."""

import asyncio

import pytest
from typer.testing import CliRunner

from recon4.cli.main import app
from recon4.errors import ConfigError
from recon4.system.stopping import StopSignals
from recon4_app.assistant.comparing import compare, figures_of
from recon4_app.assistant.http_client import ServerClient
from recon4_app.assistant.server import make_server

WRITING = {"start_job", "resume_job", "cancel_job", "rebuild_map", "decide_loop", "undo_decision"}


def offered(**options):
    server = make_server(ServerClient("http://127.0.0.1:1/"), **options)
    return {tool.name for tool in asyncio.run(server.list_tools())}, server.instructions


def test_an_assistant_only_looks_unless_more_is_allowed(tmp_path):
    names, instructions = offered(allow_write=False, downloads=None)
    more, _ = offered(allow_write=True, downloads=tmp_path)

    assert not names & (WRITING | {"download_export"})
    assert "only looks" in instructions
    assert more == names | WRITING | {"download_export"}


@pytest.mark.parametrize("url", ["127.0.0.1:8000", "ftp://a.example/", "https:///x"])
def test_an_address_that_is_none_is_refused(url):
    with pytest.raises(ConfigError, match="expected the address of a server"):
        ServerClient(url)


def test_a_password_never_goes_through_a_network_without_tls(tmp_path):
    with pytest.raises(ConfigError, match="has no TLS"):
        ServerClient("http://rita@backpack.local:8000/")
    with pytest.raises(ConfigError, match="does not belong into an address"):
        ServerClient("https://rita:owl@backpack.local:8000/")
    with pytest.raises(ConfigError, match=r"certificate\.pem is no certificate"):
        ServerClient("https://rita@backpack.local/", certificate=tmp_path / "certificate.pem")
    assert ServerClient("http://rita@[::1]:8000/maps").url == "http://[::1]:8000/maps/"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["http://rita@127.0.0.1:8000"], "expected in RECON4_PASSWORD"),
        (["--downloads", "/no/such/folder"], "no folder"),
    ],
)
def test_the_command_refuses_what_cannot_work(arguments, message, monkeypatch):
    monkeypatch.delenv("RECON4_PASSWORD", raising=False)

    ended = CliRunner().invoke(app, ["mcp", *arguments], obj=StopSignals())

    assert ended.exit_code == 2 and message in ended.output


def test_runs_of_the_same_recording_are_known_by_their_hashes():
    first = {"hashes": {"inputs": {"a.pcap": "1", "imu.csv": "2"}}, "points": 3}
    second = {"hashes": {"inputs": {"b.pcap": "2", "imu.csv": "1"}}, "points": 3}

    assert compare(first, second).same_recording is True
    assert compare(first, {"hashes": {"inputs": {"c": "1"}}}).same_recording is False
    assert compare(first, {}).same_recording is None
    assert compare(first, first).figures == []
    assert figures_of({"edges": {"accepted": 3}, "settings": {"a": {"b": 1}}, "lists": [1]}) == {
        "edges.accepted": 3
    }
