"""Decisions about pairs, and the ones in force: the fold over the journal.

A decision names its pair by the ids of two multiframes, so it stays valid after another search.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, replace
from enum import StrEnum
from typing import Any, NotRequired, TypedDict

import msgspec
import numpy as np

from recon4.errors import ConfigError, StoreError
from recon4.locales.coded import CodedText
from recon4.model.class_corrections import ClassCorrection
from recon4.model.plain import to_plain
from recon4.model.pose_graph import AUTOMATIC
from recon4.model.site_control import SiteControl
from recon4.review.row_contents import ApprovalFacts, Measurement, SeenFinding, measurement_in
from recon4.store.hashing import hash_json
from recon4.untrusted.typed import as_type

Pair = tuple[int, int]
"""Ids of two multiframes, the earlier one first."""


class DecisionKind(StrEnum):
    """Kind of a row of the journal."""

    ACCEPT = "accept"
    """The pair is accepted; overrides the automatic verdict."""
    REJECT = "reject"
    """The pair is rejected."""
    RESTORE = "restore"
    """The automatic verdict applies again."""
    REPLACE = "replace"
    """The pair is accepted with another measurement."""
    ADD = "add"
    """A pair that was never registered automatically is accepted."""
    UNDO = "undo"
    """Undo the last decision that is not undone."""
    REDO = "redo"
    """Redo the decision that was undone last."""
    APPROVE = "approve"
    """A finished map was approved; changes no decision."""
    ACKNOWLEDGE = "acknowledge"
    """A finding of a map was acknowledged; changes no decision."""
    CONTROL = "control"
    """Control points place the map; those of an earlier row no longer do. None of them: the map is
    placed as without."""
    CLASSIFY = "classify"
    """Points in a volume get another class."""
    WITHDRAW = "withdraw"
    """Such a correction no longer applies, whatever was decided since."""
    ASSIGN = "assign"
    """A pair is assigned to a person, or to nobody; changes no decision."""
    COMMENT = "comment"
    """A remark about a pair; changes no decision."""
    SKIP = "skip"
    """A pair is left for later; changes no decision."""
    SECOND = "second"
    """A second opinion on a pair is asked for: two people have to agree before an approval."""
    WAIVE = "waive"
    """The second opinion is not asked for any more."""


MEASURED = (DecisionKind.REPLACE, DecisionKind.ADD)
"""Kinds with a measurement of their own."""
ABOUT_MAPS = (DecisionKind.APPROVE, DecisionKind.ACKNOWLEDGE)
"""Kinds about a finished map."""
ABOUT_WORK = (
    DecisionKind.ASSIGN,
    DecisionKind.COMMENT,
    DecisionKind.SKIP,
    DecisionKind.SECOND,
    DecisionKind.WAIVE,
)
"""Kinds by which people share the work on a pair."""
CHANGE_NOTHING = (*ABOUT_MAPS, *ABOUT_WORK)
"""Kinds that change no decision, so they cannot be undone."""
ABOUT_CLASSES = (DecisionKind.CLASSIFY, DecisionKind.WITHDRAW)
VERDICTS = (DecisionKind.ACCEPT, DecisionKind.REJECT, DecisionKind.RESTORE, *MEASURED)
ABOUT_PAIRS = (*VERDICTS, *ABOUT_WORK)


class DecisionBody(TypedDict):
    """Fields that the journal stores beside its columns, as JSON values."""

    T_i_j: list[float]
    measurement: Mapping[str, Any] | None
    """Fields of `Measurement`; null = not a number."""
    facts: Mapping[str, object] | None
    """Fields of `ApprovalFacts`."""
    finding: NotRequired[Mapping[str, object]]
    """Fields of `SeenFinding`; only there in an acknowledgment."""
    control: NotRequired[Mapping[str, object]]
    """Fields of `SiteControl`; only there in a row about control points."""
    correction: NotRequired[Mapping[str, object]]
    """Fields of `ClassCorrection`; only there in a row that gives points another class."""
    withdraws: NotRequired[str]
    """Id of a correction; only there in a row that withdraws one."""
    assignee: NotRequired[str]
    """Name of a person, empty = nobody; only there in a row that assigns a pair."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Decision:
    """One row of the journal before it is written."""

    kind: DecisionKind
    who: str
    why: str = ""
    pair: Pair | None = None
    """Of decisions about a pair."""
    T_i_j: tuple[float, ...] = ()
    """The pose the reviewer saw, x y z qx qy qz qw; empty where there is no edge."""
    measurement: Measurement | None = None
    """Of `REPLACE` and `ADD`."""
    facts: ApprovalFacts | None = None
    """Of `APPROVE`."""
    finding: SeenFinding | None = None
    """Of `ACKNOWLEDGE`."""
    control: SiteControl | None = None
    """Of `CONTROL`."""
    correction: ClassCorrection | None = None
    """Of `CLASSIFY`."""
    withdraws: str = ""
    """Id of the correction that is withdrawn; of `WITHDRAW`."""
    assignee: str = ""
    """To whom the pair is assigned; empty = nobody; of `ASSIGN`."""
    time: str = ""
    """When it was written, UTC, ISO 8601; empty before."""

    def __post_init__(self) -> None:
        if self.who in ("", AUTOMATIC):
            raise ConfigError(CodedText("decision-user", who=self.who))
        if (self.pair is None) == (self.kind in ABOUT_PAIRS):
            code = "decision-names-pair" if self.pair is None else "decision-names-no-pair"
            raise ConfigError(CodedText(code, kind=self.kind))
        if self.pair is not None and not 0 <= self.pair[0] < self.pair[1]:
            raise ConfigError(CodedText("decision-pair", pair=str(self.pair)))
        if len(self.T_i_j) not in (0, 7) or not np.isfinite(self.T_i_j).all():
            raise ConfigError(CodedText("decision-pose"))
        if (self.measurement is None) == (self.kind in MEASURED):
            raise ConfigError(CodedText("decision-measurement", kind=str(self.kind)))
        acknowledges = self.kind is DecisionKind.ACKNOWLEDGE
        if acknowledges != (self.finding is not None) or (acknowledges and not self.why.strip()):
            raise ConfigError(CodedText("decision-acknowledgment"))
        if (self.kind is DecisionKind.CONTROL) != (self.control is not None):
            raise ConfigError(CodedText("decision-control", kind=str(self.kind)))
        self._check_correction()

    def _check_correction(self) -> None:
        if (self.kind is DecisionKind.CLASSIFY) != (self.correction is not None):
            raise ConfigError(CodedText("decision-correction", kind=str(self.kind)))
        if (self.kind is DecisionKind.WITHDRAW) != bool(self.withdraws):
            raise ConfigError(CodedText("decision-withdrawn", kind=str(self.kind)))
        if self.assignee and self.kind is not DecisionKind.ASSIGN:
            raise ConfigError(CodedText("decision-assigns", kind=str(self.kind)))
        if self.kind is DecisionKind.COMMENT and not self.why.strip():
            raise ConfigError(CodedText("decision-comment"))

    def body(self) -> DecisionBody:
        """What the journal stores beside its columns."""
        body: DecisionBody = {
            "T_i_j": list(self.T_i_j),
            "measurement": to_plain(self.measurement),
            "facts": asdict(self.facts) if self.facts else None,
        }
        if self.finding:
            body["finding"] = to_plain(self.finding)
        if self.control:
            body["control"] = to_plain(self.control)
        if self.correction:
            body["correction"] = to_plain(self.correction)
        if self.withdraws:
            body["withdraws"] = self.withdraws
        if self.kind is DecisionKind.ASSIGN:
            body["assignee"] = self.assignee
        return body

    @staticmethod
    def of(kind: str, who: str, why: str, *, pair: Pair | None, body: DecisionBody) -> Decision:
        """Decode a row of the journal.

        Raises:
            StoreError: If the row is no decision.
        """
        try:
            record = body["measurement"]
            return Decision(
                kind=DecisionKind(kind),
                who=who,
                why=why,
                pair=pair,
                T_i_j=tuple(body["T_i_j"]),
                measurement=measurement_in(record) if record else None,
                facts=as_type(body["facts"], ApprovalFacts | None),
                finding=as_type(body.get("finding"), SeenFinding | None),
                control=as_type(body.get("control"), SiteControl | None),
                correction=as_type(body.get("correction"), ClassCorrection | None),
                withdraws=body.get("withdraws", ""),
                assignee=body.get("assignee", ""),
            )
        except (KeyError, TypeError, ValueError, msgspec.ValidationError) as error:
            raise StoreError(CodedText("journal-no-decision", why=str(error))) from error


@dataclass(frozen=True, slots=True, kw_only=True)
class Standing:
    """The decision in force for a pair."""

    pair: Pair
    accepted: bool
    who: str
    """Reviewer of the last decision."""
    why: str
    T_i_j: tuple[float, ...]
    """The pose that the reviewer saw."""
    measurement: Measurement | None = None
    """Replaces the automatic measurement; None = that one applies."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StandingCorrection:
    """A correction of classes in force."""

    id: str
    """Of its contents."""
    correction: ClassCorrection
    who: str
    why: str
    time: str
    """When it was decided, UTC, ISO 8601."""


@dataclass(frozen=True, slots=True)
class Decided:
    """The decisions in force: the fold over a journal."""

    standing: tuple[Standing, ...] = ()
    """Ordered by pair."""
    undoable: int = 0
    """Number of decisions that can be undone."""
    redoable: int = 0
    """Number of decisions that can be redone."""
    control: SiteControl | None = None
    """What places the map; None = no control points."""
    corrections: tuple[StandingCorrection, ...] = ()
    """Of classes, in the order in which they apply."""

    @property
    def key(self) -> str:
        """SHA-256 of the decisions in force, those about pairs whenever they were made."""
        return joined_key(self.pairs_key, self.control_key, self.classes_key)

    @property
    def pairs_key(self) -> str:
        """SHA-256 of those about pairs."""
        return hash_json(to_plain(self.standing))

    @property
    def control_key(self) -> str | None:
        """SHA-256 of the control points; None = there are none."""
        return hash_json(to_plain(self.control)) if self.control else None

    @property
    def classes_key(self) -> str | None:
        """SHA-256 of the corrections of classes; None = there are none."""
        return hash_json(to_plain(self.corrections)) if self.corrections else None

    def __bool__(self) -> bool:
        return bool(self.standing or self.corrections) or self.control is not None


NOTHING_DECIDED = Decided()


def joined_key(pairs_key: str, control_key: str | None, classes_key: str | None) -> str:
    """`Decided.key` of its parts; without control points and corrections that of the pairs."""
    if classes_key is not None:
        return hash_json([pairs_key, control_key, classes_key])
    return pairs_key if control_key is None else hash_json([pairs_key, control_key])


def correction_id(correction: ClassCorrection) -> str:
    """The name of a correction: twelve digits of the SHA-256 of its contents."""
    return hash_json(to_plain(correction))[:12]


def fold(decisions: Iterable[Decision]) -> Decided:
    """The decisions in force after these, oldest first.

    Raises:
        StoreError: If an undo or redo has no decision to apply to.
    """
    made = list(decisions)
    done, undone = not_undone(made)
    confirming = _confirming(made)
    standing: dict[Pair, Standing] = {}
    control: SiteControl | None = None
    corrections: dict[str, StandingCorrection] = {}
    for decision in done:
        if decision.control is not None:
            control = decision.control if decision.control.targets else None
        elif decision.kind in ABOUT_CLASSES:
            _correct(corrections, decision)
        elif not (id(decision) in confirming and _confirms(standing, decision)):
            _stand(standing, decision)
    ordered = tuple(standing[pair] for pair in sorted(standing))
    return Decided(ordered, len(done), len(undone), control, tuple(corrections.values()))


def not_undone(decisions: Iterable[Decision]) -> tuple[list[Decision], list[Decision]]:
    """Decisions that are in force one after the other, and those that a redo would bring back.

    Raises:
        StoreError: If an undo or redo has no decision to apply to.
    """
    done: list[Decision] = []
    undone: list[Decision] = []
    for decision in decisions:
        if decision.kind in (DecisionKind.UNDO, DecisionKind.REDO):
            source, target = (
                (done, undone) if decision.kind is DecisionKind.UNDO else (undone, done)
            )
            if not source:
                raise StoreError(CodedText("journal-nothing-to", kind=str(decision.kind)))
            target.append(source.pop())
        elif decision.kind not in CHANGE_NOTHING:
            done.append(decision)
            undone.clear()
    return done, undone


def _confirming(decisions: Iterable[Decision]) -> set[int]:
    """Python's ids of the decisions that were made while a second opinion was asked for."""
    asked: set[Pair] = set()
    found: set[int] = set()
    for decision in decisions:
        if decision.pair is None:
            continue
        if decision.kind is DecisionKind.SECOND:
            asked.add(decision.pair)
        elif decision.kind is DecisionKind.WAIVE:
            asked.discard(decision.pair)
        elif decision.pair in asked:
            found.add(id(decision))
    return found


def _confirms(standing: Mapping[Pair, Standing], decision: Decision) -> bool:
    """Whether a second opinion changes nothing: the map that has the first one stays as it is."""
    assert decision.pair is not None
    first = standing.get(decision.pair)
    return (
        first is not None
        and decision.kind in (DecisionKind.ACCEPT, DecisionKind.REJECT)
        and first.accepted is (decision.kind is DecisionKind.ACCEPT)
        and decision.T_i_j == first.T_i_j
    )


def _correct(corrections: dict[str, StandingCorrection], decision: Decision) -> None:
    if decision.correction is None:
        corrections.pop(decision.withdraws, None)
        return
    name = correction_id(decision.correction)
    corrections[name] = StandingCorrection(
        id=name,
        correction=decision.correction,
        who=decision.who,
        why=decision.why,
        time=decision.time,
    )


def _stand(standing: dict[Pair, Standing], decision: Decision) -> None:
    assert decision.pair is not None
    before = standing.pop(decision.pair, None)
    if decision.kind is DecisionKind.RESTORE:
        return
    after = Standing(
        pair=decision.pair,
        accepted=decision.kind is not DecisionKind.REJECT,
        who=decision.who,
        why=decision.why,
        T_i_j=decision.T_i_j,
        measurement=decision.measurement,
    )
    if decision.kind not in MEASURED and before is not None:
        after = replace(after, measurement=before.measurement)
    standing[decision.pair] = after
