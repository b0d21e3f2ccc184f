"""A browser that sends the viewer what no page sends: ignored, said once, nobody else notices.

A real server, a real viewer process and two clients of it; one of them attacks.
"""

import json
import re
from dataclasses import dataclass
from pathlib import Path

import pytest

from recon4_app.viewer.client.view import ViewState
from tests.processes import viewer_process
from tests.project_builder import add_multiframes, build_project
from tests.security.viewer_attacks import MALFORMED, PROPERTIES, VALUES, VIEWS, packed, pointer
from tests.service.running import server_thread
from tests.service.viser_client import ViserClient, camera, viewing

POINTS = 60_000
DROPPED = "dropped a message"


@dataclass(frozen=True)
class House:
    """A running server with one project."""

    url: str
    root: Path

    def log(self) -> str:
        return (self.root / ".recon4" / "viewers" / "office.txt").read_text()

    def looking(self):
        return viewing(self.url)


@pytest.fixture(scope="module")
def house(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects")
    build_project(root / "office", points=POINTS)
    add_multiframes(root / "office")
    with server_thread(root) as running:
        yield House(running.url, root)


@pytest.fixture
def other(house):
    """Somebody else who looks at the same map."""
    with house.looking() as client:
        begin(client)
        client.rest()
        yield client


def begin(client: ViserClient) -> None:
    client.send(camera((8.0, 3.0, 1.5)))
    client.until(lambda c: c.shown == POINTS and "60\u202f000 of" in c.html())


def still_served(client: ViserClient, size_m: float = 0.15) -> bool:
    """Whether a widget of a client still does what it is for."""
    client.set("Point size", size_m)
    client.until(lambda c: f'"point_size_m": {size_m}' in str(c.storage))
    return True


def assert_nobody_noticed(house: House, other: ViserClient, process: int, before: str) -> None:
    assert viewer_process(house.root) == process
    assert "Traceback" not in house.log()[len(before) :], house.log()[len(before) :]
    received = other.bytes
    other.rest(quiet_s=0.2)
    assert other.bytes == received
    other.set("Point size", 0.02)
    assert still_served(other, 0.1)


def test_malformed_messages_are_ignored_and_said_once(house, other, caplog):
    process, before = viewer_process(house.root), house.log()

    with house.looking() as client:
        begin(client)
        for data in MALFORMED.values():
            client.socket.send(data)
        assert still_served(client)

    assert caplog.text.count(DROPPED) == 1
    assert_nobody_noticed(house, other, process, before)


@pytest.mark.parametrize("name", MALFORMED)
def test_a_malformed_message_as_the_first_one_changes_nothing(house, name):
    with house.looking() as client:
        client.socket.send(MALFORMED[name])
        begin(client)


def test_values_that_a_widget_cannot_have_are_ignored_and_said_once(house, other):
    process, before = viewer_process(house.root), house.log()

    with house.looking() as client:
        begin(client)
        for label, value in VALUES.values():
            client.set(label, value)
        for updates in PROPERTIES:
            uuid = client.widget("Point size")["uuid"]
            client.send({"type": "GuiUpdateMessage", "uuid": uuid, "updates": updates})
        assert still_served(client)
        kept = json.loads(next(iter(client.storage.values())))

    assert kept == json.loads(ViewState(point_size_m=0.15).to_json())
    said = house.log()[len(before) :]
    assert len(re.findall("ignored a value", said)) == 1, said
    assert_nobody_noticed(house, other, process, before)


def test_a_number_beyond_a_slider_is_its_end(house):
    with house.looking() as client:
        begin(client)
        client.set("Point size", 5.0)
        client.until(lambda c: '"point_size_m": 0.2' in str(c.storage))
        client.set("Multiframe", -(2**63))
        client.set("Window", 1e12)
        client.until(lambda c: '"window_s": 30.0' in str(c.storage))

        assert '"moment": 0' in str(client.storage)


def test_widgets_and_keys_of_somebody_else_do_nothing(house, other):
    process, before = viewer_process(house.root), house.log()
    view = dict(other.storage)

    with house.looking() as client:
        begin(client)
        for widget in other.widgets.values():
            for value in (True, 0.2, "turbo"):
                updates = {"value": value}
                uuid = widget["uuid"]
                client.send({"type": "GuiUpdateMessage", "uuid": uuid, "updates": updates})
        for uuid in other.commands.values():
            client.send({"type": "CommandTriggerMessage", "uuid": uuid})
        assert still_served(client)

    assert other.storage == view
    assert_nobody_noticed(house, other, process, before)


@pytest.mark.parametrize("changes", VIEWS)
def test_a_kept_view_that_is_absurd_ends_no_session(house, other, changes):
    process, before = viewer_process(house.root), house.log()
    kept = json.loads(ViewState().to_json())
    text = json.dumps(kept)[:-1] + ", " + changes[1:]

    with house.looking() as client:
        client.storage["recon4.view.office"] = text
        begin(client)
        assert still_served(client)

    assert_nobody_noticed(house, other, process, before)


def test_a_window_without_area_is_drawn_once_it_has_one(house):
    """A page in a hidden frame has a canvas of no pixels."""
    before = house.log()
    with house.looking() as client:
        client.send(camera((8.0, 3.0, 1.5), width=0, height=0))
        client.socket.send(pointer())
        begin(client)

    assert "Traceback" not in house.log()[len(before) :]


def test_a_storm_of_clicks_delays_nobody_else(house, other):
    process, before = viewer_process(house.root), house.log()

    with house.looking() as client:
        begin(client)
        for _ in range(2000):
            client.socket.send(pointer(ray_direction=(0.3, 0.2, -0.1)))
        client.send({"type": "CommandTriggerMessage", "uuid": "x"})
        began = other.bytes
        assert still_served(other, 0.05)
        assert other.bytes > began

    assert_nobody_noticed(house, other, process, before)


def test_a_message_with_two_types_reaches_the_viewer_as_one_of_them(house, other):
    """Decoders differ in which of two equal keys counts."""
    process, before = viewer_process(house.root), house.log()
    message = packed(camera())
    doubled = bytes([message[0] + 1]) + message[1:] + packed({"type": "ShareUrlRequest"})[1:]

    with house.looking() as client:
        begin(client)
        client.socket.send(doubled)
        assert still_served(client)

    assert_nobody_noticed(house, other, process, before)
