"""Files of tests that wait stand among those that compute."""

from pathlib import Path

from tests.file_order import BETWEEN, mixed


def files(folder, count):
    return [Path("tests", folder, f"test_{k}.py") for k in range(count)]


def order(*folders):
    paths = [path for of_folder in folders for path in of_folder]
    tests = [(path, name) for path in paths for name in "ab"]
    found = mixed(tests, lambda test: test[0])
    assert sorted(found) == sorted(tests), "each once"
    assert found[::2] == [(path, "a") for path, _ in found[1::2]], "the tests of a file in a row"
    return [path.parts[1] for path, _ in found[::2]]


def test_each_file_that_waits_is_followed_by_some_that_compute_and_long_walks_are_first():
    found = order(
        files("scenario", 2), files("security", 1), files("service", 1), files("unit", 20)
    )

    group = ["unit"] * BETWEEN
    assert found[: 4 + 2 * BETWEEN] == ["scenario"] * 2 + ["security", *group, "service", *group]
    assert set(found[4 + 2 * BETWEEN :]) == {"unit"}


def test_without_both_kinds_the_order_stays():
    assert order(files("service", 7)) == ["service"] * 7
    assert order(files("unit", 7)) == ["unit"] * 7
    assert order(files("e2e", 1), files("service", 3), files("unit", 1))[-1] == "service"
