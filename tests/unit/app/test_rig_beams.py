"""The rig page keeps corrections of beams, and names what is wrong with them."""

from dataclasses import replace

import numpy as np

from recon4.model.beams import BeamCorrections
from recon4.model.point_recipes import parse_fields_text
from recon4.model.rig import load_rig
from recon4_app.rigs.content import content_of, problems_of, rig_of

RIG = load_rig("4recon")
BEAMS = BeamCorrections.of(1e-3 * np.random.default_rng(1).standard_normal((3, 16)))


def content(beams=BEAMS, **changes):
    first = replace(RIG.sensors[0], beams=beams, **changes)
    return content_of(replace(RIG, sensors=(first, *RIG.sensors[1:])))


def test_an_edited_rig_keeps_the_corrections():
    again = rig_of(content())

    assert np.allclose(again.sensors[0].beams.rows, BEAMS.rows, atol=1e-15)
    assert again.sensors[1].beams is None


def test_corrections_that_do_not_fit_the_model_are_a_problem_of_their_field():
    problems = problems_of(content(model="HDL-32E"))

    assert "range_m must be 32 finite numbers" in problems["sensors.0.beams"]


def test_an_edited_rig_keeps_the_recipe_of_its_points_and_names_what_is_wrong_with_it():
    fields = parse_fields_text("x=px:mm,y=py:mm,z=pz:mm,time=t:us", "fields")
    edited = content(fields=fields)

    assert rig_of(edited).sensors[0].fields == fields
    wrong = edited.sensors[0].model_copy(update={"fields": "x=px"})
    problems = problems_of(edited.model_copy(update={"sensors": [wrong]}))
    assert "x, y, z; range, azimuth" in problems["sensors.0.fields"]
