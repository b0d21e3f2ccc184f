"""What a kind of walk is: its stages, in order, and what a finished run leaves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from recon4.georeference.tuning import HOLD
from recon4.model.calibration_figures import CalibrationFigures
from recon4.pose_graph.files import load_nodes
from recon4.review.decisions import NOTHING_DECIDED, Decided
from recon4.sandbox.freed_memory import return_freed_memory
from recon4.semi_rigid.graph_nodes import GraphNodes, Undecided
from recon4.store.hashing import hash_json
from recon4.store.input_contents import arrays_of, files_of
from recon4.store.stage import Artifact, Input, Stage, StageRunner
from recon4.workflows.stages import CALIBRATION, REVIEW, VERIFICATION

if TYPE_CHECKING:
    from recon4.workflows.publish import Results


@dataclass(frozen=True, slots=True)
class Run:
    """Runs stages on the artifacts of others, by their names."""

    runner: StageRunner
    decided: Decided = field(default=NOTHING_DECIDED)
    """Decisions of people in force."""

    def stage(self, stage: Stage[Any, Any], **inputs: str | Input | None) -> None:
        """Run a stage, or reuse its artifact.

        What earlier stages left free goes back to the system first: the largest stage would
        otherwise stand on top of it.

        Args:
            stage: The stage.
            inputs: Argument of its function -> name of the stage whose artifact it is given, or a
                value from outside; None = there is none.
        """
        runs = self.runner.runs
        given = {
            argument: runs[one].artifact if isinstance(one, str) else one
            for argument, one in inputs.items()
        }
        return_freed_memory()
        self.runner.run(stage, **given)

    def review(self) -> None:
        """Apply the decisions of people to the verified graph.

        Without decisions there is no stage ``review``, so that undoing all of them finds the
        artifacts of before again.
        """
        if self.decided.standing:
            decisions = Input(self.decided.pairs_key, self.decided.standing)
            self.stage(REVIEW, graph=VERIFICATION.name, decisions=decisions)
        else:
            self.runner.skip(REVIEW)

    @property
    def graph(self) -> str:
        """Stage with the final graph before leveling."""
        return REVIEW.name if self.decided.standing else VERIFICATION.name

    @property
    def nodes(self) -> Input:
        """Poses of the nodes of that graph; verdicts that leave them alone do not change it."""
        found = load_nodes(self.runner.runs[self.graph].artifact.folder)
        T = found.T_a_b
        return arrays_of(found, {"t_ns": found.t_ns, "R": T.R, "t": T.t})

    def nodes_to_refine(self, refined: Callable[[Run], None]) -> Input:
        """Those nodes and, where decisions move them, what was refined without decisions.

        Args:
            refined: Runs the stage ``refine``, which earlier runs have done as a rule.
        """
        aside = Run(self.runner.aside())
        now, before = self.nodes, aside.nodes
        if now.key == before.key:
            return Input(now.key, GraphNodes(now.value))
        refined(aside)
        made = aside.runner.runs["refine"].artifact
        key = hash_json([now.key, before.key, made.key])
        return Input(key, GraphNodes(now.value, Undecided(before.value, made.folder)))

    def undecided(self, from_review: Callable[[Run], None]) -> dict[str, Input]:
        """Input of the stage that places the map: where it is without decisions about pairs.

        Control points say where a map is; then there is no such input.

        Args:
            from_review: Runs the stages up to the final trajectory, which earlier runs have done
                as a rule.
        """
        if not self.decided.standing or self.decided.control is not None:
            return {}
        aside = Run(self.runner.aside())
        from_review(aside)
        level = aside.runner.runs["level"].artifact
        return {"undecided": Input(level.key, level.folder)}

    def seen(self, to_trajectory: Callable[[Run], None]) -> Artifact:
        """The stage ``level`` whose poses say what scans see: of a point, and through it.

        What they see stays as it was without decisions if these move the map by less than a scan
        can tell; the map itself always follows the decided poses.

        Args:
            to_trajectory: Runs the stages up to the final trajectory.
        """
        level = self.runner.runs["level"]
        moved = level.figures.moved
        if moved is None or moved.moved_m > HOLD.seen_m or moved.turned_rad > HOLD.seen_rad:
            return level.artifact
        aside = Run(self.runner.aside())
        to_trajectory(aside)
        return aside.runner.runs["level"].artifact

    def files(self, stage: str, names: tuple[str, ...]) -> Input:
        """Some files of a stage's artifact: a stage that is given them reads no others of it."""
        return files_of(self.runner.runs[stage].artifact, names)

    @property
    def control(self) -> dict[str, Input]:
        """Input of the stage that places the map: control points, if there are any."""
        found = self.decided.control
        if found is None:
            return {}
        key = self.decided.control_key
        assert key is not None
        return {"control": Input(key, found)}

    @property
    def corrections(self) -> dict[str, Input]:
        """Input of the stage that makes the map: corrections of classes, if there are any."""
        key = self.decided.classes_key
        return {} if key is None else {"corrections": Input(key, self.decided.corrections)}

    @property
    def calibration(self) -> CalibrationFigures | None:
        """What the recording says of its rig; None = they were not compared."""
        found = self.runner.runs.get(CALIBRATION.name)
        return found.figures if found else None

    @property
    def measurements(self) -> dict[str, str]:
        """Inputs of a stage that places points: the multiframes, and the calibrated rig if used."""
        found = {"frames": "frames"}
        used = self.calibration is not None and self.calibration.applied
        return found | ({"calibration": CALIBRATION.name} if used else {})

    @property
    def rig_audit(self) -> str | None:
        """Stage that says what contradicts the rig that is used; None = nothing does."""
        audited = self.calibration is not None and not self.calibration.applied
        return CALIBRATION.name if audited else None


@dataclass(frozen=True, slots=True)
class Workflow:
    """A kind of walk: which stages it has, and what a finished run leaves."""

    name: str
    imports: Stage[Any, Any]
    """Reads the recording."""
    before_review: Callable[[Run], None]
    """The stages that decisions of people do not change, up to the verified graph."""
    from_review: Callable[[Run], None]
    """The stages from the reviewed graph to the map."""
    kept: tuple[Stage[Any, Any], ...]
    """Stages that are kept as they are when decisions change, in order."""
    remade: tuple[Stage[Any, Any], ...]
    """Stages that follow them, in order."""
    audit: Stage[Any, Any]
    results: Callable[[], Results[Any]]
    """What a finished run leaves in the project folder; the report is imported with it."""

    @property
    def stages(self) -> tuple[Stage[Any, Any], ...]:
        """All stages, in order."""
        return (*self.kept, *self.remade, self.audit)

    def run(self, run: Run) -> None:
        """All stages after the import; each is skipped when its artifact is there."""
        self.before_review(run)
        self.run_from_review(run)

    def run_from_review(self, run: Run) -> None:
        """The stages that depend on decisions of people."""
        run.review()
        self.from_review(run)
        self.run_audit(run)

    def run_audit(self, run: Run) -> None:
        """The findings, from the artifacts of all other stages."""
        others = {name: name for name in run.runner.runs if name != self.audit.name}
        run.stage(self.audit, **others)
