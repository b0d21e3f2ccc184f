"""Nothing calls out: no telemetry, no grid download, no tunnel, no update check.

Figure: processing, slicing and serving under strace, every process followed: 0 connections and
0 datagrams to an address outside this computer.
"""

import ipaddress
import os
import re
import shutil
import subprocess
import sys

import pytest

from tests.service.running import ROOT

CALLS = "connect,sendto,sendmsg,sendmmsg"
ADDRESS = re.compile(r'(?:inet_addr\("|inet_pton\(AF_INET6, ")([0-9a-f.:]+)"')
CANARY = "import socket; socket.socket(2, 2).connect(('198.51.100.7', 53))"


@pytest.fixture(scope="module")
def isolated():
    """The start of a command without network where that is allowed, else with what there is."""
    if shutil.which("strace") is None:
        pytest.skip("needs strace to see what processes connect to")
    if subprocess.run(["strace", "-f", "-o", "/dev/null", "true"], check=False).returncode:
        pytest.skip("this computer does not allow strace")
    prefix = ["unshare", "-rn", "sh", "-c", 'ip link set lo up; exec "$@"', "sh"]
    allowed = shutil.which("ip") and shutil.which("unshare")
    if not allowed or subprocess.run([*prefix, "true"], check=False).returncode:
        prefix = []
    return prefix


def outside(trace):
    """Addresses a trace names that are not of this computer, with the call."""
    found = []
    for line in trace.read_text(errors="replace").splitlines():
        match = ADDRESS.search(line)
        if match is None:
            continue
        address = ipaddress.ip_address(match[1])
        if not address.is_loopback and not address.is_unspecified:
            found.append(line)
    return found


def traced(isolated, trace, *command):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PROJ_NETWORK": "ON"}
    watched = ["strace", "-f", "--seccomp-bpf", "-qq", "-e", f"trace={CALLS}", "-o", str(trace)]
    return subprocess.run(
        [*isolated, *watched, sys.executable, *command],
        cwd=trace.parent, env=environment, check=False, timeout=900,
    ).returncode  # fmt: skip


@pytest.mark.slow
@pytest.mark.study
def test_processing_slicing_and_serving_connect_to_nothing_outside(
    isolated, short_recording, tmp_path
):
    walk, root = tmp_path / "walk", tmp_path / "projects"
    shutil.copytree(short_recording, walk)  # the server reads what is beside its folder only
    root.mkdir()
    trace = tmp_path / "trace"

    code = traced(isolated, trace, "-m", "tests.security.offline_run", str(walk), str(root))

    assert code == 0
    assert (root / "office" / "map.laz").exists()
    assert 'inet_addr("127.0.0.1")' in trace.read_text(errors="replace")  # it does see connections
    assert outside(trace) == []


def test_the_trace_would_show_a_connection(isolated, tmp_path):
    trace = tmp_path / "trace"

    traced(isolated, trace, "-c", CANARY)

    assert len(outside(trace)) == 1
