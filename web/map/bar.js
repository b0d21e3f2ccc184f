// The tool bar of the map, its caption, and the list of keys.

import { html, nothing, render } from "../shared/dom.js";
import { count } from "../shared/format.js";
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
 * @property {() => void} csv
 * @property {(time: number) => void} seek
 * @property {(p: number[]) => void} goTo
 * @property {() => void} faceSection
 * @property {() => void} snapping
 * @property {(pin: import("./places.js").Pin) => void} choosePin
 */

/** @type {Array<[string, string]>} */
export const KEYS = [
  ["Drag", "Orbit; when standing, look around"],
  ["Shift or right drag", "Move sideways"],
  ["Wheel", "Zoom to the pointer"],
  ["Double click", "Fly to a point"],
  ["Two fingers", "Zoom and move"],
  ["Arrows", "Move"],
  ["Space", "Pick what is in the middle: every tool by keyboard"],
  ["+ -", "Nearer, farther"],
  ["F", "All of the map"],
  ["5 7 1 2 3 4", "Oblique, top, front, back, right, left"],
  ["O", "Perspective or parallel"],
  ["M H A Q I", "Measure a distance, height, angle, area, point"],
  ["R V", "Profile of a strip, volume over a plane"],
  ["S", "Snap to corners, edges and planes, or not"],
  ["Enter", "End the corners of an area or a volume"],
  ["B", "Clip box: drag a rectangle"],
  ["X", "Section: drag a line"],
  ["Z", "With and without ceilings"],
  ["C", "Next color"],
  ["N", "Note: click a place"],
  ["G", "Stand on the walk: click a place"],
  ["P", "Fly along the walk"],
  ["W", "Show the walk"],
  ["L", "Copy the link to this view"],
  ["T", "Show or hide the panel"],
  ["Esc", "End any tool"],
];

/**
 * @param {string} text
 * @param {string} key
 * @param {() => void} act
 * @param {boolean} [pressed]
 */
const tool = (text, key, act, pressed) =>
  html`<button
    type="button"
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
    html`<div role="toolbar" aria-label="View">
        ${tool("Fit", "F", act.fit)}
        ${Object.entries(VIEWS).map(([name, { text, key }]) =>
          tool(text, key, () => act.view(name)),
        )}
        ${tool("Parallel", "O", act.parallel, state.camera?.parallel ?? false)}
      </div>
      <div role="toolbar" aria-label="Tools">
        ${kinds.map(([kind, key]) =>
          tool(
            KINDS[kind].text,
            key,
            () => act.tool("measure", kind),
            current === "measure" && measuring === kind,
          ),
        )}
        ${tool("Box", "B", () => act.tool("box"), current === "box")}
        ${tool("Section", "X", () => act.tool("section"), current === "section")}
        ${page.notes.may ? tool("Note", "N", () => act.tool("note"), current === "note") : nothing}
        ${tool("Stand here", "G", () => act.tool("stand"), current === "stand")}
        ${tool("Fly", "P", act.fly, flight.on)}
      </div>
      <div role="toolbar" aria-label="Page">
        ${tool("Link", "L", act.share)}
        ${page.mayShare ? tool("Share…", "with a guest", act.invite) : nothing}
        ${tool("Full window", "full screen", act.whole)}
        ${tool("Panel", "T", act.panel, page.panel)} ${tool("?", "keys", act.help)}
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
  const shown = `${count(points)} of ${count(index.points)} points${rested ? "" : " …"}`;
  render(
    html`<div role="status">${reading ? html`<p class="reading">${reading}</p>` : nothing}</div>
      <p class="caption">
        <span class="shown">${shown}</span> · <span>${scale}</span> · <span>${index.frame}</span>
        ${project ? html` · <span>${project.approval.text}</span>` : nothing}
        ${flight.on ? html` · <span>${flight.time.toFixed(0)} s of the walk</span>` : nothing}
      </p>`,
    element,
  );
}

export const drawHelp = (/** @type {HTMLElement} */ dialog) =>
  render(
    html`<h2 id="help-title">Keys</h2>
      <dl class="keys">
        ${KEYS.map(
          ([key, text]) =>
            html`<div>
              <dt>${key}</dt>
              <dd>${text}</dd>
            </div>`,
        )}
      </dl>
      <form method="dialog"><button class="primary">Close</button></form>`,
    dialog,
  );
