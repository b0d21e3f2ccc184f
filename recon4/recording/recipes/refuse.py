"""Refuses points that need a recipe, with the proposed one ready for a rig file."""

from __future__ import annotations

from collections.abc import Sequence

from recon4.errors import ConfigError, EmptyRecording
from recon4.locales.coded import CodedText
from recon4.recording.bags.driver_topics import needed_text
from recon4.recording.recipes.check import RecipeSample, require_fitting
from recon4.recording.recipes.propose import Proposal, say_doubts
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import RigToComplete, Stream, rig_to_complete


class UnknownFields(RigToComplete):
    """The only points are in columns without common names; a rig with recipes for them is there."""


def proposal_text(name: str, proposal: Proposal) -> str:
    """What points have, and the recipe for them as a line of a rig file."""
    if proposal.recipe is None:
        return needed_text(name, proposal.columns)
    return " ".join([f"{name}: {proposal.recipe.toml()}", *_doubts(name, proposal)])


def _doubts(name: str, proposal: Proposal) -> list[str]:
    report = ImportReport()
    say_doubts(name, proposal, report)
    return report.said_derived()


def with_doubts(proposal: Proposal, sample: RecipeSample) -> Proposal:
    """A proposal with what the check of recipes says against it."""
    if proposal.recipe is None:
        return proposal
    report = ImportReport()
    try:
        require_fitting(proposal.recipe, sample, report)
    except ConfigError as error:
        return proposal.with_doubts([str(error)])
    return proposal.with_doubts(report.said())


def require_known(unknown: Sequence[tuple[Stream, Proposal]], name: str) -> None:
    """Refuse a recording whose only points need a recipe.

    Args:
        unknown: The LiDARs, each with the recipe that is proposed.
        name: Of the recording.

    Raises:
        UnknownFields: With the recipes, ready for a rig file.
        EmptyRecording: If nothing is proposed, with what is needed.
    """
    ready = [(stream, one) for stream, one in unknown if one.recipe is not None]
    if not unknown:
        return
    if not ready:
        lacking = "; ".join(proposal_text(stream.label, one) for stream, one in unknown)
        raise EmptyRecording(CodedText("no-lidar-data", name=name, lacking=lacking))
    recipe = ready[0][1].recipe
    assert recipe is not None
    proposed = "\n  ".join(proposal_text(stream.label, one) for stream, one in ready)
    text = CodedText("points-unnamed", name=name, proposed=proposed, fields=recipe.text())
    doubts = [text for stream, one in ready for text in _doubts(stream.label, one)]
    raise UnknownFields(text, rig_to_complete([s for s, _ in ready]), doubts)
