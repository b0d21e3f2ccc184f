"""The pages of the documentation: links, paths, modules, routes, settings and commands exist."""

import re
import shlex
import tomllib
from dataclasses import fields
from functools import cache
from pathlib import Path

import pytest
from rich.text import Text
from typer.main import get_command

from recon4.cli.main import app
from recon4.model.rig import parse_rig
from recon4.settings import Settings
from recon4_app.access.routes_check import declared
from recon4_app.main import create_app
from recon4_app.settings import ServerSettings

ROOT = Path(__file__).parents[2]
IN_DOCS = sorted((ROOT / "docs").rglob("*.md"))
PAGES = [*sorted(ROOT.glob("*.md")), *IN_DOCS]
COMMANDS = get_command(app)

SOURCES = [
    f"/{path.relative_to(ROOT)}"
    for top in ("recon4", "app", "tests", "tools", "examples")
    for path in (ROOT / top).rglob("*.py")
]

LINK = re.compile(r"\]\(([^)\s]+)\)|<img src=\"([^\"]+)\"")
REPOSITORY_PATH = re.compile(
    r"(?<![\w./-])(?:recon4|app|web|tests|tools|docs|examples)/[\w./{},*-]*\w[}/]?"
)
PYTHON_FILE = re.compile(r"(?<![\w./*{},-])[\w/]+\.py\b")
MODULE = re.compile(r"`((?:recon4|recon4_app)(?:\.\w+)+)")
ROUTE = re.compile(r"(?:^|`)(GET|HEAD|POST|PUT|PATCH|DELETE) +(/api[\w/<>{}.-]*)", re.MULTILINE)
SETTING = re.compile(r"`(?:--set )?(\w+)\.(\w+)(?: ?=[^`]*)?`")
IDENTIFIER = re.compile(r"`([A-Za-z_][\w.]*(?:\([^`\n]*)?)`")
INVENTED = {"run_x", "g_beam", "H_k", "g_k"}
"""Names that stand for others: an example, symbols of equations."""
SUFFIXES = {
    "json",
    "ftl",
    "npz",
    "npy",
    "g2o",
    "laz",
    "csv",
    "tum",
    "toml",
    "py",
    "las",
    "png",
    "yaml",
}
CODE = re.compile(r"^```\w*\n(.*?)^```|`([^`\n]+)`|^ {4}(\S[^\n]*)$", re.MULTILINE | re.DOTALL)
TYPED = re.compile(r"^recon4 ([a-z][^\n#]*)", re.MULTILINE)
PAGE_OF_DOCS = re.compile(r"\bdocs/[\w/-]+\.md\b")
BENCHMARK = re.compile(
    r"python -m ((?:tests\.benchmarks|tools)\.\w+)|python (tests/\S+\.py|examples/\S+\.py)"
)


@pytest.fixture(params=PAGES, ids=lambda path: path.relative_to(ROOT).as_posix())
def page(request):
    return request.param


def headings(path):
    """The anchors of a page."""
    titles = re.findall(r"^#+ (.*)$", path.read_text("utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def test_links_of_a_page_lead_somewhere(page):
    missing = []
    for target in ("".join(found) for found in LINK.findall(page.read_text("utf-8"))):
        file, _, anchor = target.partition("#")
        path = page.parent / file if file else page
        if ":" not in target and not (path.exists() and anchor in {"", *headings_of(path)}):
            missing.append(target)

    assert missing == []


def headings_of(path):
    return headings(path) if path.suffix == ".md" else set()


def test_paths_a_page_names_exist(page):
    code = " ".join("".join(found) for found in CODE.findall(page.read_text("utf-8")))
    paths = [path for text in REPOSITORY_PATH.findall(code) for path in expanded(text)]

    assert [path for path in paths if not any(ROOT.glob(path))] == []


def test_pages_that_the_code_names_exist():
    trees = (*("recon4", "app", "tools", "tests", "web"),)
    files = [f for tree in trees for f in (ROOT / tree).rglob("*") if f.suffix in {".py", ".js"}]
    named = [(f, one) for f in files for one in PAGE_OF_DOCS.findall(f.read_text("utf-8"))]

    assert len(named) > 30
    assert [(f.name, one) for f, one in named if not (ROOT / one).exists()] == []


def expanded(path):
    """``a/{b,c}.py`` as the paths it stands for: ``a/b.py`` and ``a/c.py``."""
    before, brace, rest = path.partition("{")
    choices, _, after = rest.partition("}")
    return [before + one + after for one in choices.split(",")] if brace else [path]


def test_python_files_a_page_names_exist(page):
    named = [
        name
        for code in re.findall(r"`([^`\n]+)`", page.read_text("utf-8"))
        for name in PYTHON_FILE.findall(code)
    ]

    assert [name for name in named if not any(file.endswith(f"/{name}") for file in SOURCES)] == []


def test_modules_and_their_names_a_page_names_exist(page):
    named = MODULE.findall(page.read_text("utf-8"))

    assert [name for name in named if not is_module(name) and not is_defined(name)] == []


def is_module(name):
    home = ROOT / "app" if name.startswith("recon4_app") else ROOT
    path = home.joinpath(*name.split("."))
    return path.is_dir() or path.with_suffix(".py").is_file()


def is_defined(name):
    """Whether a module defines the last part of a dotted name at its top level."""
    module, _, last = name.rpartition(".")
    home = ROOT / "app" if name.startswith("recon4_app") else ROOT
    file = home.joinpath(*module.split(".")).with_suffix(".py")
    defined = rf"^(?:def |class |async def )?{last}\b"
    return file.is_file() and re.search(defined, file.read_text("utf-8"), re.MULTILINE) is not None


def test_settings_a_page_names_exist(page):
    groups = {group.name: group for group in fields(Settings)}
    named = {
        (group, name)
        for group, name in SETTING.findall(page.read_text("utf-8"))
        if group in groups and name not in SUFFIXES
    }
    defaults = Settings()

    assert [found for found in named if not hasattr(getattr(defaults, found[0]), found[1])] == []


def test_names_of_the_code_in_a_page_exist(page):
    named = {
        name
        for code in IDENTIFIER.findall(page.read_text("utf-8"))
        if code.rpartition(".")[2] not in SUFFIXES
        for name in re.findall(r"\w+", code.partition("(")[0])
        if "_" in name.strip("_") or re.search("[a-z][A-Z]", name)
    }

    assert sorted(name for name in named - INVENTED if name not in all_code()) == []


def test_architecture_names_every_top_level_module():
    page = (ROOT / "docs" / "explanation" / "architecture.md").read_text("utf-8")
    modules = {
        path.name for top in ("recon4", "app/recon4_app") for path in (ROOT / top).glob("[!_]*.py")
    }

    absent = sorted(name for name in modules if not re.search(rf"[ `/]{name}[ `]", page))
    assert not absent, f"name modules in docs/explanation/architecture.md: {absent}"


@cache
def all_code():
    """The Python and JavaScript files of the repository as one text."""
    tops = [ROOT / top for top in ("recon4", "app", "web", "tests", "tools", "examples")]
    files = [path for top in tops for path in top.rglob("*") if path.suffix in {".py", ".js"}]
    return "".join(path.read_text("utf-8") for path in files if path.name != "test_docs.py")


@pytest.fixture(scope="module")
def routes(tmp_path_factory):
    """Method and path of every route of the server, names of parameters left out."""
    server = create_app(ServerSettings(root=tmp_path_factory.mktemp("nothing")))
    return {
        (method, unnamed(route.path))
        for route in declared(server)
        for method in route.methods or {"GET"}
    }


def unnamed(path):
    return re.sub(r"<[^>]*>|\{[^}]*\}", "{}", path)


def test_routes_a_page_names_exist(page, routes):
    named = ROUTE.findall(page.read_text("utf-8"))

    assert [found for found in named if (found[0], unnamed(found[1])) not in routes] == []


def test_programs_in_the_commands_of_a_page_exist(page):
    found = BENCHMARK.findall(page.read_text("utf-8"))
    files = [module.replace(".", "/") + ".py" if module else file for module, file in found]

    assert [file for file in files if not (ROOT / file).is_file()] == []


def test_commands_of_a_page_exist_with_their_options(page):
    assert [line for line in typed(page.read_text("utf-8")) if not known(line)] == []


def typed(text):
    """The text after ``recon4`` in the code of a page, in blocks and in lines."""
    return [line for code in CODE.findall(text) for line in TYPED.findall("".join(code))]


def known(line):
    """Whether the command exists and has all these options."""
    words = shlex.split(line.replace("…", " ").replace("|", " "))
    command = COMMANDS
    while words and words[0] in getattr(command, "commands", {}):
        command = command.commands[words.pop(0)]
    options = {name for one in command.params for name in (*one.opts, *one.secondary_opts)}
    options_given = {word.partition("=")[0] for word in words if word.startswith("--")}
    return command is not COMMANDS and options_given <= options | {"--help"}


def test_the_rig_file_of_its_page_is_valid():
    (example,) = re.findall(
        r"```toml\n(.*?)```", (ROOT / "docs/reference/rig.md").read_text("utf-8"), re.DOTALL
    )

    assert [one.name for one in parse_rig(example, where="rig.md").sensors] == [
        "horizontal",
        "vertical",
    ]


def test_every_page_has_one_place_in_the_contents_of_the_site():
    contents = tomllib.loads((ROOT / "zensical.toml").read_text("utf-8"))["project"]["nav"]

    assert sorted(pages_in(contents)) == [f"{one.relative_to(ROOT / 'docs')}" for one in IN_DOCS]


def pages_in(entry):
    """The pages of an entry of the contents and of all below it."""
    if isinstance(entry, str):
        return [entry]
    below = entry.values() if isinstance(entry, dict) else entry
    return [page for one in below for page in pages_in(one)]


@pytest.mark.parametrize("page", IN_DOCS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_a_page_of_the_site_links_to_no_file_outside_of_it(page):
    """It is read where there is no checkout."""
    docs = ROOT / "docs"
    targets = ["".join(found).partition("#")[0] for found in LINK.findall(page.read_text("utf-8"))]
    local = [target for target in targets if target and ":" not in target]

    assert [one for one in local if docs not in (page.parent / one).resolve().parents] == []


def test_help_texts_contain_no_markup():
    def helps(command):
        below = getattr(command, "commands", {}).values()
        own = [command.help, *(getattr(one, "help", None) for one in command.params)]
        return [*filter(None, own), *(text for one in below for text in helps(one))]

    texts = helps(COMMANDS)

    assert len(texts) > 50
    assert [text for text in texts if Text.from_markup(text).plain != text] == []


def test_the_patterns_of_these_tests_find_what_they_should():
    assert known("slice walk cut.png --z 1.5")
    assert known("users add NAME --role admin --root ROOT")
    assert not known("slize walk cut.png")
    assert not known("slice walk cut.png --height 1.5")
    assert typed("a `recon4 fly` and\n    recon4 walk  # x\nrecon4 reads") == ["fly", "walk  "]
    assert typed("```sh\nrecon4 run\n```\nrecon4 reads") == ["run"]
    assert REPOSITORY_PATH.findall(
        "see recon4/geometry/{se3,mesh}.py, app/recon4_app/live/ and /app/x"
    ) == [
        "recon4/geometry/{se3,mesh}.py",
        "app/recon4_app/live/",
    ]
    assert expanded("recon4/{a,b}.py") == ["recon4/a.py", "recon4/b.py"]
    assert PYTHON_FILE.findall("se3.py, velodyne/models.py; test_x*.py") == [
        "se3.py",
        "velodyne/models.py",
    ]
    assert is_module("recon4.pipeline") and is_defined("recon4.pipeline.process")
    assert not is_module("recon4.pipelines") and not is_defined("recon4.pipeline.processes")
    assert ROUTE.findall("| `POST /api/a/<id>` | x\nGET    /api/b?c=d") == [
        ("POST", "/api/a/<id>"),
        ("GET", "/api/b"),
    ]
    assert IDENTIFIER.findall("`a.b_c(d)`, `e_f` and `g h`") == ["a.b_c(d)", "e_f"]
    assert SETTING.findall("`map.voxel_m=0.05`, `--set a.b=c`, `graph.mode`") == [
        ("map", "voxel_m"),
        ("a", "b"),
        ("graph", "mode"),
    ]
