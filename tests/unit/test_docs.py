"""The pages of the documentation: what they name is there, what they tell to type is understood."""

import re
import shlex
from pathlib import Path

import pytest
from rich.text import Text
from typer.main import get_command

from recon4.cli.main import app
from recon4.model.rig import parse_rig

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
COMMANDS = get_command(app)

LINK = re.compile(r"\]\(([^)\s]+)\)|<img src=\"([^\"]+)\"")
OUR_FILE = re.compile(r"`((?:recon4|app|web|tests|docs)/[\w./-]+)`")
CODE = re.compile(r"^```\w*\n(.*?)^```|`([^`\n]+)`|^ {4}(\S[^\n]*)$", re.MULTILINE | re.DOTALL)
TYPED = re.compile(r"^recon4 ([a-z][^\n#]*)", re.MULTILINE)
BENCHMARK = re.compile(r"python -m (tests\.benchmarks\.\w+)|python (tests/\S+\.py|docs/\S+\.py)")


@pytest.fixture(params=PAGES, ids=lambda path: path.name)
def page(request):
    return request.param


def headings(path):
    """The anchors of a page."""
    titles = re.findall(r"^#+ (.*)$", path.read_text("utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def test_what_a_page_links_to_is_there(page):
    missing = []
    for target in ("".join(found) for found in LINK.findall(page.read_text("utf-8"))):
        file, _, anchor = target.partition("#")
        path = page.parent / file if file else page
        if ":" not in target and not (path.exists() and anchor in {"", *headings_of(path)}):
            missing.append(target)

    assert missing == []


def headings_of(path):
    return headings(path) if path.suffix == ".md" else set()


def test_files_a_page_names_are_there(page):
    named = OUR_FILE.findall(page.read_text("utf-8"))

    assert [name for name in named if not (ROOT / name).exists()] == []


def test_programs_a_page_tells_to_run_are_there(page):
    found = BENCHMARK.findall(page.read_text("utf-8"))
    files = [module.replace(".", "/") + ".py" if module else file for module, file in found]

    assert [file for file in files if not (ROOT / file).is_file()] == []


def test_commands_of_a_page_exist_with_their_options(page):
    assert [line for line in typed(page.read_text("utf-8")) if not known(line)] == []


def typed(text):
    """What comes after recon4 in the code of a page, be it a block or a few words."""
    return [line for code in CODE.findall(text) for line in TYPED.findall("".join(code))]


def known(line):
    """Whether there is such a command and it has all these options."""
    words = shlex.split(line.replace("…", " ").replace("|", " "))
    command = COMMANDS
    while words and words[0] in getattr(command, "commands", {}):
        command = command.commands[words.pop(0)]
    options = {name for one in command.params for name in (*one.opts, *one.secondary_opts)}
    asked = {word.partition("=")[0] for word in words if word.startswith("--")}
    return command is not COMMANDS and asked <= options | {"--help"}


def test_the_rig_file_of_its_page_is_one():
    (example,) = re.findall(
        r"```toml\n(.*?)```", (ROOT / "docs/rig.md").read_text("utf-8"), re.DOTALL
    )

    assert [one.name for one in parse_rig(example, where="rig.md").sensors] == [
        "horizontal",
        "vertical",
    ]


def test_every_page_can_be_reached_from_the_readme():
    readme = PAGES[0].read_text("utf-8")

    assert [one.name for one in PAGES[1:] if f"(docs/{one.name}" not in readme] == []


def test_no_word_of_a_help_text_is_taken_for_markup():
    def helps(command):
        below = getattr(command, "commands", {}).values()
        own = [command.help, *(getattr(one, "help", None) for one in command.params)]
        return [*filter(None, own), *(text for one in below for text in helps(one))]

    texts = helps(COMMANDS)

    assert len(texts) > 50
    assert [text for text in texts if Text.from_markup(text).plain != text] == []


def test_the_tests_own_eye_is_sharp():
    assert known("slice walk cut.png --z 1.5")
    assert known("users add NAME --role admin --root ROOT")
    assert not known("slize walk cut.png")
    assert not known("slice walk cut.png --height 1.5")
    assert typed("a `recon4 fly` and\n    recon4 walk  # x\nrecon4 reads") == ["fly", "walk  "]
    assert typed("```sh\nrecon4 run\n```\nrecon4 reads") == ["run"]
