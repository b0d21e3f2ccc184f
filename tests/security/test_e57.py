"""XML in an E57 file: 0 requests leave, 0 bytes of a key leave, every refusal within 10 s."""

import subprocess
import sys
import time

import pytest

from recon4.errors import CorruptFile
from recon4.recording.formats.reference_clouds import read_points
from tests.security.e57_files import with_xml, write_sound

LISTENER = """
import sys
from http.server import BaseHTTPRequestHandler, HTTPServer

class Handler(BaseHTTPRequestHandler):
    def do_GET(self):
        with open(sys.argv[1], "a") as file:
            file.write(self.path + "\\n")
        self.send_response(404)
        self.end_headers()

    def log_message(self, *words):
        pass

server = HTTPServer(("127.0.0.1", 0), Handler)
print(server.server_port, flush=True)
server.serve_forever()
"""
"""In a process of its own: libE57 holds the interpreter while it waits for an answer."""


@pytest.fixture
def sound(tmp_path):
    path = tmp_path / "sound.e57"
    write_sound(path)
    return path


@pytest.fixture
def listener(tmp_path):
    """Its address, and a function that returns the received requests."""
    asked = tmp_path / "asked.txt"
    asked.touch()
    command = [sys.executable, "-c", LISTENER, str(asked)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            port = process.stdout.readline().strip()
            yield f"http://127.0.0.1:{port}", lambda: asked.read_text().split()
        finally:
            process.kill()


def before_root(text):
    return lambda xml: xml.replace(b"<e57Root", text.encode() + b"<e57Root", 1)


def in_root(text):
    return lambda xml: xml.replace(b"<e57Root", b"<e57Root " + text.encode(), 1)


def inside(text):
    return lambda xml: xml.replace(b"</e57Root>", text.encode() + b"</e57Root>", 1)


def nested(depth):
    return inside('<a type="Structure">' * depth + "</a>" * depth)


XSI = 'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
OUTSIDE = {
    "document type": lambda url: before_root(f'<!DOCTYPE e57Root SYSTEM "{url}/d.dtd">'),
    "parameter entity": lambda url: before_root(
        f'<!DOCTYPE e57Root [<!ENTITY % d SYSTEM "{url}/d.dtd"> %d;]>'
    ),
    "entity": lambda url: before_root(
        f'<!DOCTYPE e57Root [<!ENTITY e SYSTEM "{url}/signing.key">]>'
    ),
    "schema": lambda url: in_root(
        f'{XSI} xsi:schemaLocation="http://www.astm.org/COMMIT/E57/2010-e57-v1.0 {url}/s.xsd"'
    ),
    "schema without namespace": lambda url: in_root(
        f'{XSI} xsi:noNamespaceSchemaLocation="{url}/s.xsd"'
    ),
}


@pytest.mark.parametrize("kind", OUTSIDE)
def test_xml_that_refers_to_something_outside_is_refused_and_nothing_is_fetched(
    tmp_path, sound, listener, kind
):
    url, asked = listener
    path = with_xml(sound, tmp_path / "hostile.e57", OUTSIDE[kind](url))

    with pytest.raises(CorruptFile, match="XML section"):
        list(read_points(path))

    assert asked() == []


LAUGHS = "".join(f'<!ENTITY a{k} "{f"&a{k - 1};" * 10}">' for k in range(1, 10))
SHAPES = {
    "200 000 nested elements": (nested(200_000), "nested deeper than 64"),
    "65 nested elements": (nested(65), "nested deeper than 64"),
    "entities of entities": (
        before_root(f'<!DOCTYPE e57Root [<!ENTITY a0 "ha">{LAUGHS}]>'),
        "document type",
    ),
    "a million and more elements": (inside("<a/>" * 1_000_001), "more than 1000000 elements"),
    "17 MiB": (inside(f"<!--{'x' * (17 << 20)}-->"), "at most 16777216"),
    "another encoding": (
        lambda xml: xml.replace(b'encoding="UTF-8"', b'encoding="IBM1140"'),
        "expected the encoding UTF-8",
    ),
    "UTF-16": (lambda xml: xml.decode().encode("utf-16"), "expected UTF-8"),
    "an instruction": (before_root('<?xml-model href="x"?>'), "processing instruction"),
    "no end": (lambda xml: xml[:-20], "not sound XML"),
    "65 attributes": (
        in_root(" ".join(f'a{k}="1"' for k in range(65))),
        "more than 64 attributes",
    ),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_xml_beyond_the_caps_is_refused_soon_with_the_figure(tmp_path, sound, shape):
    change, words = SHAPES[shape]
    path = with_xml(sound, tmp_path / "hostile.e57", change)

    began_s = time.process_time()
    with pytest.raises(CorruptFile, match=words):
        list(read_points(path))

    assert time.process_time() - began_s < 10.0


def test_a_file_with_its_xml_written_again_is_still_read(tmp_path, sound):
    path = with_xml(sound, tmp_path / "same.e57", lambda xml: xml.replace(b"\n", b"\n  \n"))

    assert sum(len(chunk) for chunk in read_points(path)) == 500


@pytest.mark.parametrize("at", [0, 700, 1020])
def test_a_changed_bit_in_a_page_of_the_xml_is_noticed(sound, at):
    data = bytearray(sound.read_bytes())
    data[len(data) - 1024 + at] ^= 1
    sound.write_bytes(data)

    with pytest.raises(CorruptFile, match="wrong checksum"):
        list(read_points(sound))
