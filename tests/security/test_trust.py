"""An approval counts only if its signer is trusted, and only while the journal has it.

Figures held: 0 files with an approval of an unknown signer, replayed, or without its row; each
refusal says why and what to do.
"""

import json
import shutil
import sqlite3

import pytest

from recon4.archive.verify import accept, verify
from recon4.cli.main import main
from recon4.progress import Silent
from recon4.review.approval_state import ApprovalKind, latest_state
from recon4.review.decisions import (
    Decision,
    DecisionKind,
)
from recon4.review.journal import append, read_rows
from recon4.review.row_contents import ApprovalFacts
from recon4.review.signature import public_key_of, sign
from recon4.store.atomic import write_json
from recon4.store.hashing import hash_json
from tests.project_builder import add_multiframes, approve_project, build_project

OUT = ("map.laz", "map.ply", "poses.txt")
CUTS = ("slice.csv", "slice.laz", "slice.dxf", "slice.pdf", "slice.tif")


@pytest.fixture(scope="module")
def approved(tmp_path_factory):
    root = tmp_path_factory.mktemp("trust") / "maps"
    build_project(root / "office", points=60_000)
    add_multiframes(root / "office")
    approve_project(root / "office", root / ".recon4" / "signing.key", who="anna")
    return root


@pytest.fixture
def maps(approved, tmp_path):
    """A folder of a server with an approved project."""
    shutil.copytree(approved, tmp_path / "maps", copy_function=shutil.copy2)
    return tmp_path / "maps"


@pytest.fixture
def office(maps):
    return maps / "office"


def sign_again(office, key_file, **changes):
    """The statement with changes, signed by another key over the same journal, seals made to fit.

    What a person who can write the project folder can do.
    """
    path = office / "versions" / "1" / "approval.json"
    record = json.loads(path.read_text())
    statement = record["statement"] | changes
    sha256, issued = hash_json(statement), record["issued"]
    signature = sign({"hash": sha256, "issued": issued}, key_file)
    path.unlink()
    write_json(path, dict(statement=statement, hash=sha256, issued=issued, signature=signature))
    write_journal_again(office, version=1, statement=statement)
    summary = json.loads((office / "summary.json").read_text())
    summary["approval"] |= {"hash": sha256, "who": statement["who"]}
    write_json(office / "summary.json", summary)
    accept(office)


def write_journal_again(office, *, version, statement):
    """A journal with one approval, its chain intact."""
    for name in ("decisions.sqlite", "seals.json"):
        (office / name).unlink()
    facts = ApprovalFacts(
        version=version,
        approval=hash_json(statement),
        artifacts=hash_json(statement["artifacts"]),
        verdict="good",
    )
    append(office, Decision(kind=DecisionKind.APPROVE, who=statement["who"], facts=facts))


def remove_last_row(office):
    """As `sqlite3` does it, with seals made to fit."""
    db = sqlite3.connect(office / "decisions.sqlite")
    db.execute("DROP TRIGGER no_removal")
    db.execute("DELETE FROM journal WHERE seq = (SELECT max(seq) FROM journal)")
    db.commit()
    db.close()
    accept(office)


def refused(office, tmp_path, capsys):
    """Every export is refused with the same words, which are returned; nothing is left."""
    out = tmp_path / "out"
    out.mkdir(exist_ok=True)
    codes = [main(["export", str(office), str(out / name)]) for name in OUT]
    codes += [main(["slice", str(office), str(out / name), "--z", "1.5"]) for name in CUTS]
    assert codes == [1] * len(codes) and list(out.iterdir()) == []
    words = {line for line in capsys.readouterr().err.splitlines() if line.startswith("recon4:")}
    assert len(words) == 1, words
    return words.pop()


def test_an_approval_with_anybodys_key_is_refused_everywhere(maps, office, tmp_path, capsys):
    sign_again(office, tmp_path / "any.key", who="J. Novák")
    unknown = sign({}, tmp_path / "any.key")

    words = refused(office, tmp_path, capsys)

    assert f"unknown key {unknown['key']}" in words
    assert f"recon4 keys add NAME {unknown['public_key']} --root ROOT" in words
    for path in (office, maps):
        assert main(["verify", str(path)]) == 1
        said = capsys.readouterr().out
        assert "version 1 by J. Novák: the signature is intact" in said
        assert "0 damaged, 1 not trusted" in said and "approved by" not in said
    assert latest_state(office).kind is ApprovalKind.UNKNOWN_SIGNER
    assert latest_state(office).text == (
        f"Signed by unknown key {unknown['key']}: not counted as approved"
    )


def test_a_key_that_an_admin_added_counts_and_one_that_was_removed_does_not(
    maps, office, tmp_path, capsys
):
    sign_again(office, tmp_path / "brno.key")
    key, root = public_key_of(tmp_path / "brno.key"), ["--root", str(maps)]

    assert main(["keys", "add", "Survey Brno", key, *root]) == 0
    assert main(["verify", str(office)]) == 0
    assert "(Survey Brno)" in capsys.readouterr().out
    assert main(["export", str(office), str(tmp_path / "map.ply")]) == 0
    assert "Approved v1 · anna · 20" in capsys.readouterr().out
    assert b"recon4 approval" in (tmp_path / "map.ply").read_bytes()[:600]

    assert main(["keys", "remove", "Survey Brno", *root]) == 0
    assert "which" in refused(office, tmp_path, capsys)
    assert main(["users", "audit", *root]) == 0
    log = capsys.readouterr().out
    assert "trust key: " in log and "remove key: " in log and "Survey Brno" in log


def test_on_another_computer_the_signer_is_unknown_until_the_person_adds_the_key(
    maps, office, tmp_path, capsys, monkeypatch
):
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    alone = tmp_path / "stick" / "office"
    shutil.copytree(office, alone)
    key = public_key_of(maps / ".recon4" / "signing.key")

    words = refused(alone, tmp_path, capsys)

    assert "the signature is intact, but the signer is unknown on this computer" in words
    assert words.endswith(f"recon4 keys add NAME {key}")
    assert main(["verify", str(alone)]) == 1
    assert main(["keys", "add", "Maps of the office", key]) == 0
    assert main(["verify", str(alone)]) == 0
    assert main(["export", str(alone), str(tmp_path / "map.ply")]) == 0


def test_a_project_moved_to_another_server_does_not_count_there(office, tmp_path, capsys):
    other = tmp_path / "other"
    shutil.copytree(office, other / "office")
    sign({}, other / ".recon4" / "signing.key")

    assert "this server did not sign it" in refused(other / "office", tmp_path, capsys)


def test_a_draft_is_written_on_request_and_says_so(office, tmp_path, capsys):
    sign_again(office, tmp_path / "any.key")

    assert main(["export", str(office), str(tmp_path / "map.ply"), "--draft"]) == 0
    assert main(["slice", str(office), str(tmp_path / "s.csv"), "--z", "1.5", "--draft"]) == 0

    assert capsys.readouterr().out.count("Draft: written without approval") == 2
    assert b"recon4 approval" not in (tmp_path / "map.ply").read_bytes()[:600]
    assert "recon4 approval" not in (tmp_path / "s.csv").read_text()[:600]


def test_a_restored_backup_brings_no_trust_with_it(maps, office, tmp_path, capsys):
    sign_again(office, tmp_path / "brno.key")
    key = public_key_of(tmp_path / "brno.key")
    assert main(["keys", "add", "Survey Brno", key, "--root", str(maps)]) == 0
    assert main(["backup", str(maps), "--out", str(tmp_path / "backups"), "--with-keys"]) == 0

    assert main(["restore", str(tmp_path / "backups"), str(tmp_path / "new")]) == 0
    found = verify(tmp_path / "new" / "office", Silent())

    assert found.damaged == () and found.approvals == ()
    assert len(found.untrusted) == 1 and "unknown on this computer" in found.untrusted[0]
    with_keys = [str(tmp_path / "backups"), str(tmp_path / "same"), "--with-keys"]
    assert main(["restore", *with_keys]) == 0
    assert len(verify(tmp_path / "same", Silent()).approvals) == 1


def test_after_a_renewal_of_the_key_earlier_approvals_count(maps, office, capsys):
    assert main(["keys", "renew", "--root", str(maps)]) == 0
    assert main(["verify", str(office)]) == 0
    assert main(["keys", "list", "--root", str(maps)]) == 0

    assert capsys.readouterr().out.count("(own, ") == 2


def test_an_approval_whose_row_was_removed_is_not_dropped_in_silence(office, tmp_path, capsys):
    remove_last_row(office)

    words = refused(office, tmp_path, capsys)

    assert "versions/1 is in no row of the journal" in words and "approve the map again" in words
    assert main(["verify", str(office)]) == 1
    assert latest_state(office).kind is ApprovalKind.NOT_VALID
    assert latest_state(office).text == "Not approved: an approval is missing in the journal"


def test_a_missing_version_that_the_summary_names_is_said(office, tmp_path, capsys):
    remove_last_row(office)
    shutil.rmtree(office / "versions")

    assert "summary.json names an approval" in refused(office, tmp_path, capsys)


def test_an_earlier_statement_is_not_presented_as_a_later_version(office, tmp_path, capsys):
    """The folder is copied and the journal written again; the signature itself stays intact."""
    shutil.copytree(office / "versions" / "1", office / "versions" / "2")
    shutil.rmtree(office / "versions" / "1")
    record = json.loads((office / "versions" / "2" / "approval.json").read_text())
    write_journal_again(office, version=2, statement=record["statement"])
    accept(office)

    assert "are not those that were signed" in refused(office, tmp_path, capsys)
    assert main(["verify", str(office)]) == 1


def test_another_name_in_the_journal_than_in_the_statement_is_found(office, tmp_path, capsys):
    record = json.loads((office / "versions" / "1" / "approval.json").read_text())
    write_journal_again(office, version=1, statement=record["statement"] | {"who": "emma"})
    db = sqlite3.connect(office / "decisions.sqlite")
    db.execute("DROP TRIGGER no_change")
    (row,) = read_rows(office)
    body = json.loads(row.body)
    body["facts"]["approval"] = record["hash"]
    text = json.dumps(body, separators=(",", ":"))
    forged = type(row)(**{n: getattr(row, n) for n in row.__slots__} | {"body": text})
    db.execute("UPDATE journal SET body = ?, hash = ?", (text, forged.sealed()))
    db.commit()
    db.close()
    accept(office)

    assert "signer in the journal are not those" in refused(office, tmp_path, capsys)
