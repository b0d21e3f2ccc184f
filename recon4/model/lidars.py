"""The LiDARs that recon4 knows: what weights, overlap, surfaces and the simulator use of each.

Sources are the user manuals and data sheets of the makers, named at each row's group; what
`CHECKED` names was compared with copies and quotations of them. How the packets of a model are
decoded is in `recon4.recording.packets`.
"""

from __future__ import annotations

from dataclasses import replace

from recon4.model.lidar_facts import LidarFacts

_VLP16 = LidarFacts(
    name="VLP-16",
    maker="Velodyne",
    beams=16,
    elevation_deg=(-15.0, 15.0),
    min_range_m=0.4,
    range_m=50.0,
    range_sd_m=0.015,
    divergence_rad=0.003,
    sample_ports=(8308,),
)
_VELODYNE = (  # manuals 63-9243 D, 63-9325, 63-9113, 63-9194 (HDL-64E S3), 63-9483 (VLS-128)
    _VLP16,
    replace(_VLP16, name="VLP-16 Hi-Res", elevation_deg=(-10.0, 10.0)),
    replace(_VLP16, name="VLP-32C", beams=32, elevation_deg=(-25.0, 15.0), range_m=80.0),
    replace(
        _VLP16,
        name="HDL-32E",
        beams=32,
        elevation_deg=(-30.67, 10.67),
        range_sd_m=0.01,
        has_imu=True,
    ),
    replace(_VLP16, name="Puck LITE"),
    replace(
        _VLP16,
        name="VLS-128",
        beams=128,
        elevation_deg=(-25.0, 15.0),
        min_range_m=0.5,
        range_m=220.0,
    ),
    replace(_VLP16, name="HDL-64E", beams=64, elevation_deg=(-24.9, 2.0), range_sd_m=0.02),
)

_XT32 = LidarFacts(
    name="XT32",
    maker="Hesai",
    beams=32,
    elevation_deg=(-16.0, 15.0),
    min_range_m=0.05,
    range_m=80.0,
    range_sd_m=0.005,
    divergence_rad=0.002,
)
_PANDAR40P = replace(
    _XT32,
    name="Pandar40P",
    beams=40,
    elevation_deg=(-25.0, 15.0),
    min_range_m=0.3,
    range_m=200.0,
    range_sd_m=0.01,
)
_QT64 = replace(
    _XT32,
    name="QT64",
    beams=64,
    elevation_deg=(-52.1, 52.1),
    min_range_m=0.1,
    range_m=20.0,
    range_sd_m=0.015,
    divergence_rad=0.005,
)
_HESAI = (  # user manuals of Hesai, chapter "Specifications"; not all state a divergence
    replace(_XT32, name="XT16", beams=16, elevation_deg=(-15.0, 15.0)),
    _XT32,
    replace(_XT32, name="XT32M2X", elevation_deg=(-20.8, 19.5), min_range_m=0.5),
    _PANDAR40P,
    replace(_PANDAR40P, name="Pandar64", beams=64),
    replace(_PANDAR40P, name="Pandar128", beams=128, has_imu=True),
    replace(_PANDAR40P, name="OT128", beams=128, range_sd_m=0.015, has_imu=True),
    _QT64,
    replace(_QT64, name="QT128", beams=128, elevation_deg=(-52.6, 52.6), min_range_m=0.05),
    replace(
        _PANDAR40P,
        name="AT128",
        beams=128,
        scanning="solid-state",
        elevation_deg=(-12.5, 12.9),
        azimuth_deg=120.0,
        min_range_m=0.5,
        range_m=210.0,
    ),
    replace(_QT64, name="JT16", beams=16, elevation_deg=(0.6, 40.7), range_m=30.0, has_imu=True),
    replace(_QT64, name="JT128", beams=128, elevation_deg=(-5.0, 90.0), range_m=30.0, has_imu=True),
)

_AVIA = LidarFacts(
    name="Avia",
    maker="Livox",
    beams=6,
    scanning="rosette",
    elevation_deg=(-38.6, 38.6),
    azimuth_deg=70.4,
    min_range_m=1.0,
    range_m=190.0,
    range_sd_m=0.02,
    divergence_rad=0.0049,
    has_imu=True,
    p_sensor_imu_m=(-0.04165, -0.02326, 0.0284),
)
_LIVOX = (  # user manuals: Mid-40/100 v1.6, Mid-70 v1.2, Horizon v1.2, Tele-15 v1.0, Avia v1.2,
    # Mid-360 v1.2, HAP v1.0; the divergence is the larger one of 0.28° x 0.03° (Mid-360: as the
    # others, its manual states none that fits its spots)
    _AVIA,
    replace(
        _AVIA,
        name="Mid-40",
        beams=1,
        has_imu=False,
        elevation_deg=(-19.2, 19.2),
        azimuth_deg=38.4,
        range_m=90.0,
    ),
    replace(
        _AVIA,
        name="Mid-70",
        beams=1,
        has_imu=False,
        elevation_deg=(-35.2, 35.2),
        azimuth_deg=70.4,
        min_range_m=0.05,
        range_m=90.0,
    ),
    replace(
        _AVIA,
        name="Horizon",
        p_sensor_imu_m=(-0.05512, -0.02226, 0.0297),
        elevation_deg=(-12.55, 12.55),
        azimuth_deg=81.7,
        min_range_m=0.5,
        range_m=90.0,
    ),
    replace(
        _AVIA,
        name="Tele-15",
        p_sensor_imu_m=(0.0, 0.0, 0.0),
        elevation_deg=(-8.1, 8.1),
        azimuth_deg=14.5,
        min_range_m=3.0,
        range_m=320.0,
        divergence_rad=0.0021,
    ),
    replace(
        _AVIA,
        name="Mid-360",
        alike="Avia 2, Mid-360L",
        beams=4,
        p_sensor_imu_m=(0.011, 0.02329, -0.04412),
        elevation_deg=(-7.0, 52.0),
        azimuth_deg=360.0,
        min_range_m=0.1,
        range_m=40.0,
        port=56301,
        sample_ports=(56401,),
    ),
    replace(
        _AVIA,
        name="HAP",
        p_sensor_imu_m=(0.0, 0.0, 0.0),
        elevation_deg=(-12.5, 12.5),
        azimuth_deg=120.0,
        port=57000,
        sample_ports=(58000,),
        min_range_m=0.5,
        range_m=150.0,
    ),
)
_OS1 = LidarFacts(
    name="OS1",
    maker="Ouster",
    beams=64,
    elevation_deg=(-21.2, 21.2),
    min_range_m=0.5,
    range_m=90.0,
    range_sd_m=0.015,
    divergence_rad=0.0031,
    port=7502,
    sample_ports=(7503,),
    has_imu=True,
    p_sensor_imu_m=(0.006253, -0.011775, 0.007645),
)
_OUSTER_KINDS = (  # data sheets of revision 7, firmware 3.0: precision in the middle of its range
    replace(
        _OS1,
        name="OS0",
        elevation_deg=(-45.0, 45.0),
        range_m=35.0,
        range_sd_m=0.02,
        divergence_rad=0.0061,
    ),
    _OS1,
    replace(
        _OS1,
        name="OS2",
        elevation_deg=(-11.25, 11.25),
        min_range_m=0.8,
        range_m=200.0,
        range_sd_m=0.04,
        divergence_rad=0.0016,
    ),
    replace(
        _OS1,
        name="OSDome",
        elevation_deg=(0.0, 90.0),
        range_m=20.0,
        range_sd_m=0.02,
        divergence_rad=0.0061,
    ),
)
_OUSTER = (
    replace(_OUSTER_KINDS[0], name="Ouster", beams=0),  # of a kind that is not known
    *(
        replace(kind, name=f"{kind.name}-{beams}", beams=beams)
        for kind in _OUSTER_KINDS
        for beams in (32, 64, 128)
    ),
    replace(  # of the first generation, software user guide 1.12
        _OS1,
        name="OS1-16",
        beams=16,
        elevation_deg=(-16.6, 16.6),
        min_range_m=0.8,
        range_m=40.0,
        range_sd_m=0.03,
        divergence_rad=0.0023,
    ),
)

_HELIOS = LidarFacts(
    name="Helios 32",
    maker="RoboSense",
    beams=32,
    port=6699,
    sample_ports=(7788,),
    elevation_deg=(-16.0, 15.0),
    min_range_m=0.2,
    range_m=90.0,
    range_sd_m=0.01,
    divergence_rad=0.0026,
)
_BPEARL = replace(
    _HELIOS,
    name="Bpearl",
    elevation_deg=(0.0, 90.0),
    min_range_m=0.1,
    range_m=30.0,
    range_sd_m=0.015,
)
_ROBOSENSE = (  # user manuals: Helios 1.5, Bpearl 3.2, Ruby Plus 2.0, Airy 1.0, M1 2.0, E1 1.0
    _HELIOS,
    replace(_HELIOS, name="Helios 5515", elevation_deg=(-55.0, 15.0), min_range_m=0.1),
    replace(_HELIOS, name="Helios 16P", beams=16, elevation_deg=(-15.0, 15.0)),
    _BPEARL,
    replace(_BPEARL, name="Bpearl V4"),
    replace(
        _HELIOS,
        name="Ruby Plus",
        alike="Ruby",
        beams=128,
        elevation_deg=(-25.0, 15.0),
        min_range_m=0.4,
        range_m=240.0,
    ),
    replace(
        _HELIOS,
        name="Airy",
        beams=96,
        elevation_deg=(0.0, 90.0),
        min_range_m=0.1,
        range_m=30.0,
        sample_ports=(7788, 6688),
        has_imu=True,
        rpy_sensor_imu_deg=(180.0, 0.0, -90.0),  # public reports, and numbers in device packets
    ),
    replace(
        _HELIOS,
        name="RS-16",
        beams=16,
        elevation_deg=(-15.0, 15.0),
        min_range_m=0.4,
        range_m=80.0,
        range_sd_m=0.01,
    ),
    replace(
        _HELIOS,
        name="RS-32",
        elevation_deg=(-25.0, 15.0),
        min_range_m=0.4,
        range_sd_m=0.015,
    ),
    replace(
        _HELIOS,
        name="M1",
        beams=5,
        scanning="solid-state",
        elevation_deg=(-12.5, 12.5),
        azimuth_deg=120.0,
        min_range_m=0.5,
        range_m=150.0,
        range_sd_m=0.015,
        divergence_rad=0.0035,
    ),
    replace(
        _HELIOS,
        name="M2",
        beams=5,
        scanning="solid-state",
        elevation_deg=(-12.5, 12.5),
        azimuth_deg=120.0,
        min_range_m=0.5,
        range_m=200.0,
        range_sd_m=0.015,
        divergence_rad=0.0035,
    ),
    replace(
        _HELIOS,
        name="E1",
        beams=1,
        scanning="solid-state",
        elevation_deg=(-45.0, 45.0),
        azimuth_deg=120.0,
        min_range_m=0.1,
        range_m=30.0,
        range_sd_m=0.015,
        divergence_rad=0.0045,
    ),
)

_GENERIC = LidarFacts(
    name="generic",
    maker="",
    beams=0,
    elevation_deg=(-90.0, 90.0),
    min_range_m=0.4,
    range_m=50.0,
    range_sd_m=0.015,
    divergence_rad=0.003,
)

LIDARS: dict[str, LidarFacts] = {
    model.name: model for model in (*_VELODYNE, *_HESAI, *_LIVOX, *_OUSTER, *_ROBOSENSE, _GENERIC)
}
"""All models by name; ``generic`` is any LiDAR whose points come as clouds."""

_REPORTS = "public reports that quote the maker's pages"
_MANUALS = "public code that quotes the manual"
CHECKED: dict[str, str] = {
    "VLP-16": "HELIOS++, scanners_tls.xml, after manual 63-9243 E (its beam is narrower)",
    "HDL-64E": "HELIOS++, scanners_tls.xml",
    "XT16": _REPORTS,
    "XT32": _REPORTS,
    "XT32M2X": _REPORTS,
    "QT128": _REPORTS,
    "OT128": _REPORTS,
    "AT128": f"{_REPORTS}; not its deviation",
    "JT16": f"{_REPORTS}; not its deviation",
    "Avia": _REPORTS,
    "Mid-70": "HELIOS++, scanners_als.xml, with its beam; public reports",
    "Mid-360": "user manual v1.0, pages 13 and 20, as quoted; not its beam",
    "HAP": "user manual, table 1.2.1, with its beam",
    "OS1-16": "data sheet of the first generation, with its beam",
    "OS1-32": f"{_MANUALS}: data sheet of revision 7; not its deviation",
    "OS1-64": f"{_MANUALS}: data sheet of revision 7; not its deviation",
    "OS1-128": f"{_MANUALS}: data sheet of revision 7; not its deviation",
    "OSDome-128": f"{_MANUALS}: data sheet of revision 7, firmware 3.1",
    "Helios 32": _REPORTS,
    "Helios 5515": _REPORTS,
    "Bpearl": _REPORTS,
}
"""Models whose view, ranges and deviation were compared, and with what; others are as remembered
from their manuals."""


def lidar_model(name: str) -> LidarFacts:
    """The facts of a model; those of ``generic`` for an unknown name."""
    return LIDARS.get(name, _GENERIC)
