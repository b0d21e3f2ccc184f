"""A typical session for `test_no_outbound.py`: process, slice, serve, request, stop.

Run as a program of its own, with a recording and a folder, so that strace can follow it.
"""

import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

RECON4 = (sys.executable, "-m", "recon4")
FEW = ("--set", "map.voxel_m=0.05", "--set", "graph.node_stride=10")

GRID = """
from recon4.errors import GeoreferenceError
from recon4.georeference.crs import CrsTransform, GeodeticOrigin
try:
    CrsTransform(GeodeticOrigin(0.9, 0.14, 100.0), "EPSG:25832+7837")
except GeoreferenceError as error:
    assert "needs the grid" in str(error), error
else:
    raise SystemExit("the height system was accepted without its grid")
"""


def main(recording: Path, root: Path) -> None:
    office = root / "office"
    pcap, imu = str(recording / "recording.pcap"), str(recording / "imu.csv")
    recon4("process", pcap, "--imu", imu, "--out", str(office), *FEW)
    recon4("slice", str(office), str(root / "slice.png"), "--z", "1.0")
    recon4("settings")
    crs_with_grids()
    serve(root, pcap)


def recon4(*arguments: str) -> None:
    subprocess.run([*RECON4, *arguments], check=True)


def crs_with_grids() -> None:
    """Request a height system whose grid is not installed: PROJ could download it."""
    subprocess.run([sys.executable, "-c", GRID], check=True)


def serve(root: Path, recording: str) -> None:
    command = [*RECON4, "serve", str(root), "--port", "0"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert server.stdout is not None
    url = next(word for line in server.stdout for word in line.split() if "http://" in word)
    for path in (
        *("", "api/projects", "projects/office/", "projects/office/viewer/"),
        *("projects/office/slices/", "api/projects/office/thumbnail", "api/live/choices"),
        *("api/projects/office/report", "api/server", f"api/look?path={recording}"),
        *("api/projects/office/review", "api/projects/office/slices/overview"),
    ):
        with urllib.request.urlopen(url.rstrip("/") + "/" + path, timeout=120) as answer:
            answer.read()
    server.send_signal(signal.SIGTERM)
    assert server.wait(60) == 0


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
