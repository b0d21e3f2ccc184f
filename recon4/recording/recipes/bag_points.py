"""Recipes of the topics of a bag: declared ones, compared with its points, and proposed ones."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from recon4.errors import ConfigError, CorruptFile
from recon4.locales.coded import CodedText, at
from recon4.model.derived_kinds import DerivedKind
from recon4.model.point_recipes import PointRecipe
from recon4.model.rig import Rig
from recon4.recording.bags.lidar_choice import CloudTopic
from recon4.recording.bags.topic_contents import read_contents
from recon4.recording.formats.bags import CLOUD, Bag, BagTopic
from recon4.recording.formats.cloud_tables import cloud_lists
from recon4.recording.recipes.apply import Columns, chosen_list
from recon4.recording.recipes.check import RecipeSample, require_fitting
from recon4.recording.recipes.propose import (
    Proposal,
    proposal_values,
    propose,
    say_doubts,
    say_overlooked,
)
from recon4.recording.recipes.refuse import with_doubts
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream


@dataclass(frozen=True, slots=True)
class UnknownPoints:
    """A topic of points whose columns have no common names."""

    topic: BagTopic
    frame: str
    points: int
    """Usual number of points of a message."""
    proposal: Proposal

    @property
    def stream(self) -> Stream:
        """The LiDAR that it would be."""
        name = self.topic.name
        return Stream(
            name, "generic", topic=name, frame=self.frame, points=self.points,
            fields=self.proposal.recipe,
        )  # fmt: skip


def declared_recipes(
    bag: Bag, rig: Rig | None, fields: PointRecipe | None, *, report: ImportReport
) -> dict[str, PointRecipe]:
    """The recipes for topics of an open bag that a rig or a command declares.

    Args:
        bag: An open bag.
        rig: With recipes of its sensors.
        fields: A recipe for the only topic that has its columns.
        report: Receives what is suspicious.

    Raises:
        ConfigError: If a recipe does not fit the points, or it is not clear which ones it is for.
    """
    found: dict[str, PointRecipe] = {}
    for sensor in rig.sensors if rig is not None else ():
        if sensor.fields and not sensor.topic:
            raise ConfigError(CodedText("recipe-no-topic", sensor=sensor.name))
        if sensor.fields:
            found[sensor.topic] = sensor.fields
    samples = bag_samples(bag, [t for t in bag.topics if _may_be_points(t)])
    if fields is not None:
        found[_topic_with(fields, samples)] = fields
    for topic, recipe in found.items():
        if topic in samples:
            require_fitting(recipe, samples[topic], report)
    return found


def _may_be_points(topic: BagTopic) -> bool:
    return bool(topic.messages) and (topic.type == CLOUD or bool(topic.columns) or topic.is_points)


def bag_samples(bag: Bag, topics: Sequence[BagTopic]) -> dict[str, RecipeSample]:
    """The first messages of topics of points, as they were sent."""
    found = {}
    for name, contents in read_contents(bag, topics, as_sent=True).items():
        lists = []
        for message in contents.messages:
            try:
                lists.append(cloud_lists(message))
            except CorruptFile:  # counted when it is read
                continue
        period_s = 1.0 / contents.rate_hz if contents.rate_hz > 0.0 else float("nan")
        found[name] = RecipeSample(name, lists, period_s, contents.frame)
    return found


def _topic_with(recipe: PointRecipe, samples: Mapping[str, RecipeSample]) -> str:
    """The only topic that has the columns of a recipe.

    Raises:
        ConfigError: If there is none, or several.
    """
    having, why = [], []
    for name, sample in samples.items():
        try:
            chosen_list(recipe.columns, sample.largest)
            having.append(name)
        except CorruptFile as error:
            why.append(f"{name}: {error}")
    if len(having) == 1:
        return having[0]
    if having:
        raise ConfigError(
            CodedText("recipe-several-topics", recipe=recipe.text(), having=", ".join(having))
        )
    raise ConfigError(at(f"fields {recipe.text()}", "; ".join(why) or CodedText("bag-no-points")))


def unknown_points(bag: Bag, known: Iterable[CloudTopic], *, only: str = "") -> list[UnknownPoints]:
    """Topics of points whose columns are not known, each with a proposal.

    Args:
        bag: An open bag.
        known: Its clouds; those with x, y and z are known.
        only: The only topic that is asked for; empty = all.
    """
    without = [one.topic for one in known if not one.has_places]
    own = [t for t in bag.topics if t.columns and not t.is_points and t.messages]
    asked = [t for t in (*without, *own) if only in ("", t.name)]
    found = []
    for name, sample in bag_samples(bag, asked).items():
        topic = next(t for t in bag.topics if t.name == name)
        proposal = with_doubts(propose(name, sample.largest, sample.period_s), sample)
        if topic.type == CLOUD or proposal.is_of_lidar or proposal.recipe is None:
            found.append(UnknownPoints(topic, sample.frame, _count(sample.largest), proposal))
    return found


def _count(lists: Mapping[str, Columns]) -> int:
    return int(np.max([len(c) for one in lists.values() for c in one.values()], initial=0))


def say_columns(
    bag: Bag,
    clouds: Iterable[CloudTopic],
    unknown: Iterable[UnknownPoints],
    *,
    report: ImportReport,
) -> None:
    """State columns that are not read and look like times, rings, intensities or places.

    Args:
        bag: An open bag.
        clouds: Those that are read.
        unknown: Those that are not.
        report: Receives them, each with a recipe.
    """
    for one in unknown:
        values = proposal_values(one.proposal)
        report.derive(DerivedKind.COLUMNS_UNKNOWN, topic=one.topic.name, **values)
        say_doubts(one.topic.name, one.proposal, report)
    lacking = [one.topic for one in clouds if one.detail < one.FULL_DETAIL and one.has_places]
    for name, sample in bag_samples(bag, [t for t in lacking if t.name not in bag.recipes]).items():
        proposal = with_doubts(propose(name, sample.largest, sample.period_s), sample)
        for columns in sample.largest.values():
            say_overlooked(name, proposal, columns, report=report)
