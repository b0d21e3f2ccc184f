"""What the names of columns mean, in the languages of surveyors: axis, id, role, and unit.

Names are compared without accents, case, blanks and punctuation: ``Souřadnice Y [m]`` is
``souradnicey`` in meters.
"""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass
from typing import Literal, get_args

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText

Spread = Literal["se", "sn", "sh", "cee", "cen", "ceh", "cnn", "cnh", "chh"]
"""Standard deviations east, north, height, and covariances."""
Meaning = Literal["x", "y", "z", "-x", "-y", "lat", "lon", "id", "role", "radius", "-", Spread]
"""Of a column: east or x, north or y, height or z, the same with the other sign (S-JTSK), degrees,
name of a point, control or check, radius of a target; ``-`` = not used."""
Unit = Literal["m", "dm", "cm", "mm", "km", "ft", "us-ft", "in"]
Family = Literal["xy", "en", ""]
"""How the axes are named: x, y, z, or by direction."""

UNITS_M: dict[Unit, float] = {
    "m": 1.0,
    "dm": 0.1,
    "cm": 0.01,
    "mm": 0.001,
    "km": 1000.0,
    "ft": 0.3048,
    "us-ft": 1200.0 / 3937.0,
    "in": 0.0254,
}
"""Length of a unit [m]; a US survey foot is 2 ppm longer than an international one."""
UNIT_NAMES: dict[Unit, str] = {
    "m": "meters",
    "dm": "decimeters",
    "cm": "centimeters",
    "mm": "millimeters",
    "km": "kilometers",
    "ft": "international feet",
    "us-ft": "US survey feet",
    "in": "inches",
}


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


def _axis(letter: str, number: int) -> frozenset[str]:
    affixes = "coord coordinate koordinate koord souradnice coordonnee coordenada coordinata pos"
    names = {letter, f"points{number}", f"{letter}pos", f"position{letter}", f"{letter}position"}
    for affix in [*affixes.split(), "wspolrzedna"]:
        names |= {affix + letter, letter + affix}
    return frozenset(names)


_X, _Y, _Z = _axis("x", 0), _axis("y", 1), _axis("z", 2)
_EAST = _words(
    "e east easting eastings rechtswert rechts rw ostwert ost vychod vychodni est este wschod"
)
_NORTH = _words(
    "n north northing northings hochwert hoch hw nordwert nord sever severni norte polnoc"
)
_HEIGHT = _words(
    "h u up height heights elevation elev alt altitude hohe hoehe hohenwert vyska nadmorskavyska"
    " hauteur altura cota quota wysokosc orthometricheight ellipsoidalheight heightellipsoidal"
    " heightorthometric ellipsoidischehohe hoheunn hoheunhn niveau level rl"
)
_LAT = _words("lat latitude breite geographischebreite sirka zemepisnasirka latitud latitudine")
_LON = _words("lon lng long longitude lange laenge delka zemepisnadelka longitud longitudine")
_ID = _words(
    "id localid name point pointid pointname pointno pointnumber ptid pt pid nr no num number punkt"
    " punktnummer punktnr punktname punktid pktnr pkt pnr ptnr bod cislo cislobodu cb bodc nom"
    " nombre punto numero label station marker gcp target nazev oznaceni numerpunktu nrpunktu"
)
_MEANINGS: tuple[tuple[Meaning, Family, frozenset[str]], ...] = (
    ("x", "xy", _X),
    ("y", "xy", _Y),
    ("z", "xy", _Z),
    ("x", "en", _EAST),
    ("y", "en", _NORTH),
    ("z", "en", _HEIGHT),
    ("lat", "", _LAT),
    ("lon", "", _LON),
    ("id", "", _ID),
    ("role", "", _words("role rolle")),
    ("radius", "", _words("radius radiusm")),
)
Role = Literal["control", "check"]
_CONTROL_WORDS = "control controlpoint gcp passpunkt vlicovacibod"
_CHECK_WORDS = "check checkpoint kontrollpunkt prufpunkt pruefpunkt kontrolnibod"
ROLES: dict[str, Role] = {
    "": "check",
    **dict.fromkeys(_CONTROL_WORDS.split(), "control"),
    **dict.fromkeys(_CHECK_WORDS.split(), "check"),
}
"""What the cells of a column of roles mean."""
SIGMAS: tuple[Spread, ...] = ("se", "sn", "sh")
COVARIANCES: tuple[Spread, ...] = ("cee", "cen", "ceh", "cnn", "cnh", "chh")
_SPREAD = re.compile(r"(s|sd|std|stdev|stddev|sig|sigma)([enh])|(c|cov|q)([en][enh]|hh)")
_UNIT_WORDS: dict[str, Unit] = {
    **dict.fromkeys(("m", "meter", "meters", "metr", "metry", "metre"), "m"),
    **dict.fromkeys(("mm", "millimeter", "millimeters"), "mm"),
    **dict.fromkeys(("cm", "centimeter", "centimeters"), "cm"),
    **dict.fromkeys(("ft", "feet", "foot", "ift", "intft", "ftint"), "ft"),
    **dict.fromkeys(("usft", "ftus", "sft", "usfeet", "ussurveyfeet", "ussurveyfoot"), "us-ft"),
    **dict.fromkeys(("in", "inch", "inches"), "in"),
    "dm": "dm",
    "km": "km",
}
_BRACKETED = re.compile(r"[\[(<{](.*?)[\])>}]")


@dataclass(frozen=True, slots=True)
class ColumnName:
    """What a name says."""

    meaning: Meaning
    family: Family = ""
    unit: Unit | None = None
    """None = it states none."""
    odd_unit: str = ""
    """A unit in brackets that is not known."""


def column_name(text: str) -> ColumnName:
    """The meaning of the name of a column; ``-`` for a name that is not known."""
    bracketed = _BRACKETED.search(text)
    stated = plain_word(bracketed[1]).removesuffix("2") if bracketed else ""
    words = _BRACKETED.sub(" ", text).lstrip("/#%! ")
    plain, unit = plain_word(words), _UNIT_WORDS.get(stated)
    found = _meaning(plain)
    if found is None and unit is None:
        found, unit = _with_unit_behind(words)
    if found is None:
        return ColumnName("-")
    meaning, family = found
    return ColumnName(meaning, family, unit, stated if stated and unit is None else "")


def is_unit(text: str) -> bool:
    """Whether a cell is the name of a unit, in brackets or without."""
    return plain_word(text) in _UNIT_WORDS


def parse_meanings(text: str) -> tuple[Meaning, ...]:
    """The columns as a person writes them: ``id,x,y,z``; ``-`` is a column that is not used.

    Raises:
        ConfigError: If a word is not known.
    """
    found = tuple(_one_meaning(word.strip()) for word in text.split(",")) if text.strip() else ()
    return check_meanings(found)


def check_meanings(columns: tuple[Meaning, ...]) -> tuple[Meaning, ...]:
    """Columns that name each axis once; an empty tuple is returned as it is.

    Raises:
        ConfigError: If an axis is missing or named twice.
    """
    beside = ("-", "role", "radius", "id", *SIGMAS, *COVARIANCES)
    axes = sorted(column.lstrip("-") for column in columns if column not in beside)
    if columns and axes not in (["x", "y", "z"], ["lat", "lon", "z"]):
        raise ConfigError(CodedText("table-columns", columns=",".join(columns)))
    return columns


def _one_meaning(word: str) -> Meaning:
    for meaning in get_args(Meaning):
        if word.lower() == meaning:
            return meaning
    found = column_name(word).meaning if word else "-"
    if word and found == "-":
        raise ConfigError(CodedText("table-column-word", word=word[:40]))
    return found


def _meaning(plain: str) -> tuple[Meaning, Family] | None:
    for meaning, family, names in _MEANINGS:
        if plain in names:
            return meaning, family
    spread = _SPREAD.fullmatch(re.sub("u$|u(?=u$)", "h", plain))
    for one in (*SIGMAS, *COVARIANCES):
        if spread and one in (f"s{spread[2]}", f"c{spread[4]}"):
            return one, ""
    return None


def _with_unit_behind(words: str) -> tuple[tuple[Meaning, Family] | None, Unit | None]:
    """A name with its unit behind it: ``x_mm``, ``Easting m``, ``z_us_ft``."""
    parts = [part for part in re.split(r"[\s_.\-]+", words) if part]
    for count in (1, 2):
        unit = _UNIT_WORDS.get(plain_word("".join(parts[-count:])))
        found = _meaning(plain_word("".join(parts[:-count])))
        if unit and found:
            return found, unit
    return None, None


def plain_word(text: str) -> str:
    """Without accents, case, blanks and punctuation."""
    letters = text.replace("ß", "ss").replace("ł", "l").replace("σ", "s")
    bare = unicodedata.normalize("NFKD", letters)
    return re.sub(r"[^a-z0-9]", "", bare.lower())
