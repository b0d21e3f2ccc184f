"""Messages of a confined process, which a hostile recording may have taken over."""

from __future__ import annotations

import io
import struct
from pathlib import Path

import msgspec
import pytest

from recon4.orders.order import Answer, Order, OrderKind, OrderRefused, receive, send
from recon4.orders.tuning import ORDERS

FOLDER = "artifacts/.tmp-0123456789ab-key/buckets-abc_1234"
GOOD = {"kind": "map-tile", "folder": FOLDER, "items": [[0, -1, 2]]}


def message(value: object) -> bytes:
    return framed(msgspec.json.encode(value))


def framed(data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + data


def received(data: bytes) -> Order | None:
    return receive(io.BytesIO(data), Order)


def test_an_order_arrives_as_it_was_sent():
    order = Order(kind=OrderKind.MAP_TILE, folder=FOLDER, items=((1, 2, 3), (-4, 5, 6)))
    pipe = io.BytesIO()

    send(pipe, order)
    pipe.seek(0)

    assert receive(pipe, Order) == order
    assert receive(pipe, Order) is None


@pytest.mark.parametrize(
    ("changed", "why"),
    [
        ({"kind": "os.system"}, "Invalid enum value"),
        ({"kind": ["map-tile"]}, "kind"),
        ({"items": [[1, 2]]}, "3 numbers"),
        ({"items": [[1, 2, 3, 4]]}, "3 numbers"),
        ({"items": [[1, 2, 1 << 40]]}, "numbers below"),
        ({"items": [[1, 2, 0.5]]}, "int"),
        ({"items": [[1, 2, True]]}, "int"),
        ({"items": [[1, 2, "3"]]}, "int"),
        ({"items": "all"}, "items"),
        ({"folder": 7}, "folder"),
        ({"function": "os.system"}, "unknown field"),
    ],
)
def test_anything_but_names_of_the_list_and_integers_is_refused(changed, why):
    with pytest.raises(OrderRefused, match=why):
        received(message(GOOD | changed))


@pytest.mark.parametrize(
    "data",
    [
        framed(b"\x80\x04\x95cposix\nsystem\n."),  # a pickle
        framed(b"[" * 100_000),
        framed(b'{"kind": "map-tile"}'),
        framed(b""),
        struct.pack(">I", ORDERS.message_bytes + 1),
    ],
)
def test_bytes_that_are_no_order_are_refused_before_they_are_read_on(data):
    with pytest.raises(OrderRefused):
        received(data)


def test_too_many_parts_are_refused(monkeypatch):
    monkeypatch.setattr("recon4.orders.order.ORDERS", msgspec.structs.replace(ORDERS, items=2))

    with pytest.raises(OrderRefused, match="at most 2 parts"):
        received(message(GOOD | {"items": [[0, 0, 0]] * 3}))


def test_a_message_that_breaks_off_is_the_end_of_the_process():
    assert received(message(GOOD)[:-1]) is None
    assert received(message(GOOD)[:3]) is None


def test_an_answer_is_no_order():
    pipe = io.BytesIO()
    send(pipe, Answer(item=0))
    pipe.seek(0)

    with pytest.raises(OrderRefused):
        receive(pipe, Order)


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "project" / FOLDER).mkdir(parents=True)
    (tmp_path / "outside" / "buckets").mkdir(parents=True)
    artifacts = tmp_path / "project" / "artifacts"
    (artifacts / "link").symlink_to(tmp_path / "outside")
    (artifacts / "inner").symlink_to(artifacts / ".tmp-0123456789ab-key")
    (artifacts / "file").write_text("")
    return tmp_path / "project"


def folder_in(project: Path, folder: str) -> Path:
    return Order(kind=OrderKind.MAP_TILE, folder=folder, items=()).folder_in(project)


@pytest.mark.parametrize("folder", [FOLDER, "unfinished/map-key/buckets"])
def test_a_folder_of_a_stage_is_found(project, folder):
    (project / folder).mkdir(parents=True, exist_ok=True)

    assert folder_in(project, folder) == project / folder


@pytest.mark.parametrize(
    "folder",
    [
        "",
        "/",
        "/etc",
        "artifacts",
        "artifacts/",
        "artifacts/..",
        "artifacts/../..",
        f"{FOLDER}/../../../..",
        "other/folder",
        "artifacts/link/buckets",
        "artifacts/inner/buckets-abc_1234",
        "artifacts/file",
        "artifacts/none",
        "artifacts/a b",
        "artifacts/a\nb",
        "artifacts/" + "a" * 400,
        "artifacts/a/b/c/d/e",
    ],
)
def test_a_folder_elsewhere_or_behind_a_link_is_refused(project, folder):
    with pytest.raises(OrderRefused):
        folder_in(project, folder)
