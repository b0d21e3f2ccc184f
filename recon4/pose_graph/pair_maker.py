"""Registers pairs of a search on a worker."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path

from recon4.errors import StoreError
from recon4.pose_graph.pair_files import (
    VIEWS,
    SearchInputs,
    load_part,
    part_path,
    save_tried,
    tried_path,
)
from recon4.pose_graph.pairs import PairRegistrar
from recon4.pose_graph.search import OdometryTrack, SearchMeans, make_registrar
from recon4.pose_graph.tuning import graph_tuning
from recon4.registration.submap import TrackedFrames, node_rows


@dataclass(frozen=True, slots=True, eq=False)
class PairMaker:
    """Registers the pairs of one folder."""

    folder: Path
    registrar: PairRegistrar

    @staticmethod
    def open(folder: Path) -> PairMaker:
        """Read what all rounds have in common.

        Raises:
            StoreError: If a file is missing or damaged.
        """
        given = SearchInputs.load(folder)
        frames = given.folders.open()
        track = OdometryTrack.load(Path(given.folders.odometry))
        stride = graph_tuning(given.settings.graph).node_stride
        registrar = make_registrar(
            TrackedFrames(frames, track.trajectory, track.lost),
            node_rows(frames.t_mid_ns, stride, track.lost),
            settings=given.settings,
            means=SearchMeans(Path(tempfile.gettempdir()), views=folder / VIEWS),
        )
        return PairMaker(folder, registrar)

    def make(self, numbers: tuple[int, ...]) -> None:
        """Register a part of a round and leave what it gave in the folder, whole or not at all.

        Args:
            numbers: Of the round and of the part.

        Raises:
            StoreError: If there is no such part, views are missing, or it cannot be written.
        """
        number, part = numbers
        groups, pairs = load_part(part_path(self.folder, number, part))
        for node in sorted({node for pair in pairs.values() for node in (pair.i, pair.j)}):
            if not self.registrar.views.has(node):
                raise StoreError(f"{VIEWS}: node {node} is missing or damaged")
        edges = self.registrar.try_groups(groups, pairs)
        save_tried(tried_path(self.folder, number, part), pairs, edges)
