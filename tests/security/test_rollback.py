"""A whole project put back as it was earlier is announced, by the server's record outside of it.

Figures held: 0 files with an approval from a project older than its server's record; a new project
of the same name, a copy and one back from the trash are not accused.
"""

import shutil

import httpx
import pytest

from recon4.cli.main import main
from recon4.review.approval_state import ApprovalKind, latest_state
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append, read_rows
from recon4_app.projects.trash import Trash
from recon4_app.review.newest_approvals import record_all, record_signed
from tests.project_builder import approve_project, build_project
from tests.service.running import server_thread

OLDER = "this project is older than what this server approved (version 2 of "
RESULTS = ("report.html", "trajectory.tum", "summary.json")


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A server's folder after two approvals, and the project before the first, second, and now."""
    base = tmp_path_factory.mktemp("rollback")
    office, key = base / "maps" / "office", base / "maps" / ".recon4" / "signing.key"
    build_project(office, points=20_000)
    keep(office, base / "draft")
    approve_project(office, key, who="anna")
    record_signed(office, key.parent)
    keep(office, base / "first")
    for name in RESULTS:
        (office / name).unlink()  # links to the files of the version
    build_project(office, points=21_000)
    approve_project(office, key, who="emma")
    record_signed(office, key.parent)
    keep(office, base / "second")
    return base


def keep(project, target):
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(project, target, copy_function=shutil.copy2)


@pytest.fixture
def base(made, tmp_path):
    keep(made, tmp_path / "base")
    return tmp_path / "base"


@pytest.fixture
def maps(base):
    return base / "maps"


def roll_back(base, state):
    keep(base / state, base / "maps" / "office")


def exported(maps, tmp_path, *options):
    return main(["export", str(maps / "office"), str(tmp_path / "map.ply"), *options])


@pytest.mark.parametrize("state", ["draft", "first"])
def test_an_earlier_state_with_its_journal_versions_and_seals_is_refused(
    base, maps, tmp_path, capsys, state
):
    assert main(["verify", str(maps)]) == 0 and exported(maps, tmp_path) == 0
    (tmp_path / "map.ply").unlink()
    roll_back(base, state)
    capsys.readouterr()

    assert exported(maps, tmp_path) == 1 and not (tmp_path / "map.ply").exists()
    assert OLDER in capsys.readouterr().err
    assert main(["verify", str(maps / "office")]) == 1
    assert OLDER in capsys.readouterr().out
    found = latest_state(maps / "office")
    assert found.kind is ApprovalKind.NOT_VALID
    assert found.text == "Not approved: older than what this server approved"
    assert exported(maps, tmp_path, "--draft") == 0


def test_the_pages_say_so_and_hand_out_no_file(base, maps):
    roll_back(base, "first")
    with server_thread(maps) as server:
        (card,) = server.get("/api/projects").json()
        file = server.get("/api/projects/office/files/trajectory.tum")
        review = server.get("/api/projects/office/review").json()["approval"]

    texts = {card["approval"]["text"], review["text"]}
    assert texts == {"Not approved: older than what this server approved"}
    assert file.status_code == 422 and OLDER in file.json()["detail"]


def test_one_command_takes_it_as_it_is_and_the_audit_log_has_it(base, maps, tmp_path, capsys):
    roll_back(base, "first")

    assert main(["verify", str(maps / "office"), "--accept"]) == 0
    assert latest_state(maps / "office").text.startswith("Approved v1 · anna")
    assert exported(maps, tmp_path) == 0
    capsys.readouterr()
    assert main(["users", "audit", "--root", str(maps)]) == 0
    assert "accept project as it is: office" in capsys.readouterr().out
    roll_back(base, "draft")
    assert latest_state(maps / "office").kind is ApprovalKind.NOT_VALID
    assert main(["verify", str(maps / "office"), "--accept"]) == 0
    assert latest_state(maps / "office").text == "Draft: not approved"


def test_decisions_after_the_newest_approval_are_no_older_state(maps):
    append(maps / "office", Decision(kind=DecisionKind.REJECT, who="anna", pair=(0, 300)))

    assert latest_state(maps / "office").kind is ApprovalKind.CHANGED


def test_a_later_row_that_only_carries_the_recorded_hash_does_not_help(base, maps):
    """A row with the hash written into it, whose content does not have that hash."""
    import sqlite3

    newest = read_rows(maps / "office")[-1].hash
    roll_back(base, "first")
    db = sqlite3.connect(maps / "office" / "decisions.sqlite")
    db.execute(
        "INSERT INTO journal SELECT seq + 1, time, who, 'reject', 0, 300, '{}', '', hash, ? "
        "FROM journal ORDER BY seq DESC LIMIT 1",
        (newest,),
    )
    db.commit()
    db.close()

    assert latest_state(maps / "office").kind is ApprovalKind.NOT_VALID


def test_older_results_under_the_newer_journal_are_named_an_earlier_version(base, maps, capsys):
    """Ledger, results and artifacts of version 1; journal and seals made to fit."""
    office = maps / "office"
    for name in ("ledger.sqlite", "project.json", *RESULTS):
        (office / name).unlink()
        shutil.copy2(base / "first" / name, office / name)

    assert latest_state(office).kind is ApprovalKind.EARLIER
    assert latest_state(office).text.endswith("; version 2 is newer")
    assert main(["export", str(office), str(base / "map.ply")]) == 0
    assert "; version 2 is newer" in capsys.readouterr().out


def test_a_new_project_of_the_same_name_is_not_accused_and_the_old_one_comes_back(base, maps):
    trash = Trash(maps, maps / ".recon4" / "trash", kept_s=100.0)
    deleted = trash.put(maps / "office")
    build_project(maps / "office", points=20_000)
    assert latest_state(maps / "office").text == "Draft: not approved"
    shutil.rmtree(maps / "office")

    trash.restore(deleted.id)

    assert latest_state(maps / "office").text.startswith("Approved v2 · emma")
    roll_back(base, "first")
    assert latest_state(maps / "office").kind is ApprovalKind.NOT_VALID
    trash.remove(trash.put(maps / "office").id)
    assert list((maps / ".recon4" / "approvals").iterdir()) == []


def test_an_approval_that_a_killed_server_did_not_record_is_recorded_later(base, maps):
    shutil.rmtree(maps / ".recon4" / "approvals")
    keep(maps / "office", maps / "copy")

    record_all(maps, maps / ".recon4")
    roll_back(base, "first")
    record_all(maps, maps / ".recon4")  # does not follow the older state

    assert latest_state(maps / "office").kind is ApprovalKind.NOT_VALID
    assert latest_state(maps / "copy").text.startswith("Approved v2 · emma")


def test_approving_an_older_state_again_takes_it_as_it_is(base, maps):
    roll_back(base, "draft")
    with server_thread(maps) as server:
        before = server.get("/api/projects/office").json()["approval"]["kind"]
        approve_project(maps / "office", maps / ".recon4" / "signing.key", who="anna")
        record_signed(maps / "office", maps / ".recon4")
        after = server.get("/api/projects/office").json()["approval"]["text"]

    assert before == "not valid" and after.startswith("Approved v1 · anna")


def test_a_damaged_record_is_named_and_trusts_nothing(maps, tmp_path, capsys):
    path = maps / ".recon4" / "approvals" / "office.json"
    path.write_text('{"format": 1, "version": "two"}')

    assert exported(maps, tmp_path) == 1
    assert "approvals/office.json in the server's own files is damaged" in capsys.readouterr().err
    assert latest_state(maps / "office").kind is ApprovalKind.NOT_VALID
    assert main(["verify", str(maps / "office"), "--accept"]) == 0


def test_an_approval_over_http_is_recorded(base, maps):
    """Signed in its confined child; the record is written by the server after it."""
    shutil.rmtree(maps / ".recon4" / "approvals")
    roll_back(base, "draft")
    approve_project(maps / "office", maps / ".recon4" / "signing.key")  # completes the summary
    for name in ("decisions.sqlite", "seals.json"):
        (maps / "office" / name).unlink()
    shutil.rmtree(maps / "office" / "versions")
    approve = {"why": "checked against the plan", "confirmed": False}
    with server_thread(maps) as server:
        state = server.get("/api/projects/office/review").json()
        answer = httpx.post(
            f"{server.url}/api/projects/office/review/approve",
            json=approve | {"after_seq": state["seq"], "graph": state["graph"]},
            headers={"Origin": server.url},
            timeout=60.0,
        )

    assert answer.status_code == 201, answer.text
    assert answer.json()["approval"]["kind"] == "approved"
    assert (maps / ".recon4" / "approvals" / "office.json").is_file()
