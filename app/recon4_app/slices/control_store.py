"""Surveyed points of projects on disk, with their positions in the latest map."""

from __future__ import annotations

import threading

from recon4.errors import StoreError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText, unreadable
from recon4.model.site_control import SiteControl
from recon4.slices.stored_picks import add_seen_picks, carried_picks
from recon4.store.atomic import write_json
from recon4.store.seal import changing, check_sealed
from recon4.untrusted.bounded import read_text_limited
from recon4_app.errors import Conflict
from recon4_app.projects.store import ProjectStore
from recon4_app.slices.model import ControlState, Xyz
from recon4_app.slices.tuning import SLICE_STORE

CONTROL = "slices/control.json"
_EVERY: list[Xyz] = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]


class ControlStore:
    """Control and check points of all projects."""

    def __init__(self, projects: ProjectStore) -> None:
        self._projects = projects
        self._keeping = threading.Lock()

    def read(self, project_id: str) -> ControlState:
        """The points; none at first.

        Raises:
            StoreError: If a file is damaged.
        """
        return self._carried(project_id, self._stored(project_id))

    def keep(self, project_id: str, state: ControlState) -> ControlState:
        """Store control points on disk; new positions are those of the latest map.

        Raises:
            Conflict: If another user stored control points since this state was read.
        """
        key = self._projects.map_artifact(project_id).name
        with self._keeping:
            stored = self._stored(project_id)
            if state.version not in (None, stored.version):
                raise Conflict(CodedText("control-points-changed"))
            shown = self._carried(project_id, stored)
            kept = _joined(stored, shown, state, key=key)
            root = self._projects.folder(project_id)
            (root / "slices").mkdir(exist_ok=True)
            with changing(root, CONTROL):
                write_json(root / CONTROL, kept.model_dump(mode="json"))
        return self._carried(project_id, kept)

    def keep_seen(self, project_id: str, control: SiteControl) -> None:
        """Keep who saw the picks that the map is put on: its next versions have them, too."""
        stored = self._stored(project_id)
        seen = {one.id: one for one in control.targets}
        add_seen_picks(self._projects.folder(project_id), seen, stored.picks)

    def _stored(self, project_id: str) -> ControlState:
        """The points as they are on disk, each pick in its own map."""
        root = self._projects.folder(project_id)
        check_sealed(root, CONTROL)  # an acceptance sheet is made of it
        path = root / CONTROL
        if not path.exists():
            return ControlState(version=0)
        try:
            text = read_text_limited(path, SLICE_STORE.max_control_bytes, failure=StoreError)
            state = ControlState.model_validate_json(text)
        except (StoreError, ValueError) as error:
            raise StoreError(unreadable(path.name, error)) from error
        return state.model_copy(update={"version": state.version or 0})

    def _carried(self, project_id: str, state: ControlState) -> ControlState:
        """The same, with picks of an earlier map where the latest one has them."""
        made, level = (self._projects.artifact(project_id, stage) for stage in ("map", "level"))
        if made is None or level is None:
            return state
        earlier = {n: at for n, at in state.picks.items() if state.found_in.get(n) != made.name}
        here = carried_picks(self._projects.folder(project_id), earlier, level)
        return state.model_copy(
            update={
                "picks": state.picks | {n: _xyz(one.xyz_m) for n, one in here.items()},
                "along": state.along | {n: [*map(_xyz, one.along)] for n, one in here.items()},
                "found_in": state.found_in | dict.fromkeys(here, made.name),
            }
        )


def _joined(
    stored: ControlState, shown: ControlState, state: ControlState, *, key: str
) -> ControlState:
    """What is stored next: a pick that was not changed stays in the map it was picked in.

    Args:
        stored: What is on disk.
        shown: The same, with picks in the latest map.
        state: What a person made of it.
        key: Of the latest map.
    """
    along: dict[str, list[Xyz]] = {}
    picks, found_in = dict(state.picks), dict.fromkeys(state.picks, key)
    for name, at in state.picks.items():
        directions = state.along.get(name)
        if shown.picks.get(name) != at:
            along[name] = directions or _EVERY
        elif directions in (None, shown.along.get(name)):
            picks[name], found_in[name] = stored.picks[name], stored.found_in.get(name, "")
            if name in stored.along:  # else of an earlier version: it stays without
                along[name] = stored.along[name]
        elif directions:
            along[name], found_in[name] = directions, shown.found_in.get(name, "")
    changes = {"picks": picks, "along": along, "found_in": found_in}
    return state.model_copy(update=changes | {"version": (stored.version or 0) + 1})


def _xyz(values: Array) -> Xyz:
    x, y, z = values.tolist()
    return x, y, z
