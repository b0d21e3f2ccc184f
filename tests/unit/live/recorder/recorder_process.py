"""A real recorder process on real sockets."""

import json
import socket
import subprocess
import sys
from contextlib import contextmanager

from recon4.live.protocol import decode_message
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.report import ImportReport


@contextmanager
def recording(session, module="recon4.live.recorder.process"):
    process = subprocess.Popen(
        [sys.executable, "-m", module, str(session.project)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    with process:
        try:
            assert process.stdout.readline() == "ready\n", process.stderr.read()
            with Talk(session) as talk:
                yield process, talk
        finally:
            process.kill()


class Talk:
    """A listener on the recorder's socket."""

    def __init__(self, session):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(20.0)
        self.socket.connect(str(session.socket("recorder")))
        self.lines = self.socket.makefile("r")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.lines.close()
        self.socket.close()

    def send(self, **message):
        self.socket.sendall(json.dumps(message).encode() + b"\n")

    def hear(self, kind, met=lambda message: True):
        for line in self.lines:
            message = json.loads(line)
            if message["kind"] == kind and met(message):
                return message
        raise AssertionError(f"never heard {kind}")


def decode(message):
    return decode_message(json.dumps(message).encode())


def send(session, count, *, size=1206, start=0):
    udp = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    udp.bind(("127.0.0.77", 0))
    for k in range(start, start + count):
        udp.sendto(k.to_bytes(4, "little") + bytes(size - 4), (session.address, 2368))
    udp.close()


def numbers(path):
    report = ImportReport()
    found = [
        int.from_bytes(batch.buffer[s : s + 4].tobytes(), "little")
        for batch in read_pcap(path, report)
        for s in batch.start.tolist()
    ]
    return found, report
