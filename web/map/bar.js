// The tool bar of the map, its caption, and the list of keys.

import { approvalWords } from "../shared/approval.js";
import { html, nothing, render } from "../shared/dom.js";
import { count } from "../shared/format.js";
import { frameText } from "../shared/frame.js";
import { t } from "../shared/texts.js";
import { KINDS } from "./measure.js";
import { page } from "./page.js";
import { VIEWS } from "./views.js";

/**
 * @import {MeasureKind} from "./measure.js"
 * @typedef {object} Act what the bar and the panel do
 * @property {(name: string) => void} view
 * @property {() => void} fit
 * @property {() => void} parallel
 * @property {(tool: import("./page.js").Tool, kind?: MeasureKind) => void} tool
 * @property {() => void} fly
 * @property {() => unknown} share
 * @property {() => unknown} invite a guest
 * @property {() => unknown} whole
 * @property {() => void} panel
 * @property {() => void} help
 * @property {(next: Partial<import("./state.js").MapState>) => void} change
 * @property {(name: string) => void} save
 * @property {(query: string) => void} open
 * @property {(view: string) => void} forget
 * @property {ReturnType<typeof import("./notes.js").notesOf>} notes
 * @property {ReturnType<typeof import("./profile.js").profileOf>} profile
 * @property {ReturnType<typeof import("./compare.js").compareOf>} compare
 * @property {() => void} csv
 * @property {(time: number) => void} seek
 * @property {(p: number[]) => void} goTo
 * @property {() => void} faceSection
 * @property {() => void} snapping
 * @property {(pin: import("./places.js").Pin) => void} choosePin
 */

/** @type {Array<[string, string]>} */
export const KEYS = [
  [t("key-drag"), t("do-drag")],
  [t("key-sideways"), t("do-sideways")],
  [t("key-wheel"), t("do-wheel")],
  [t("key-double"), t("do-double")],
  [t("key-fingers"), t("do-fingers")],
  [t("key-arrows"), t("do-arrows")],
  [t("key-space"), t("do-space")],
  ["+ -", t("do-zoom")],
  ["F", t("do-fit")],
  ["5 7 1 2 3 4", t("do-views")],
  ["O", t("do-parallel")],
  ["M H A Q I", t("do-measure")],
  ["R V", t("do-profile")],
  ["S", t("do-snap")],
  ["Enter", t("do-enter")],
  ["B", t("do-box")],
  ["X", t("do-section")],
  ["K", t("do-brush")],
  ["J", t("do-like")],
  ["Z", t("do-ceilings")],
  ["C", t("do-color")],
  ["N", t("do-note")],
  ["G", t("do-stand")],
  ["P", t("do-fly")],
  ["W", t("do-walk")],
  ["L", t("do-link")],
  ["T", t("do-panel")],
  ["Esc", t("do-esc")],
];

/**
 * @param {string} text
 * @param {string} key
 * @param {() => void} act
 * @param {boolean} [pressed]
 * @param {string} [name] "first" = before the others where there is little room
 */
const tool = (text, key, act, pressed, name = "") =>
  html`<button
    type="button"
    class=${name}
    title=${`${text} (${key})`}
    aria-keyshortcuts=${key.length === 1 ? key : nothing}
    aria-pressed=${pressed === undefined ? nothing : String(pressed)}
    @click=${act}
  >
    ${text}
  </button>`;

export function drawBar(/** @type {HTMLElement} */ element, /** @type {Act} */ act) {
  const { state, tool: current, measuring, flight } = page;
  const kinds = /** @type {Array<[MeasureKind, string]>} */ ([
    ["distance", "M"],
    ["height", "H"],
    ["angle", "A"],
    ["area", "Q"],
    ["point", "I"],
    ["profile", "R"],
    ["volume", "V"],
  ]);
  render(
    html`<div role="toolbar" aria-label=${t("view")}>
        ${tool(t("fit"), "F", act.fit)}
        ${Object.entries(VIEWS).map(([name, { text, key }]) =>
          tool(text, key, () => act.view(name)),
        )}
        ${tool(t("parallel"), "O", act.parallel, state.camera?.parallel ?? false)}
      </div>
      <div role="toolbar" aria-label=${t("page")}>
        ${tool(t("link"), "L", act.share)}
        ${page.mayShare ? tool(t("share"), t("with-guest"), act.invite) : nothing}
        ${tool(t("full-window"), t("full-screen"), act.whole)}
        ${tool(t("panel"), "T", act.panel, page.panel, "first")}
        ${tool("?", t("keys-small"), act.help, undefined, "first")}
      </div>
      <div role="toolbar" aria-label=${t("tools")}>
        ${kinds.map(([kind, key]) =>
          tool(
            KINDS[kind].text,
            key,
            () => act.tool("measure", kind),
            current === "measure" && measuring === kind,
          ),
        )}
        ${tool(t("box"), "B", () => act.tool("box"), current === "box")}
        ${tool(t("section"), "X", () => act.tool("section"), current === "section")}
        ${
          page.notes.may
            ? tool(t("note"), "N", () => act.tool("note"), current === "note")
            : nothing
        }
        ${tool(t("stand-here"), "G", () => act.tool("stand"), current === "stand")}
        ${tool(t("fly"), "P", act.fly, flight.on)}
      </div>`,
    element,
  );
}

/**
 * @param {HTMLElement} element
 * @param {{points: number, rested: boolean, scale: string}} drawn
 */
export function drawStatus(element, { points, rested, scale }) {
  const { index, project, reading, flight } = page;
  if (!index) return;
  const shown =
    t("points-shown", { shown: count(points), count: count(index.points) }) + (rested ? "" : " …");
  render(
    html`<div role="status">${reading ? html`<p class="reading">${reading}</p>` : nothing}</div>
      <p class="caption">
        <span class="shown">${shown}</span> · <span>${scale}</span
        ><span class="frame"> · ${frameText(index.frame)}</span>
        ${project ? html` · <span>${approvalWords(project.approval)}</span>` : nothing}
        ${
          flight.on
            ? html` · <span>${t("s-of-walk", { s: flight.time.toFixed(0) })}</span>`
            : nothing
        }
      </p>`,
    element,
  );
}

export const drawHelp = (/** @type {HTMLElement} */ dialog) =>
  render(
    html`<h2 id="help-title" tabindex="-1" autofocus>${t("keys")}</h2>
      <dl class="keys">
        ${KEYS.map(
          ([key, text]) =>
            html`<div>
              <dt>${key}</dt>
              <dd>${text}</dd>
            </div>`,
        )}
      </dl>
      <form method="dialog"><button class="primary">${t("close")}</button></form>`,
    dialog,
  );
