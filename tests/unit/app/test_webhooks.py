"""Webhooks against a real HTTP server: signed, sent until taken, never to where they may not."""

import asyncio
import base64
import hashlib
import hmac
import ipaddress
import json
import socket
import threading
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer

import pytest
from msgspec import structs

from recon4.errors import ConfigError
from recon4.locales.coded import said
from recon4.review.newest_approval import record_newest
from recon4_app.access.audit import AuditLog
from recon4_app.access.database import open_database
from recon4_app.jobs.model import Inputs, Job, JobState
from recon4_app.jobs.store import JobStore
from recon4_app.settings import ServerSettings
from recon4_app.webhooks.addresses import NotReachable, address_of, is_public, target_of
from recon4_app.webhooks.deliver import Webhooks, trial_event
from recon4_app.webhooks.model import EventKind
from recon4_app.webhooks.signing import new_secret
from recon4_app.webhooks.store import WebhookStore
from recon4_app.webhooks.tuning import WEBHOOKS
from tests.project_builder import approve_project, build_project

HERE = ipaddress.ip_network("127.0.0.0/8")
SECRET = new_secret()
ALL = tuple(EventKind)


class Receiver(HTTPServer):
    """Answers with the statuses it was given, then with 204; remembers what it took."""

    def __init__(self):
        super().__init__(("127.0.0.1", 0), _Taking)
        self.statuses, self.got = [], []
        self.url = f"http://127.0.0.1:{self.server_port}/hook?a=1"


class _Taking(BaseHTTPRequestHandler):
    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.server.got.append((self.path, dict(self.headers), body))
        self.send_response(self.server.statuses.pop(0) if self.server.statuses else 204)
        self.send_header("Location", self.server.url)
        self.end_headers()

    def log_message(self, *_):
        pass


@pytest.fixture
def receiver():
    server = Receiver()
    thread = threading.Thread(target=server.serve_forever, args=(0.01,))
    thread.start()
    yield server
    server.shutdown()
    thread.join()
    server.server_close()


class Parts:
    """The webhooks of a server as one start of it has them."""

    def __init__(self, root, clock, networks):
        settings = ServerSettings(root=root, webhook_networks=networks)
        settings.state.mkdir(exist_ok=True)
        self.jobs = JobStore(settings.state / "jobs.sqlite")
        self.engine = open_database(settings.state / "access.sqlite")
        self.log = AuditLog(self.engine)
        self.store = WebhookStore(self.engine, clock)
        self.webhooks = Webhooks(self.store, self.jobs, self.log, settings=settings)

    def round(self):
        self.webhooks.collect()
        asyncio.run(self.webhooks.deliver())

    def end_job(self, number=1, state=JobState.FAILED):
        """A job that ran and ended after every webhook was added."""
        inputs = Inputs(recordings=())
        job = Job(id=f"{number:016x}", project="office", inputs=inputs, created="2033-01-01")
        waiting = self.jobs.add(job)
        running = self.jobs.change(waiting, waiting.to(JobState.RUNNING, attempt=1))
        ended = running.to(state, finished="2033-05-18T03:33:20+00:00", note="no points")
        return self.jobs.change(running, ended)


@pytest.fixture
def started(tmp_path, clock):
    """Start a server on the same files, as often as a test wants."""
    opened = []

    @contextmanager
    def start(networks=(HERE,)):
        parts = Parts(tmp_path, clock, networks)
        opened.append(parts)
        yield parts
        parts.jobs.close()
        parts.engine.dispose()

    return start


def added(parts, url, events=ALL):
    return parts.store.add(url, events, secret=SECRET, by="anna")


def test_a_finished_job_is_posted_once_with_a_signature(started, receiver):
    with started() as parts:
        added(parts, receiver.url)
        job = parts.end_job()
        parts.round()
        parts.round()
        (entry,) = parts.log.newest(10)

    ((path, headers, body),) = receiver.got
    signed = b".".join(
        [headers["webhook-id"].encode(), headers["webhook-timestamp"].encode(), body]
    )
    key = base64.b64decode(SECRET.removeprefix("whsec_"))
    expected = base64.b64encode(hmac.new(key, signed, hashlib.sha256).digest()).decode()
    record = json.loads(body)
    assert path == "/hook?a=1" and headers["webhook-signature"] == f"v1,{expected}"
    assert (record["type"], record["data"]["state"]) == ("job.finished", "failed")
    assert record["data"]["job"] == job.id and headers["webhook-id"] == f"job-{job.id}"
    assert (entry.action, entry.outcome) == ("post webhook", "done")
    assert "127.0.0.1" in entry.object and "hook?a=1" not in entry.object


def test_a_server_that_was_killed_loses_no_event(started, receiver):
    with started() as parts:
        webhook = added(parts, receiver.url)
        parts.end_job(1)  # killed before anything was collected
    with started() as parts:
        parts.webhooks.collect()  # killed before anything was sent
        parts.end_job(2)
    with started() as parts:
        parts.round()
        left = parts.store.get(webhook.id).waiting

    assert [headers["webhook-id"][-1] for _, headers, _ in receiver.got] == ["1", "2"]
    assert left == 0


def test_what_is_not_taken_is_sent_again_after_longer_and_longer(started, receiver, clock):
    receiver.statuses = [503, 302, 404]
    with started() as parts:
        webhook = added(parts, receiver.url)
        parts.end_job()
        waits_s, problems = [], []
        for _ in range(3):
            parts.round()
            waits_s.append(parts.store.next_due_s())
            problems.append(parts.store.get(webhook.id).problem)
            parts.round()  # not yet due
            clock.now_s += waits_s[-1]
        parts.round()
        (delivery,) = parts.store.deliveries(webhook.id)
        failures = [one for one in parts.log.newest(10) if one.outcome == "failed"]

    assert waits_s == [5.0, 20.0, 80.0]
    assert "answered 503" in problems[0] and "redirects are not followed" in problems[1]
    assert said(problems[0], "de") == "Der Empfänger antwortete 503"
    assert len(receiver.got) == 4 and len({body for *_, body in receiver.got}) == 1
    assert delivery.delivered and delivery.attempts == 4 and not delivery.problem
    assert len(failures) == 1  # the log is not flooded by a receiver that is away


def test_an_approval_is_posted_once(started, receiver, tmp_path):
    build_project(tmp_path / "office", points=1000)
    with started() as parts:
        state = tmp_path / ".recon4"
        webhook = added(parts, receiver.url, (EventKind.APPROVAL_SIGNED,))
        approve_project(tmp_path / "office", state / "signing.key", who="Eva")
        record_newest(tmp_path / "office", state)
        parts.end_job()
        parts.round()
        assert parts.store.get(webhook.id).waiting == 0
    with started() as parts:
        parts.round()

    ((_, _, body),) = receiver.got
    data = json.loads(body)["data"]
    assert (data["project"], data["version"], data["who"]) == ("office", 1, "Eva")


def test_a_webhook_takes_only_what_happens_after_it_was_added(started, receiver, clock):
    with started() as parts:
        parts.end_job(1)
        clock.now_s = 2_500_000_000.0  # later than the jobs of `end_job`
        added(parts, receiver.url)
        parts.round()
        assert parts.jobs.ended() == []
        parts.store.keep(trial_event("x", "1", time="2100-01-01T00:00:00+00:00"))
        parts.round()

    assert [headers["webhook-id"] for _, headers, _ in receiver.got] == ["test-1"]


def test_a_name_that_leads_into_a_network_that_is_not_allowed_is_not_called(started, receiver):
    name = receiver.url.replace("127.0.0.1", "localhost")
    with started(networks=()) as parts:
        webhook = added(parts, name)
        parts.end_job()
        parts.round()
        problem = parts.store.get(webhook.id).problem

    assert receiver.got == [] and "is not in the internet" in problem


def test_a_receiver_that_says_nothing_is_left_in_time(started, monkeypatch):
    monkeypatch.setattr(
        "recon4_app.webhooks.post.WEBHOOKS", structs.replace(WEBHOOKS, answer_s=0.2)
    )
    with started() as parts, mute_server() as url:
        webhook = added(parts, url)
        parts.end_job()
        parts.round()

        assert parts.store.get(webhook.id).problem == "no answer within 0 s"


@contextmanager
def mute_server():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        yield f"http://127.0.0.1:{listener.getsockname()[1]}/"


@pytest.mark.parametrize(
    ("address", "public"),
    [
        ("93.184.216.34", True),
        ("2606:2800:220:1::1", True),
        *[(one, False) for one in ("127.0.0.1", "10.1.2.3", "192.168.1.201", "169.254.169.254")],
        *[(one, False) for one in ("0.0.0.0", "224.0.0.1", "::1", "fe80::1", "fd00::1")],
        *[(one, False) for one in ("::ffff:10.0.0.1", "64:ff9b::a00:1", "2002:a00:1::")],
        ("100.64.0.1", False),
    ],
)
def test_only_addresses_of_the_internet_are_public(address, public):
    assert is_public(ipaddress.ip_address(address)) == public


def test_without_tls_only_networks_that_were_named_are_called():
    target = target_of("http://93.184.216.34/")

    with pytest.raises(NotReachable, match="https is required"):
        asyncio.run(address_of(target, ()))
    allowed = (ipaddress.ip_network("93.184.216.0/24"),)
    assert asyncio.run(address_of(target, allowed)) == "93.184.216.34"


@pytest.mark.parametrize(
    ("url", "message"),
    [
        ("ftp://a.example/", "expected https"),
        ("https://anna:x@a.example/", "a password"),
        ("https://a.example/#x", "a fragment"),
        ("https://a.example:x/", "Port"),
        ("https://a.example/\r\nHost: b", "expected https"),
        ("https://a.example/" + "x" * 500, "at most 500"),
    ],
)
def test_what_is_no_address_is_refused(started, url, message):
    with started() as parts, pytest.raises(ConfigError, match=message):
        added(parts, url)


def test_a_secret_must_have_enough_bytes(started):
    with started() as parts, pytest.raises(ConfigError, match="24 to 64 bytes"):
        parts.store.add("https://a.example/", ALL, secret="whsec_YWJj", by="anna")
