"""The report for the client: its numbers, hostile texts, its signature."""

import json
import logging
import re
import shutil
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from io import BytesIO

import numpy as np
import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.asymmetric import ec
from cryptography.hazmat.primitives.serialization import BestAvailableEncryption, pkcs12
from cryptography.x509.oid import NameOID
from pypdf import PdfReader

from recon4.delivery.pdf_signature import Organization, sign_pdf, signatures_in
from recon4.delivery.report_files import ReportWish, report_of, said_state, server_key, write_pdf
from recon4.errors import ConfigError, StoreError
from recon4.findings.wording import title_of
from recon4.locales.coded import CodedText
from recon4.model.finding_kinds import FindingKind
from recon4.model.pose_graph import Verdict
from recon4.report import pdf
from recon4.report.client import Row
from recon4.report.client_words import words
from recon4.report.pdf import pdf_of
from recon4.review.approval_state import NOT_APPROVED, ApprovalKind, ApprovalState
from recon4.review.signature import public_key_of
from recon4.review.trusted_keys import ensure_own_key
from recon4.store.checked import Altered
from recon4.store.project import read_artifacts
from recon4.store.seal import changing
from tests.made_once import made_once
from tests.project_builder import (
    TILE_M,
    approve_project,
    build_project,
    loop_walk,
    room_points,
    verified_graph,
    write_summary,
)

POINTS, STRAYS = 20_000, 5
HOSTILE = (
    '#set page(width: 1pt) *bold* _x_ $a$ `r` <l> @ref \\u{0} "]} #panic("x")',
    "control \x00\x07\x1b[31m \u202e reversed \ud800 \ue000 \U000e0041",
    "x" * 10_000,
    "=" * 40 + "\n= heading\n- list\n/ term: y",
    "中文 العربية हिन्दी 🚀",
)


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """The folder of a server with the project ``room``, not approved."""
    return made_once(tmp_path_factory, "report-server", _make_server)


def _make_server(folder):
    folder.mkdir()
    (folder / ".recon4").mkdir()
    ensure_own_key(folder / ".recon4")
    build_project(folder / "room", points=POINTS, strays=STRAYS)


@pytest.fixture
def room(server, tmp_path):
    shutil.copytree(server, tmp_path / "server")
    return tmp_path / "server" / "room"


def _approved(room):
    key = room.parent / ".recon4" / "signing.key"
    approve_project(room, key)
    return key


def _value(rows, label):
    (found,) = [row.value for row in rows if row.label == label]
    return found


def test_numbers_are_those_that_the_artifacts_give_by_another_way(room):
    report = report_of(room, None, NOT_APPROVED, wish=ReportWish())
    front, say = report.front, words()
    at = np.load(read_artifacts(room)["level"] / "trajectory.npz")
    key = next(name for name in at.files if at[name].dtype == np.int64)
    duration_s = (at[key][-1] - at[key][0]) / 1e9
    xyz = room_points(np.random.default_rng(7), POINTS)  # what the map was made of
    tiles = len(np.unique(np.floor(xyz / TILE_M), axis=0))
    size = " × ".join(f"{value:.1f} m" for value in np.ptp(xyz, axis=0))
    # Two ellipses of 6 m and 3 m, sampled at 0.5 s.
    angle = np.append(np.arange(0.0, 59.9, 0.5), 59.9) * 4.0 * np.pi / 59.9
    path = np.stack([6.0 * np.cos(angle), 3.0 * np.sin(angle)], axis=1)
    length_m = np.linalg.norm(np.diff(path, axis=0), axis=1).sum()

    assert _value(front.what, say("front.points")) == f"{POINTS:,}".replace(",", "\u202f")
    assert _value(front.what, say("front.left_out")).split()[0] == str(STRAYS * tiles)
    assert _value(front.where, say("front.extent")) == size
    walked = f"{length_m:.1f} m in {duration_s / 60:.1f} min"
    assert _value(front.what, say("front.walked")) == walked


def test_weakest_loop_closures_are_accepted_ones_and_counts_add_up(room):
    report = report_of(room, None, NOT_APPROVED, wish=ReportWish())
    (loops,) = [one for one in report.sections if one.title == words()("section.loops")]
    counts = {verdict: sum(map(int, of_it)) for verdict, *of_it in loops.tables[0].rows}
    walk = loop_walk()  # of which the builder made the graph
    edges = verified_graph(walk).edges

    assert sum(counts.values()) == len(edges)
    assert counts["accepted"] == sum(one.verdict is Verdict.ACCEPTED for one in edges)
    assert len(loops.tables[1].rows) <= 10


def pages_in(pdf):
    return len(PdfReader(BytesIO(pdf)).pages)


@pytest.mark.parametrize("limits", [3, 15])
def test_the_first_page_has_its_image_as_high_as_there_is_room(room, limits):
    report = report_of(room, None, NOT_APPROVED, wish=ReportWish())
    front = replace(report.front, limits=("A sentence on what the map is not for.",) * limits)
    first = PdfReader(BytesIO(pdf_of(replace(report, front=front)))).pages[0]

    caption = report.front.drawing.caption
    assert caption in " ".join(first.extract_text().split())


def test_hostile_texts_are_shown_and_change_nothing(room):
    plain = report_of(room, None, NOT_APPROVED, wish=ReportWish())
    usual = pages_in(pdf_of(plain))
    for text in HOSTILE:
        with changing(room, "summary.json", compared=False):
            summary = json.loads((room / "summary.json").read_text("utf-8"))
            printable = text.encode("utf-8", "ignore").decode()
            write_summary(room, summary | {"name": printable, "rig": printable})
        report = report_of(room, None, NOT_APPROVED, wish=ReportWish())
        named = replace(report, title=text, foot=text)  # past what reading already refused

        assert pdf_of(named).startswith(b"%PDF-")
        assert pages_in(pdf_of(report)) <= usual + 2


def test_the_same_record_gives_the_same_bytes(room):
    report = report_of(room, None, NOT_APPROVED, wish=ReportWish())

    assert pdf_of(report) == pdf_of(report)
    assert b"pdfaid:part" in pdf_of(report)


def test_a_draft_says_so_and_is_never_signed(room, tmp_path):
    made = write_pdf(room, tmp_path / "draft.pdf", ReportWish(key=server_key(room)))

    assert not made.signed
    assert signatures_in(tmp_path / "draft.pdf") == []
    report = report_of(room, None, made.approval, wish=ReportWish())
    assert not report.front.signature.approved
    assert words()("limits.draft") in report.front.limits


def test_the_report_of_an_approved_map_is_signed_with_the_key_of_the_server(room, tmp_path):
    key = _approved(room)

    made = write_pdf(room, tmp_path / "a.pdf", ReportWish(key=server_key(room)))

    (found,) = signatures_in(tmp_path / "a.pdf")
    assert made.signed and found.intact
    assert found.public_key == public_key_of(key)


def test_a_draft_of_an_approved_map_is_not_signed(room, tmp_path):
    key = _approved(room)

    made = write_pdf(room, tmp_path / "a.pdf", ReportWish(key=key, draft=True))

    assert not made.signed and signatures_in(tmp_path / "a.pdf") == []


def test_an_altered_map_gets_no_report(room, tmp_path):
    key = _approved(room)
    (path,) = read_artifacts(room)["level"].glob("trajectory.npz")
    whole = path.read_bytes()
    path.write_bytes(whole[:-1] + bytes([whole[-1] ^ 1]))

    with pytest.raises(Altered):
        write_pdf(room, tmp_path / "a.pdf", ReportWish(key=key))
    assert list(tmp_path.glob("*.pdf")) == []


def test_every_altered_byte_of_a_signed_report_is_found(room, tmp_path):
    key = _approved(room)
    write_pdf(room, tmp_path / "a.pdf", ReportWish(key=key))
    whole = (tmp_path / "a.pdf").read_bytes()
    path = tmp_path / "b.pdf"
    rng = np.random.default_rng(3)
    for at in rng.integers(0, len(whole), 40).tolist():
        changed = bytearray(whole)
        changed[at] ^= 1 << int(rng.integers(0, 8))
        path.write_bytes(changed)
        try:
            found = signatures_in(path)
        except StoreError:
            continue
        if found and all(one.intact for one in found):
            # Only what a signature cannot cover: the hexadecimal digits that hold it.
            begin = whole.index(b"/Contents <", whole.rindex(b"/ByteRange") - 60_000)
            assert begin < at < whole.index(b">", begin) + 1
    for added in (b"\n", b"% more\n"):
        path.write_bytes(whole + added)
        assert [one.intact for one in signatures_in(path)] == [False]


def test_the_validation_of_pyhanko_agrees(room, tmp_path):
    from pyhanko.pdf_utils.reader import PdfFileReader
    from pyhanko.sign.validation import validate_pdf_signature
    from pyhanko_certvalidator import ValidationContext

    key = _approved(room)
    write_pdf(room, tmp_path / "a.pdf", ReportWish(key=key))
    whole = (tmp_path / "a.pdf").read_bytes()
    at = whole.index(b"stream") + 40
    altered = whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :]

    logging.getLogger("pyhanko").setLevel(logging.CRITICAL + 1)
    for data, bottom_line in ((whole, True), (altered, False)):
        (one,) = PdfFileReader(BytesIO(data)).embedded_signatures
        context = ValidationContext(trust_roots=[one.signer_cert], allow_fetching=False)
        status = validate_pdf_signature(one, signer_validation_context=context)
        assert status.bottom_line is bottom_line
        assert one.sig_object["/SubFilter"] == "/ETSI.CAdES.detached"


def _pkcs12(path, passphrase):
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(NameOID.ORGANIZATION_NAME, "Survey Office")])
    now = datetime.now(UTC)
    certificate = (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(key.public_key())
        .serial_number(7)
        .not_valid_before(now - timedelta(days=1))
        .not_valid_after(now + timedelta(days=30))
        .sign(key, hashes.SHA256())
    )
    path.write_bytes(
        pkcs12.serialize_key_and_certificates(
            b"x", key, certificate, None, BestAvailableEncryption(passphrase)
        )
    )
    return certificate


def test_the_certificate_of_an_organization_signs(tmp_path, room):
    _approved(room)
    certificate = _pkcs12(tmp_path / "o.p12", b"secret words")
    given = Organization(file=tmp_path / "o.p12", passphrase=b"secret words")

    write_pdf(room, tmp_path / "a.pdf", ReportWish(key=given))

    (found,) = signatures_in(tmp_path / "a.pdf")
    assert found.intact and found.public_key == ""
    assert found.certificate == certificate.fingerprint(hashes.SHA256()).hex()
    assert "Survey Office" in found.name


def test_a_wrong_passphrase_is_said_without_the_passphrase(tmp_path):
    _pkcs12(tmp_path / "o.p12", b"right")
    given = Organization(file=tmp_path / "o.p12", passphrase=b"wrong-one")

    with pytest.raises(ConfigError, match="PKCS#12 with this passphrase") as error:
        sign_pdf(b"%PDF-1.7", given, reason="")
    assert "wrong-one" not in str(error.value)


@pytest.mark.parametrize("data", [b"", b"%PDF-1.7\n", b"not a pdf", b"%PDF-1.7\n" + b"[" * 100_000])
def test_what_is_no_pdf_is_refused(tmp_path, data):
    (tmp_path / "a.pdf").write_bytes(data)

    with pytest.raises(StoreError, match="is not a PDF"):
        signatures_in(tmp_path / "a.pdf")


def test_without_the_extra_the_message_says_how_to_install_it(monkeypatch, room, tmp_path):
    import sys

    monkeypatch.setitem(sys.modules, "typst", None)

    with pytest.raises(ConfigError, match=r"pip install 'recon4\[pdf\]'"):
        write_pdf(room, tmp_path / "a.pdf", ReportWish())
    assert pdf.INSTALL in "pip install 'recon4[pdf]'"


def test_delivered_files_are_listed_with_their_hashes(room):
    files = (Row("map.laz", "ab" * 32),)

    report = report_of(room, None, NOT_APPROVED, wish=ReportWish(files=files))

    assert report.sections[-1].hashes == files


def test_a_language_without_catalog_is_refused(room):
    with pytest.raises(ConfigError, match="expected one of en"):
        report_of(room, None, NOT_APPROVED, wish=ReportWish(language="xx"))


def test_a_german_report_has_german_words_and_commas_but_names_as_given(room):
    report = report_of(room, None, NOT_APPROVED, wish=ReportWish(language="de"))
    front, say = report.front, words("de")

    assert (report.language, report.words["draft"]) == ("de", "ENTWURF")
    assert re.fullmatch(r"\d+,\d m in \d,\d min", _value(front.what, say("front.walked")))
    assert front.signature.text == "Entwurf: nicht freigegeben"
    assert say.value("VLP-16, topic /a.b/points, port 2368, 10.02 Hz") == (
        "VLP-16, Topic /a.b/points, Port 2368, 10,02 Hz"
    )
    assert say.decimal("192.168.1.201, 0.2.0, -0.5 m") == "192.168.1.201, 0.2.0, -0,5 m"
    assert say.label("sensor moving") == "Sensor moving"
    line = CodedText("approval-earlier", version=1, who="Ann", day="2026-11-27", newest=3)
    state = ApprovalState(
        kind=ApprovalKind.EARLIER, text=str(line), code=line.code, values=dict(line.values)
    )
    assert said_state(state, say) == "Freigegeben v1 · Ann · 2026-11-27; Version 3 ist neuer"
    assert said_state(state, words()) == state.text
    assert state.text == "Approved v1 · Ann · 2026-11-27; version 3 is newer"
    found = [one for section in report.sections for one in section.findings]
    assert found and all(one.title == title_of(FindingKind(one.code), "de") for one in found)
