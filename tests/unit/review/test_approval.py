"""Signing results: when it is refused, what stays after a crash, what a check finds."""

import json
import shutil
import sqlite3
import stat
from dataclasses import replace
from html import escape

import pytest

from recon4.progress import Silent
from recon4.report.approval import draft_block
from recon4.review import approval
from recon4.review.approval import NotApprovable, approve, make_read_only
from recon4.review.approval_state import approval_state
from recon4.review.approved import approval_of_map
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import NAME, JournalChanged, append, read_rows
from recon4.review.signature import has_valid_signature, sign
from recon4.review.verify import verify_review
from recon4.store.atomic import write_json
from recon4.store.hashing import FileDigest, hash_file
from recon4.store.project import Project
from recon4.store.seal import changing

SIGNER = {"who": "Eva", "role": "reviewer", "why": "compared with the plan"}
FILES = {
    "edges.json": '{"edges": []}',
    "trajectory.tum": "1 0 0 0 0 0 0 1\n",
    "graph.g2o": "# made by recon4\nVERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n",
    "report.html": f"<p>{draft_block()}",
}


def make_artifact(root, key):
    """One file and its manifest."""
    folder = root / "artifacts" / key
    folder.mkdir()
    (folder / "points.txt").write_text(f"points of {key}\n")
    files = {"points.txt": FileDigest.of(folder / "points.txt").to_json()}
    empty = {"recipe": {"inputs": {}}, "done": {}, "figures": {}, "versions": {}}
    write_json(folder / "manifest.json", empty | {"files": files})


GOOD = {"usability": "good", "reasons": [], "unobserved": []}
LOST = "Tracking was lost in 314 of 545 multiframes (58 %)."
BAD = {"usability": "do not use", "reasons": [LOST], "unobserved": []}
CORRIDOR = {"start_s": 33.0, "end_s": 62.0, "direction": "horizontal", "degeneracy": 0.001}
WEAK = {"usability": "check", "reasons": ["Between …"], "unobserved": [CORRIDOR]}


def publish(root, key="ab", verdict=GOOD):
    """What a run leaves, small."""
    make_artifact(root, key)
    for name, text in FILES.items():
        (root / name).unlink(missing_ok=True)
        (root / name).write_text(text)
    record = {
        "name": "office",
        "points": 7,
        "approval": None,
        "verdict": verdict,
        "stages": [{"stage": "map", "key": key, "figures": {}}],
        "hashes": {"inputs": {}, "results": {name: hash_file(root / name) for name in FILES}},
    }
    with changing(root, "summary.json", compared=False):
        (root / "summary.json").unlink(missing_ok=True)
        write_json(root / "summary.json", record)


@pytest.fixture
def root(tmp_path):
    root = tmp_path / "office"
    Project.open(root).close()
    publish(root)
    return root


@pytest.fixture
def unusable(root):
    """The project with a map that must not be used."""
    shutil.rmtree(root / "artifacts" / "ab")
    publish(root, verdict=BAD)
    return root


@pytest.fixture
def key(tmp_path):
    return tmp_path / ".recon4" / "signing.key"


def reject(j=7, who="Eva"):
    return Decision(kind=DecisionKind.REJECT, who=who, pair=(2, j))


def undo():
    return Decision(kind=DecisionKind.UNDO, who="Eva")


def damage(root):
    return verify_review(root, Silent()).damaged


def test_what_was_approved_is_whole_read_only_and_says_so(root, key):
    found = approve(root, key, SIGNER, confirmed=False)
    make_read_only(found)

    assert damage(root) == ()
    assert {path.name for path in found.folder.iterdir()} == {
        *(*FILES, "summary.json", "approval.json"),
    }
    for path in found.folder.iterdir():
        assert stat.S_IMODE(path.stat().st_mode) == 0o444
    for name in FILES:
        assert found.hash in (root / name).read_text()
    summary = json.loads((root / "summary.json").read_text())
    assert summary["approval"]["hash"] == found.hash
    assert summary["hashes"]["results"] == {name: hash_file(root / name) for name in FILES}
    assert stat.S_IMODE(key.stat().st_mode) == 0o600


def forge_journal(root):
    db = sqlite3.connect(root / NAME)
    db.execute("DROP TRIGGER no_change")
    db.execute("UPDATE journal SET who = 'Jan' WHERE seq = 1")
    db.commit()
    db.close()


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda root: (root / "summary.json").unlink(), "no finished map yet"),
        (forge_journal, "the journal was altered"),
        (lambda root: (root / "edges.json").write_text("{}"), "edges.json is not what the run"),
        (lambda root: (root / "graph.g2o").unlink(), "graph.g2o is not what the run wrote"),
        (lambda root: append(root, reject(9)), "the last decisions are not in the map"),
        (
            lambda root: (root / "artifacts/ab/points.txt").write_text("points of AB\n"),
            "artifacts/ab/points.txt: expected .* rebuild the map first",
        ),
        (
            lambda root: (root / "artifacts/ab/manifest.json").unlink(),
            "manifest.json: cannot be read",
        ),
    ],
)
def test_what_is_not_as_it_was_made_is_not_signed(root, key, spoil, words):
    append(root, reject())
    append(root, undo())
    spoil(root)

    with pytest.raises(NotApprovable, match=words):
        approve(root, key, SIGNER, confirmed=True)

    assert not (root / "versions").exists()
    assert "approve" not in {row.kind for row in read_rows(root)}


@pytest.mark.parametrize(
    ("verdict", "words"),
    [
        (BAD, 'the verdict on this map is "do not use": Tracking was lost in 314 of 545'),
        (WEAK, "a direction of this map is not observable along 1 of its stretches"),
        (None, "this map has no verdict"),
    ],
)
@pytest.mark.parametrize("why", ["", "  fine \n\t   "])
def test_a_map_that_may_be_wrong_is_not_signed_without_a_reason(root, key, verdict, words, why):
    publish(root, "cd", verdict)

    with pytest.raises(NotApprovable, match=f"{words}.* give a reason of at least 10 characters"):
        approve(root, key, SIGNER | {"why": why}, confirmed=True)

    assert not (root / "versions").exists()


def test_the_reason_stands_wherever_the_signer_stands(unusable, key, capsys):
    why = "only the hall <is> used, checked with the total station"

    found = approve(unusable, key, SIGNER | {"why": why}, confirmed=False)

    statement = json.loads((found.folder / "approval.json").read_text())["statement"]
    assert (statement["why"], statement["verdict"]) == (why, BAD)
    report = (unusable / "report.html").read_text()
    assert "do not use" in report and 'class="bad"' in report and escape(why) in report
    for name in ("trajectory.tum", "graph.g2o", "edges.json", "summary.json"):
        text = (unusable / name).read_text()
        assert '"verdict": "do not use"' in text and f'"why": "{why}"' in text
    (line,) = verify_review(unusable, Silent()).approvals
    assert line.endswith(f', verdict "do not use", reason "{why}"')
    state = approval_state(unusable, {"map": "ab"})
    assert (state.verdict, state.why) == ("do not use", why)


def test_a_verdict_that_was_changed_after_the_run_is_not_signed(unusable, key):
    path = unusable / "summary.json"
    path.write_text(path.read_text().replace("do not use", "good"))

    with pytest.raises(NotApprovable, match=r"summary.json"):
        approve(unusable, key, SIGNER, confirmed=False)


def test_a_verdict_that_cannot_be_read_is_not_signed(root, key):
    publish(root, "cd", {"usability": "splendid", "reasons": []})

    with pytest.raises(NotApprovable, match="its verdict cannot be read"):
        approve(root, key, SIGNER, confirmed=False)


def test_the_same_results_are_signed_once(root, key):
    approve(root, key, SIGNER, confirmed=False)
    append(root, reject())
    append(root, undo())

    with pytest.raises(NotApprovable, match="version 1 by Eva approves these results already"):
        approve(root, key, SIGNER | {"who": "Jan"}, confirmed=False)

    assert [path.name for path in (root / "versions").iterdir()] == ["1"]


def test_a_decision_made_while_it_was_signed_is_not_signed_over(root, key, monkeypatch):
    def decide_meanwhile(value, key_file):
        append(root, reject())
        return sign(value, key_file)

    monkeypatch.setattr(approval, "sign", decide_meanwhile)
    with pytest.raises(JournalChanged):
        approve(root, key, SIGNER, confirmed=False)
    monkeypatch.undo()
    append(root, undo())

    found = approve(root, key, SIGNER, confirmed=False)

    assert found.version == 1 and damage(root) == ()
    assert sorted(path.name[:11] for path in (root / "versions").iterdir()) == ["1", "unfinished-"]


def test_an_approval_that_counted_before_a_crash_is_handed_out_later(root, key, monkeypatch):
    def die(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(approval, "put_back", die)
    with pytest.raises(KeyboardInterrupt):
        approve(root, key, SIGNER, confirmed=False)
    monkeypatch.undo()
    before = (root / "report.html").read_text()

    with pytest.raises(NotApprovable, match="already"):
        approve(root, key, SIGNER, confirmed=False)

    state = approval_state(root, {"map": "ab"})
    assert state.text.startswith("Approved v1 · Eva · ")
    assert state.hash not in before and state.hash in (root / "report.html").read_text()


def test_an_earlier_map_keeps_its_approval(root, key):
    first = approve(root, key, SIGNER, confirmed=False)
    publish(root, key="cd")
    killed = root / "versions" / ".tmp-0123456789ab-2"
    killed.mkdir()
    second = approve(root, key, SIGNER | {"who": "Jan"}, confirmed=False)

    assert (first.version, second.version) == (1, 2)
    assert approval_of_map(root, "ab").stamp.who == "Eva"
    assert approval_of_map(root, "cd").hash == second.hash
    assert approval_of_map(root, "ef") is None
    assert damage(root) == () and not killed.exists()


def change_statement(record):
    record["statement"]["figures"]["points"] += 1


def other_hash(record):
    record["hash"] = "0" * 64


def other_algorithm(record):
    record["signature"]["algorithm"] = "none"


def other_signature(record):
    record["signature"]["value"] = "00" * 64


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (change_statement, "the statement is not the one in the journal"),
        (other_hash, "the statement is not the one in the journal"),
        (other_algorithm, "the signature is not valid"),
        (other_signature, "the signature is not valid"),
        (lambda record: record.pop("signature"), "approval.json cannot be read"),
        (lambda record: record["issued"].update({"more.txt": "ab"}), "the signature is not valid"),
        (lambda record: record["issued"].pop("edges.json"), "the signature is not valid"),
        (lambda record: record["signature"].update(key="0" * 16), "it names the key 0000"),
    ],
)
def test_a_changed_approval_is_found(root, key, change, words):
    path = approve(root, key, SIGNER, confirmed=False).folder / "approval.json"
    record = json.loads(path.read_text())
    change(record)
    path.chmod(0o644)
    path.write_text(json.dumps(record))

    assert any(words in what for what in damage(root))


def test_why_an_approval_does_not_count_is_said_in_the_language_of_the_reader(root, key):
    path = approve(root, key, SIGNER, confirmed=False).folder / "approval.json"
    record = json.loads(path.read_text())
    other_signature(record)
    path.chmod(0o644)
    path.write_text(json.dumps(record))

    state = approval_state(root, {"map": "ab"})

    assert state.detail == "the approval of version 1 is not valid: the signature is not valid"
    german = state.in_language("de").detail
    assert german == "die Freigabe von Version 1 ist nicht gültig: die Signatur ist nicht gültig"


def test_added_and_removed_files_of_a_version_are_found(root, key):
    folder = approve(root, key, SIGNER, confirmed=False).folder
    (folder / "more.txt").write_text("x")
    (folder / "edges.json").unlink()

    assert damage(root) == (
        "version 1: edges.json is missing",
        "version 1: more.txt does not belong here",
    )


def test_a_rewritten_journal_does_not_match_the_signature(root, key):
    append(root, reject())
    append(root, undo())
    approve(root, key, SIGNER, confirmed=False)
    rows = read_rows(root)
    (root / NAME).unlink()
    (root / "seals.json").unlink()
    append(root, reject(who="Jan"))
    append(root, undo())
    forged = replace(rows[2], prev_hash=read_rows(root)[1].hash)
    sealed = replace(forged, hash=forged.sealed())
    db = sqlite3.connect(root / NAME)
    values = [getattr(sealed, name) for name in sealed.__slots__]
    db.execute(f"INSERT INTO journal VALUES ({','.join('?' * len(values))})", values)
    db.commit()
    db.close()

    assert damage(root) == ("version 1: it was signed over another journal",)


def test_a_signature_is_of_this_value_by_this_key(tmp_path, key):
    signature = sign({"a": 1}, key)
    other = sign({"a": 1}, tmp_path / "other.key")

    assert has_valid_signature({"a": 1}, signature) and not has_valid_signature({"a": 2}, signature)
    assert sign({"a": 1}, key) == signature and other["key"] != signature["key"]
    assert not has_valid_signature({"a": 1}, signature | {"public_key": other["public_key"]})
