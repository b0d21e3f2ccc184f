"""Types of messages that are decoded with definitions from here.

Messages of packets whose definition in the bag is another one are read by that, field by field.

A definition that is one of those known here is read by the known one, which is faster.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import cache
from types import MappingProxyType
from typing import Any

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.recording.formats.message_schema import (
    MessageSchema,
    SchemaField,
    parse_schema,
    read_message,
)
from recon4.recording.packets.messages import DEFINITIONS, PACKET_MESSAGES

TRANSFORMS = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
"""Of ROS 2 and late ROS 1, of early ROS 1."""
_DEFINITIONS = {
    **dict.fromkeys(TRANSFORMS, "geometry_msgs/TransformStamped[] transforms\n"),
}


@cache
def typestore(*, ros1: bool) -> Any:
    """The types of ROS 1 or ROS 2 and those of packets, as `rosbags` decodes them."""
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    for name, text in {**DEFINITIONS, **_DEFINITIONS, **_versions()}.items():
        if name not in store.types:
            store.register(get_types_from_msg(text, name))
    return store


class MessageTypes:
    """Decodes the messages of a bag, and keeps which version of a type it holds."""

    def __init__(self, definitions: Mapping[str, str] = MappingProxyType({})) -> None:
        """Begin with the usual versions.

        Args:
            definitions: Type of the messages of a bag -> its definition in the bag.

        Raises:
            CorruptFile: If that of a message of packets lacks what is needed.
        """
        self._found: dict[str, str] = {}
        self._own = own_schemas(definitions)

    def decode(self, kind: str, data: bytes, *, ros1: bool) -> Any:
        """A message as an object with its fields, by the definition in the bag if it is another one
        than those known, else by the first version that takes all its bytes.

        Raises:
            Exception: Of many kinds, from generated code, if it fits none.
        """
        if kind in self._own:
            return read_message(self._own[kind], data, ros1=ros1)
        store = typestore(ros1=ros1)
        decode = store.deserialize_ros1 if ros1 else store.deserialize_cdr
        last, *others = sorted(_names_of(kind), key=self._found.get(kind, kind).__eq__)
        for name in reversed(others):
            with suppress(Exception):
                found = decode(data, name)
                self._found[kind] = name
                return found
        found = decode(data, last)
        self._found[kind] = last
        return found


def _names_of(kind: str) -> list[str]:
    """The names in `typestore` of all versions of a type of messages, the usual one last."""
    row = PACKET_MESSAGES.get(kind)
    count = len(row.versions) if row is not None else 0
    return [*(_version(kind, kind, number) for number in range(count, 0, -1)), kind]


def _version(kind: str, of: str, number: int) -> str:
    """A name for a version of a type that a kind of messages consists of."""
    return f"{of}{kind.rpartition('/')[2]}{number}" if of != kind else f"{kind}Version{number}"


def _versions() -> dict[str, str]:
    """Further versions of all messages of packets under names of their own."""
    found: dict[str, str] = {}
    for kind, row in PACKET_MESSAGES.items():
        for number, texts in enumerate(row.versions, start=1):
            names = {of: _version(kind, of, number) for of in texts}
            found |= {names[of]: _renamed(text, names) for of, text in texts.items()}
    return found


def _renamed(text: str, names: Mapping[str, str]) -> str:
    for of, name in names.items():
        text = text.replace(of.replace("/msg/", "/"), name.replace("/msg/", "/"))
    return text


Shape = tuple[object, ...]
"""Kinds and lengths of all fields of a message, those of inner types in turn."""


def own_schemas(definitions: Mapping[str, str]) -> dict[str, MessageSchema]:
    """The types of messages with packets that are not as any known driver has them.

    Args:
        definitions: Type of the messages -> its definition in the bag; empty = there is none.

    Returns:
        Type -> its fields; a definition that makes no sense is none.

    Raises:
        CorruptFile: If a definition lacks a field that the packets need.
    """
    found = {}
    for kind, text in definitions.items():
        if kind not in PACKET_MESSAGES or not text:
            continue
        try:
            schema = parse_schema(kind, text)
        except CorruptFile:
            continue
        known = _known(kind)
        if _shape(schema.fields, schema.types) not in [_shape(k.fields, k.types) for k in known]:
            _require_fields(kind, schema, known)
            found[kind] = schema
    return found


def _known(kind: str) -> list[MessageSchema]:
    """All versions of a type that are known here."""
    row = PACKET_MESSAGES[kind]
    found = []
    for texts in (row.definitions, *row.versions):
        others = [
            f"{'=' * 80}\nMSG: {name}\n{text}" for name, text in texts.items() if name != kind
        ]
        found.append(parse_schema(kind, "\n".join([texts[kind], *others])))
    return found


def _shape(fields: Sequence[SchemaField], types: Mapping[str, tuple[SchemaField, ...]]) -> Shape:
    return tuple(
        (
            _shape(types[field.kind], types) if field.kind in types else field.kind,
            field.is_list,
            field.count,
        )
        for field in fields
    )


def _require_fields(kind: str, schema: MessageSchema, known: Sequence[MessageSchema]) -> None:
    """Check that what all known versions have is there, by its name."""
    needed = set.intersection(*(_names(one.fields, one.types) for one in known))
    missing = sorted(needed - _names(schema.fields, schema.types) - {"header"})
    if missing:
        raise CorruptFile(
            CodedText(
                "typestore-lacks", kind=kind.replace("/msg/", "/"), missing=", ".join(missing)
            )
        )


def _names(
    fields: Sequence[SchemaField], types: Mapping[str, tuple[SchemaField, ...]], before: str = ""
) -> set[str]:
    """Names of all fields, those of inner types as ``packets.data``; a header has no parts."""
    found = {f"{before}{field.name}" for field in fields}
    for field in fields:
        if field.kind in types and field.name != "header":
            found |= _names(types[field.kind], types, f"{before}{field.name}.")
    return found
