"""The report of a 2-D map says its verdict, and shows map, trajectory and edges."""

import re
from base64 import b64encode

import numpy as np
import pytest

from recon4.pipeline import process
from recon4.recording.sources import Sources
from tests.planar_walks import along, blank_corridor, furnished_room, scanned, write_carmen


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    folder = tmp_path_factory.mktemp("room")
    corners = np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0], [3.0, 1.0]])
    scans = scanned(furnished_room(), along(corners)).scans
    write_carmen(folder / "walk.log", scans)
    out = folder / "<b>walk & co"
    return out, process(Sources((folder / "walk.log",)), out)


def page(out):
    return (out / "report.html").read_text("utf-8")


def test_a_good_map_is_said_to_be_good(room):
    out, summary = room

    text = page(out)

    assert "No problem found in this map" in text
    assert "Tracking was not lost for longer than a moment" in text
    assert f">{summary.scans} <small>0 lost</small>" in text
    assert f"{summary.path_length_m:.1f} <small>m</small>" in text


def test_map_trajectory_and_edges_are_shown(room):
    out, _ = room

    text = page(out)

    image = b64encode((out / "map.png").read_bytes()).decode("ascii")
    assert text.count(image) == 3
    assert len(re.findall(r'<path class="line-final" d="M', text)) == 1
    assert text.count('class="mark-end"') >= 1
    assert text.count('class="edge-unverified" d="M') == 1
    assert "<tr><td>unverified</td>" in text


def test_the_page_runs_nothing_and_escapes_names(room):
    text = page(room[0])

    assert "&lt;b&gt;walk &amp; co" in text
    assert "<b>walk" not in text
    assert "<script" not in text
    assert "http" not in text.replace("http-equiv", "").replace("http://www.w3.org", "").replace(
        "http://purl.org", ""
    ).replace("http://creativecommons.org", "")


def test_a_corridor_is_said_to_be_unobservable_and_where(tmp_path):
    walked = scanned(blank_corridor(), along(np.array([[2.0, 1.0], [27.0, 1.0]])))
    write_carmen(tmp_path / "walk.log", walked.scans)
    summary = process(Sources((tmp_path / "walk.log",)), tmp_path / "out")

    text = page(tmp_path / "out")

    assert (
        f'class="verdict {"bad" if summary.verdict.usability == "do not use" else "warning"}"'
        in text
    )
    assert all(reason.replace("'", "&#39;") in text for reason in summary.verdict.reasons)
    assert "Where the laser hardly observes one direction" in text
    rows = text.split("Where the laser hardly observes one direction")[1].split("</table>")[0]
    assert rows.count("<tr>") == 1 + len(summary.verdict.unobserved)
    trajectory = text.split("Trajectory of the laser.")[0].rsplit("<svg", 1)[1]
    assert re.search(r'class="line-(check|do-not-use)"', trajectory), "no stretch on the plan"
    assert "Findings along the walk" in text
