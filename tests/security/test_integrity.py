"""What carries an approval is what was approved.

Figures held: 0 files with an approval on altered bytes, by command line and over HTTP, whichever
file of the approval's chain was altered; 0 tracebacks.
"""

import json
import shutil

import httpx
import pytest

from recon4.archive.verify import verify
from recon4.cli.main import main
from recon4.pipeline import remake
from recon4.progress import Silent
from recon4.review.approval import put_back
from recon4.review.approved import approval_of
from recon4.review.decisions import (
    Decision,
    DecisionKind,
)
from recon4.review.journal import append
from recon4.review.row_contents import ApprovalFacts
from recon4.review.signature import sign
from recon4.review.source import Source
from recon4.store.atomic import write_json
from recon4.store.checked import Altered
from recon4.store.hashing import FileDigest, hash_json
from recon4.store.project import Project, read_artifacts
from recon4.store.seal import begin_change
from tests import moved_points
from tests.benchmarks.flips import flip_bits, make, make_server_state
from tests.project_builder import approve_project, build_project
from tests.service.running import server_thread

ENDINGS = ("csv", "laz", "dxf", "png", "svg", "pdf", "tif")
CUT = {"kind": "horizontal", "z_m": 1.5, "thickness_m": 0.4}


@pytest.fixture(scope="module")
def approved(tmp_path_factory):
    """A project as it was approved; copied by every test."""
    root = tmp_path_factory.mktemp("integrity")
    build_project(root / "office", points=120_000)
    approve_project(root / "office", root / ".recon4" / "signing.key", who="anna")
    return root / "office"


@pytest.fixture
def office(approved, tmp_path):
    shutil.copytree(approved.parent, tmp_path / "root", copy_function=shutil.copy2)
    return tmp_path / "root" / "office"


def move_points(root):
    """Some points of the map 0.1 m to the east."""
    moved_points.move_points(read_artifacts(root)["map"])


def damage_points(root, at=40):
    """A byte of the points, in place; the file keeps its length."""
    path = read_artifacts(root)["map"] / "tiles" / "xyz.zst"
    data = bytearray(path.read_bytes())
    data[at] ^= 1
    path.write_bytes(data)


def move_tile(root):
    """The corner of a tile, in its list."""
    path = read_artifacts(root)["map"] / "tiles.json"
    record = json.loads(path.read_text())
    record["tiles"][0]["origin_m"][0] += 0.1
    path.write_text(json.dumps(record))


def write_manifest_again(root):
    """Points moved, and the manifest made to fit: only the signature knows better."""
    move_points(root)
    folder = read_artifacts(root)["map"]
    record = json.loads((folder / "manifest.json").read_text())
    for name in moved_points.CHANGED:
        record["files"][name] = FileDigest.of(folder / name).to_json()
    (folder / "manifest.json").write_text(json.dumps(record))


def put_elsewhere(root):
    """A place on Earth that the approved map never had."""
    record = {
        "levelling": {},
        "crs": {"name": "EPSG:32633"},
        "georeference": {"origin": {"lat_deg": 50.0, "lon_deg": 14.0, "height_m": 300.0}},
    }
    (read_artifacts(root)["level"] / "georeference.json").write_text(json.dumps(record))


def change_signer(root):
    path = root / "versions" / "1" / "approval.json"
    path.chmod(0o644)
    path.write_text(path.read_text().replace("anna", "emma"))


ATTACKS = [
    move_points,
    damage_points,
    move_tile,
    write_manifest_again,
    put_elsewhere,
    change_signer,
]


@pytest.mark.parametrize("attack", ATTACKS)
@pytest.mark.parametrize("ending", ["laz", "ply"])
def test_an_altered_map_is_not_exported_with_an_approval(office, tmp_path, attack, ending, capsys):
    attack(office)

    code = main(["export", str(office), str(tmp_path / f"map.{ending}")])

    assert code == 1 and not list(tmp_path.glob("*map*"))
    assert "Traceback" not in capsys.readouterr().err


def test_the_refusal_names_tile_file_and_hashes(office, tmp_path, capsys):
    damage_points(office)

    assert main(["slice", str(office), str(tmp_path / "s.csv"), "--z", "1.5"]) == 1

    words = capsys.readouterr().err
    assert "tile (0, 0, 0) of the map was changed" in words
    assert "tiles/xyz.zst" in words and "expected " in words and ", got " in words


@pytest.mark.parametrize("attack", ATTACKS)
def test_an_altered_map_is_not_cut_with_an_approval(office, tmp_path, attack, capsys):
    attack(office)

    out = [tmp_path / f"slice.{ending}" for ending in ENDINGS]
    codes = [main(["slice", str(office), str(path), "--z", "1.5"]) for path in out]

    assert codes == [1] * len(ENDINGS) and not list(tmp_path.glob("*slice*"))
    assert "Traceback" not in capsys.readouterr().err


def test_what_was_not_altered_is_stamped(office, tmp_path):
    assert main(["export", str(office), str(tmp_path / "map.ply")]) == 0
    assert main(["slice", str(office), str(tmp_path / "slice.csv"), "--z", "1.5"]) == 0

    assert b'"who": "anna"' in (tmp_path / "map.ply").read_bytes()[:600]
    assert '"who": "anna"' in (tmp_path / "slice.csv").read_text()[:600]


def test_a_tile_the_cut_does_not_touch_does_not_stop_it(tmp_path):
    office = tmp_path / "office"
    build_project(office, points=600_000)  # three blocks of hashes
    approve_project(office, tmp_path / ".recon4" / "signing.key", who="anna")
    damage_points(office, at=-1)  # the last block: a tile in the far corner
    line = ["--line", "0.5,0.5,0.5,9.0"]

    assert (
        main(["slice", str(office), str(tmp_path / "near.csv"), *line, "--thickness", "0.1"]) == 0
    )
    assert main(["slice", str(office), str(tmp_path / "all.csv"), "--z", "1.5"]) == 1
    assert main(["export", str(office), str(tmp_path / "map.laz")]) == 1


@pytest.mark.parametrize(
    ("attack", "endings"),
    [
        (move_points, ("csv", "pdf")),
        pytest.param(move_points, ENDINGS, marks=pytest.mark.study),
        *(pytest.param(one, ("csv", "pdf"), marks=pytest.mark.study) for one in ATTACKS[1:]),
    ],
)
def test_the_server_writes_no_approval_on_an_altered_map(office, attack, endings):
    """Every ending under every attack is cut by command above; here each is a child process."""
    base = "/api/projects/office/slices"
    asked = {"plane": CUT}
    with server_thread(office.parent) as server:
        before = server.get(base).json()
        attack(office)
        answers = [
            server.get(f"{base}/export.{ending}", params={"ask": json.dumps(asked)})
            for ending in endings
        ]
        answers += [server.get(f"{base}/control/report.{ending}") for ending in ("csv", "html")]
        shown = server.get(base).json()["approval"]
        review = server.get("/api/projects/office/review").json()["approval"]

    assert before["approval"]["text"].startswith("Approved v1 · anna · ")
    assert [answer.status_code for answer in answers] == [422] * len(answers)
    assert all(
        "expected" in a.json()["detail"] or "is not valid" in a.json()["detail"] for a in answers
    )
    assert (shown["kind"], review["kind"]) == ("not valid", "not valid")
    assert shown["detail"] and review["detail"]


def test_an_issued_file_that_was_altered_is_neither_served_nor_put_back(office):
    with server_thread(office.parent) as server:
        whole = server.get("/api/projects/office/files/trajectory.tum")
        for folder in (office, office / "versions" / "1"):
            path = folder / "trajectory.tum"
            text = path.read_text().replace("0 0 0 0 0 0 0 1", "0 0 0 9 0 0 0 1")
            path.unlink()
            path.write_text(text)
        altered = server.get("/api/projects/office/files/trajectory.tum")
    approval = approval_of(
        office, {stage: path.name for stage, path in read_artifacts(office).items()}
    )

    assert (whole.status_code, altered.status_code) == (200, 422)
    assert "trajectory.tum: expected " in altered.json()["detail"]
    with pytest.raises(Altered, match=r"trajectory\.tum"):
        put_back(office, approval)


def test_a_picture_of_altered_points_beside_an_approval_is_refused(office):
    base = "/api/projects/office/slices"
    asked = {"plane": CUT, "width": 64, "height": 64}
    with server_thread(office.parent) as server:
        whole = server.post(f"{base}/image", json=asked)
        checked = server.get("/api/projects/office/review").json()["approval"]["kind"]
        move_points(office)
        altered = server.post(f"{base}/image", json=asked)

    assert (whole.status_code, checked, altered.status_code) == (200, "approved", 422)
    assert "tile (0, 0, 0) of the map was changed" in altered.json()["detail"]


def test_an_approval_without_hashes_of_manifests_is_compared_with_the_whole_file(
    approved, tmp_path
):
    """As recon4 signed before: the manifest itself is all there is to compare with."""
    old = tmp_path / "old"
    shutil.copytree(approved, old)
    sign_as_before(old, tmp_path / ".recon4" / "signing.key")
    manifest = read_artifacts(old)["map"] / "manifest.json"
    record = json.loads(manifest.read_text())
    for digest in record["files"].values():
        digest.pop("blocks", None)
    manifest.write_text(json.dumps(record))

    assert main(["export", str(old), str(tmp_path / "whole.ply")]) == 0
    assert b'"who": "anna"' in (tmp_path / "whole.ply").read_bytes()[:600]
    move_points(old)
    assert main(["export", str(old), str(tmp_path / "moved.ply")]) == 1


def sign_as_before(root, key_file):
    """Statement format 1, by the same person over the same empty journal."""
    path = root / "versions" / "1" / "approval.json"
    record = json.loads(path.read_text())
    statement = {name: value for name, value in record["statement"].items() if name != "manifests"}
    sha256, issued = hash_json(statement), record["issued"]
    signature = sign({"hash": sha256, "issued": issued}, key_file)
    path.chmod(0o644)
    record = {"statement": statement, "hash": sha256, "issued": issued, "signature": signature}
    write_json(path, record)
    summary = json.loads((root / "summary.json").read_text())
    summary["approval"]["hash"] = sha256
    write_json(root / "summary.json", summary)
    (root / "decisions.sqlite").unlink()
    (root / "seals.json").unlink()
    facts = ApprovalFacts(version=1, approval=sha256, artifacts=hash_json(statement["artifacts"]))
    append(root, Decision(kind=DecisionKind.APPROVE, who="anna", facts=facts))


def test_every_flipped_bit_of_a_project_and_its_server_is_found(tmp_path):
    """A tenth of ``python -m tests.benchmarks.flips``."""
    make_server_state(tmp_path)
    make(tmp_path)
    assert verify(tmp_path, Silent()).damaged == ()

    found = flip_bits(tmp_path, 200, seed=7)

    assert (found.missed, found.tracebacks, found.found) == ([], [], 200)


def edit_settings(root):
    """`remake` reads the settings of the stages it keeps in their manifests."""
    path = read_artifacts(root)["verification"] / "manifest.json"
    path.write_text(path.read_text().replace('"version": 1', '"version": 2', 1))


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (edit_settings, "manifest.json is not what recon4 wrote"),
        (lambda root: (root / "summary.json").write_text("{"), "summary.json"),
        (lambda root: (root / "project.json").write_text('{"format": 1}'), "project.json is not"),
        (lambda root: (root / "decisions.sqlite").unlink(), "decisions.sqlite"),
        (lambda root: (root / "seals.json").write_text("[]"), "seals.json is not what was"),
    ],
)
def test_verify_names_what_was_edited(office, spoil, words, capsys):
    assert main(["verify", str(office)]) == 0
    spoil(office)

    assert main(["verify", str(office)]) == 1

    output = capsys.readouterr()
    assert words in output.out and "Traceback" not in output.out + output.err


@pytest.mark.parametrize("use", [remake, Source.of])
def test_settings_edited_in_a_manifest_are_not_used_to_make_a_map_again(office, use):
    edit_settings(office)

    with pytest.raises(Altered, match=r"manifest\.json is not what recon4 wrote"):
        use(office)


def test_control_points_that_were_edited_make_no_acceptance_sheet(office):
    base = "/api/projects/office/slices/control"
    with server_thread(office.parent) as server:
        put = httpx.put(
            server.url + base, json={"points": []}, headers={"Origin": server.url}, timeout=30.0
        )
        whole = server.get(f"{base}/report.csv")
        path = office / "slices" / "control.json"
        path.write_text(path.read_text().replace('"map"', '"crs"'))
        edited = server.get(f"{base}/report.csv")

    assert (put.status_code, whole.status_code, edited.status_code) == (200, 200, 422)
    assert "control.json is not what recon4 wrote" in edited.json()["detail"]


def test_a_process_killed_while_it_changed_a_file_leaves_it_open_not_altered(office):
    begin_change(office, ("slices/control.json",))
    (office / "slices").mkdir()
    (office / "slices" / "control.json").write_text('{"version": 1}')

    found = verify(office, Silent())

    assert found.damaged == ()
    assert [note for note in found.notes if note.startswith("slices/control.json is open")]


def test_what_is_accepted_is_sealed_as_it_is(office, capsys):
    (office / "project.json").write_text('{"format": 1, "name": "by hand"}')
    with pytest.raises(Altered, match="recon4 verify --accept"):
        Project.open(office)

    assert main(["verify", "--accept", str(office)]) == 0
    Project.open(office).close()


def test_changed_files_of_an_earlier_server_are_found_and_named(tmp_path, capsys):
    with server_thread(tmp_path):
        pass
    state = tmp_path / ".recon4"
    code = main(["verify", str(tmp_path)])
    assert code == 0, capsys.readouterr()
    data = bytearray((state / "access.sqlite").read_bytes())
    data[-1] ^= 1
    (state / "access.sqlite").write_bytes(data)

    assert main(["verify", str(tmp_path)]) == 1
    assert ".recon4: access.sqlite is not what recon4 wrote" in capsys.readouterr().out
