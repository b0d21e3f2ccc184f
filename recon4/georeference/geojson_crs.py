"""How a GeoJSON file says in which coordinates it is, if not in longitude and latitude."""

from __future__ import annotations

_MAP_WKT = (
    'LOCAL_CS["map frame: not georeferenced",LOCAL_DATUM["map",0],'
    'UNIT["metre",1],AXIS["X",EAST],AXIS["Y",NORTH]]'
)


def geojson_crs(crs: str = "", wkt: str = "") -> dict[str, object]:
    """The member ``crs`` of a file whose coordinates are not those of RFC 7946.

    Without it every reader takes coordinates for longitude and latitude, and so for meters near
    the coast of Africa. GDAL reads names of EPSG and WKT here, and so does what is built on it.

    Args:
        crs: Code as ``EPSG:25832`` or, with a system of heights, ``EPSG:25832+7837``.
        wkt: Of a system without a code; empty = the frame of a map that is not georeferenced.
    """
    codes = crs.removeprefix("EPSG:").split("+")
    if not all(code.isdigit() for code in codes):
        name = wkt or _MAP_WKT
    elif len(codes) == 1:
        name = f"urn:ogc:def:crs:EPSG::{codes[0]}"
    else:
        name = "urn:ogc:def:crs," + ",".join(f"crs:EPSG::{code}" for code in codes)
    return {"type": "name", "properties": {"name": name}}
