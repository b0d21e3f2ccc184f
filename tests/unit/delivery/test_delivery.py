"""Deliveries: packed, verified without their project, altered, hostile."""

import io
import json
import shutil
import stat
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from recon4.cli.main import main
from recon4.delivery import package
from recon4.delivery.check import check_file
from recon4.delivery.package import DeliveryWish, chosen_files, deliver
from recon4.delivery.report_files import server_key
from recon4.errors import ConfigError, CorruptFile, NoSpace, Recon4Error, StoreError
from recon4.export import xyz
from recon4.export.reread import account_of_text
from recon4.progress import Silent
from recon4.report.client_words import words
from recon4.review.trusted_keys import ensure_own_key, read_keys
from recon4.store.hashing import hash_file
from tests.full_disk import files_end_at
from tests.made_once import made_once
from tests.project_builder import approve_project, build_project

FILES = ("map.laz", "map.ply", "map.xyz", "map.pcd")


@pytest.fixture(scope="module")
def sent(tmp_path_factory):
    """The folder of a server with an approved project, and its delivery ``sent.zip``."""
    return made_once(tmp_path_factory, "delivery-server", _make_sent)


def _make_sent(folder):
    folder.mkdir()
    (folder / ".recon4").mkdir()
    ensure_own_key(folder / ".recon4")
    build_project(folder / "room", points=5_000)
    approve_project(folder / "room", folder / ".recon4" / "signing.key")
    (folder / "license.txt").write_text("CC BY 4.0\n")
    wish = DeliveryWish(
        files=FILES, key=server_key(folder / "room"), license=folder / "license.txt"
    )
    deliver(folder / "room", folder / "sent.zip", wish, progress=Silent())


@pytest.fixture
def stranger(tmp_path, monkeypatch):
    """A computer that knows nobody's key."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    (tmp_path / "elsewhere").mkdir()
    return tmp_path / "elsewhere"


def _repacked(source, target, change):
    """A delivery whose files went through ``change(name, data)``; None leaves one out."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for name in old.namelist():
            data = change(name, old.read(name))
            if data is not None:
                new.writestr(name, data)
    return target


def test_an_intact_delivery_names_its_signer(sent):
    found = check_file(sent / "sent.zip")

    assert found.whole
    assert set(found.intact) == {*FILES, "README.txt", "LICENSE.txt", "report.pdf", "report.html"}
    assert found.signer.startswith("this server, key ")
    assert "Approved v1" in found.says


def test_on_a_computer_that_does_not_know_the_key_the_signer_is_unknown(sent, stranger):
    shutil.copy(sent / "sent.zip", stranger)

    found = check_file(stranger / "sent.zip")

    assert not found.whole and not found.altered and found.signer == ""
    assert "signer is unknown on this computer" in found.doubt


def test_altered_missing_and_added_files_are_named(sent, stranger):
    changed = {"map.ply": lambda data: data[:-1] + b"x", "map.xyz": lambda data: None}
    path = _repacked(
        sent / "sent.zip", stranger / "a.zip", lambda n, d: changed.get(n, lambda same: same)(d)
    )
    with zipfile.ZipFile(path, "a") as more:
        more.writestr("extra.txt", "x")

    found = check_file(path)

    assert (found.altered, found.missing, found.added) == (
        ("map.ply",),
        ("map.xyz",),
        ("extra.txt",),
    )
    assert "map.laz" in found.intact and not found.whole


def test_a_manifest_that_was_changed_is_refused(sent, stranger):
    def changed(name, data):
        return data.replace(b'"Approved v1', b'"Approved v2') if name == "manifest.json" else data

    path = _repacked(sent / "sent.zip", stranger / "a.zip", changed)

    with pytest.raises(StoreError, match="changed after it was signed"):
        check_file(path)


def test_a_manifest_without_its_signature_does_not_count(sent, stranger):
    def changed(name, data):
        if name != "manifest.json":
            return data
        return json.dumps(json.loads(data) | {"signature": None}).encode()

    found = check_file(_repacked(sent / "sent.zip", stranger / "a.zip", changed))

    assert not found.whole and found.doubt == "it is not signed"


def test_an_unpacked_delivery_is_verified_as_a_folder(sent, stranger):
    with zipfile.ZipFile(sent / "sent.zip") as packed:
        packed.extractall(sent / "unpacked")
    try:
        assert check_file(sent / "unpacked").whole
        (sent / "unpacked" / "map.laz").unlink()
        (sent / "unpacked" / "map.laz").symlink_to(sent / "room" / "report.html")
        assert check_file(sent / "unpacked").altered == ("map.laz",)
    finally:
        shutil.rmtree(sent / "unpacked")


def test_a_flipped_bit_anywhere_is_found(sent, stranger):
    whole = (sent / "sent.zip").read_bytes()
    path = stranger / "a.zip"
    rng = np.random.default_rng(1)
    unseen = 0
    for at in rng.integers(0, len(whole), 60).tolist():
        data = bytearray(whole)
        data[at] ^= 1 << int(rng.integers(0, 8))
        path.write_bytes(data)
        try:
            found = check_file(path)
        except Recon4Error:
            continue
        unseen += not (found.altered or found.missing or found.added)
    assert unseen <= 2  # dates and attributes of entries, which are no content


def test_hashes_in_the_report_are_those_of_the_files(sent, tmp_path):
    with zipfile.ZipFile(sent / "sent.zip") as packed:
        listed = json.loads(packed.read("manifest.json"))["files"]
        packed.extractall(tmp_path)

    assert {name: hash_file(tmp_path / name) for name in listed} == {
        name: one["sha256"] for name, one in listed.items()
    }


def test_a_draft_is_delivered_as_one_and_not_signed(tmp_path):
    (tmp_path / ".recon4").mkdir()
    ensure_own_key(tmp_path / ".recon4")
    build_project(tmp_path / "room", points=2_000)
    wish = DeliveryWish(files=("poses.txt",), key=server_key(tmp_path / "room"))
    if "frames" not in {path.name for path in (tmp_path / "room").iterdir()}:
        wish = replace(wish, files=("map.ply",))

    made = deliver(tmp_path / "room", tmp_path / "d.zip", wish, progress=Silent())

    found = check_file(tmp_path / "d.zip")
    assert not made.signed and found.doubt == "it is not signed" and "Draft" in found.says
    with zipfile.ZipFile(tmp_path / "d.zip") as packed:
        assert "not signed" in packed.read("README.txt").decode()


def test_nothing_is_left_if_an_export_reads_back_wrong(sent, tmp_path, monkeypatch):
    def damage(path, progress):
        data = bytearray(path.read_bytes())
        data[-4000] ^= 0xFF
        path.write_bytes(data)
        return account_of_text(path, progress)

    monkeypatch.setattr(xyz, "account_of_text", damage)
    wish = DeliveryWish(files=("map.xyz",))

    with pytest.raises(Recon4Error, match="reads back wrong"):
        deliver(sent / "room", tmp_path / "d.zip", wish, progress=Silent())
    assert list(tmp_path.iterdir()) == []


def test_files_are_chosen_by_name_or_ending():
    assert chosen_files(["e57, laz", "map.ply"]) == ("map.e57", "map.laz", "map.ply")
    with pytest.raises(ConfigError, match="expected some of"):
        chosen_files(["dwg"])


def test_a_delivery_needs_its_ending(sent, tmp_path):
    with pytest.raises(ConfigError, match=r"must be named \.zip"):
        deliver(sent / "room", tmp_path / "d.tar", DeliveryWish(), progress=Silent())


def _zip(*entries, comment=b""):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as made:
        for entry, data in entries:
            made.writestr(entry, data)
        made.comment = comment
    return out.getvalue()


def _special(name, mode):
    entry = zipfile.ZipInfo(name)
    entry.external_attr = mode << 16
    return entry


def _bomb():
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as made:
        made.writestr("manifest.json", bytes(200 << 20))
    return out.getvalue()


def _overlapping():
    """Two names in the list at the end for the bytes of one entry."""
    whole = _zip(("manifest.json", b"{}"), ("b.txt", b"x"))
    at = whole.rindex(b"PK\x01\x02")  # the second row of the list: its offset becomes the first's
    return whole[: at + 42] + bytes(4) + whole[at + 46 :]


def _changed(at, *values):
    """A delivery of one stored file, some of whose bytes are others."""
    whole = bytearray(_zip(("manifest.json", b"{}")))
    whole[at : (at + len(values)) or None] = bytes(values)
    return bytes(whole)


def _gap():
    """Bytes between the last entry and the list at the end, which begins after them."""
    whole = _zip(("manifest.json", b"{}"))
    at = whole.index(b"PK\x01\x02")
    start = (at + 9).to_bytes(4, "little")
    return whole[:at] + b"something" + whole[at:-6] + start + whole[-2:]


HARMFUL = {
    "outside": _zip(("../a", b"x")),
    "absolute": _zip(("/etc/a", b"x")),
    "windows": _zip(("a\\..\\b:c", b"x")),
    "hidden": _zip(("a\u202eb", b"x")),
    "link": _zip((_special("a", stat.S_IFLNK | 0o777), b"/etc/passwd")),
    "pipe": _zip((_special("a", stat.S_IFIFO | 0o600), b"")),
    "folder": _zip(("a/", b"")),
    "comment": _zip(("manifest.json", b"{}"), comment=b"x"),
    "case": _zip(("a.txt", b"x"), ("A.TXT", b"y")),
    "bomb": _bomb(),
    "overlap": _overlapping(),
    "not a delivery": _zip(("a.txt", b"x")),
    "cut": _zip(("a.txt", b"x" * 1000))[:500],
    "before": b"PK\x03\x04" + bytes(100) + _zip(("manifest.json", b"{}")),
    "behind": _zip(("manifest.json", b"{}")) + b"something",
    "gap": _gap(),
    "method of a stream": _changed(8, 8),
    "checksum of a stream": _changed(14, 1, 2),
    "size of a stream": _changed(18, 1),
    "count": _changed(-14, 2),
    "disk": _changed(-18, 1),
    "many": _zip(*[(f"{k}", b"") for k in range(10_001)]),
    "deep": _zip(("manifest.json", b"[" * 100_000)),
    "no files": _zip(("manifest.json", b'{"kind": "recon4 delivery", "format": 1}')),
}


HARMFUL_WHY = {
    "overlap": "overlaps",
    "before": "'manifest.json' has bytes of no entry before it",
    "gap": "the list at its end has bytes of no entry before it",
    "behind": "at its end",
    **dict.fromkeys(("count", "disk"), "at its end"),
    **{f"{what} of a stream": "differs from the list" for what in ("method", "checksum", "size")},
}
"""What those say that have no other fault."""


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize("name", [*HARMFUL, "twice"])
def test_hostile_archives_are_refused(name, stranger):
    data = HARMFUL[name] if name != "twice" else _zip(("a", b"x"), ("a", b"y"))
    (stranger / "a.zip").write_bytes(data)
    expected = StoreError if name in ("deep", "no files") else CorruptFile

    with pytest.raises(expected) as refused:
        check_file(stranger / "a.zip")
    assert HARMFUL_WHY.get(name, "") in str(refused.value)
    assert [path.name for path in stranger.iterdir()] == ["a.zip"]


class _Stream(io.BytesIO):
    """Does not seek: checksum and sizes then follow the bytes of each entry."""

    def seekable(self):
        return False

    def seek(self, *_):
        raise OSError


def test_a_delivery_that_was_packed_again_as_a_stream_is_whole(sent, stranger):
    stream = _Stream()
    with (
        zipfile.ZipFile(sent / "sent.zip") as old,
        zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as new,
    ):
        for name in old.namelist():
            new.writestr(name, old.read(name))
    (stranger / "a.zip").write_bytes(stream.getvalue())

    found = check_file(stranger / "a.zip")

    assert (found.altered, found.missing, found.added) == ((), (), ())


def test_the_key_of_the_server_is_the_one_that_is_trusted(sent):
    (key,) = read_keys(sent / ".recon4", server=True).keys.values()

    assert key.fingerprint in check_file(sent / "sent.zip").signer


def test_the_readme_names_the_coordinates_of_the_files(sent, tmp_path):
    map_ = package._open(sent / "room", DeliveryWish(), Silent())
    for wish, said in (
        (DeliveryWish(crs="EPSG:25832"), "EPSG:25832 (ETRS89 / UTM zone 32N)."),
        (DeliveryWish(), "Coordinates of the map: local frame"),
    ):
        package._write_readme(tmp_path, map_, wish, texts=words(), name="d.zip")
        assert said in (tmp_path / "README.txt").read_text("utf-8")
        (tmp_path / "README.txt").unlink()


def test_a_map_that_was_made_again_meanwhile_is_refused(sent):
    map_ = package._open(sent / "room", DeliveryWish(), Silent())
    package._refuse_changed(map_)
    others = dict(map_.export.artifacts) | {"map": sent / "room" / "artifacts" / "other"}

    with pytest.raises(StoreError, match="made again"):
        package._refuse_changed(replace(map_, export=replace(map_.export, artifacts=others)))


def test_a_folder_that_is_not_there_is_said(sent, tmp_path):
    with pytest.raises(StoreError, match="cannot be made"):
        deliver(sent / "room", tmp_path / "no" / "d.zip", DeliveryWish(), progress=Silent())


def test_a_full_disk_names_the_delivery_and_leaves_nothing(sent, tmp_path):
    with files_end_at(40_000), pytest.raises(NoSpace, match=f"writing {tmp_path / 'd.zip'};"):
        deliver(sent / "room", tmp_path / "d.zip", DeliveryWish(), progress=Silent())
    assert not list(tmp_path.iterdir())


def _unsigned(**files):
    """A manifest without signature that lists files with these hashes."""
    listed = {name: {"bytes": 5, "sha256": sha256} for name, sha256 in files.items()}
    texts = dict.fromkeys(("project", "made", "recon4", "approval", "crs"), "")
    head = {"format": 1, "kind": "recon4 delivery", "signature": None, "files": listed}
    return json.dumps(head | texts).encode()


def test_names_of_an_unpacked_delivery_cannot_command_a_terminal(stranger):
    name = "a\x1b[2J"
    (stranger / "d").mkdir()
    (stranger / "d" / name).write_bytes(b"x")
    (stranger / "d" / "manifest.json").write_bytes(_unsigned(**{name: "ab"}))

    assert check_file(stranger / "d").altered == ("a<U+001B>[2J",)


def test_what_cannot_be_read_is_altered_whatever_hash_is_listed(stranger):
    data = _zip(("manifest.json", _unsigned(a="")), ("a", b"12345"))
    (stranger / "a.zip").write_bytes(data.replace(b"12345", b"12346"))  # its checksum is wrong

    found = check_file(stranger / "a.zip")

    assert (found.intact, found.altered) == ((), ("a",))


def test_a_delivery_is_not_accepted_as_it_is(sent, capsys):
    assert main(["verify", str(sent / "sent.zip"), "--accept"]) == 2
    assert "--accept" in capsys.readouterr().err


def test_an_added_file_with_an_old_name_is_named_and_not_called_an_overlap(stranger):
    data = _zip(("Gr__e.txt", b"x"), ("manifest.json", _unsigned(a="ab")))
    (stranger / "a.zip").write_bytes(data.replace(b"Gr__e", "Größe".encode("cp437")))

    assert check_file(stranger / "a.zip").added == ("Größe.txt",)
