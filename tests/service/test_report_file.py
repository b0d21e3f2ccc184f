"""The report for the client, made and signed by the server."""

import pytest
from pypdf import PdfReader

from recon4.delivery.pdf_signature import signatures_in
from recon4.review.signature import public_key_of
from tests.project_builder import approve_project, build_project
from tests.service.running import server_thread


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    return tmp_path_factory.mktemp("reports") / "maps"


@pytest.fixture(scope="module")
def server(root):
    for name in ("approved", "draft"):
        build_project(root / name, points=5_000)
    approve_project(root / "approved", root / ".recon4/signing.key")
    with server_thread(root) as running:
        yield running


def test_the_report_of_an_approved_map_is_signed_by_the_server(server, root, tmp_path):
    answer = server.get("/api/projects/approved/report.pdf")

    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "application/pdf"
    (tmp_path / "a.pdf").write_bytes(answer.content)
    (found,) = signatures_in(tmp_path / "a.pdf")
    assert found.intact and found.public_key == public_key_of(root / ".recon4/signing.key")


def test_the_report_of_a_draft_is_not_signed_and_is_in_the_language_of_the_request(
    server, tmp_path
):
    answer = server.get("/api/projects/draft/report.pdf", headers={"Accept-Language": "de"})

    assert answer.status_code == 200, answer.text
    (tmp_path / "a.pdf").write_bytes(answer.content)
    assert signatures_in(tmp_path / "a.pdf") == []
    assert "ENTWURF" in PdfReader(tmp_path / "a.pdf").pages[0].extract_text()


def test_the_report_is_also_a_page_in_the_language_of_the_request(server):
    answer = server.get("/api/projects/draft/client.html", headers={"Accept-Language": "de"})

    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    assert answer.headers["content-security-policy"].startswith("sandbox; default-src 'none'")
    assert '<html lang="de">' in answer.text and "ENTWURF" in answer.text


def test_a_project_that_is_not_there_has_no_report(server):
    for name in ("report.pdf", "client.html"):
        assert server.get(f"/api/projects/nothing/{name}").status_code == 404


def test_the_quality_report_is_in_the_language_of_the_request_and_its_file_in_english(server, root):
    for name, state in (("draft", "Von niemandem freigegeben."), ("approved", "freigegeben von")):
        address, file = f"/api/projects/{name}/report", root / name / "report.html"

        german = server.get(address, headers={"Accept-Language": "de"}).text
        english = server.get(address, headers={"Accept-Language": "en"}).text

        assert state in german
        assert english == file.read_text("utf-8")
