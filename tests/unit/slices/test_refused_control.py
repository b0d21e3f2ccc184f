"""Why a map is not put on its control points, in the language of who asked."""

import pytest

from recon4.errors import GeoreferenceError
from recon4.georeference.control_blunders import Blunder, BlunderKind
from recon4.locales.coded import text_of
from recon4.model.site_control import SiteControl
from recon4.slices.site_control import ControlTrial, require_agreement


@pytest.mark.parametrize(
    ("language", "reason"), [("en", "Easting and northing are"), ("de", "Ost und Nord sind")]
)
def test_a_refused_survey_names_the_blunder_in_the_language_of_who_asked(language, reason):
    axes = Blunder(kind=BlunderKind.AXES, points=())
    trial = ControlTrial(SiteControl(targets=(), crs=""), None, (axes,), ())

    with pytest.raises(GeoreferenceError) as refused:
        require_agreement(trial, language)

    assert reason in text_of(refused.value).said(language)
