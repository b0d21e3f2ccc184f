"""The workers that an administrator chose for the jobs of a server."""

from __future__ import annotations

import pytest

from recon4.cli.main import main
from recon4.errors import ConfigError, StoreError
from recon4.executors.chosen import ChosenWorkers, read_choice, store_choice


@pytest.mark.parametrize(
    "chosen",
    [
        {"count": 3},
        {"scheduler": "tls://north.example:8786", "dashboard": "https://north.example/status"},
        {"scheduler": "tls://[2001:db8::1]:8786"},
        {},
    ],
)
def test_a_choice_is_kept(chosen, tmp_path):
    store_choice(tmp_path, ChosenWorkers(**chosen))

    assert read_choice(tmp_path) == ChosenWorkers(**chosen)
    assert read_choice(tmp_path).used == bool(chosen)


def test_a_server_without_a_choice_uses_nobody(tmp_path):
    assert not read_choice(tmp_path).used


@pytest.mark.parametrize(
    ("chosen", "why"),
    [
        ({"count": -1}, "expected 0 to 256"),
        ({"count": 257}, "expected 0 to 256"),
        ({"scheduler": "tcp://north:8786"}, "expected tls://HOST:PORT"),
        ({"scheduler": "tls://north"}, "expected tls://HOST:PORT"),
        ({"scheduler": "tls://north:8786/../x"}, "expected tls://HOST:PORT"),
        ({"dashboard": "javascript:alert(1)"}, "address of a page"),
        ({"dashboard": "http://north/\n"}, "address of a page"),
        ({"count": 1, "scheduler": "tls://north:8786"}, "not both"),
    ],
)
def test_a_choice_that_makes_no_sense_is_refused_and_changes_nothing(chosen, why, tmp_path):
    store_choice(tmp_path, ChosenWorkers(count=2))

    with pytest.raises(ConfigError, match=why):
        store_choice(tmp_path, ChosenWorkers(**chosen))

    assert read_choice(tmp_path) == ChosenWorkers(count=2)


@pytest.mark.parametrize("text", ["{", '{"count": "two"}', '{"program": "x"}', '{"count": 1e9}'])
def test_a_damaged_choice_is_an_error_and_no_choice(text, tmp_path):
    (tmp_path / "workers.json").write_text(text, "utf-8")

    with pytest.raises(StoreError):
        read_choice(tmp_path)


def test_doctor_says_why_the_chosen_workers_cannot_be_used(tmp_path, capsys):
    state = tmp_path / ".recon4"
    state.mkdir()
    store_choice(state, ChosenWorkers(scheduler="tls://127.0.0.1:1"))

    assert main(["doctor", str(tmp_path)]) == 1

    (line,) = [line for line in capsys.readouterr().out.splitlines() if "workers of jobs" in line]
    assert line.startswith("NO")
    assert f"no such certificate or key: {state}/cluster/ca.pem" in line
