"""Topics that several LiDARs share: some drivers publish what all their sensors send in one.

Such a topic is read as several, ``TOPIC#SOURCE``. The source of a cloud is its frame and, where the
message has one, the number of the LiDAR; that of a packet its frame and what the packet says of its
sensor. A message is taken apart once, and what is decoded for that stays with it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import Field, dataclass, replace
from typing import Any, ClassVar, Protocol, TypeVar

from recon4.recording.tuning import SHARED_TOPICS

SOURCE_MARK = "#"
_STRAY = "?"


@dataclass(frozen=True, slots=True, order=True)
class TopicSource:
    """Which sensor a part of a message is of."""

    frame: str
    """Of the header; empty = not said."""
    sender: str = ""
    """Number of the LiDAR, or what its packets say of it; empty = nothing."""

    def __str__(self) -> str:
        return ".".join(filter(None, (self.frame, self.sender)))


class Routed(Protocol):
    """A message of a topic, a frozen record."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    @property
    def topic(self) -> str:
        """Its name."""
        ...


Message = TypeVar("Message", bound=Routed)


def frame_named(content: Any) -> str:
    """The frame in the header of a decoded message; empty = not said."""
    return str(getattr(getattr(content, "header", None), "frame_id", "")).strip("/")[:80]


def source_of(content: Any) -> TopicSource:
    """Which sensor a decoded message of points is of, as ``livox_frame.2``."""
    return TopicSource(frame_named(content), str(getattr(content, "lidar_id", "")))


def sources_of(parts: Iterable[TopicSource]) -> tuple[TopicSource, ...]:
    """The sensors of the first parts of messages of a topic, if they are several; empty = one.

    Parts that do not tell their sender are of those of the same frame that do.
    """
    seen = Counter(parts)
    fewest = max(SHARED_TOPICS.often, SHARED_TOPICS.rare * seen.total())
    found = sorted(source for source, number in seen.items() if number >= fewest)
    named = {source.frame for source in found if source.sender}
    found = [source for source in found if source.sender or source.frame not in named]
    return tuple(found) if len(found) > 1 else ()


@dataclass(frozen=True, slots=True)
class SharedTopics:
    """The topics of a bag that several sensors share."""

    sources: Mapping[str, Sequence[TopicSource]]
    """Topic -> its sources."""

    @property
    def strays(self) -> frozenset[str]:
        """Names of what is in shared topics and of none of their sources."""
        return frozenset(f"{topic}{SOURCE_MARK}{_STRAY}" for topic in self.sources)

    def names(self, topic: str) -> list[str]:
        """What a topic is read as."""
        return [f"{topic}{SOURCE_MARK}{one}" for one in self.sources.get(topic, ())] or [topic]

    def stored(self, topics: Iterable[str]) -> set[str]:
        """The topics in the file that have the messages of some topics."""
        by_name = {name: topic for topic in self.sources for name in self.names(topic)}
        by_name |= {name: name.removesuffix(SOURCE_MARK + _STRAY) for name in self.strays}
        return {by_name.get(name, name) for name in topics}

    def routed(
        self,
        messages: Iterable[Message],
        wanted: Iterable[str],
        parts: Callable[[Message], Mapping[TopicSource, Message]],
    ) -> Iterator[Message]:
        """The messages of some topics, parts of shared ones under the name with their source.

        Args:
            messages: Those of the file.
            wanted: Topics, shared ones by the names of their sources.
            parts: Takes a message of a shared topic apart.
        """
        names = set(wanted)
        for message in messages:
            if message.topic not in self.sources:
                yield message
                continue
            for source, part in parts(message).items():
                name = f"{message.topic}{SOURCE_MARK}{self._owner(message.topic, source)}"
                if name in names:
                    yield replace(part, topic=name)

    def _owner(self, topic: str, source: TopicSource) -> TopicSource | str:
        """Whose a part is: the only sensor of its frame, if it does not tell its sender."""
        sources = self.sources[topic]
        if source in sources:
            return source
        alike = [one for one in sources if one.frame == source.frame and not source.sender]
        return alike[0] if len(alike) == 1 else _STRAY
