// What the generator's pages lack for people who do not see them, or use no mouse.

/** Names the landmarks that would have no name or that of another, and lets keys scroll what is
 * wider than the page. */
function mend() {
  const name = (selector, text) =>
    document.querySelectorAll(selector).forEach((one, k) => one.setAttribute("aria-label", text(k)));
  name(".md-nav--primary", () => "Pages");
  name(".md-path", () => "Path to this page");
  name(".md-code__nav", (k) => `Code ${k + 1}`);
  for (const one of document.querySelectorAll("pre > code, .md-typeset__scrollwrap"))
    if (one.scrollWidth > one.clientWidth) one.tabIndex = 0;
    else one.removeAttribute("tabindex");
  for (const one of document.querySelectorAll("th:empty")) one.setAttribute("role", "presentation");
}

new MutationObserver(mend).observe(document.body, { childList: true, subtree: true });
addEventListener("resize", mend);
mend();
