"""The audit log names what was done in the language of who reads it."""

import ast
import re
from pathlib import Path

from recon4.locales.languages import ENGLISH, ROOT
from recon4.locales.texts import messages_of, texts
from recon4_app.access.people import Permission

APP = Path(__file__).parents[3] / "app"
WRITING = {"audit": 1, "note": 1, "_changing": 1}
"""Functions that write an entry, and which of their arguments is the action."""


def actions_of(path):
    """The actions that a module writes into the audit log."""
    calls = [one for one in ast.walk(ast.parse(path.read_text("utf-8"))) if type(one) is ast.Call]
    given = [keyword.value for one in calls for keyword in one.keywords if keyword.arg == "action"]
    given += [action for one in calls for action in _action([one.func, *one.args])]
    given += [action for one in calls for action in _action(one.args)]
    words = [word for one in given for word in ast.walk(one) if isinstance(word, ast.Constant)]
    return {word.value for word in words if isinstance(word.value, str)}


def _action(called):
    """The action of a call as function and arguments, as also threads are given them."""
    if called and isinstance(called[0], ast.Name) and called[0].id in WRITING:
        return called[1 + WRITING[called[0].id] :][:1]
    return []


def test_every_action_of_the_audit_log_has_a_text():
    actions = {*Permission, *(one for path in APP.rglob("*.py") for one in actions_of(path))}
    names = {f"audit-{re.sub(r'[^a-z0-9]+', '-', one)}" for one in actions}

    assert len(actions) > 60
    assert sorted(names - messages_of(ROOT / ENGLISH / "account.ftl").keys()) == []
    assert texts("de", "account")("audit-start-job") == "Auftrag gestartet"
