"""What the page *Map* reads first: files of the map, or made at a first request of earlier ones."""

import pytest

from recon4.first_view.files import FIRST_FILES
from recon4.store.project import read_artifacts
from recon4_app.compute_pool.process import ChildProcess
from tests.project_builder import approve_project, build_project
from tests.served import served

BASE = "/api/projects/{}/map"
PROJECTS = ("office", "earlier")
STORED = ("xyz", "normalized")


def projects(root):
    for name in PROJECTS:
        build_project(root / name, points=2000, first=name == "office")


server = served(projects, fresh=True)


@pytest.fixture
def children(monkeypatch):
    """One entry for each child of the compute pool that begins."""
    start, begun = ChildProcess.start, []

    async def counted(*args, **options):
        begun.append(args)
        return await start(*args, **options)

    monkeypatch.setattr(ChildProcess, "start", counted)
    return begun


def first_files(server, project="office"):
    return read_artifacts(server.root / project)["map"] / FIRST_FILES


def index_of(server, project="office"):
    return server.get(BASE.format(project)).json()


def sample(server, stored, project="office"):
    key = read_artifacts(server.root / project)["map"].name
    query = {"stored": stored, "version": 6}
    return server.get(f"{BASE.format(project)}/{key}/sample", params=query)


def test_a_map_is_opened_without_any_work(server, children):
    index = index_of(server)
    samples = [sample(server, stored).content for stored in STORED]

    assert index["color"] == "normalized" and index["key"] == first_files(server).parent.name
    assert [len(data) for data in samples] == [11 * 2000, 2 * 2000]
    assert not children
    assert len(sample(server, "time").content) == 2 * 2000
    assert len(children) == 1


def test_one_child_makes_all_of_a_map_of_an_earlier_version(server, children):
    earlier = index_of(server, "earlier")
    samples = [sample(server, stored, "earlier").content for stored in STORED]

    assert len(children) == 1
    assert earlier | {"key": ""} == index_of(server) | {"key": ""}
    assert samples == [sample(server, stored).content for stored in STORED]


def test_what_was_approved_is_shown_or_nothing(server, children):
    approve_project(server.root / "office", server.root / ".recon4/signing.key")
    folder = first_files(server)
    whole = {stored: sample(server, stored).status_code for stored in STORED}
    points = folder / "xyz.bin"
    points.chmod(0o644)
    points.write_bytes(points.read_bytes()[:-1] + b"x")
    changed = sample(server, "xyz")
    index = folder / "index.json"
    index.chmod(0o644)
    index.write_bytes(index.read_bytes().replace(b"normalized", b"intensity"))

    assert whole == dict.fromkeys(STORED, 200)
    assert "xyz.bin: expected" in changed.json()["detail"]
    assert "index.json: expected" in server.get(BASE.format("office")).json()["detail"]
    assert not children


@pytest.mark.parametrize("link", ["xyz.bin", ""])
def test_a_link_out_of_the_project_is_not_followed(server, children, link):
    place = first_files(server) / link
    away = place.rename(server.root / "secret")
    place.symlink_to(away)
    (away if link else away / "xyz.bin").write_bytes(b"secret" * 9)

    answer = sample(server, "xyz")

    assert len(answer.content) == 11 * 2000 and len(children) == 1


@pytest.mark.parametrize(
    ("name", "damage"),
    [
        ("index.json", b'{"key": 1}'),
        ("index.json", b"[NaN"),
        ("xyz.bin", b"\x01\x00"),
        ("xyz.bin", b"\x02\x00\x00\x00" + b"\x00" * 8),
        ("xyz.bin", b"\x01\x00\x00\x00" + b"\x02\x00\x00\x00" * 2 + b"\x00" * 21),
        ("xyz.bin", b"\x01\x00\x00\x00" + b"\xff" * 8),
    ],
)
def test_a_damaged_file_is_said(server, name, damage):
    place = first_files(server) / name
    place.unlink()
    place.write_bytes(damage)

    answer = server.get(BASE.format("office")) if "index" in name else sample(server, "xyz")

    assert answer.status_code >= 400 and name in answer.json()["detail"]
