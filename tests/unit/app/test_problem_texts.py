"""Every problem has a code and a text in each language."""

import ast
import pickle
import re
from collections import Counter
from typing import Annotated, Any, Literal

import pytest
from pydantic import BaseModel, Field, ValidationError, model_validator
from starlette.requests import HTTPConnection

from recon4 import errors
from recon4.errors import ConfigError, CorruptFile, StoreError, WrongSettings
from recon4.locales.coded import (
    FILES,
    KINDS,
    CodedText,
    StoredText,
    all_said,
    as_coded,
    coded,
    codes,
    said,
    stored_text,
    text_of,
)
from recon4.locales.languages import ENGLISH, ROOT, languages
from recon4.locales.texts import messages_of, texts
from recon4.settings import Settings, override
from recon4_app.compute_pool.messages import decode_error, encode_error
from recon4_app.error_responses import field_message
from recon4_app.errors import NotFound
from recon4_app.jobs.reason import in_language, reason_of
from recon4_app.network.close_codes import close_reason
from tests.source_trees import sources, trees_with

OTHERS = languages()[1:]
SAME = {
    "and-further",
    "where-why",
    "markers-skipped",
    "approved-refused",
    "serial-failed",
    "webhook-url",
    "recording-bag1",
    "recording-bag2",
    "missing-contents",
    "missing-imu-table",
    "zip-entry",
}
SAME |= {"missing-topic", "samples-sender", "samples-topic", "word-topic-imu", "rig-expects-topic"}
SAME |= {"info-head", "info-start", "held-one", "held-more", "detail-times", "detail-protocols"}
"""Codes whose text is the same in German."""


@pytest.mark.parametrize("language", OTHERS)
@pytest.mark.parametrize("file", FILES)
def test_every_code_is_said_in_each_language(language, file):
    english = messages_of(ROOT / ENGLISH / f"{file}.ftl")
    own = messages_of(ROOT / language / f"{file}.ftl")

    assert english.keys() == own.keys()
    assert {name for name in own if own[name].equals(english[name])} <= SAME


def test_a_websocket_closes_with_a_reason_in_the_language_that_ends_after_a_whole_character():
    browser = HTTPConnection({"type": "http", "headers": [(b"accept-language", b"de")]})

    assert close_reason(NotFound(CodedText("project-unknown", name="a")), browser).startswith(
        "kein"
    )
    english = HTTPConnection({"type": "http", "headers": []})
    assert close_reason(ConfigError("x" + "ü" * 99), english) == "x" + "ü" * 61


def test_no_code_is_in_two_files_or_a_text_of_all_pages():
    files = [list(messages_of(ROOT / ENGLISH / f"{file}.ftl")) for file in (*FILES, "shared")]
    counted = Counter(name for names in files for name in names)

    assert [name for name, count in counted.items() if count > 1] == []
    assert "project-unknown" in codes() and "word-entry-note" not in codes()


def test_a_text_is_english_and_is_said_again_in_another_language():
    text = CodedText("export-no-room", needed_bytes=12.34e9, free_bytes=20_405_504)

    assert text == "this export needs about 12.3 GB while it is made, 20 MB are free"
    assert said(text, "de").endswith("etwa 12,3 GB, frei sind 20 MB")
    assert said("as it is", "de") == "as it is"
    assert pickle.loads(pickle.dumps(text)).values == text.values


def test_a_text_that_another_one_quotes_is_said_in_its_language():
    busy = pickle.loads(pickle.dumps(CodedText("project-busy", detail=CodedText("disk-is-full"))))

    german = busy.said("de")

    assert german == f"jetzt nicht möglich: {CodedText('disk-is-full').said('de')}"
    assert busy == f"not now: {CodedText('disk-is-full')}"
    assert busy.said_values("de")["detail"] in german


def test_one_is_said_as_one():
    one, two = (CodedText("approve-conflicts", count=count) for count in (1, 2))

    assert one.startswith("1 accepted loop closure does not fit") and "them" not in one
    assert two.startswith("2 accepted loop closures do not fit")
    assert one.said("de").startswith("1 angenommener Schleifenschluss passt nicht")


def test_words_of_the_server_are_those_of_the_pages():
    text = CodedText("not-allowed", name="Jo", role="viewer", what="process")

    assert text == "Jo is a viewer here and may not process; ask an admin"
    assert text.said("de").startswith("Jo hat hier die Rolle Betrachter und darf nicht: verarbeit")
    weak = CodedText("password-weak", attempts=2e3, needed=10**8, weak="date repeat")
    assert "mostly a date or year; a repetition." in weak


def test_an_error_without_a_code_of_its_own_has_that_of_its_kind():
    error = coded(CorruptFile("walk.laz: not a sound LAS/LAZ file"))

    assert error.code == "kind-corrupt-file" and error == "walk.laz: not a sound LAS/LAZ file"
    assert error.values == {"detail": "walk.laz: not a sound LAS/LAZ file"}
    assert error.said("de").startswith("Eine Datei ist beschädigt") and error.endswith("LAZ file")
    assert coded(WrongSettings({"a": "b"})).values == {"detail": "b"}
    damaged = said(text_of(StoreError("map.json: no")), "de")
    assert damaged.endswith("nicht brauchbar (Meldung auf Englisch): map.json: no")
    assert coded(OSError("elsewhere")).code == "message" and text_of(OSError("it")) == "it"
    assert as_coded(error) is error


def test_every_kind_of_error_has_a_code():
    kinds = {one for one in vars(errors).values() if isinstance(one, type)}

    base_or_no_failure = {errors.Recon4Error, errors.Cancelled, errors.Path}
    assert kinds - base_or_no_failure - {WrongSettings} == set(KINDS)


def test_the_error_of_a_helper_process_keeps_its_code():
    there = ConfigError(CodedText("map-empty"))
    here = decode_error(encode_error(there))

    assert isinstance(here, ConfigError) and coded(here).said("de") == "die Karte hat keine Punkte"


def test_wrong_settings_are_said_in_a_language_each_and_together():
    with pytest.raises(WrongSettings) as refused:
        override(Settings(), ["map.voxel_m=thick", "ingest.rate_hz=0.1"])
    here = decode_error(encode_error(refused.value))
    assert isinstance(here, WrongSettings) and here.problems == refused.value.problems

    german = all_said(here.problems, "de")

    assert german["map.voxel_m"] == "map.voxel_m muss float sein, erhalten: 'thick'"
    assert german["ingest.rate_hz"].startswith("rate_hz muss 0 oder mindestens 0.5 sein")
    assert coded(here).said("de") == "; ".join(german.values())


def test_a_stored_code_that_says_nothing_now_leaves_the_english_text():
    assert stored_text("gone-since", {}, "it failed") == "it failed"
    assert stored_text("job-unknown", {}, "it failed") == "it failed"
    assert stored_text("job-unknown", {"job": "a1"}, "it failed") == "no job a1"


PLAIN = 59
"""Errors whose text is English only; most are of damaged files of our own."""
WHAT = re.compile(r'at_most\([^)]*what="([^"]+)"')


def test_no_further_error_is_said_in_english_only():
    kinds = {name for name, one in vars(errors).items() if isinstance(one, type)}
    plain = [
        f"{path}:{node.lineno}"
        for path, tree in trees_with("raise ", sources("recon4", "app"))
        for node in ast.walk(tree)
        if isinstance(node, ast.Raise)
        and isinstance(node.exc, ast.Call)
        and isinstance(node.exc.func, ast.Name)
        and node.exc.func.id in kinds
        and node.exc.args
        and isinstance(node.exc.args[0], ast.JoinedStr | ast.Constant)
    ]

    assert len(plain) <= PLAIN, "\n".join(["give it a CodedText:", *plain])


def test_what_is_started_too_often_is_named_in_each_language():
    started = {what for path in sources("app") for what in WHAT.findall(path.read_text("utf-8"))}

    assert "jobs" in started
    words = messages_of(ROOT / ENGLISH / "problems.ftl").keys()
    assert {f"word-started-{one}" for one in started} <= words


class _Asked(BaseModel):
    number: Annotated[int, Field(ge=1, le=9)] = 1
    length: Annotated[float, Field(gt=0.0, lt=5.0, allow_inf_nan=False)] = 1.0
    name: Annotated[str, Field(min_length=1, max_length=3, pattern="^[a-z]+$")] = "a"
    kind: Literal["a", "b"] = "a"
    yes: bool = True
    many: Annotated[list[int], Field(min_length=1, max_length=2)] = [1]
    by_name: dict[str, int] = {}

    @model_validator(mode="after")
    def _named(self) -> "_Asked":
        if self.name == "no":
            raise ValueError(CodedText("project-or-title"))
        return self


WRONG = [
    *({"number": value} for value in (0, 10, "x", 1.5, [])),
    *({"length": value} for value in (0.0, 9.0, "x", [], float("inf"))),
    *({"name": value} for value in ("", "long", "A", 3)),
    *({"many": value} for value in ([], [1, 2, 3], 5)),
    *({"kind": "c"}, {"yes": "perhaps"}, {"yes": []}, {"by_name": 3}),
]


def problem_of(given: dict[str, Any]) -> dict[str, Any]:
    with pytest.raises(ValidationError) as raised:
        _Asked.model_validate(given)
    return {**raised.value.errors()[0], "loc": ("body", *raised.value.errors()[0]["loc"])}


@pytest.mark.parametrize("given", WRONG, ids=str)
def test_what_is_wrong_with_a_field_is_said_in_each_language(given):
    problem, field = problem_of(given), next(iter(given))
    name = f"field-{problem['type']}"

    assert texts(ENGLISH, "problems")(name, **problem.get("ctx", {})) == problem["msg"]
    assert field_message(problem, ENGLISH) == f"{field}: {problem['msg']}"
    assert field_message(problem, "de").startswith(f"{field}: ")
    assert problem["msg"] not in field_message(problem, "de")


def test_a_rule_of_our_own_is_said_too():
    problem = problem_of({"name": "no"})

    assert field_message(problem, "de").endswith("project oder title angeben")
    assert field_message(problem, ENGLISH).endswith("a project needs a name: give project or title")


def test_what_a_text_quotes_keeps_its_code_in_a_file_and_through_the_compute_pool():
    deepest = CodedText("capture-map-stopped")
    text = CodedText("project-busy", detail=CodedText("approve-damaged", detail=deepest))
    job, file = reason_of(text), StoredText.of(text)
    assert job is not None

    pooled = coded(decode_error(encode_error(ConfigError(text)))).said("de")

    assert pooled == text.said("de") and deepest.said("de") in pooled
    assert in_language(job, str(text), "de") == file.said("de") == pooled
    assert file.said(ENGLISH) == str(text)


def test_values_that_nest_without_end_are_cut():
    names = [":".join(["detail"] * depth) for depth in range(1, 700)]
    hostile = {name: "busy" for name in names} | {f"{name}:": "project-busy" for name in names}

    assert stored_text("project-busy", hostile, "") == 9 * "not now: " + "busy"
