"""`make quick` runs the tests that mirror what was changed."""

import subprocess

import pytest

from tools.touched import ALWAYS, ROOT, mirrors_of, touched, without_those_below


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("recon4/mapping/tiles.py", ["tests/unit/mapping"]),
        ("recon4/findings/witnesses/imu.py", ["tests/unit/findings"]),
        ("recon4/settings/mapping.py", ["tests/unit/test_settings.py"]),
        ("recon4/cli/main.py", ["tests/unit/test_cli.py"]),
        ("recon4/backup.py", ["tests/unit/test_backup.py", "tests/unit/test_backup_hostile.py"]),
        ("app/recon4_app/jobs/worker.py", ["tests/unit/app"]),
        ("web/live/live.js", ["tests/unit/test_web_addresses.py"]),
        ("tools/structure.py", ["tests/unit/test_structure.py"]),
        ("examples/process.py", ["tests/unit/api"]),
        ("tests/unit/mapping/test_some.py", []),
        ("tests/unit/live/test_disk.py", ["tests/unit/live/test_disk.py"]),
        ("tests/unit/recording/packet_builders.py", ["tests/unit/recording"]),
        ("tests/unit/conftest.py", []),
        ("docs/explanation/map.md", []),
        ("Makefile", []),
    ],
)
def test_a_file_is_tested_by_what_has_the_name_of_its_room(file, expected):
    assert mirrors_of(file) == expected


def test_the_rules_that_are_always_checked_exist():
    assert [path for path in ALWAYS if not (ROOT / path).is_file()] == []


def test_a_test_in_a_folder_that_runs_is_not_named_again():
    paths = ["tests/unit/live/test_disk.py", "tests/unit/live", "tests/unit/live", "a.py"]

    assert without_those_below(paths) == ["tests/unit/live", "a.py"]


@pytest.fixture
def repository(tmp_path):
    """A repository with two commits, whose remote branch is the first of them."""

    def git(*arguments):
        who = ("-c", "user.name=A", "-c", "user.email=a@example.org")
        subprocess.run(["git", *who, *arguments], cwd=tmp_path, check=True, capture_output=True)

    git("init", "-q")
    for name in ("first", "second"):
        (tmp_path / name).write_text(name)
        git("add", name)
        git("commit", "-q", "-m", name)
    git("update-ref", "refs/remotes/origin/main", "HEAD~1")
    return tmp_path, git


def test_commits_changes_and_new_files_since_the_common_branch_count(repository):
    root, _ = repository
    (root / "first").write_text("changed")
    (root / "third").write_text("new")

    assert touched(root) == ["first", "second", "third"]


def test_after_the_push_the_last_commit_counts(repository):
    root, git = repository
    git("update-ref", "refs/remotes/origin/main", "HEAD")

    assert touched(root) == ["second"]


def test_without_a_remote_only_what_is_not_committed_counts(repository):
    root, git = repository
    git("update-ref", "-d", "refs/remotes/origin/main")
    (root / "first").write_text("changed")

    assert touched(root) == ["first"]
