"""The architecture as a test: who may import whom, and where heavy packages live.

The table in ``docs/explanation/architecture.md`` says the same in words.
"""

import ast
import re
import subprocess
import sys
import tomllib
from functools import cache
from importlib import metadata
from pathlib import Path

from packaging.requirements import Requirement

ROOT = Path(__file__).parents[2]
BASE = {
    "recon4.errors",
    "recon4.locales",
    "recon4.units",
    "recon4.untrusted",
    "recon4.progress",
    "recon4.settings",
}
MODEL = BASE | {"recon4.geometry", "recon4.model"}
STAGE = MODEL | {"recon4.kernels", "recon4.store"}
WORDED = STAGE | {"recon4.recording", "recon4.findings.derived", "recon4.findings.wording"}
SOLVED = ("files", "inverses", "solve", "verification")
ORDERING = STAGE | {"recon4.orders.order", "recon4.orders.parts"}

MAY_IMPORT = {
    "recon4/errors.py": set(),
    "recon4/units.py": set(),
    "recon4/locales": {"recon4.errors", "recon4.locales"},
    "recon4/untrusted": {"recon4.errors", "recon4.locales", "recon4.untrusted"},
    "recon4/system": {"recon4.errors", "recon4.locales", "recon4.sandbox", "recon4.system"},
    "recon4/system/compile_kernels.py": {"recon4.kernels.signatures", "recon4.progress"}
    | {"recon4.sandbox", "recon4.store.locks", "recon4.system"},
    "recon4/archive": STAGE | {"recon4.archive", "recon4.review"},
    "recon4/progress.py": {"recon4.errors", "recon4.model.events"},
    "recon4/settings": {"recon4.errors", "recon4.locales", "recon4.settings"},
    "recon4/executors": {"recon4.errors", "recon4.executors", "recon4.locales"},
    "recon4/executors/chosen.py": {"recon4.errors", "recon4.executors", "recon4.locales"}
    | {"recon4.store.atomic", "recon4.store.json_files", "recon4.untrusted.typed"},
    "recon4/orders": {"recon4.errors", "recon4.orders", "recon4.executors.executor"}
    | {"recon4.store.package_versions", "recon4.sandbox", "recon4.system.processes"}
    | {"recon4.untrusted", "recon4.progress", "recon4.model.events"},
    "recon4/orders/child.py": {"recon4"},
    "recon4/orders/maker.py": {"recon4.orders", "recon4.sandbox", "recon4.system.processes"}
    | {"recon4.recording.formats.scratch", "recon4.mapping.tile_files", "recon4.untrusted"}
    | {"recon4.classes.stage", "recon4.pose_graph.pair_maker"},
    "recon4/batch": MODEL
    | {"recon4.batch", "recon4.executors", "recon4.export.cells", "recon4.store"}
    | {"recon4.recording.kinds", "recon4.recording.info.nearby_samples"}
    | {"recon4.system.processes", "recon4.system.stopping"},
    "recon4/batch/child.py": {"recon4"},
    "recon4/geometry": {"recon4.geometry"},
    "recon4/model": MODEL,
    "recon4/kernels": {"recon4.kernels", "recon4.units"},
    "recon4/sandbox": {"recon4.sandbox", "recon4.kernels.processor"},
    "recon4/store": MODEL | {"recon4.kernels.packing", "recon4.store"},
    "recon4/recording": STAGE | {"recon4.recording"},
    "recon4/recording/info/records.py": WORDED,
    "recon4/recording/report.py": WORDED,
    "recon4/live": STAGE
    | {"recon4.live", "recon4.registration", "recon4.sandbox", "recon4.system.runtime_folder"}
    | {"recon4.system.processes", "recon4.system.stopping"}
    | {f"recon4.recording.{name}" for name in ("ingest", "kinds", "report", "sources")}
    | {f"recon4.recording.lasers.{name}" for name in ("scan_capture", "scan_replay")}
    | {"recon4.recording.formats.datagrams", "recon4.recording.formats.pcap"}
    | {f"recon4.recording.samples.{name}" for name in ("clean", "measured_channels")}
    | {f"recon4.recording.packets.{name}" for name in ("replay", "sensor_clock", "velodyne.models")}
    | {"recon4.slam2d", "recon4.pose_graph.tuning", "recon4.profiler.tuning"}
    | {f"recon4.findings.{name}" for name in ("imu_axes", "verdict", "wording")},
    "recon4/live/project_files.py": STAGE
    | {"recon4.live", "recon4.workflows.stages", "recon4.workflows.planar"},
    "recon4/registration": MODEL | {"recon4.kernels", "recon4.registration"},
    "recon4/registration/stage.py": MODEL
    | {"recon4.registration", "recon4.store.arrays", "recon4.store.tried_hypotheses"},
    "recon4/pose_graph": ORDERING | {"recon4.registration", "recon4.pose_graph"},
    "recon4/slam2d": STAGE | {"recon4.slam2d", *(f"recon4.pose_graph.{name}" for name in SOLVED)},
    "recon4/slam2d/stage.py": STAGE
    | {"recon4.slam2d", "recon4.pose_graph.files"}
    | {f"recon4.recording.{name}" for name in ("lasers.laser2d", "lasers.mount", "report")},
    "recon4/calibration": STAGE
    | {"recon4.calibration", "recon4.registration", "recon4.semi_rigid.knots"}
    | {"recon4.mapping.undistort", "recon4.georeference.antenna_calibration"},
    "recon4/semi_rigid": STAGE | {"recon4.registration", "recon4.pose_graph", "recon4.semi_rigid"},
    "recon4/profiler": STAGE
    | {f"recon4.{room}" for room in ("registration", "pose_graph", "slam2d", "semi_rigid")}
    | {"recon4.profiler"},
    "recon4/georeference": STAGE
    | {"recon4.mapping", "recon4.pose_graph", "recon4.georeference"}
    | {f"recon4.registration.{name}" for name in ("aiding", "tuning")},
    "recon4/review": STAGE
    | {f"recon4.{room}" for room in ("registration", "pose_graph", "mapping", "profiler")}
    | {"recon4.review", "recon4.slam2d", "recon4.report.approval"}
    | {f"recon4.findings.{name}" for name in ("summary_notes", "review_problems", "wording")},
    "recon4/review/class_corrections.py": STAGE
    | {"recon4.classes.corrections", "recon4.classes.likeness"}
    | {"recon4.mapping.tiles", "recon4.review"},
    "recon4/intensity": STAGE | {"recon4.mapping", "recon4.intensity"},
    "recon4/mapping": ORDERING | {"recon4.mapping", "recon4.sandbox.freed_memory"},
    "recon4/classes": ORDERING | {"recon4.mapping", "recon4.classes"},
    "recon4/export": STAGE
    | {"recon4.mapping", "recon4.export"}
    | {f"recon4.recording.formats.{name}" for name in ("cloud_files", "three_dtk")},
    "recon4/export/map_files.py": STAGE
    | {"recon4.mapping", "recon4.export", "recon4.georeference", "recon4.review"}
    | {"recon4.pose_graph.files", "recon4.products.storeys", "recon4.recording.formats.poses"},
    "recon4/export/geopackage.py": STAGE | {"recon4.export", "recon4.georeference"},
    "recon4/export/geojson.py": STAGE | {"recon4.georeference"},
    "recon4/export/notes.py": STAGE | {"recon4.export", "recon4.georeference"},
    "recon4/export/bcf.py": STAGE
    | {"recon4.export", "recon4.georeference", "recon4.slices.map_crs"},
    "recon4/export/findings.py": STAGE
    | {"recon4.export", "recon4.findings.summary_notes", "recon4.georeference"}
    | {"recon4.review.state"},
    "recon4/export/scan_files.py": STAGE
    | {"recon4.mapping", "recon4.export", "recon4.pose_graph", "recon4.profiler"},
    "recon4/evaluation": STAGE
    | {"recon4.mapping", "recon4.evaluation", "recon4.simulation", "recon4.recording.tables"}
    | {f"recon4.recording.formats.{name}" for name in ("cloud_files", "cloud_headers", "poses")}
    | {"recon4.recording.report"},
    "recon4/findings": MODEL | {"recon4.findings"},
    "recon4/findings/witnesses": STAGE
    | {"recon4.findings", "recon4.pose_graph", "recon4.registration", "recon4.slam2d"}
    | {"recon4.georeference.antenna_audit"},
    "recon4/findings/audit.py": STAGE | {"recon4.findings"},
    "recon4/findings/walk_record.py": STAGE | {"recon4.findings", "recon4.pose_graph"},
    "recon4/findings/planar_walk.py": STAGE
    | {"recon4.findings", "recon4.pose_graph", "recon4.slam2d"},
    "recon4/findings/accuracy.py": MODEL | {"recon4.findings", "recon4.evaluation"},
    "recon4/findings/explain.py": MODEL | {"recon4.findings", "recon4.cli.terminal"},
    "recon4/slices": STAGE
    | {f"recon4.{room}" for room in ("recording", "mapping", "georeference", "export")}
    | {"recon4.evaluation", "recon4.slices"},
    "recon4/comparison": STAGE
    | {"recon4.comparison", "recon4.export.laz", "recon4.mapping", "recon4.review.approved"}
    | {f"recon4.slices.{name}" for name in ("align", "map_crs", "reference")},
    "recon4/products": STAGE
    | {f"recon4.{room}" for room in ("mapping", "products", "slices")}
    | {"recon4.review.stamp"},
    "recon4/first_view": STAGE
    | {"recon4.first_view", "recon4.mapping", "recon4.products.storeys", "recon4.slices.map_crs"},
    "recon4/slices/site_control.py": STAGE
    | {"recon4.georeference", "recon4.slices"}
    | {f"recon4.pose_graph.{name}" for name in ("files", "uncertainty_files")}
    | {"recon4.evaluation.site_control"},
    "recon4/report": STAGE
    | {"recon4.mapping", "recon4.pose_graph", "recon4.evaluation", "recon4.report"}
    | {"recon4.findings"},
    "recon4/delivery": STAGE
    | {"recon4.delivery", "recon4.export", "recon4.report", "recon4.review"}
    | {"recon4.mapping.tiles", "recon4.products", "recon4.slices.map_crs"},
    "recon4/delivery/geopackage_layers.py": STAGE
    | {"recon4.delivery", "recon4.evaluation.site_control", "recon4.export", "recon4.review"}
    | {"recon4.findings.summary_notes", "recon4.georeference.crs_file"}
    | {"recon4.mapping.tiles", "recon4.slices.doubles"},
    "recon4/simulation": STAGE | {"recon4.recording", "recon4.simulation"},
    "recon4/workflows": {"recon4"},
    "recon4": {"recon4"},
    "recon4/api": STAGE
    | {f"recon4.{room}" for room in ("api", "evaluation", "findings", "mapping", "recording")}
    | {f"recon4.{room}" for room in ("review", "simulation", "slices", "pose_graph.files")}
    | {"recon4.pipeline", "recon4.export.map_files", "recon4.cli.kernel_cache"},
    "recon4/cli/main.py": {"recon4", "recon4_app.cli"},
    "app/recon4_app/cli/users.py": {"recon4.errors", "recon4.locales", "recon4_app"}
    | {"recon4.cli.terminal", "recon4.archive.verify"},
    "app": {"recon4_app", "recon4"},
}
"""Place -> prefixes of our own modules it may import; the longest place that fits counts."""

NOBODY_IMPORTS = {
    "recon4.cli.main": {"recon4/__main__.py"},
    "recon4.pipeline": {
        "recon4/api/running.py",
        "recon4/cli/main.py",
        "recon4/cli/classify.py",
        "recon4/cli/control.py",
        "recon4/cli/findings.py",
        "recon4/workflows/calibration_methods.py",
        "app/recon4_app/cli/serve.py",
        "app",
    },
}
"""The two ends of the program, and who may call them."""

ONLY_HERE = {
    "serial": {"recon4/live/recorder/serial_port.py"},
    "gtsam": {"recon4/pose_graph/factors.py"},
    "distributed": {"recon4/executors/cluster.py"},
    "open3d": {"recon4/geometry/raycast.py"},
    "laspy": {f"recon4/export/{name}.py" for name in ("copc", "las_points", "laz")}
    | {f"recon4/recording/formats/{name}.py" for name in ("las_records", "cloud_crs")}
    | {"recon4/recording/mandeye/write.py"},
    "ctypes": {"recon4/sandbox"},
    "viser": {
        "app/recon4_app/viewer/client/show.py",
        "app/recon4_app/viewer/client/panels.py",
        "app/recon4_app/viewer/client/widget_values.py",
        "app/recon4_app/viewer/unix_socket.py",
        "app/recon4_app/viewer/wakeups.py",
    },
    "matplotlib": {
        "recon4/report",
        "recon4/slices/colors.py",
        "recon4/slices/sheet.py",
        "app/recon4_app/viewer/cloud/palette.py",
    },
    "ezdxf": {
        "recon4/slices/export.py",
        "recon4/products/drawing.py",
        "recon4/recording/tables/dxf_points.py",
    },
    "shapely": {"recon4/products", "recon4/model/volumes.py"},
    "fastapi": {"app"},
    "uvicorn": {"app"},
    "typer": {"recon4/cli", "app/recon4_app/cli"},
    "cryptography": {"app/recon4_app/network/certificate.py"}
    | {f"recon4/review/{name}.py" for name in ("certificate", "signature")},
    "mcp": {"app/recon4_app/assistant"},
    "httpx2": {"app/recon4_app/assistant/http_client.py", "app/recon4_app/assistant/in_process.py"},
    "h11": {"app/recon4_app/webhooks/post.py"},
    "typst": {"recon4/report/pdf.py"},
    "pyhanko": {"recon4/delivery/pdf_signature.py", "recon4/report/pdf.py"},
    "argon2": {"app/recon4_app/access/login/passwords.py"},
    "rich": {"recon4/cli/terminal.py"},
    "sqlite3": {
        "recon4/archive/backup.py",
        "recon4/export/geopackage.py",
        "recon4/store",
        "recon4/recording",
        "recon4/review",
        "app",
    },
}
"""Heavy or revealing packages -> the only modules that may import them."""

NEVER = {"pickle", "marshal", "shelve", "yaml", "cPickle", "dill", "cloudpickle"}
"""Loading these from a file of unknown origin runs its code."""
ONLY_TO_CHILDREN = Path("app/recon4_app/compute_pool/messages.py")
"""The server sends calls to its children as pickles; nothing comes back as one."""

SOURCES = [
    path.relative_to(ROOT) for top in ("recon4", "app") for path in (ROOT / top).rglob("*.py")
]


@cache
def imported(path: Path) -> frozenset[str]:
    """Modules a file imports anywhere in it; ``from x import y`` is ``x.y`` if that is a module."""
    names: set[str] = set()
    for node in ast.walk(ast.parse((ROOT / path).read_text("utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            names |= {_module(node.module or "", alias.name) for alias in node.names}
    return frozenset(names)


def _module(package: str, name: str) -> str:
    home = ROOT / "app" if package.startswith("recon4_app") else ROOT
    whole = home.joinpath(*package.split("."), name)
    return f"{package}.{name}" if whole.with_suffix(".py").exists() or whole.is_dir() else package


def under(path: Path, places: set[str]) -> bool:
    text = path.as_posix()
    return any(text == place or text.startswith(f"{place}/") for place in places)


def allowed(name: str, prefixes: set[str]) -> bool:
    # The package itself holds nothing but its version.
    return name == "recon4" or any(
        name == prefix or name.startswith(f"{prefix}.") for prefix in prefixes
    )


def test_imports_follow_the_layers():
    layer = {
        path: max((place for place in MAY_IMPORT if under(path, {place})), key=len)
        for path in SOURCES
    }

    assert [
        (str(path), name)
        for path in SOURCES
        for name in imported(path)
        if name.split(".")[0] in {"recon4", "recon4_app", "recon4_web"}
        and not allowed(name, MAY_IMPORT[layer[path]])
    ] == []


def test_heavy_packages_stay_in_their_home():
    assert [
        (str(path), package)
        for path in SOURCES
        for package in {name.split(".")[0] for name in imported(path)} & ONLY_HERE.keys()
        if not under(path, ONLY_HERE[package])
    ] == []


def test_the_ends_of_the_program_are_called_from_outside_only():
    assert [
        (str(path), module)
        for path in SOURCES
        for module in imported(path) & NOBODY_IMPORTS.keys()
        if not under(path, NOBODY_IMPORTS[module])
    ] == []


def test_nothing_that_runs_code_from_files_is_imported():
    assert [
        (path, name) for path in SOURCES for name in imported(path) if name.split(".")[0] in NEVER
    ] == [(ONLY_TO_CHILDREN, "pickle")]


def test_nothing_imports_the_whole_of_scipy_stats():
    """It alone would be a third of the start of every process that runs stages or serves."""
    slow = [path for path in SOURCES if "scipy.stats" in (ROOT / path).read_text("utf-8")]

    assert [path for path in slow if any(n.startswith("scipy.stats") for n in imported(path))] == []


def test_the_page_names_every_package():
    page = (ROOT / "docs" / "explanation" / "architecture.md").read_text("utf-8")
    packages = {
        path.parent.name
        for top in ("recon4", "app/recon4_app")
        for path in (ROOT / top).glob("*/__init__.py")
    }

    absent = {package for package in packages if not re.search(rf"\b{package}/", page)}
    assert not absent, f"give rooms a row in docs/explanation/architecture.md: {absent}"


def test_every_package_imported_is_named_in_pyproject():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    texts = list(project["dependencies"])
    for extra in ("pdf", "dask", "mcp"):
        texts += project["optional-dependencies"][extra]
    named = {_distribution(Requirement(text).name) for text in texts}
    homes = metadata.packages_distributions()

    used = {name.split(".")[0] for path in SOURCES for name in imported(path)}
    foreign = used - sys.stdlib_module_names - {"recon4", "recon4_app"}

    found = {name: {_distribution(home) for home in homes.get(name, [])} for name in foreign}
    assert {name for name, distributions in found.items() if not distributions & named} == set()


def _distribution(name: str) -> str:
    """As names of distributions are compared."""
    return re.sub(r"[-_.]+", "-", name).lower()


def test_the_command_line_starts_without_the_heavy_packages():
    heavy = [
        "numpy",
        "scipy",
        "numba",
        "gtsam",
        "open3d",
        "matplotlib",
        "viser",
        "fastapi",
        "rosbags",
    ]
    program = f"import sys, recon4.cli.main; print([n for n in {heavy} if n in sys.modules])"

    assert _output_of(program) == "[]\n"


def test_server_and_viewer_start_without_what_only_computing_needs():
    heavy = [
        "scipy.ndimage",
        "scipy.sparse",
        "scipy.linalg",
        "laspy",
        "pyproj",
        "open3d",
        "matplotlib",
        "ezdxf",
        "gtsam",
    ]
    load = "import sys, recon4_app.main, recon4_app.viewer.process"
    program = f"{load}; print([n for n in {heavy} if n in sys.modules])"

    assert _output_of(program) == "[]\n"


def _output_of(program: str) -> str:
    return subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True, cwd=ROOT
    ).stdout
