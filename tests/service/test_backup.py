"""A backup made while a server runs a job restores to something that goes on from there."""

from recon4.archive.verify import verify
from recon4.cli.main import main
from recon4.progress import Silent
from recon4.review.signature import public_key_of
from tests.project_builder import approve_project, build_project
from tests.service.running import SLOW, open_gate, recording_with_gate, server_thread


def test_a_backup_while_a_job_runs_is_whole_and_restores(tmp_path):
    root = tmp_path / "root"
    root.mkdir()
    build_project(root / "office", points=20_000)
    approve_project(root / "office", root / ".recon4" / "signing.key")
    recording = recording_with_gate(root / "recording")
    with server_thread(root, worker_module=SLOW) as server:
        job = server.start("walk", recording)
        server.wait_at_gate(job)
        assert main(["backup", str(root), "--out", str(tmp_path / "backups")]) == 0
        open_gate(recording)
        server.wait_state(job, "succeeded")

    assert main(["restore", str(tmp_path / "backups"), str(tmp_path / "new")]) == 0

    found = verify(tmp_path / "new", Silent())
    assert (found.damaged, found.approvals, len(found.untrusted)) == ((), (), 1)
    key = public_key_of(root / ".recon4" / "signing.key")
    assert main(["keys", "add", "Server before", key, "--root", str(tmp_path / "new")]) == 0
    assert len(verify(tmp_path / "new", Silent()).approvals) == 1
    with server_thread(tmp_path / "new", worker_module=SLOW) as again:
        assert {one["id"] for one in again.get("/api/projects").json()} == {"office", "walk"}
