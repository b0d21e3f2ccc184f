// The keys of the page of slices.

import { html, render } from "../shared/dom.js";
import { keyList } from "../shared/keys.js";
import { t } from "../shared/texts.js";

/** @type {Array<[string, string]>} */
const KEYS = [
  [t("key-back"), t("do-back")],
  [t("key-forward"), t("do-forward")],
  ["H V F", t("do-kinds")],
  ["+ −", t("do-thick")],
  ["C", t("do-color")],
  ["M", t("do-measure")],
  ["R", t("do-points")],
  ["0", t("do-whole")],
  [t("key-pan"), t("do-pan")],
  ["Enter", t("do-pick")],
  ["Esc", t("do-end")],
];

export function help(/** @type {HTMLElement} */ dialog) {
  render(
    html`<h2 id="help-title" tabindex="-1" autofocus>${t("keys")}</h2>
      ${keyList(KEYS)}
      <p>${t("above-help")}</p>
      <form method="dialog"><button class="primary">${t("close")}</button></form>`,
    dialog,
  );
}
