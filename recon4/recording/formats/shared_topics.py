"""Topics that several LiDARs share: some drivers publish the clouds of all their sensors in one.

Such a topic is read as several, ``TOPIC#SOURCE``. The source of a message is its frame and, where
the message has one, the number of the LiDAR.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import Field, dataclass, replace
from typing import Any, ClassVar, Protocol, TypeVar

from recon4.recording.tuning import SHARED_TOPICS

SOURCE_MARK = "#"


class Routed(Protocol):
    """A message of a topic, a frozen record."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    @property
    def topic(self) -> str:
        """Its name."""
        ...


Message = TypeVar("Message", bound=Routed)


def source_of(content: Any) -> str:
    """Which sensor a decoded message of points is of, as ``livox_frame.2``; empty = not said."""
    frame = str(getattr(getattr(content, "header", None), "frame_id", "")).strip("/")
    number = getattr(content, "lidar_id", "")
    return f"{frame[:80]}.{number}" if number != "" else frame[:80]


def sources_of(contents: Iterable[Any]) -> tuple[str, ...]:
    """The sources of the first messages of a topic, if they are several; empty = one."""
    seen = Counter(source_of(content) for content in contents)
    found = tuple(sorted(name for name, number in seen.items() if number >= SHARED_TOPICS.often))
    return found if len(found) > 1 else ()


@dataclass(frozen=True, slots=True)
class SharedTopics:
    """The topics of a bag that several sensors share."""

    sources: Mapping[str, Sequence[str]]
    """Topic -> its sources."""

    def names(self, topic: str) -> list[str]:
        """What a topic is read as."""
        return [f"{topic}{SOURCE_MARK}{one}" for one in self.sources.get(topic, ())] or [topic]

    def stored(self, topics: Iterable[str]) -> set[str]:
        """The topics in the file that have the messages of some topics."""
        by_name = {name: topic for topic in self.sources for name in self.names(topic)}
        return {by_name.get(name, name) for name in topics}

    def routed(
        self,
        messages: Iterable[Message],
        wanted: Iterable[str],
        decode: Callable[[Message], Any | None],
    ) -> Iterator[Message]:
        """The messages of some topics, those of shared ones under the name with their source."""
        names = set(wanted)
        for message in messages:
            if message.topic not in self.sources:
                yield message
                continue
            content = decode(message)
            name = f"{message.topic}{SOURCE_MARK}{source_of(content)}"
            if content is not None and name in names:
                yield replace(message, topic=name)
