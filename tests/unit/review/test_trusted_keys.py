"""Which keys count: of a server, of a person; added, removed, renewed; damaged files."""

import json
import stat

import pytest

from recon4.errors import ConfigError
from recon4.review.signature import public_key_of, sign
from recon4.review.trusted_keys import (
    SIGNING_KEY,
    STATE,
    UnknownSigner,
    add_key,
    ensure_own_key,
    personal_folder,
    read_keys,
    record_own_key,
    remove_key,
    renew_own_key,
    trusted_for,
)


@pytest.fixture
def state(tmp_path):
    state = tmp_path / "maps" / STATE
    ensure_own_key(state)
    return state


@pytest.fixture
def foreign(tmp_path):
    return sign({}, tmp_path / "foreign.key")


def of(state):
    return read_keys(state, server=True)


def test_a_server_trusts_its_own_key_and_no_other(state, foreign):
    own = public_key_of(state / SIGNING_KEY)

    assert of(state).signer(own).own
    with pytest.raises(UnknownSigner, match=f"unknown key {foreign['key']}: this server did not"):
        of(state).signer(foreign["public_key"])


def test_a_server_whose_key_was_never_recorded_trusts_it(tmp_path):
    sign({}, tmp_path / STATE / SIGNING_KEY)  # as an earlier version left it

    assert of(tmp_path / STATE).signer(public_key_of(tmp_path / STATE / SIGNING_KEY)).own


def test_a_foreign_key_counts_from_when_it_is_added_until_it_is_removed(state, foreign):
    add_key(of(state), "Survey Brno", foreign["public_key"], by="eva")
    added = of(state).signer(foreign["public_key"])
    remove_key(of(state), "Survey Brno", by="jan")

    assert (added.name, added.by, added.own) == ("Survey Brno", "eva", False)
    with pytest.raises(UnknownSigner, match=r"\(Survey Brno\), which jan removed"):
        of(state).signer(foreign["public_key"])
    add_key(of(state), "Survey Brno", foreign["public_key"], by="eva")
    assert of(state).signer(foreign["public_key"]).name == "Survey Brno"


def test_after_a_renewal_both_keys_count_until_the_old_one_is_removed(state):
    old = public_key_of(state / SIGNING_KEY)

    new = renew_own_key(state)

    assert public_key_of(state / SIGNING_KEY) == new.public_key != old
    assert stat.S_IMODE((state / SIGNING_KEY).stat().st_mode) == 0o600
    assert of(state).signer(old).own and of(state).signer(new.public_key).own
    remove_key(of(state), of(state).signer(old).fingerprint, by="eva")
    with pytest.raises(UnknownSigner):
        of(state).signer(old)


def test_a_key_replaced_by_hand_leaves_the_recorded_one_trusted(state):
    old = public_key_of(state / SIGNING_KEY)
    (state / SIGNING_KEY).unlink()

    ensure_own_key(state)

    assert of(state).signer(old).own
    assert of(state).signer(public_key_of(state / SIGNING_KEY)).own


def test_the_key_a_server_signs_with_is_not_removed_and_a_removed_one_not_recorded_again(state):
    own = of(state).signer(public_key_of(state / SIGNING_KEY))
    with pytest.raises(ConfigError, match="make another first"):
        remove_key(of(state), own.fingerprint, by="eva")
    old = (state / SIGNING_KEY).read_bytes()
    renew_own_key(state)
    remove_key(of(state), own.fingerprint, by="eva")
    (state / SIGNING_KEY).write_bytes(old)

    record_own_key(state)

    with pytest.raises(UnknownSigner, match="eva removed"):
        of(state).signer(own.public_key)


@pytest.mark.parametrize("text", ["", "abc", "g" * 64, "0" * 63, "0" * 65])
def test_what_is_no_public_key_is_refused(state, text):
    with pytest.raises(ConfigError, match="public key of 64 hexadecimal digits"):
        add_key(of(state), "Brno", text, by="eva")


@pytest.mark.parametrize("name", ["", "  ", "x" * 101, "Br\u202eno"])
def test_a_name_that_would_mislead_is_refused(state, foreign, name):
    with pytest.raises(ConfigError, match="visible characters"):
        add_key(of(state), name, foreign["public_key"], by="eva")


def test_a_name_two_keys_have_is_not_removed(state, foreign, tmp_path):
    other = sign({}, tmp_path / "other.key")
    for one in (foreign, other):
        add_key(of(state), "Brno", one["public_key"], by="eva")

    with pytest.raises(ConfigError, match="2 keys are named 'Brno': give the fingerprint"):
        remove_key(of(state), "Brno", by="eva")


def test_a_file_under_a_false_name_or_damaged_is_no_key_and_is_named(state, foreign):
    add_key(of(state), "Brno", foreign["public_key"], by="eva")
    folder = state / "trusted_keys"
    (folder / f"{foreign['key']}.json").rename(folder / f"{'0' * 16}.json")
    (folder / "half.json").write_text('{"format": 1, "pub')

    found = of(state)

    assert foreign["public_key"] not in found.keys
    assert len(found.damaged) == 2 and "0000.json cannot be used" in found.damaged[0]
    with pytest.raises(UnknownSigner, match=r"half\.json cannot be used"):
        found.signer(foreign["public_key"])


def test_a_project_is_judged_by_its_server_also_in_the_trash_and_through_a_link(state, tmp_path):
    root = state.parent
    (state / "trash" / "office-1").mkdir(parents=True)
    (root / "office").mkdir()
    (tmp_path / "elsewhere").mkdir()
    (root / "linked").symlink_to(tmp_path / "elsewhere")

    assert trusted_for(root / "office").folder == state
    assert trusted_for(state / "trash" / "office-1").folder == state
    assert trusted_for(root / "linked").folder == personal_folder()


def test_nothing_inside_a_project_makes_a_key_trusted(tmp_path, foreign):
    project = tmp_path / "alone" / "office"
    project.mkdir(parents=True)
    add_key(read_keys(project / STATE, server=True), "Me", foreign["public_key"], by="me")
    add_key(read_keys(project, server=True), "Me", foreign["public_key"], by="me")

    with pytest.raises(UnknownSigner, match="unknown on this computer"):
        trusted_for(project).signer(foreign["public_key"])


def test_the_keys_of_a_person_are_in_the_configuration(tmp_path, foreign, monkeypatch):
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    add_key(trusted_for(tmp_path / "office"), "Brno", foreign["public_key"], by="eva")

    (path,) = (tmp_path / "config" / "recon4" / "trusted_keys").iterdir()

    assert json.loads(path.read_text())["name"] == "Brno"
    assert trusted_for(tmp_path / "office").signer(foreign["public_key"]).name == "Brno"
