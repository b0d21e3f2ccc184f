"""The first page of the report for the client."""

from __future__ import annotations

from datetime import UTC, datetime

from recon4.evaluation.site_control import accuracy_of, control_in
from recon4.findings.walk_record import path_length_m
from recon4.findings.wording import headline, title_of
from recon4.mapping.tiles import TileSet
from recon4.model.figures import PlaneThickness
from recon4.model.height_system import height_system
from recon4.model.rig_origin import recording_day
from recon4.model.site_control import SITE_GRID
from recon4.model.usability import Unobserved, Usability
from recon4.report.assessment import Assessment
from recon4.report.client import Drawing, FrontPage, Row, Signature
from recon4.report.client_words import Words
from recon4.report.findings import LEVELS
from recon4.report.tuning import CLIENT_REPORT
from recon4.untrusted.names import visible


def front_page(
    assessed: Assessment,
    tiles: TileSet | None,
    signature: Signature,
    *,
    words: Words,
    drawing: Drawing | None,
) -> FrontPage:
    """Verdict, what, where, when, accuracy, limits and signature."""
    usability = assessed.verdict.usability
    return FrontPage(
        verdict=headline(usability, words.language),
        level=LEVELS[usability],
        reasons=_reasons(assessed, words),
        what=tuple(_what(assessed, tiles, words)),
        where=tuple(_where(assessed, tiles, words)),
        when=tuple(_when(assessed, words)),
        accuracy=tuple(accuracy_rows(assessed, words)),
        limits=tuple(_limits(assessed, tiles, signature, words=words)),
        signature=signature,
        drawing=drawing,
    )


def shown(text: str) -> str:
    """A text of people or of their files, fit to be shown: visible characters, not endless."""
    return visible(" ".join(text.split()), most=CLIENT_REPORT.most_characters)


def grouped(count: int) -> str:
    """12 345 678, with thin spaces that do not break."""
    return f"{count:,}".replace(",", "\u202f")


def accuracy_rows(assessed: Assessment, words: Words) -> list[Row]:
    """How well the map is known: against truth and check points, and by its own adjustment."""
    out = [*_true_errors(assessed, words), *_check_points(assessed, words)]
    level, drift = assessed.results.level, assessed.drift
    stated = level.uncertainty if level else None
    if stated is not None:
        kind = "earth" if stated.on_earth else "start"
        if assessed.facts.crs == SITE_GRID:
            kind = "site"
        value = words(
            f"accuracy.position_{kind}", value=words.number(stated.largest_sd_m, 1, 100.0)
        )
        out.append(Row(words("accuracy.position"), value))
        if stated.shape_rms_m is not None:
            value = words("accuracy.shape_value", value=words.number(stated.shape_rms_m, 1, 100.0))
            out.append(Row(words("accuracy.shape"), value))
    figures = assessed.results.map
    if figures is not None:
        out += _thickness("thickness", figures.thickness, words)
        out += _thickness("measured", figures.thickness_as_measured, words)
    if drift is not None:
        value = words("accuracy.drift_value", value=words.number(drift.largest_m, 1, 100.0))
        out.append(Row(words("accuracy.drift"), value))
    return out or [Row(words("accuracy.none"), "–")]


def _true_errors(assessed: Assessment, words: Words) -> list[Row]:
    found = assessed.facts.evaluation
    if found is None:
        return []
    truth = shown(found.truth)
    rmse = f"{words.number(found.aligned.position_m.rmse, 1, 100.0)} cm"
    out = [Row(words("accuracy.truth", truth=truth), rmse)]
    if found.relative is not None:
        mean = words.number(found.relative.point_weighted.mean_m, 2, 100.0)
        out.append(Row(words("accuracy.relative"), f"{mean} cm"))
    return out


def _check_points(assessed: Assessment, words: Words) -> list[Row]:
    """What independent check points say of the map; none without them."""
    outcome = control_in(assessed.results.georeference)
    if outcome is None:
        return []
    found = accuracy_of(outcome, "check")
    pairs = (("flat", found.rmse_h_m), ("height", found.rmse_v_m))
    known = [
        words(f"accuracy.check_points_{key}", value=words.number(value_m, 1, 100.0))
        for key, value_m in pairs
        if value_m is not None
    ]
    if not known:
        return []
    points = grouped(found.points)
    value = words("accuracy.check_points_value", values=", ".join(known), points=points)
    return [Row(words("accuracy.check_points"), value)]


def _thickness(key: str, found: PlaneThickness | None, words: Words) -> list[Row]:
    if found is None or found.p50_m is None or found.p95_m is None:
        return []
    median, most = words.number(found.p50_m, 2, 100.0), words.number(found.p95_m, 2, 100.0)
    value = words("accuracy.thickness_value", median=median, most=most)
    return [Row(words(f"accuracy.{key}"), value)]


def _reasons(assessed: Assessment, words: Words) -> tuple[str, ...]:
    """Titles of the findings behind the verdict, each once."""
    if assessed.verdict.usability is Usability.GOOD:
        return ()
    titles = [title_of(one.kind, words.language) for one in assessed.findings if one.is_reason]
    return tuple(dict.fromkeys(titles))


def _what(assessed: Assessment, tiles: TileSet | None, words: Words) -> list[Row]:
    facts, results = assessed.facts, assessed.results
    out = [Row(words("front.recording"), shown(facts.title))]
    walk = results.final or results.odometry
    if walk is not None and len(walk) > 1:
        length = words.number(float(path_length_m(walk)[-1]), 1)
        minutes = words.number((walk.t_ns[-1] - walk.t_ns[0]) / 60e9, 1)
        text = words("front.walked_value", length=length, minutes=minutes)
        out.append(Row(words("front.walked"), text))
    if facts.rig:
        out.append(Row(words("row.rig"), shown(facts.rig)))
    if tiles is not None:
        out.append(Row(words("front.points"), grouped(len(tiles))))
        if tiles.strays:
            text = words("front.left_out_value", points=grouped(tiles.strays))
            out.append(Row(words("front.left_out"), text))
    return out


def _where(assessed: Assessment, tiles: TileSet | None, words: Words) -> list[Row]:
    crs = assessed.facts.crs
    local = "front.crs_local_level" if assessed.results.placement.is_leveled else "front.crs_local"
    out = [Row(words("front.crs"), words.term(shown(crs)) if crs else words(local))]
    controlled = control_in(assessed.results.georeference) is not None
    heights = words(f"heights.{height_system(crs, controlled=controlled)}", crs=shown(crs))
    out.append(Row(words("front.heights"), heights))
    if tiles is not None and len(tiles):
        low, high = tiles.bounds_m
        x, y, z = (words.number(float(b - a), 1) for a, b in zip(low, high, strict=True))
        out.append(Row(words("front.extent"), words("front.extent_value", x=x, y=y, z=z)))
    return out


def _when(assessed: Assessment, words: Words) -> list[Row]:
    facts, began_ns = assessed.facts, assessed.results.recorded_ns
    recorded = words("front.recorded_unknown")
    if began_ns and recording_day(began_ns):
        time = datetime.fromtimestamp(began_ns / 1e9, UTC)
        recorded = f"{time:%Y-%m-%d %H:%M} UTC"
    version = facts.versions.get("recon4", "")
    return [
        Row(words("front.recorded"), recorded),
        Row(words("front.processed"), f"{facts.created[:16].replace('T', ' ')} UTC"),
        Row(words("front.software"), shown(f"recon4 {version}")),
    ]


def _limits(
    assessed: Assessment, tiles: TileSet | None, signature: Signature, *, words: Words
) -> list[str]:
    """What the map must not be used for, one sentence each."""
    facts = assessed.facts
    out = [] if signature.approved else [words("limits.draft")]
    if assessed.verdict.usability is not Usability.GOOD:
        out.append(words("limits.reasons"))
    if facts.evaluation is None and not _check_points(assessed, words):
        out.append(words("limits.computed"))
    if facts.crs == SITE_GRID:
        out.append(words("limits.site_grid"))
    elif facts.crs:
        out.append(words("limits.crs", crs=shown(facts.crs)))
    else:
        out.append(words("limits.local"))
    if not assessed.results.placement.is_leveled:
        out.append(words("limits.not_leveled"))
    out += [_unobserved(one, words) for one in assessed.verdict.unobserved[:3]]
    if tiles is not None and tiles.strays:
        out.append(words("limits.left_out"))
    return out


def _unobserved(one: Unobserved, words: Words) -> str:
    return words(
        "limits.unobserved",
        start=words.number(one.start_s, 0),
        end=words.number(one.end_s, 0),
        direction=words(f"direction.{one.direction}") if one.direction else "–",
    )
