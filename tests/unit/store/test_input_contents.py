"""Stages that are given contents: what made the same again makes nothing else run."""

import numpy as np
import pytest

from recon4.progress import Silent
from recon4.settings import Settings
from recon4.settings.reads import ReadsNothing
from recon4.store.input_contents import arrays_of, files_of
from recon4.store.project import Project
from recon4.store.stage import Input, Stage, StageRunner


def _sort(context, *, letters):
    (context.out / "sorted.txt").write_text("".join(sorted(letters)))
    (context.out / "given.txt").write_text(letters)


def _shout(context, *, made):
    (context.out / "loud.txt").write_text((made / "sorted.txt").read_text().upper())


SORT = Stage("sort", 1, ReadsNothing, _sort)
SHOUT = Stage("shout", 1, ReadsNothing, _shout)


@pytest.fixture
def run(tmp_path):
    """Sorts letters and shouts what some files of that have."""

    def go(letters, names):
        with Project.open(tmp_path / "letters") as project:
            runner = StageRunner(project, Settings(), Silent())
            made = runner.run(SORT, letters=Input(letters, letters))
            runner.run(SHOUT, made=files_of(made, names))
            return runner.runs["sort"], runner.runs["shout"]

    return go


def test_what_wrote_the_same_bytes_makes_nothing_else_run(run):
    _, first = run("office", ("sorted.txt",))

    sort, shout = run("eciffo", ("sorted.txt",))

    assert not sort.reused
    assert shout.reused
    assert shout.artifact == first.artifact


def test_other_bytes_of_a_file_that_is_read_make_the_next_stage_run(run):
    run("office", ("sorted.txt", "given.txt"))

    assert not run("eciffo", ("sorted.txt", "given.txt"))[1].reused
    assert not run("offices", ("sorted.txt",))[1].reused


def test_a_file_that_an_artifact_does_not_have_is_part_of_the_key(run):
    run("office", ("sorted.txt",))

    sort, shout = run("office", ("sorted.txt", "lost.txt"))

    assert sort.reused
    assert not shout.reused


def test_a_record_is_known_by_every_bit_of_its_arrays():
    t_m = np.arange(6.0).reshape(2, 3)
    key = arrays_of("poses", {"t_m": t_m}).key

    assert arrays_of("others", {"t_m": t_m.copy()}).key == key
    others = [
        {"t_m": np.nextafter(t_m, 9.0)},
        {"t_m": t_m.reshape(3, 2)},
        {"t_m": t_m.astype(np.float32)},
        {"R": t_m},
    ]
    assert key not in {arrays_of("poses", one).key for one in others}
