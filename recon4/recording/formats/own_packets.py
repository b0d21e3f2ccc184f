"""Messages of packets by the definition that a bag brings: forks of drivers add and move fields.

A definition that is one of those known here is read by the known one, which is faster.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from recon4.errors import CorruptFile
from recon4.recording.formats.message_schema import MessageSchema, SchemaField, parse_schema
from recon4.recording.packets.messages import PACKET_MESSAGES

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
            f"the bag defines {kind.replace('/msg/', '/')} without {', '.join(missing)}, by which "
            "its packets are read: play it back through its driver, and record the PointCloud2 "
            "that it publishes"
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
