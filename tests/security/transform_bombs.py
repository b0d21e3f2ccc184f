"""Bags whose transforms and robot descriptions ask for far more work than a robot needs."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tests.builders import storage_file
from tests.robot_bags import TF2, RobotBag

_MANY = 5000


def _bag(path: Path, write: Callable[[RobotBag], None]) -> None:
    folder = path.with_suffix("")
    with RobotBag(folder, "mcap") as bag:
        write(bag)
    storage_file(folder).rename(path)
    shutil.rmtree(folder)


def tf_chain(path: Path) -> None:
    """Ten thousand frames in a row, and as many transforms that close cycles over it."""

    def write(bag: RobotBag) -> None:
        for first in range(0, 10_000, _MANY):
            rows = range(first, first + _MANY)
            bag.tf(*((f"f{k}", f"f{k + 1}", (0, 0, 0, 0, 0, 0, 1)) for k in rows))
            bag.tf(*((f"f{k}", f"f{9999 - k}", (1, 0, 0, 0, 0, 0, 1)) for k in rows))

    _bag(path, write)


def tf_flood(path: Path) -> None:
    """A hundred thousand statements of a few transforms, each another one."""

    def write(bag: RobotBag) -> None:
        places = np.random.default_rng(1).uniform(-1.0, 1.0, (_MANY, 3))
        rows = [(f"f{k % 7}", "g", (*p, 0, 0, 0, 1)) for k, p in enumerate(places)]
        message = bag.stated(rows)
        for k in range(24):
            bag.write("/tf_static", TF2, k, message)

    _bag(path, write)


def urdf_entities(path: Path) -> None:
    """A description whose entities grow to gigabytes."""
    names = "".join(f'<!ENTITY e{k} "{f"&e{k - 1};" * 20}">' for k in range(1, 12))
    text = f'<!DOCTYPE r [<!ENTITY e0 "x">{names}]><robot>&e11;</robot>'
    _bag(path, lambda bag: bag.description(text))


def urdf_deep(path: Path) -> None:
    """Elements nested a hundred thousand deep."""
    _bag(path, lambda bag: bag.description("<robot>" + "<a>" * 100_000))


def urdf_joints(path: Path) -> None:
    """More joints than any robot has, in four megabytes."""
    joint = '<joint type="fixed"><parent link="a"/><child link="b"/></joint>'
    text = f"<robot>{joint * 60_000}</robot>"
    _bag(path, lambda bag: bag.description(text))
