"""The viewer's page: viser's own client, served under the project's path with some fixes."""

from __future__ import annotations

import html
from dataclasses import replace
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, RedirectResponse, Response

from recon4_app.deps import Server
from recon4_app.network.behind import public_path
from recon4_app.pages import WEB
from recon4_app.projects.model import ProjectView
from recon4_app.viewer.hotkeys import HOTKEYS

router = APIRouter()

SHIMS = """
<script>
// Taps on the scene: viser ignores captured pointers, and browsers capture touch implicitly.
addEventListener('pointerdown', (event) => {
  if (event.pointerType === 'touch' && event.target.hasPointerCapture?.(event.pointerId))
    event.target.releasePointerCapture(event.pointerId);
}, true);
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
  const title = withText('Connected');
  if (!title || !withText('Edges by')) return;
  watch.disconnect();
  document.getElementById('cover').remove();
  pressForStretch();
  if (innerWidth < 576) title.click();
}).observe(document, { childList: true, subtree: true, characterData: true }));
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
    if (!words) return clearInterval(timer);
    const seconds = Math.round((performance.now() - began) / 1000);
    const problem = await fetch('state').then((response) => response.json())
      .then((state) => state.problem, () => 'the server does not answer');
    words.textContent = problem ? `${problem}. Trying again…` : `Opening the map… ${seconds} s`;
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
    page = with_shims(client(), replace(project, approval=approval))
    return HTMLResponse(page, headers=policy)


@router.get("/projects/{project_id}/viewer/state", include_in_schema=False)
def viewer_state(project_id: str, server: Server) -> dict[str, str]:
    """Why the viewer does not start, as ``problem``; empty = it runs or starts."""
    return {"problem": server.viewers.problem(server.projects.folder(project_id))}


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


def with_shims(page: str, project: ProjectView) -> str:
    """The page with our fixes, a caption about units and frame, and a cover until it is ready.

    The cover shows the thumbnail of a finished map.
    """
    head, body = page.find("<head>"), page.rfind("</body>")
    assert 0 <= head < body
    head += len("<head>")
    # The id is made of letters, digits, dots and dashes: `recon4_app.projects.store.PROJECT_ID`.
    address = f"../../../api/projects/{project.id}/thumbnail"
    image = f'<img src="{address}" alt="">' if project.has_map else ""
    badge = (
        f'<div id="cover">{image}<span id="cover-words" role="status">Opening the map…</span></div>'
        f'<div id="frame-caption">{html.escape(frame_caption(project))}</div>'
        '<button id="show-keys" type="button" aria-label="Keys">?</button>' + list_of_keys()
    )
    return page[:head] + drawing() + SHIMS + page[head:body] + badge + page[body:]


def list_of_keys() -> str:
    """A dialog with all keys, as HTML."""
    rows = [*((key.capitalize(), label) for label, key, _ in HOTKEYS), ("?", "This list")]
    items = "".join(
        f"<li><kbd>{html.escape(key)}</kbd> {html.escape(label)}</li>" for key, label in rows
    )
    return (
        '<dialog id="keys" aria-label="Keys"><form method="dialog">'
        f"<ul>{items}</ul><button>Close</button></form></dialog>"
    )


def policy_for(host: str) -> str:
    """Content security policy of the viewer: its inline code, and no other server."""
    return (
        "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval' blob: data:; "
        "worker-src blob: data:; style-src 'unsafe-inline'; img-src 'self' data: blob:; "
        f"font-src data:; connect-src 'self' ws://{host} wss://{host} blob: data:; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'self'"
    )


def frame_caption(project: ProjectView) -> str:
    """Caption about the coordinates on screen, frame and units, and whether the map is approved."""
    crs = project.summary.get("crs")
    place = f"local map frame of {crs}" if isinstance(crs, str) and crs else "map frame"
    return f"{place} · z up · meters · {project.approval.text}"
