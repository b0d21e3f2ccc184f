"""Uploads: tus 1.0 on a real server, interrupted anywhere, resumed, rejected with a message."""

import hashlib
import os
import random
import signal
import threading
import time
from pathlib import Path, PurePosixPath

import httpx
import pytest

from recon4_app.settings import ServerSettings
from recon4_app.uploads.model import UploadedFile
from recon4_app.uploads.store import UploadStore
from tests.served import served
from tests.service.running import server_process, server_thread
from tests.service.tus_client import CHUNK, TUS, create, offset, patch, patch_and_break_off

DATA = random.Random(4).randbytes(300_000)


server = served()


def upload_of(server, location):
    return server.get(f"/api/uploads/{location.rsplit('/', 1)[1].split('-')[0]}").json()


def begin(server, name, files, size):
    answer = server.post("/api/uploads", json={"name": name, "files": files, "bytes": size})
    assert answer.status_code == 201, answer.text
    return answer.json()


def test_a_file_sent_by_any_tus_client_becomes_a_recording(server):
    made = create(server.url, len(DATA), filename="Ráno v lese.pcap")
    sent = patch(server.url, made.headers["Location"], 0, DATA)
    view = upload_of(server, made.headers["Location"])

    assert (made.status_code, sent.status_code) == (201, 204)
    assert sent.headers["Upload-Offset"] == str(len(DATA))
    assert view["finished"] and view["name"] == "Ráno v lese.pcap"
    path = Path(view["recording"])
    assert path.name == "Rano_v_lese.pcap"
    assert path.parent.parent == server.root / "recordings"
    assert path.read_bytes() == DATA
    assert path.stat().st_mode & 0o222 == 0  # never modified


def test_the_server_lists_its_tus_extensions(server):
    answer = httpx.options(f"{server.url}/api/uploads/files")

    assert answer.headers["Tus-Version"] == "1.0.0"
    assert "creation-with-upload" in answer.headers["Tus-Extension"]
    assert "sha256" in answer.headers["Tus-Checksum-Algorithm"]


def test_cut_at_any_byte_and_resumed_the_bytes_are_the_same(server):
    """200 cuts at random bytes; each time the server is asked how far it came."""
    rng = random.Random(7)
    data = rng.randbytes(20_000_000)
    location = create(server.url, len(data), filename="walk.bag").headers["Location"]
    lost = []

    for _ in range(200):
        at = offset(server.url, location)
        announced = data[at : at + rng.randint(1, 200_000)]
        sent = rng.randrange(len(announced))
        patch_and_break_off(server.url, location, at, announced, sent=sent)
        lost.append(at + sent - offset(server.url, location))
    status, at = 409, 0
    while status in (409, 423):  # what was cut may still be on its way
        at = offset(server.url, location)
        status = patch(server.url, location, at, data[at:]).status_code

    path = Path(upload_of(server, location)["recording"])
    assert at > 1_000_000  # what came before a cut counts
    assert min(lost) >= 0  # what was in the network's buffers is sent again
    assert hashlib.sha256(path.read_bytes()).digest() == hashlib.sha256(data).digest()


def test_a_killed_server_knows_where_it_was(tmp_path):
    with server_process(tmp_path) as (server, process):
        location = create(server.url, len(DATA), filename="walk.bag").headers["Location"]
        patch(server.url, location, 0, DATA[:123_456])
        process.send_signal(signal.SIGKILL)
        process.wait()

    with server_thread(tmp_path) as server:
        at = offset(server.url, location)
        patch(server.url, location, at, DATA[at:])
        path = Path(upload_of(server, location)["recording"])

    assert at == 123_456
    assert path.read_bytes() == DATA


def test_a_folder_keeps_its_names_and_is_one_recording(server):
    names = {
        "0000.bin": b"a",
        "clouds/0001.bin": b"bb",
        "clouds/CON.bin": b"c",
        "Clouds/0001.BIN": b"dddd",
        "ů/=1+1 (ž).csv": b"",
    }
    upload = begin(server, "KITTI walk", len(names), sum(map(len, names.values())))

    for name, data in names.items():
        made = create(server.url, len(data), relativePath=name, upload=upload["id"])
        if data:
            patch(server.url, made.headers["Location"], 0, data)
    view = server.get(f"/api/uploads/{upload['id']}").json()

    folder = Path(view["recording"])
    found = {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*.*")}
    assert view["finished"] and folder.name == f"kitti-walk-{upload['id']}"
    assert found == {
        "0000.bin": b"a",
        "clouds/0001.bin": b"bb",
        "clouds/_CON.bin": b"c",
        "Clouds/0001~2.BIN": b"dddd",
        "u/_1+1_z_.csv": b"",
    }


def test_the_files_and_offsets_of_an_unfinished_upload_are_listed(server):
    upload = begin(server, "walk", 2, 20)
    location = create(server.url, 10, relativePath="a.pcap", upload=upload["id"])
    patch(server.url, location.headers["Location"], 0, b"12345")

    again = create(server.url, 10, relativePath="a.pcap", upload=upload["id"])
    rows = server.get(f"/api/uploads/{upload['id']}/files").json()

    assert again.headers["Location"] == location.headers["Location"]
    assert again.headers["Upload-Offset"] == "5"
    assert [(row["name"], row["offset"]) for row in rows] == [("a.pcap", 5)]
    httpx.delete(f"{server.url}/api/uploads/{upload['id']}")
    assert server.get(f"/api/uploads/{upload['id']}").status_code == 404


def test_the_first_bytes_may_come_with_the_announcement(server):
    headers = CHUNK | {"Upload-Length": "5"}

    made = httpx.post(f"{server.url}/api/uploads/files", headers=headers, content=b"hello")

    assert made.headers["Upload-Offset"] == "5"
    assert upload_of(server, made.headers["Location"])["finished"]


def test_bytes_with_a_wrong_checksum_are_not_kept(server):
    location = create(server.url, 10, filename="a.bag").headers["Location"]
    good = patch(server.url, location, 0, b"12345", check=True)
    wrong = CHUNK | {"Upload-Offset": "5", "Upload-Checksum": "sha1 AAAA"}

    bad = httpx.patch(server.url + location, headers=wrong, content=b"67890")

    assert (good.status_code, bad.status_code) == (204, 460)
    assert offset(server.url, location) == 5
    httpx.delete(server.url + location, headers=TUS)


@pytest.mark.parametrize(
    ("headers", "status", "words"),
    [
        ({"Tus-Resumable": "0.2.1"}, 412, "Tus-Resumable: 1.0.0"),
        ({"Content-Type": "text/plain"}, 415, "Content-Type"),
        ({"Upload-Offset": "3"}, 409, "expected Upload-Offset 0"),
        ({"Upload-Offset": "-1"}, 400, "Upload-Offset"),
        ({"Upload-Checksum": "crc7 AAAA"}, 400, "sha256"),
    ],
)
def test_a_chunk_that_makes_no_sense_is_refused(server, headers, status, words):
    location = create(server.url, 10, filename="a.bag").headers["Location"]
    sent = CHUNK | {"Upload-Offset": "0"} | headers

    answer = httpx.patch(server.url + location, headers=sent, content=b"12345")

    assert answer.status_code == status
    assert words in answer.json()["detail"]
    assert answer.headers["Tus-Resumable"] == "1.0.0"
    assert offset(server.url, location) == 0
    assert httpx.delete(server.url + location, headers=TUS).status_code == 204


def test_more_bytes_than_announced_are_not_kept(server):
    location = create(server.url, 4, filename="a.bag").headers["Location"]

    answer = patch(server.url, location, 0, b"12345")

    assert answer.status_code == 400
    assert offset(server.url, location) == 0
    httpx.delete(server.url + location, headers=TUS)


@pytest.mark.parametrize("name", ["../evil", "a/../../b", "/" * 5, "a/b/c/d/e/f/g/h/i"])
def test_a_name_that_leads_elsewhere_is_refused(server, name):
    upload = begin(server, "walk", 1, 1)

    answer = create(server.url, 1, relativePath=name, upload=upload["id"])

    assert answer.status_code == 400
    httpx.delete(f"{server.url}/api/uploads/{upload['id']}")


def test_only_bytes_of_uploads_may_be_large(server):
    """Two million bytes: refused anywhere else, taken as a chunk."""
    data = bytes(2_000_000)
    location = create(server.url, len(data), filename="a.bag").headers["Location"]

    elsewhere = server.post("/api/uploads", content=data)
    chunk = patch(server.url, location, 0, data)

    assert (elsewhere.status_code, chunk.status_code) == (413, 204)


def test_too_much_too_many_and_no_room_are_refused_in_words(tmp_path):
    free = os.statvfs(tmp_path).f_bavail * os.statvfs(tmp_path).f_frsize
    limits = {"max_upload_bytes": free * 2, "max_open_uploads": 1}
    with server_thread(tmp_path, **limits) as server:
        ask = {"name": "walk", "files": 1}
        large = server.post("/api/uploads", json=ask | {"bytes": free * 3})
        no_room = server.post("/api/uploads", json=ask | {"bytes": free - (1 << 30)})
        first = begin(server, "walk", 1, 1)
        second = server.post("/api/uploads", json=ask | {"bytes": 1})

    assert large.status_code == 413 and "more than this server accepts" in large.text
    assert no_room.status_code == 507 and "make room first" in no_room.text
    assert second.status_code == 429 and "unfinished already" in second.text
    assert first["received"] == 0


def test_an_upload_nothing_comes_for_is_given_up_and_a_recording_is_not(tmp_path):
    store = UploadStore(ServerSettings(root=tmp_path))
    stale = store.begin("stale", files=1, total=3, fingerprint="", by="me")
    store.add(stale, "a.bag", length=3)
    whole = store.begin("whole", files=1, total=0, fingerprint="", by="me")
    store.add(whole, "b.bag", length=0)
    store.finish(whole)
    in_a_week_s = time.time() + 8 * 86400.0

    early = store.sweep(time.time())
    swept = store.sweep(in_a_week_s)

    assert early == []
    assert set(swept) == {stale.id, whole.id}
    assert list((tmp_path / ".recon4" / "uploads").iterdir()) == []
    assert whole.recording(store.recordings).exists()


def test_what_a_server_that_ended_had_received_long_ago_is_given_up(tmp_path):
    store = UploadStore(ServerSettings(root=tmp_path))
    upload = store.begin("stale", files=1, total=3, fingerprint="", by="me")
    store.add(upload, "a.bag", length=3)
    folder = tmp_path / ".recon4" / "uploads" / upload.id
    for path in (*folder.rglob("*"), folder):
        os.utime(path, (0, time.time() - 8 * 86400.0))

    assert UploadStore(ServerSettings(root=tmp_path)).sweep(time.time()) == [upload.id]


def test_files_are_counted_while_others_are_announced(tmp_path):
    upload = UploadStore(ServerSettings(root=tmp_path)).begin(
        "walk", files=100_000, total=100_000, fingerprint="", by="me"
    )

    def announce():
        for n in range(upload.files):
            path = PurePosixPath(f"{n}.bin")
            upload.announced[str(path)] = UploadedFile(
                number=n, name=str(path), path=path, bytes=1, offset=1
            )

    sender = threading.Thread(target=announce)
    sender.start()
    while sender.is_alive():
        assert upload.received <= upload.files
        assert not upload.whole or len(upload.announced) == upload.files
    sender.join()

    assert upload.received == upload.files
    assert upload.whole


def test_a_damaged_upload_is_reported_until_it_expires(tmp_path):
    broken = UploadStore(ServerSettings(root=tmp_path)).begin(
        "walk", files=1, total=3, fingerprint="", by="me"
    )
    folder = tmp_path / ".recon4" / "uploads" / broken.id
    (folder / "upload.json").write_text("{")
    store = UploadStore(ServerSettings(root=tmp_path))

    (notice,) = store.notices()

    assert broken.id in notice and "Send the recording again" in notice
    assert store.sweep(time.time()) == []
    assert store.sweep(time.time() + 8 * 86400.0) == [broken.id]
    assert store.notices() == []
    assert not folder.exists()


def test_a_server_killed_between_the_last_byte_and_the_end_ends_it(tmp_path):
    store = UploadStore(ServerSettings(root=tmp_path))
    upload = store.begin("walk", files=1, total=3, fingerprint="", by="me")
    part = store.add(upload, "a.bag", length=3)
    store.data(upload, part).write_bytes(b"abc")

    found = UploadStore(ServerSettings(root=tmp_path)).get(upload.id)

    assert found.finished
    assert found.recording(store.recordings).read_bytes() == b"abc"
