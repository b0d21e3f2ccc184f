"""The viewer's page: viser's own client, served under the project's path with some fixes."""

from __future__ import annotations

import html
import json
import re
from dataclasses import replace
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, RedirectResponse, Response

from recon4.locales.coded import said
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import Texts
from recon4_app.deps import Server
from recon4_app.network.behind import public_path
from recon4_app.pages import WEB, Language, language_of
from recon4_app.projects.model import ProjectView
from recon4_app.viewer.hotkeys import HOTKEYS
from recon4_app.viewer.words import word_of, words

router = APIRouter()

_LANG = re.compile(r'<html(?: lang="[^"]*")?')
SHIMS = """
<script>
// Taps on the scene: viser ignores captured pointers, and browsers capture touch implicitly.
addEventListener('pointerdown', (event) => {
  if (event.pointerType === 'touch' && event.target.hasPointerCapture?.(event.pointerId))
    event.target.releasePointerCapture(event.pointerId);
}, true);
// The viewer reads the language of the page here. viser puts its prefix before the name.
localStorage.setItem('viser-user:recon4.language', document.documentElement.lang);
// Reconnecting: viser requires focus, which an iframe that was not tapped never has.
Document.prototype.hasFocus = function () { return !document.hidden; };
document.addEventListener('visibilitychange', () =>
  dispatchEvent(new Event(document.hidden ? 'blur' : 'focus')));
// A link names a stretch of the walk in the fragment. It is left where the viewer reads it, and the
// key that reads it is pressed until it was read: a viewer that starts or is busy misses keys.
// viser puts its prefix before the name of what it reads.
const project = decodeURIComponent(location.pathname.split('/').at(-3));
const askedStretch = 'viser-user:recon4.stretch.' + project;
let pressing = 0;
const pressForStretch = () => {
  if (localStorage.getItem(askedStretch) === null) return clearInterval(pressing);
  if (document.readyState === 'loading' || document.getElementById('cover')) return;
  document.documentElement.dispatchEvent(
    new KeyboardEvent('keydown', { key: 'g', code: 'KeyG', bubbles: true }));
};
const takeStretch = () => {
  if (!location.hash) return;
  localStorage.setItem(askedStretch, location.hash.slice(1));
  history.replaceState(null, '', location.pathname + location.search);
  clearInterval(pressing);
  pressing = setInterval(pressForStretch, 1500);
  pressForStretch();
};
takeStretch();
addEventListener('hashchange', takeStretch);
// Until our controls exist, a cover hides viser's own page. On a phone the controls would
// hide half of the map: collapse them.
addEventListener('DOMContentLoaded', () => new MutationObserver((_, watch) => {
  const withText = (text) => [...document.querySelectorAll('#root *')].find((one) =>
    !one.firstElementChild && one.textContent === text);
  const cover = document.getElementById('cover');
  const title = withText(cover.dataset.controls);
  if (!title || !withText(cover.dataset.edgesBy)) return;
  watch.disconnect();
  cover.remove();
  pressForStretch();
  if (innerWidth < 576) title.click();
}).observe(document, { childList: true, subtree: true, characterData: true }));
// viser writes its own notices in English: their text nodes get the words of the page's language.
addEventListener('DOMContentLoaded', () => {
  const words = JSON.parse(document.getElementById('notices').textContent);
  if (!words.length) return;
  const said = (text) => {
    for (const [[before, after], own] of words)
      if (after === undefined ? text === before :
          text.startsWith(before) && text.endsWith(after))
        return own.replace('VALUE', () => text.slice(before.length, -after.length));
    return text;
  };
  const say = (root) => {
    const texts = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
    for (let node = texts.currentNode; node; node = texts.nextNode())
      if (node.nodeType === Node.TEXT_NODE && said(node.data) !== node.data)
        node.data = said(node.data);
  };
  new MutationObserver((changes) => {
    for (const { target, addedNodes } of changes) [target, ...addedNodes].forEach(say);
  }).observe(document.body, { childList: true, subtree: true, characterData: true });
});
// The list of keys, by its key or button.
addEventListener('DOMContentLoaded', () => {
  const keys = document.getElementById('keys');
  document.getElementById('show-keys').onclick = () => keys.showModal();
  addEventListener('keydown', (event) => {
    if (keys.open && event.key === 'Escape') {  // before viser takes the key
      keys.close();
      event.stopImmediatePropagation();
    } else if (event.key === '?' && !event.target.closest?.('input, textarea, select'))
      keys.showModal();
  }, true);
});
// While it opens, the cover counts the seconds and shows why the viewer does not start.
addEventListener('DOMContentLoaded', () => {
  const began = performance.now();
  const timer = setInterval(async () => {
    const words = document.getElementById('cover-words');
    const { opening, again, silent } = words?.dataset ?? {};
    if (!words) return clearInterval(timer);
    const seconds = Math.round((performance.now() - began) / 1000);
    const problem = await fetch('state').then((response) => response.json())
      .then((state) => state.problem, () => silent);
    words.textContent = (problem ? again : opening)
      .replace('PROBLEM', () => problem).replace('SECONDS', seconds);
    words.classList.toggle('error', problem !== '');
  }, 3000);
});
</script>
<style>
#cover { position: fixed; inset: 0; z-index: 10000; display: grid; place-content: center;
  justify-items: center; gap: 12px; padding: 12px; box-sizing: border-box; text-align: center;
  font: 15px/1.5 system-ui, sans-serif; color: #9aa8b5; background: #101418; }
#cover img { max-width: 100%; max-height: 70vh; background: #eef2f5; border-radius: 8px; }
#cover .error { color: #ff8a80; }
#frame-caption { position: fixed; left: 0; top: 0; z-index: 5; padding: 4px 10px;
  font: 12px/1.5 system-ui, sans-serif; color: #e8edf2; background: rgb(16 20 24 / 72%);
  pointer-events: none; border-bottom-right-radius: 6px; }
#show-keys { position: fixed; left: 8px; bottom: 8px; z-index: 5; width: 44px; height: 44px;
  font: 600 16px system-ui, sans-serif; color: #e8edf2; background: rgb(16 20 24 / 72%);
  border: 1px solid #3a444e; border-radius: 8px; }
#keys { font: 14px/1.6 system-ui, sans-serif; color: #e8edf2; background: #101418;
  border: 1px solid #3a444e; border-radius: 8px; }
#keys ul { list-style: none; margin: 0; padding: 0; }
#keys kbd { display: inline-block; min-width: 64px; }
#keys button { min-height: 44px; min-width: 88px; margin-top: 8px; font: inherit; }
</style>
"""


NOTICES = (
    "connecting",
    "connected",
    "inactive",
    "rejected",
    "software",
    "software-why",
    "no-webgl",
    "no-webgl-why",
    "old-browser",
    "old-browser-why",
    "unknown-browser",
    "unknown-browser-why",
    "expand",
    "collapse",
    "collapse-area",
    "settings",
    "share",
    "share-not",
    "return",
)
"""What viser writes of itself: texts `viser-…`, in English as it has them."""


@router.get("/projects/{project_id}/viewer/", response_class=HTMLResponse, include_in_schema=False)
def viewer_page(project_id: str, request: Request, server: Server) -> Response:
    """Serve the page; its WebSocket goes to the same path without the trailing slash.

    viser would connect to foreign servers with ``?websocket=`` and ``?playbackPath=``: a URL with a
    query is redirected.
    """
    project = server.projects.get(project_id)
    if request.scope["query_string"]:
        return RedirectResponse(request.scope["path"], status_code=307)
    policy = {"Content-Security-Policy": policy_for(request.headers["host"])}
    approval = server.checks.known(server.projects.folder(project.id), project.approval)
    language = language_of(request)
    page = with_shims(client(), replace(project, approval=approval), language)
    headers = {"Content-Language": language, "Vary": "Accept-Language, Cookie"}
    return HTMLResponse(page, headers=policy | headers)


@router.get("/projects/{project_id}/viewer/state", include_in_schema=False)
def viewer_state(project_id: str, server: Server, language: Language) -> dict[str, str]:
    """Why the viewer does not start, as ``problem``; empty = it runs or starts."""
    return {"problem": said(server.viewers.problem(server.projects.folder(project_id)), language)}


@router.get("/projects/{project_id}/viewer", include_in_schema=False)
def viewer_without_slash(project_id: str, request: Request, server: Server) -> Response:
    """Redirect to the page."""
    path = f"/projects/{server.projects.get(project_id).id}/viewer/"
    return RedirectResponse(public_path(request.scope, path))


@cache
def drawing() -> str:
    """The script that spares a battery: a module without ``export``, as it runs before viser's."""
    module = (WEB / "shared" / "draw_at_rest.js").read_text("utf-8")
    return f"<script>{module.replace('export ', '')}\ndrawLessAtRest();</script>"


@cache
def client() -> str:
    """The client of viser: one self-contained file of its wheel."""
    found = find_spec("viser")
    assert found is not None and found.origin is not None
    page = Path(found.origin).parent / "client" / "build" / "index.html"
    return page.read_text("utf-8")


def with_shims(page: str, project: ProjectView, language: str) -> str:
    """The page with our fixes, a caption about units and frame, and a cover until it is ready.

    The cover shows the thumbnail of a finished map. All words are in one language.
    """
    say = words(language)
    page = _LANG.sub(f'<html lang="{language}"', page, count=1)
    head, body = page.find("<head>"), page.rfind("</body>")
    assert 0 <= head < body
    head += len("<head>")
    # The id is made of letters, digits, dots and dashes: `recon4_app.projects.store.PROJECT_ID`.
    address = f"../../../api/projects/{project.id}/thumbnail"
    image = f'<img src="{address}" alt="">' if project.has_map else ""
    badge = (
        f'<div id="cover" {_data(say, controls="controls", edges_by="edges-by")}>'
        f'{image}<span id="cover-words" role="status" {_cover_words(say)}>'
        f"{html.escape(say('opening-map'))}</span></div>"
        f'<div id="frame-caption">{html.escape(frame_caption(project, say))}</div>'
        f'<button id="show-keys" type="button" aria-label="{html.escape(say("list-of-keys"))}">'
        f"?</button>{list_of_keys(say)}"
        f'<script type="application/json" id="notices">{notices(say)}</script>'
    )
    return page[:head] + drawing() + SHIMS + page[head:body] + badge + page[body:]


def _data(say: Texts, **names: str) -> str:
    """Texts as attributes that the scripts read."""
    return " ".join(
        f'data-{key.replace("_", "-")}="{html.escape(say(name))}"' for key, name in names.items()
    )


def _cover_words(say: Texts) -> str:
    """What the cover says later, as attributes."""
    opening = html.escape(say("opening-since", seconds="SECONDS"))
    again = html.escape(say("trying-again", problem="PROBLEM"))
    return f'data-opening="{opening}" data-again="{again}" {_data(say, silent="server-silent")}'


def notices(say: Texts) -> str:
    """What viser writes in English, and the same in the language, as JSON; none in English.

    A text that quotes a value is in two parts, before and after it.
    """
    if say.language == ENGLISH:
        return "[]"
    quoted = {"browser": "VALUE"}
    english = words(ENGLISH)
    pairs = [
        (english(f"viser-{one}", **quoted).split("VALUE"), say(f"viser-{one}", **quoted))
        for one in NOTICES
    ]
    return json.dumps(pairs).replace("<", "\\u003c")


def list_of_keys(say: Texts) -> str:
    """A dialog with all keys, as HTML."""
    rows = [(word_of("cap", key, say), say(f"hotkey-{name}")) for key, name in HOTKEYS]
    rows.append(("?", say("hotkey-list")))
    items = "".join(
        f"<li><kbd>{html.escape(key)}</kbd> {html.escape(label)}</li>" for key, label in rows
    )
    return (
        f'<dialog id="keys" aria-label="{html.escape(say("list-of-keys"))}"><form method="dialog">'
        f"<ul>{items}</ul><button>{html.escape(say('close'))}</button></form></dialog>"
    )


def policy_for(host: str) -> str:
    """Content security policy of the viewer: its inline code, and no other server."""
    return (
        "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval' blob: data:; "
        "worker-src blob: data:; style-src 'unsafe-inline'; img-src 'self' data: blob:; "
        f"font-src data:; connect-src 'self' ws://{host} wss://{host} blob: data:; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'self'"
    )


def frame_caption(project: ProjectView, say: Texts) -> str:
    """Caption about the coordinates on screen, frame and units, and whether the map is approved."""
    crs = project.summary.get("crs")
    known = isinstance(crs, str) and crs
    frame = say("frame-crs", crs=str(crs)) if known else say("frame-map")
    return say("caption", frame=frame, approval=project.approval.line.said(say.language))
