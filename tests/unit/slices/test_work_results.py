"""Results of child processes are transferred to the server as typed JSON."""

import inspect
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter

import recon4_app
from recon4.evaluation.slices import SliceError
from recon4.model.pose_graph import Judge, Judgment, Measure, Reason, Verdict
from recon4.review.pairs import PairFacts
from recon4.review.preview import DecidedEdge, Effect
from recon4.review.queue import AlternativePath
from recon4.review.solve import Difference, EdgeConflict, Move
from recon4.slices.compare import ComparedSlice, Comparison, SignedFigures
from recon4.slices.control_points import ControlPoint
from recon4.slices.measured_points import MeasuredPosition
from recon4.slices.reference_fit import ReferenceFit
from recon4.slices.residuals import residuals
from recon4_app.compute_pool.messages import declared, decode_result, encode_result
from recon4_app.review.review_work import pair_facts, preview
from recon4_app.slices.control_work import control_report
from recon4_app.slices.slice_work import comparison

APP = Path(recon4_app.__file__).parent
WORK = [
    function
    for path in sorted(APP.rglob("*_work.py"))
    for module in [import_module(".".join(path.relative_to(APP.parent).with_suffix("").parts))]
    for name, function in inspect.getmembers(module, inspect.isfunction)
    if not name.startswith("_")
    if function.__module__ == module.__name__ or name in getattr(module, "__all__", ())
]
HELPERS = {"map_of", "reference_of", "span_of"}
"""Not called through the pool."""
ROW = SliceError("z = 1.00 m", 10, 1, 0.01, 0.9, 1.0)
CHANGE = Difference(1.0, 2.0, 5, 4, (Move(3, 30, 10**18, 0.1),), ((10, 40),), ())
POSE = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


@pytest.mark.parametrize("function", WORK, ids=lambda function: function.__name__)
def test_every_result_has_a_type_that_can_be_checked(function):
    hint = declared(function) if function.__name__ not in HELPERS else None
    if hint is not None and hint is not bytes:
        TypeAdapter(hint)


def test_records_come_back_as_they_were():
    effect = Effect(
        key="k",
        last=CHANGE,
        all=CHANGE,
        edges=(DecidedEdge((10, 40), 1.5, "accepted"),),
        conflicts=(EdgeConflict((1, 2), 9.0, 5.0, 0.2, 0.1, "Eva"),),
        missing=(),
        changed=(),
        warnings=("w",),
        seconds=0.1,
    )
    pair = PairFacts(
        (1, 2), (10**18, 10**18 + 1), POSE, POSE, None, POSE[3:], 0.1, 0.2,
        (AlternativePath((1, 3, 2), 0.1, 0.01),), 1,
        (
            Judgment(Judge.SEARCH, Verdict.ACCEPTED, measure=Measure.ERROR, value=0.1, limit=None),
            Judgment(Judge.PERSON, Verdict.REJECTED, Reason.OPERATOR, person="Eva", note="glass"),
        ),
    )  # fmt: skip
    row = ComparedSlice.of(ROW, SignedFigures(9, -0.01, 0.02, (0.03, None, 0.0)))
    fit = ReferenceFit(0.9, 0.8, None, True, "✓")
    table = Comparison((row,), row, None, 0.5, tuple(range(100)), 0.002, 0.1, fit, "model", "plane")
    report = residuals(
        [ControlPoint("A", (0.0, 0.0, 0.0))],
        {"A": MeasuredPosition.full(np.array([0.01, 0.0, 0.0]))},
    )

    assert decode_result(preview, encode_result(preview, effect)) == effect
    assert decode_result(pair_facts, encode_result(pair_facts, pair)) == pair
    assert decode_result(comparison, encode_result(comparison, table)) == table
    again = decode_result(control_report, encode_result(control_report, report))
    assert again == report
