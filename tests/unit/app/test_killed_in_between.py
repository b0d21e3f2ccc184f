"""Uploads and the trash, killed before each single operation on files: nothing lost, nothing half.

The kill is SIGKILL in a process of its own. After it the store is opened as the next server does.
"""

import itertools
import os
import signal
import sys
import time
from contextlib import suppress

from recon4.review.newest_approval import record_path
from recon4.store.atomic import make_folders
from recon4_app.errors import AppError
from recon4_app.projects.trash import Trash
from recon4_app.settings import ServerSettings
from recon4_app.uploads.store import UploadStore

CHANGES = ("os.rename", "os.remove", "os.mkdir", "os.rmdir", "os.chmod", "os.truncate")
DATA = b"packets"


def killed_before(act, count):
    """Run in a child that is killed before its change number ``count``; False = it had fewer."""
    child = os.fork()
    if child == 0:
        left = [count]

        def watch(event, arguments):
            writes = event == "open" and arguments[2] & (os.O_CREAT | os.O_TRUNC)
            if event in CHANGES or writes:
                if not left[0]:
                    os.kill(os.getpid(), signal.SIGKILL)
                left[0] -= 1

        sys.addaudithook(watch)
        with suppress(BaseException):
            act()
            os._exit(0)
        os._exit(1)
    status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    assert status in (0, -signal.SIGKILL)
    return status != 0


def every_kill(tmp_path, prepare, act, check):
    """Kill an action before each of its changes, in a folder of its own; then check."""
    for count in itertools.count():
        root = tmp_path / str(count)
        root.mkdir()
        given = prepare(root)
        killed = killed_before(lambda given=given, root=root: act(root, given), count)
        check(root, given, killed)
        if not killed:
            assert count > 0
            return


def uploads(root):
    return UploadStore(ServerSettings(root=root))


def send(store, upload, name):
    file = store.add(upload, name, length=len(DATA))
    store.data(upload, file).write_bytes(DATA)
    file.offset = len(DATA)
    store.finish(upload)


def announced(root):
    return uploads(root).begin("walk", files=1, total=len(DATA), fingerprint="", by="a").id


def test_an_upload_killed_while_it_is_announced_is_no_damage(tmp_path):
    def check(root, _, __):
        store = uploads(root)
        assert store.notices() == []
        upload = store.begin("walk", files=1, total=len(DATA), fingerprint="", by="a")
        send(store, upload, "a.pcap")
        assert len(list(root.glob("recordings/*/a.pcap"))) == 1

    every_kill(tmp_path, lambda _: None, lambda root, _: announced(root), check)


def test_an_upload_killed_while_a_file_is_announced_takes_the_same_file(tmp_path):
    def act(root, upload_id):
        store = uploads(root)
        store.add(store.get(upload_id), "b/a.pcap", length=len(DATA))

    def check(root, upload_id, _):
        store = uploads(root)
        assert store.notices() == []
        send(store, store.get(upload_id), "b/a.pcap")
        assert [path.read_bytes() for path in root.glob("recordings/*/b/a.pcap")] == [DATA]

    every_kill(tmp_path, announced, act, check)


def test_an_upload_killed_at_its_end_becomes_a_whole_recording_once(tmp_path):
    def act(root, upload_id):
        store = uploads(root)
        send(store, store.get(upload_id), "a.pcap")

    def check(root, upload_id, killed):
        store = uploads(root)
        upload = store.get(upload_id)
        found = list(root.glob("recordings/*/a.pcap"))
        assert upload.finished == bool(found)
        assert upload.finished or killed
        if not found:
            send(store, upload, "a.pcap")
        assert [path.read_bytes() for path in root.glob("recordings/*/a.pcap")] == [DATA]

    every_kill(tmp_path, announced, act, check)


def test_an_upload_killed_while_it_is_removed_is_there_or_gone(tmp_path):
    def act(root, upload_id):
        store = uploads(root)
        store.remove(store.get(upload_id))

    def check(root, upload_id, killed):
        store = uploads(root)
        assert store.notices() == []
        assert killed or not store.all()
        for upload in store.all():
            send(store, upload, "a.pcap")
        with suppress(AppError):
            store.remove(store.get(upload_id))
        assert os.listdir(root / ".recon4" / "uploads") == []

    every_kill(tmp_path, announced, act, check)


# -- trash


def trash(root):
    return Trash(root, root / ".recon4" / "trash", kept_s=3600.0)


def approved_project(root):
    """A folder with the server's record of its approval; only their names matter here."""
    state = root / ".recon4"
    make_folders(root / "office")
    (root / "office" / "map.laz").write_bytes(DATA)
    make_folders(record_path(state, "office").parent)
    record_path(state, "office").write_text("{}")


def deleted_project(root):
    approved_project(root)
    return trash(root).put(root / "office").id


def places(root):
    """Where the project is whole, by the names of its folders; and the names of the records."""
    state = root / ".recon4"
    folders = [root / "office", *(state / "trash").glob("[!.]*")]
    whole = [path.name for path in folders if (path / "map.laz").exists()]
    return whole, [path.stem for path in (state / "approvals").iterdir()]


def test_a_project_killed_while_it_is_deleted_or_restored_keeps_its_record(tmp_path):
    def check(root, _, __):
        again = trash(root)
        again.recover()
        whole, records = places(root)
        assert len(whole) == 1 and records == whole
        if whole == ["office"]:
            again.put(root / "office")
        (deleted,) = again.all()
        again.restore(deleted.id)
        assert places(root) == (["office"], ["office"])

    (tmp_path / "put").mkdir()
    every_kill(
        tmp_path / "put",
        approved_project,
        lambda root, _: trash(root).put(root / "office"),
        check,
    )
    (tmp_path / "back").mkdir()
    every_kill(
        tmp_path / "back", deleted_project, lambda root, gone: trash(root).restore(gone), check
    )


def test_a_project_killed_while_it_is_removed_is_whole_or_gone_with_its_record(tmp_path):
    def check(root, deleted_id, killed):
        again = trash(root)
        again.recover()
        whole, records = places(root)
        assert records == whole and whole in ([], [deleted_id])
        assert killed or not whole
        make_folders(root / "office")  # another of that name
        (root / "office" / "map.laz").write_bytes(b"another")
        again.sweep(time.time() + 7200.0)
        again.recover()
        assert places(root) == (["office"], [])
        assert os.listdir(root / ".recon4" / "trash") == []

    every_kill(tmp_path, deleted_project, lambda root, gone: trash(root).remove(gone), check)
