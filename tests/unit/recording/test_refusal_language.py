"""Why a recording is refused is said in the language of who reads it."""

import ast
from pathlib import Path

import numpy as np
import pytest

from recon4 import errors, recording
from recon4.errors import EmptyRecording
from recon4.locales.coded import said, text_of
from recon4.recording.clocks.names import clocks_text
from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.packets.family import Companion
from recon4.recording.packets.ouster.encode import metadata_json
from recon4.recording.packets.ouster.metadata import read_metadata
from recon4.recording.packets.ouster.metadata_choice import MetadataFiles, missing_text
from tests.security.fuzz.kinds_ouster import metadata_of
from tests.unit.recording.ingested import run
from tests.unit.recording.packet_builders import rig, sensor, spin
from tests.unit.recording.test_pcap_streams import FIRST, capture

ROOT = Path(recording.__path__[0])
ROOMS = ("packets", "rigs", "recipes", "assembly", "openers", "bags", "report.py", "clocks")
"""Where a rig or a recording is refused with what to do about it; formats quote libraries."""
KINDS = (np.int64, np.uint32, np.uint16, np.int64, np.int64, np.uint8)
ERRORS = {name for name, one in vars(errors).items() if isinstance(one, type)}


def trees(*rooms):
    paths = [
        p for room in rooms for p in ([ROOT / room] if "." in room else (ROOT / room).rglob("*.py"))
    ]
    return {path: ast.parse(path.read_text("utf-8")) for path in paths}


def is_english(text, functions, depth=0):
    """Whether an expression is put together in English, by itself or in a function it calls."""
    if isinstance(text, ast.JoinedStr | ast.BinOp) or isinstance(getattr(text, "value", 0), str):
        return True
    if not isinstance(text, ast.Call) or depth > 2:
        return False
    if isinstance(text.func, ast.Attribute) and text.func.attr == "join":
        return True
    name = getattr(text.func, "id", getattr(text.func, "attr", ""))
    if name in ("at", "wrong_row"):
        return any(is_english(part, functions, depth) for part in text.args[1:])
    returned = [
        node.value
        for node in ast.walk(functions.get(name, ast.Module([], [])))
        if isinstance(node, ast.Return)
    ]
    return any(is_english(one, functions, depth + 1) for one in returned if one)


def test_no_refusal_of_a_recording_is_put_together_in_english():
    everything = {p: ast.parse(p.read_text("utf-8")) for p in ROOT.rglob("*.py")}
    functions = {
        node.name: node
        for tree in everything.values()
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
    }
    found = [
        f"{path.relative_to(ROOT)}:{call.lineno}"
        for path, tree in trees(*ROOMS).items()
        for call in ast.walk(tree)
        if isinstance(call, ast.Call)
        and isinstance(call.func, ast.Name)
        and (call.func.id in ERRORS or call.func.id == "UnknownFields")
        and call.args
        and is_english(call.args[0], functions)
    ]

    assert found == []


@pytest.mark.parametrize(
    "model", ["XT32", "OT128", "OS1-64", "Mid-360", "Avia", "Helios 32", "M1", "M2", "E1", "Airy"]
)
def test_packets_of_another_model_than_that_of_the_rig_are_named_in_german(tmp_path, model):
    path = capture(tmp_path / "v.pcap", (FIRST, 2370, spin(100)))
    other = rig(sensor("top", model=model, port=2368, address="10.0.0.5"))

    with pytest.raises(EmptyRecording) as caught:
        run(path, out=tmp_path / "o", rig=other)

    text = said(text_of(caught.value), "de")
    assert f"erwartet top: {model} von 10.0.0.5 an Port 2368; die Aufzeichnung hat" in text
    assert "VLP-16" in text
    assert "das Rig berichtigen" in text


def test_what_an_ouster_without_metadata_needs_is_said_in_german():
    other = metadata_of("LEGACY", "OS1-64")
    found = read_metadata(Companion("other.json", metadata_json(other)))
    nothing = Datagrams(*(np.zeros(0, kind) for kind in KINDS))

    text = missing_text(nothing, MetadataFiles((found,), ()), sensor("top", model="OS1-64"))

    assert said(text, "de").startswith("top: Pakete eines Ouster enthalten die Winkel")
    assert "other.json ist von Paketen mit 12608 Bytes (LEGACY, 64 Strahlen" in said(text, "de")


def test_clocks_that_differ_are_said_in_german():
    text = clocks_text([("a", 0), ("b", 3_600_000_000_000)])

    assert said(text, "de").startswith("die Uhren der LiDARs gehen verschieden: b geht gegen a vor")
    assert said(text, "de").endswith("b time_offset_s = -3600.000")
