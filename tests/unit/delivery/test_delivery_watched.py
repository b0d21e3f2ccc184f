"""Deliveries while they are made: progress, requests to stop, language, README."""

import signal
import subprocess
import sys
import zipfile
from dataclasses import dataclass, field

import pytest

from recon4.delivery.check import check_file
from recon4.delivery.kinds import KINDS
from recon4.delivery.package import DeliveryWish, deliver
from recon4.delivery.readme import classes_line, crs_line, file_line
from recon4.delivery.report_files import server_key
from recon4.errors import Cancelled
from recon4.progress import Silent
from recon4.report.client_words import words
from recon4.review.trusted_keys import ensure_own_key
from tests.project_builder import approve_project, build_project

PIECES = ("approvals", "hash map.laz", "report", "pack", "compare")


@dataclass
class Watched(Silent):
    """Counts the units of each piece of work; stops at the second unit of one."""

    stop_at: str = ""
    pieces: list = field(default_factory=list)
    """Name, expected and counted units."""

    def start(self, what, total, unit):
        self.pieces.append([what, total, 0])

    def advance(self, done=1):
        if self.pieces[-1][0] == self.stop_at:
            raise Cancelled(self.stop_at)
        self.pieces[-1][2] += done

    def units(self, what):
        """Expected and counted units of the last piece of a name."""
        return next((total, done) for name, total, done in self.pieces[::-1] if name == what)


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    folder = tmp_path_factory.mktemp("server")
    (folder / ".recon4").mkdir()
    ensure_own_key(folder / ".recon4")
    build_project(folder / "room", points=5_000)
    approve_project(folder / "room", folder / ".recon4" / "signing.key")
    return folder / "room"


def wish(room, **more):
    return DeliveryWish(files=("map.laz",), key=server_key(room), **more)


def test_every_byte_that_is_hashed_packed_and_compared_is_counted(room, tmp_path):
    watched, out = Watched(), tmp_path / "a.zip"

    deliver(room, out, wish(room), progress=watched)

    with zipfile.ZipFile(out) as packed:
        sizes = {one.filename: one.file_size for one in packed.infolist()}
    whole = sum(sizes.values())
    compared = whole - sizes["manifest.json"]
    assert watched.units("hash map.laz") == (sizes["map.laz"], sizes["map.laz"])
    assert watched.units("pack") == (whole, whole)
    assert watched.units("compare") == (compared, compared)
    of_artifacts, counted = watched.units("approvals")
    assert of_artifacts == counted > sizes["map.laz"]
    again = Watched()
    assert check_file(out, progress=again).intact and again.units("compare") == (compared, compared)


@pytest.mark.parametrize("piece", PIECES)
def test_a_request_to_stop_counts_in_every_piece_and_leaves_nothing(room, tmp_path, piece):
    with pytest.raises(Cancelled):
        deliver(room, tmp_path / "a.zip", wish(room), progress=Watched(stop_at=piece))

    assert list(tmp_path.iterdir()) == []


def test_all_texts_for_the_client_are_in_the_language_that_was_chosen(room, tmp_path):
    deliver(room, tmp_path / "a.zip", wish(room, language="de"), progress=Silent())

    with zipfile.ZipFile(tmp_path / "a.zip") as packed:
        page, readme = (packed.read(n).decode() for n in ("report.html", "README.txt"))
        digest = check_file(tmp_path / "a.zip").intact and packed.read("manifest.json").decode()
    assert '<html lang="de">' in page and "Bericht" in page
    listed = digest.partition('"map.laz"')[2].partition('"sha256": "')[2][:64]
    assert listed in page
    lines = readme.splitlines()
    files = [line.split()[0] for line in lines if line.startswith("  ") and "." in line.split()[0]]
    assert files == ["report.pdf", "report.html", "map.laz", "manifest.json"]
    assert "die Karte, 5 000 Punkte, als LAZ 1.4: für die meisten Programme" in readme


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_readme_says_of_every_file_what_it_is(language):
    said = words(language)
    lines = {kind: file_line(kind, kind, points=1_000, texts=said) for kind in KINDS}

    assert len({line.split(maxsplit=1)[1] for line in lines.values()}) == len(KINDS) - 2
    assert "12" in lines["poses.txt"] and "# offset" in lines["map.pcd"]
    assert "1 000" in lines["map.copc.laz"] and "1 000" not in lines["plan.dxf"]


@pytest.mark.parametrize(
    ("crs", "says"),
    [
        ("", "local frame of the map, meters"),
        ("site grid", "site grid"),
        ("EPSG:31469", "EPSG:31469 (DHDN / 3-degree Gauss-Kruger zone 5)"),
        ("EPSG:99999", "EPSG:99999"),
    ],
)
def test_the_readme_names_the_system_of_the_coordinates(crs, says):
    assert crs_line(crs, words()) == f"Coordinates of the map: {says}."


def test_the_readme_names_the_classes_that_points_have():
    assert classes_line({0: 5, 2: 7, 6: 1, 18: 9}, words()).endswith(": 2 ground, 6 building.")
    assert classes_line({0: 5}, words()) == ""


KILLED = """
import os, signal, sys
from pathlib import Path
from recon4.delivery.package import DeliveryWish, deliver
from recon4.progress import Silent

class Killed(Silent):
    def start(self, what, total, unit):
        self.seen = (*getattr(self, "seen", ()), what)
        if self.seen[-2:] == ("pack", "compare"):
            os.kill(os.getpid(), signal.SIGKILL)

deliver(Path(sys.argv[1]), Path(sys.argv[2]), DeliveryWish(files=("map.laz",)), progress=Killed())
"""


def test_what_a_killed_delivery_left_is_removed_by_the_next_one(room, tmp_path):
    out, other = tmp_path / "a[1].zip", tmp_path / ".b.zip.abcdefgh"
    other.mkdir()
    ended = subprocess.run([sys.executable, "-c", KILLED, room, out], check=False)
    assert ended.returncode == -signal.SIGKILL
    left = {path.name for path in tmp_path.iterdir()}
    assert len(left) == 3, "the folder of its files, the file that was to be compared, another's"

    deliver(room, out, wish(room), progress=Silent())

    assert {path.name for path in tmp_path.iterdir()} == {out.name, other.name}


def test_a_delivery_that_is_being_packed_is_left_alone_by_another_one(room, tmp_path):
    out, inner = tmp_path / "a.zip", []

    class Twice(Silent):
        def start(self, what, total, unit):
            if what == "pack" and not inner:
                inner.append(what)
                deliver(room, out, wish(room), progress=Silent())

    deliver(room, out, wish(room), progress=Twice())

    assert inner and [path.name for path in tmp_path.iterdir()] == ["a.zip"]
    assert check_file(out).intact
