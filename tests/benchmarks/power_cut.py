"""Power cuts at many moments: ``python -m tests.benchmarks.power_cut [--cuts 200] [--reruns 5]``.

Needs FUSE (Linux, ``/dev/fuse`` and ``fusermount3``) and ``mfusepy``. A short walk is processed,
pairs are decided about, the map is approved and a file is uploaded, all on a disk that records
every write, fsync and rename. Then the disk as it may be after a power cut is built for many
moments (`tests.power_cut.disk_model`), and on each of them

- the project opens, every row of the ledger has its artifact with the same bytes,
- nothing that was acknowledged is lost: stages, decisions, approval, uploaded bytes,
- and (``--reruns``) the same command ends in the bytes of an unbroken run.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from recon4.errors import Recon4Error
from recon4.progress import Silent
from recon4.review.approval import approve
from recon4.review.decisions import Decision, DecisionKind
from recon4.review.journal import append, read_rows
from recon4.review.verify import verify_review
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import simulate
from recon4.store.atomic import make_folders
from recon4.store.project import is_project, read_stages
from recon4.store.stage import damage_of
from recon4_app.settings import ServerSettings
from recon4_app.uploads.store import UploadStore
from tests.power_cut.disk_model import Disk, Keeps, operations
from tests.power_cut.recording_disk import MARK
from tests.service import tus_client
from tests.service.killing import RESULTS
from tests.service.running import ROOT, server_process, wait_for
from tests.short_capture import QUICK

SIGNER = {"who": "Eva", "role": "reviewer", "why": "compared with the plan"}
UPLOAD = b"point cloud data " * 20_000
CHUNK = 100_000


def main() -> None:
    """Record, cut, check and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cuts", type=int, default=200)
    parser.add_argument("--reruns", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=5.0)
    parser.add_argument("--keep", type=Path, help="Folder for the record; used again if there.")
    given = parser.parse_args()
    top = given.keep or Path(tempfile.mkdtemp(prefix="recon4-power-"))
    top.mkdir(exist_ok=True)
    if not (top / "log.done").exists():
        record(top, given.seconds)
        (top / "log.done").touch()
    began = time.perf_counter()
    problems = check_all(top, cuts=given.cuts, reruns=given.reruns)
    print(f"{time.perf_counter() - began:.0f} s for the checks; {problems.total()} problems")
    for what, count in problems.most_common(40):
        print(f"  {count:5} x {what}")
    if given.keep is None:
        shutil.rmtree(top)
    sys.exit(1 if problems else 0)


def record(top: Path, seconds: float) -> None:
    """Do everything once on the recording disk."""
    simulate(prepare("office", seconds=seconds, seed=3), top / "walk", bag=False, progress=Silent())
    with mounted(top) as root:
        subprocess.run(command(top / "walk", root / "office"), check=True, capture_output=True)
        mark(root, "processed")
        for name in RESULTS:  # approving stamps them
            shutil.copy(root / "office" / name, top / name)
        make_folders(root / ".recon4")
        approve(root / "office", root / ".recon4" / "signing.key", SIGNER, confirmed=True)
        mark(root, "approved")
        for edge in json.loads((root / "office" / "edges.json").read_text())["edges"][-5:]:
            i, j = edge["frames"]
            row = append(
                root / "office", Decision(kind=DecisionKind.REJECT, who="Eva", pair=(i, j))
            )
            mark(root, f"decided {row.seq}")
        upload(root)


def upload(root: Path) -> None:
    """A file in chunks; each acknowledgement is marked."""
    with server_process(root) as (server, _):
        made = tus_client.create(server.url, len(UPLOAD), filename="walk.pcap")
        assert made.status_code == 201, made.text
        location = made.headers["Location"]
        mark(root, "announced")
        for at in range(0, len(UPLOAD), CHUNK):
            answer = tus_client.patch(server.url, location, at, UPLOAD[at : at + CHUNK])
            assert answer.status_code == 204, answer.text
            mark(root, f"uploaded {answer.headers['Upload-Offset']}")


@contextlib.contextmanager
def mounted(top: Path) -> Iterator[Path]:
    """A recording disk."""
    mount, backing = top / "mount", top / "backing"
    for folder in (mount, backing):
        folder.mkdir()
    arguments = [str(mount), str(backing), str(top / "log")]
    with subprocess.Popen(
        [sys.executable, "-m", "tests.power_cut.recording_disk", *arguments], cwd=ROOT
    ) as disk:
        try:
            wait_for(lambda: os.path.ismount(mount), "the disk is mounted", max_s=20.0)
            yield mount
        finally:
            subprocess.run(["fusermount3", "-u", str(mount)], check=True)
            disk.wait(20)


def mark(root: Path, text: str) -> None:
    """Note in the record that something was acknowledged."""
    with contextlib.suppress(FileExistsError):
        (root / f"{MARK}{text}").mkdir()


def command(walk: Path, out: Path) -> list[str]:
    """`recon4 process` of the walk."""
    sets = [word for one in QUICK for word in ("--set", one)]
    given = [str(walk / "recording.pcap"), "--rig", "4recon", "--imu", str(walk / "imu.csv")]
    return [sys.executable, "-m", "recon4", "process", *given, "--out", str(out), *sets]


def check_all(top: Path, *, cuts: int, reruns: int) -> Counter[str]:
    """Check the disks after cuts at moments drawn at random and around every mark."""
    total = sum(1 for _ in operations(top / "log"))
    rng = np.random.default_rng(1)
    moments = set(rng.choice(total, min(cuts, total), replace=False).tolist())
    whole = {name: (top / name).read_bytes() for name in RESULTS}
    again = set(rng.choice(sorted(moments), min(reruns, len(moments)), replace=False).tolist())
    problems: Counter[str] = Counter()
    states = 0
    disk = Disk()
    for k, operation in enumerate(operations(top / "log")):
        disk.follow(operation)
        if k not in moments and operation[0] != "mark":
            continue
        for keeps in Keeps:
            root = top / "after"
            disk.after_cut(root, keeps, rng)
            found = check(root, disk.marks)
            if k in again and keeps is Keeps.TORN and "approved" not in disk.marks:
                found += rerun(top, root, whole)
            problems.update(f"{keeps}: {what}" for what in found)
            if found:
                print(f"cut after operation {k} of {total}, {keeps}: {found[:3]}", flush=True)
            states += 1
            shutil.rmtree(root)
    print(f"{total} operations, {states} disks after a cut, {len(again)} runs again")
    return problems


def check(root: Path, marks: list[str]) -> list[str]:
    """Messages about damage on a disk after a power cut."""
    problems = []
    try:
        problems += check_project(root / "office", marks)
    except (Recon4Error, OSError) as error:
        problems.append(f"the project cannot be read: {str(error)[:100]}")
    sent = [int(text.split()[1]) for text in marks if text.startswith("uploaded")]
    if "announced" in marks:
        problems += check_upload(root, max(sent, default=0))
    return problems


def check_project(project: Path, marks: list[str]) -> list[str]:
    """Ledger, artifacts, decisions and approval."""
    if not is_project(project):
        return ["the project is lost"] if "processed" in marks else []
    problems = []
    rows = read_stages(project)
    for row in rows:
        folder = project / "artifacts" / row.key
        damage = damage_of(folder, hashes=True) if folder.is_dir() else ["is missing"]
        problems += [f"stage {row.stage} of the ledger: {what}" for what in damage]
    if "processed" in marks and len(rows) < 8:
        problems.append("finished stages are lost")
    if "processed" in marks:
        problems += [f"{name} is lost" for name in RESULTS if not (project / name).is_file()]
    decided = [int(text.split()[1]) for text in marks if text.startswith("decided")]
    if decided and len(read_rows(project)) < max(decided):
        problems.append("an acknowledged decision is lost")
    reviewed = verify_review(project, Silent())
    unfinished = "in no row of the journal"  # an approval without response; the next moves it
    problems += [f"review: {what}" for what in reviewed.damaged if unfinished not in what]
    if "approved" in marks and not reviewed.approvals:
        problems.append("an acknowledged approval is lost")
    return problems


def check_upload(root: Path, acknowledged: int) -> list[str]:
    """The uploaded bytes."""
    (root / ".recon4").mkdir(exist_ok=True)
    store = UploadStore(ServerSettings(root=root))
    files = [path for path in root.rglob("walk.pcap") if path.is_file()]
    if acknowledged == 0:
        return [] if store.all() else ["an announced upload is lost"]
    if not any(path.read_bytes()[:acknowledged] == UPLOAD[:acknowledged] for path in files):
        return ["acknowledged bytes of an upload are lost"]
    return [] if store.all() else ["an upload is lost whose bytes are there"]


def rerun(top: Path, root: Path, whole: dict[str, bytes]) -> list[str]:
    """The same command on a disk after a cut."""
    done = subprocess.run(
        command(top / "walk", root / "office"), check=False, capture_output=True, text=True
    )
    if done.returncode != 0:
        return [f"run again it fails: {done.stderr[-200:]}"]
    found = {name: (root / "office" / name).read_bytes() for name in RESULTS}
    return [f"run again {name} has other bytes" for name in RESULTS if found[name] != whole[name]]


if __name__ == "__main__":
    main()
