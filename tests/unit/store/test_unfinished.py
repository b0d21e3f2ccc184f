"""What a killed stage has done: found again whole, or not at all."""

import pytest

from recon4.errors import Cancelled, GraphError
from recon4.store.row_file import RowFile
from recon4.store.unfinished import UNFINISHED, RecordLog, keeping, unfinished_file


def test_a_log_goes_on_after_the_last_whole_record(tmp_path):
    path = tmp_path / "log"
    first = RecordLog(path)
    for record in (b"one", b"two", b"three"):
        first.append(record)
    path.write_bytes(path.read_bytes()[:-2])

    cut = RecordLog(path)
    cut.append(b"four")

    assert list(cut) == [b"one", b"two"]
    assert list(RecordLog(path)) == [b"one", b"two", b"four"]


def test_a_damaged_record_ends_the_log(tmp_path):
    path = tmp_path / "log"
    first = RecordLog(path)
    for record in (b"one", b"two", b"three"):
        first.append(record)
    data = bytearray(path.read_bytes())
    data[-9 - 8] ^= 1  # in "two"
    path.write_bytes(data)

    assert list(RecordLog(path)) == [b"one"]


def test_rows_that_an_earlier_process_wrote_are_there(tmp_path):
    kept = tmp_path / "rows"
    RowFile(4, 10, scratch=tmp_path, kept=kept).write(2, b"abcdef")

    rows = RowFile(4, 10, scratch=tmp_path, kept=kept)

    assert [rows.has(k) for k in range(4)] == [False, False, True, False]
    assert rows.read(2) == b"abcdef"
    assert rows.read(2, start=1, size=3) == b"bcd"


def test_a_damaged_row_is_absent(tmp_path):
    kept = tmp_path / "rows"
    RowFile(4, 10, scratch=tmp_path, kept=kept).write(2, b"abcdef")
    kept.write_bytes(kept.read_bytes().replace(b"abc", b"abd"))

    rows = RowFile(4, 10, scratch=tmp_path, kept=kept)

    assert not any(rows.has(k) for k in range(4))


def test_outside_of_a_stage_nothing_is_kept(tmp_path):
    log = RecordLog(unfinished_file("log"))
    log.append(b"one")

    assert list(log) == []


@pytest.mark.parametrize(
    ("error", "stays"), [(None, False), (Cancelled("stop"), True), (GraphError("no"), False)]
)
def test_work_stays_after_a_stop_and_is_gone_after_any_other_end(tmp_path, error, stays):
    def stage():
        with keeping(tmp_path, "graph", "key"):
            RecordLog(unfinished_file("log")).append(b"one")
            if error:
                raise error

    if error:
        with pytest.raises(type(error)):
            stage()
    else:
        stage()

    assert (tmp_path / UNFINISHED).exists() == stays


def test_another_key_of_the_stage_removes_the_work_of_the_one_before(tmp_path):
    for stage, key in (("graph", "a"), ("map", "a")):
        with pytest.raises(Cancelled), keeping(tmp_path, stage, key):
            RecordLog(unfinished_file("log")).append(b"one")
            raise Cancelled("stop")

    with keeping(tmp_path, "graph", "b"):
        assert list(RecordLog(unfinished_file("log"))) == []

    assert [path.name for path in (tmp_path / UNFINISHED).iterdir()] == ["map-a"]
