"""The log of a process: bounded in rate and size, safe to look at."""

import json
import logging
import subprocess
import sys

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import structs

from recon4_app import logs as module
from recon4_app.jobs.folder import JobFolder
from recon4_app.logs import Logs, RepeatFilter, printable, rotate_grown


class Clock:
    now_s = 0.0

    def __call__(self):
        return self.now_s


def record(message, *args, name="recon4_app.test"):
    return logging.LogRecord(name, logging.WARNING, "", 0, message, args, None)


def test_repetitions_are_counted_and_the_next_line_says_how_many():
    clock = Clock()
    judge = RepeatFilter(clock)
    written = [judge.filter(record("refused %s", n)) for n in range(100)]
    clock.now_s = 60.0
    last = record("refused %s", 100)

    assert sum(written) == module.LOGS.repeats_a_minute
    assert judge.filter(last)
    assert last.getMessage() == "refused 100 (80 more like this were not written)"
    assert judge.dropped == 80


def test_messages_that_all_differ_are_limited_too():
    judge = RepeatFilter(Clock())
    written = sum(judge.filter(record(f"message {n}")) for n in range(10_000))

    assert written == module.LOGS.records_a_minute
    assert len(judge._written) <= module.LOGS.max_kinds
    assert len(judge._dropped) <= module.LOGS.max_kinds


def test_one_noisy_logger_does_not_silence_another():
    judge = RepeatFilter(Clock())
    for n in range(1000):
        judge.filter(record(f"message {n}"))

    assert judge.filter(record("disk full", name="recon4_app.jobs"))


@given(st.text())
def test_a_message_is_one_line_without_control_characters(text):
    assert printable(text).isprintable()


@pytest.mark.parametrize("text", ["a\nb", "\x1b[2J", "\u202eevil", "\x00", "\ud800"])
def test_what_acts_on_a_terminal_is_written_as_an_escape(text):
    assert printable(text).isascii()
    assert "\\" in printable(text)


@pytest.fixture
def logged(tmp_path):
    logs = Logs(tmp_path / "logs" / "server.log")
    with logs.installed():
        yield logs, tmp_path / "logs" / "server.log"


def test_the_file_holds_an_object_a_line_with_the_traceback(logged):
    _, file = logged
    try:
        raise ValueError("no\x1b such \u202e thing")
    except ValueError:
        logging.getLogger("recon4_app.test").exception("failed %s", "a\nb")
    (line,) = file.read_text("ascii").splitlines()

    fields = json.loads(line)
    assert fields["level"] == "ERROR"
    assert fields["logger"] == "recon4_app.test"
    assert fields["message"] == "failed a\\nb"
    assert "ValueError" in fields["exception"]
    assert "\x1b" not in fields["exception"]
    assert "\u202e" not in fields["exception"]


def test_both_outputs_agree_on_what_repeats(logged, capsys):
    logs, file = logged
    for _ in range(100):
        logging.getLogger("recon4_app.test").warning("again")

    assert len(file.read_text().splitlines()) == module.LOGS.repeats_a_minute
    assert logs.dropped == 100 - module.LOGS.repeats_a_minute


def test_the_file_rotates(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "LOGS", structs.replace(module.LOGS, max_log_bytes=2000))
    monkeypatch.setattr(module, "LOGS", structs.replace(module.LOGS, records_a_minute=10_000))
    logs = Logs(tmp_path / "server.log")
    with logs.installed():
        for n in range(2000):
            logging.getLogger("recon4_app.test").warning(f"message {n}")
    files = list(tmp_path.iterdir())

    assert len(files) == module.LOGS.kept_logs
    assert max(path.stat().st_size for path in files) <= 2000


def test_a_full_disk_is_counted_and_causes_no_output(monkeypatch, capfd):
    from pathlib import Path

    logs = Logs(Path("/dev/full"))
    monkeypatch.setattr(module.QuietRotatingFile, "shouldRollover", lambda *_: False)
    with logs.installed():
        logging.getLogger("recon4_app.test").warning("one")

    assert logs.failures == 1
    assert "Traceback" not in capfd.readouterr().err


def test_a_log_another_process_appends_to_is_rotated_under_it(tmp_path):
    path = tmp_path / "log.txt"
    code = "import sys\nfor line in sys.stdin: sys.stderr.write(line); sys.stderr.flush(); print()"
    with (
        path.open("ab") as output,
        subprocess.Popen(
            [sys.executable, "-c", code],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=output,
            text=True,
        ) as writer,
    ):

        def write(line):
            writer.stdin.write(line + "\n")
            writer.stdin.flush()
            writer.stdout.readline()

        for generation in range(5):
            write(f"{generation}" * 100)
            assert rotate_grown(path, max_bytes=50, kept=3)
        write("newest")
        writer.stdin.close()

    assert path.read_text() == "newest\n", "not a hole of zeros before it"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["log.txt", "log.txt.1", "log.txt.2"]
    assert (tmp_path / "log.txt.1").read_text() == "4" * 49 + "\n"
    assert (tmp_path / "log.txt.2").read_text() == "3" * 49 + "\n"


def test_a_small_log_and_one_that_is_not_there_are_left_alone(tmp_path):
    (tmp_path / "log.txt").write_text("x")

    assert not rotate_grown(tmp_path / "log.txt")
    assert not rotate_grown(tmp_path / "none.txt")


def test_who_follows_a_job_s_log_goes_on_after_a_rotation(tmp_path):
    folder = JobFolder(tmp_path)
    (tmp_path / "log.txt").write_text("a long first line\n")
    _, following = folder.log_since(0)
    rotate_grown(tmp_path / "log.txt", max_bytes=5)
    (tmp_path / "log.txt").write_text("second\n")

    assert folder.log_since(following) == ("second\n", 7)
