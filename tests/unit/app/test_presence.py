"""Who looks at which pair now."""

from msgspec import structs

from recon4_app.review.presence import Presence
from recon4_app.review.tuning import PRESENCE


def test_pages_of_a_project_see_each_other_until_they_are_silent(clock):
    presence = Presence(clock)
    presence.look("office", "Eva", page="a", pair=(2, 7))
    presence.look("hall", "Ida", page="c", pair=None)

    (eva,) = presence.look("office", "Jan", page="b", pair=None)

    assert (eva.who, eva.pair) == ("Eva", (2, 7))
    assert presence.look("office", "Eva", page="a", pair=(2, 9))[0].who == "Jan"
    clock.now_s += PRESENCE.gone_s
    presence.look("office", "Eva", page="a", pair=None)
    clock.now_s += 1.0
    assert presence.look("office", "Eva", page="a", pair=None) == []  # Jan is gone


def test_a_flood_of_pages_is_forgotten(clock, monkeypatch):
    few = structs.replace(PRESENCE, max_pages=5)
    monkeypatch.setattr("recon4_app.review.presence.PRESENCE", few)
    presence = Presence(clock)
    for number in range(9):
        presence.look("office", "Eva", page=str(number), pair=None)

    assert len(presence.look("office", "Jan", page="x", pair=None)) == 4
