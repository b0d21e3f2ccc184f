"""Files of GNSS receivers and of their post-processing."""

from __future__ import annotations

import contextlib
from pathlib import Path

from recon4.errors import Recon4Error
from recon4.recording.gnss.files import read_gnss
from recon4.recording.info.describe import describe
from recon4.recording.report import ImportReport
from tests import gnss_logs as logs
from tests.security.fuzz.kind import Kind, Reading


def _read(path: Path) -> Reading:
    with contextlib.suppress(Recon4Error):
        describe(path).lines()
    report = ImportReport()
    found = read_gnss(path, report)
    assert found.samples.t_ns.dtype == "int64"
    return Reading(len(found.samples), salvaged=bool(report.lost()))


def _solutions() -> tuple[bytes, ...]:
    baseline = "east e-baseline(m) n-baseline(m) u-baseline(m)"
    base = b"% ref pos   : 49.2 16.6 250.0\n"
    moved = [f"2313 {112107 + k}.250 {k}.5 100.0 5.0" for k in range(9)]
    return (
        logs.pos(*logs.pos_rows(20)).encode(),
        base + logs.pos(*moved, columns=baseline).encode("utf-8"),
        logs.pos(*logs.pos_rows(20)).encode("utf-16"),
    )


def _exports() -> tuple[bytes, ...]:
    sexagesimal = logs.exported(
        *(f" 05/06/2024 07:08:{9 + k:02d}.25 49 12 {k:02d}.0 -16 36 0.0 250.25" for k in range(20)),
        names="    UTCDate     UTCTime      Latitude   Longitude  H-Ell",
        units="      (MDY)       (HMS)  (+/-D M S) (+/-D M S)    (m)",
    )
    return (logs.exported_rows(20).encode(), sexagesimal.encode(), sexagesimal.encode("utf-16"))


def _logs() -> tuple[bytes, ...]:
    zda = logs.nmea("GNZDA,070809.00,06,05,2024,00,00")
    return (
        b"".join(logs.nav_pvt(k) + logs.nav_hpposllh(k) + logs.gga(k) for k in range(9)),
        logs.bestpos() * 5 + logs.inspvax() * 5 + logs.bestposa() * 3,
        zda + b"".join(map(logs.gga, range(20))),
    )


KINDS = (
    Kind(name="gnss-pos", file_name="a.pos", seeds=_solutions, read=_read, knows_end=False),
    Kind(name="gnss-text", file_name="a.txt", seeds=_exports, read=_read, knows_end=False),
    Kind(name="gnss-log", file_name="a.ubx", seeds=_logs, read=_read, knows_end=False),
    Kind(
        name="gnss-sbet",
        file_name="a.sbet",
        seeds=lambda: (logs.sbet(60),),
        read=_read,
        knows_end=False,
    ),
)
