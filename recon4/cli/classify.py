"""The command ``recon4 classify``: give points of a map another class."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from getpass import getuser
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from recon4.cli.confinement import confine_command
from recon4.cli.terminal import say, worded, write
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText, text_of

if TYPE_CHECKING:
    from recon4.model.class_corrections import ClassCorrection, Reclassified
    from recon4.review.correction_files import ListedCorrection
    from recon4.review.decisions import StandingCorrection

classify = typer.Typer()


@classify.command("classify")
def classify_points(
    project: Annotated[Path, typer.Argument(help="Folder that `recon4 process --out` made.")],
    corrections: Annotated[
        Path | None,
        typer.Argument(help="List of volumes and their new classes, .json or a table."),
    ] = None,
    *,
    undo: Annotated[
        list[str] | None,
        typer.Option(metavar="ID", help="Withdraw a correction; repeatable. `all` = each."),
    ] = None,
    apply: Annotated[
        bool, typer.Option("--apply", help="Note the corrections and make the map again.")
    ] = False,
) -> None:
    """List the corrections of classes of a map, count what new ones would change, apply or undo.

    Without --apply the map and its journal stay as they are.
    """
    confine_command(write=[project])
    if corrections and undo:
        raise ConfigError(CodedText("classify-both"))
    if corrections:
        return _correct(project, corrections, apply=apply)
    if undo:
        return _withdraw(project, undo, apply=apply)
    if apply:
        raise ConfigError(CodedText("classify-apply"))
    _list(project)


def _list(project: Path) -> None:
    from recon4.review.class_corrections import corrections_in_map, not_in_map
    from recon4.review.journal import read_decided
    from recon4.review.state import read_summary
    from recon4.store.project import read_artifacts

    read_artifacts(project)  # raises if it is no project
    decided, in_map = read_decided(project), corrections_in_map(read_summary(project))
    for one in decided.corrections:
        write(_line(one) + ("" if one.id in in_map else f"  {worded('correction-not-in-map')}"))
    for name in not_in_map(decided, in_map).withdrawn:
        say("correction-still-in-map", correction=name)
    if not decided.corrections:
        say("corrections-none")


def _line(one: StandingCorrection) -> str:
    what = one.correction.what
    when = one.time[:16].replace("T", " ")
    return worded(
        "correction-standing",
        correction=one.id,
        points=one.correction.points,
        to=_titles([what.to]),
        restricted=len(what.only),
        only=_titles(what.only),
        who=f"{one.who}, {when}{f': {one.why}' if one.why else ''}",
    )


def _titles(classes: Sequence[int]) -> str:
    from recon4.model.class_corrections import titles_of

    return ", ".join(worded("named-class", title=title) for title in titles_of(classes))


def _correct(project: Path, path: Path, *, apply: bool) -> None:
    from recon4.review.correction_files import read_corrections

    listed = read_corrections(path)
    made, seen = _counted(project, listed)
    if apply:
        _note(project, [(one, entry.why) for one, entry in zip(made, listed, strict=True)], seen)
        _make_again(project)


def _counted(
    project: Path, listed: Sequence[ListedCorrection]
) -> tuple[list[ClassCorrection], int]:
    """Corrections as the journal keeps them, and the number of its rows that were seen.

    Raises:
        ConfigError: If one of them changes no point.
    """
    from recon4.review.class_corrections import corrections_in_map, not_in_map, try_correction
    from recon4.review.decisions import fold
    from recon4.review.journal import read_rows
    from recon4.review.state import read_summary
    from recon4.store.project import read_artifacts

    artifacts, rows = read_artifacts(project), read_rows(project)
    decided = fold(row.decision() for row in rows)
    before = list(not_in_map(decided, corrections_in_map(read_summary(project))).corrections)
    made: list[ClassCorrection] = []
    for one in listed:
        what = _resolved(artifacts, one, [*before, *made])
        trial = try_correction(artifacts, what, [*before, *made])
        if trial.refused is not None:
            raise ConfigError(
                CodedText("classify-refused", where=one.where, text=trial.refused.text)
            )
        assert trial.correction is not None
        now = ";".join(f"{title}:{count}" for title, count in trial.now.items())
        say(
            "correction-tried",
            where=one.where,
            points=trial.points,
            now=now,
            to=_titles([what.to]),
        )
        made.append(trial.correction)
    return made, len(rows)


def _resolved(
    artifacts: Mapping[str, Path], one: ListedCorrection, before: Sequence[ClassCorrection]
) -> Reclassified:
    """A correction with its volume; of all that is like a thing, say where that is.

    Raises:
        ConfigError: If nothing is there.
    """
    from recon4.model.class_corrections import Reclassified
    from recon4.review.class_corrections import propose_alike

    if isinstance(one.what, Reclassified):
        return one.what
    try:
        found = propose_alike(artifacts, one.what.picked, before)
    except ConfigError as error:
        raise ConfigError(
            CodedText("classify-refused", where=one.where, text=text_of(error))
        ) from error
    chosen = [each for each in found.clusters if each.difference <= one.what.most_different]
    say("correction-alike", where=one.where, count=len(chosen), of=_titles([found.of]))
    for each in chosen:
        x, y, z = ((a + b) / 2.0 for a, b in zip(each.low_m, each.high_m, strict=True))
        place = f"x {x:.2f}  y {y:.2f}  z {z:.2f} m"
        say("alike-at", place=place, points=each.points, difference=each.difference)
    return found.reclassified(one.what.picked.to, most_different=one.what.most_different)


def _note(project: Path, made: Sequence[tuple[ClassCorrection, str]], seen: int) -> None:
    from recon4.review.decisions import Decision, DecisionKind
    from recon4.review.journal import append

    for one, why in made:
        decision = Decision(kind=DecisionKind.CLASSIFY, who=getuser(), why=why, correction=one)
        append(project, decision, seen_seq=seen)


def _withdraw(project: Path, ids: Sequence[str], *, apply: bool) -> None:
    from recon4.review.decisions import Decision, DecisionKind
    from recon4.review.journal import append, read_decided

    there = {one.id: one for one in read_decided(project).corrections}
    chosen = list(there) if list(ids) == ["all"] else list(dict.fromkeys(ids))
    unknown = [one for one in chosen if one not in there]
    if unknown or not chosen:
        raise ConfigError(
            CodedText("classify-unknown", unknown=", ".join(unknown), there=", ".join(there))
        )
    for one in chosen:
        say("correction-withdrawn", what=_line(there[one]))
        if apply:
            append(project, Decision(kind=DecisionKind.WITHDRAW, who=getuser(), withdraws=one))
    if apply:
        _make_again(project)


def _make_again(project: Path) -> None:
    from recon4.cli.summaries import show_run
    from recon4.cli.terminal import watcher
    from recon4.pipeline import remake

    with watcher() as progress:
        summary = remake(project, progress=progress)
    show_run(summary)
