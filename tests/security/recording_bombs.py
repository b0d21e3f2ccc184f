"""Hostile recordings: small files that demand unbounded memory or time. Deterministic."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tests.security.bag1_bombs import (
    bag1_bz2,
    bag1_bz2_honest,
    bag1_connections,
    bag1_definition,
    bag1_directory,
    bag1_fields,
    bag1_lz4,
    bag1_many_chunks,
    bag1_overlap,
    bag1_sparse,
    bag1_sparse_chunk,
    bag1_tiny_messages,
)
from tests.security.capture_bombs import (
    pcap_many_senders,
    pcap_sparse,
    pcap_tiny_datagrams,
    pcapng_interfaces,
    pcapng_long_block,
    pcapng_short_block,
    pcapng_sparse,
)
from tests.security.chunk_bombs import db3_many_files, db3_many_messages
from tests.security.database_bombs import (
    db3_blob,
    db3_cycle,
    db3_generated,
    db3_sparse,
    db3_topics_repeated,
    db3_topics_view,
    db3_view,
    db3_virtual,
    metadata_aliases,
    metadata_brackets,
    metadata_file_zstd,
    metadata_indents,
    metadata_sparse,
)
from tests.security.mcap_bombs import (
    mcap_lz4,
    mcap_schema,
    mcap_sparse,
    mcap_sparse_record,
    mcap_summary_repeats,
    mcap_tiny_messages,
    mcap_zstd,
    mcap_zstd_honest,
)
from tests.security.transform_bombs import (
    tf_chain,
    tf_flood,
    urdf_deep,
    urdf_entities,
    urdf_joints,
)

BOMBS: dict[str, tuple[Callable[[Path], None], ...]] = {
    "bag1": (
        bag1_bz2,
        bag1_bz2_honest,
        bag1_lz4,
        bag1_many_chunks,
        bag1_directory,
        bag1_connections,
        bag1_sparse,
        bag1_sparse_chunk,
        bag1_definition,
        bag1_tiny_messages,
        bag1_fields,
        bag1_overlap,
    ),
    "mcap": (
        mcap_zstd,
        mcap_zstd_honest,
        mcap_lz4,
        mcap_summary_repeats,
        mcap_schema,
        mcap_tiny_messages,
        mcap_sparse_record,
        mcap_sparse,
        tf_chain,
        tf_flood,
        urdf_deep,
        urdf_entities,
        urdf_joints,
    ),
    "db3": (
        db3_view,
        db3_topics_view,
        db3_generated,
        db3_virtual,
        db3_blob,
        db3_topics_repeated,
        db3_sparse,
        db3_cycle,
    ),
    "metadata": (
        metadata_brackets,
        metadata_aliases,
        metadata_indents,
        metadata_sparse,
        metadata_file_zstd,
        db3_many_messages,
        db3_many_files,
    ),
    "pcap": (pcap_sparse, pcap_tiny_datagrams, pcap_many_senders),
    "pcapng": (pcapng_short_block, pcapng_long_block, pcapng_interfaces, pcapng_sparse),
}
"""Kind of file to what builds its bombs."""
SUFFIXES = {
    "bag1": ".bag",
    "mcap": ".mcap",
    "db3": ".db3",
    "metadata": "",
    "pcap": ".pcap",
    "pcapng": ".pcapng",
}
LINEAR = {bag1_tiny_messages, mcap_tiny_messages, bag1_many_chunks}
"""These are work that grows with the file: bounded in memory; the chunks are refused only when as
much was decompressed as a recording may hold, for which a slow processor needs ten seconds."""
LONG = LINEAR | {bag1_directory, mcap_summary_repeats, mcap_zstd_honest, tf_flood}
"""These take seconds to build and to read."""
