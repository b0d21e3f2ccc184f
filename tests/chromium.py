"""The browser of tests: Debian's Chromium without a screen."""

import os
from pathlib import Path

SHELL = Path("/usr/bin/chromium-headless-shell")
"""Chromium without the windows around pages: it takes two thirds of the processor time."""
INSTALLED = SHELL if SHELL.exists() else Path("/usr/bin/chromium")
CHROMIUM = Path(os.environ.get("RECON4_CHROMIUM", INSTALLED))
FEATURES_OF_PLAYWRIGHT = (
    *("AimEnabled", "AvoidCorsURLLoaderRestartOnRedirect", "AvoidUnnecessaryBeforeUnloadCheckSync"),
    *("DestroyProfileOnBrowserClose", "HttpsFirstBalancedModeAutoEnable", "HttpsUpgrades"),
    *("LensOverlay", "MediaRouter", "NetworkTimeServiceQuerying", "OptimizationHints"),
    *("PaintHolding", "PreconnectToSearch", "ThirdPartyStoragePartitioning"),
)
"""What Playwright turns off: Chromium takes the last list only, which is ours."""
UNSEEN_FEATURES = ("WebUIOmniboxAimPopup", "WebUIOmniboxPopup", "SpareRendererForSitePerProcess")
"""Without a screen nobody sees the pages of the address bar, of which each window loads two, nor
needs a process in advance: a third of the processor time of a plain page."""
FLAGS = [
    f"--disable-features={','.join((*FEATURES_OF_PLAYWRIGHT, *UNSEEN_FEATURES))}",
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    # Playwright's `ignore_https_errors` answers after the error: a request that met many new
    # connections was given up (ERR_TOO_MANY_RETRIES). Here there is no error to answer.
    "--ignore-certificate-errors",
]

DRAW_LESS = """{
  const contextOf = HTMLCanvasElement.prototype.getContext;
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    const chosen = kind.startsWith("webgl") ? { ...options, antialias: false } : options;
    return contextOf.call(this, kind, chosen);
  };
}
if (window !== window.parent) {
  if (location.pathname.endsWith("/viewer/"))
    history.replaceState(history.state, "", `${location.pathname}?fixedDpr=0.5${location.hash}`);
  const request = window.requestAnimationFrame.bind(window);
  const timers = new Map();
  let last = 0;
  window.requestAnimationFrame = (draw) => {
    const id = ++last;
    const drawUnlessCancelled = (time) => timers.delete(id) && draw(time);
    const draws = () =>
      window.parent.unwatched
        ? timers.set(id, setTimeout(draws, 400))
        : request(drawUnlessCancelled);
    timers.set(id, setTimeout(draws, 100));
    return id;
  };
  window.cancelAnimationFrame = (id) => {
    clearTimeout(timers.get(id));
    timers.delete(id);
  };
}"""
"""Script for every page: no antialiasing in WebGL; in a page within a page half of the viewer's
pixels in width and height (an option of viser's), and 10 frames a second, none while a test sets
``window.unwatched`` of the page around it.

Without a graphics card each frame takes processor time that the other tests need. Menus follow the
frames, too: with fewer of them a test clicks beside an entry. The viewer by itself draws at its own
pace: its camera comes to rest before a test clicks.
"""
