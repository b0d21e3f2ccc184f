// The tool bars of the map; what has no room in its bar is in the bar's list.

import { html, nothing, render, repeat, targetOf, within } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { fitting } from "./bar_fit.js";
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
 * @property {() => void} finish of a measurement whose corners are not counted
 * @property {() => void} undoPoint the last one of a measurement
 * @property {() => void} end of any tool
 * @property {() => void} toMap gives the keys back to the map
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

/**
 * @typedef {object} Button
 * @property {string} text
 * @property {string} key or what a tooltip says of it
 * @property {() => unknown} act
 * @property {number} rank the highest goes into the list first; 0 = never
 * @property {boolean} [pressed]
 * @typedef {object} Bar
 * @property {string} id
 * @property {string} name
 * @property {Button[]} buttons
 */

const GAP_PX = 8; // between two bars of a row, as in map.css
const BORDERS_PX = 2; // of a bar
/** Rank of each tool and view; what is used most goes into the list last. */
const RANKS = {
  ...{ left: 9, right: 8, back: 7, front: 5, top: 2, oblique: 1 },
  ...{ angle: 9, volume: 8, area: 7, profile: 6, height: 3, point: 2, distance: 1 },
};
/** @type {Map<string, number>} width of each button by its text [px] */
const widths = new Map();
const list = { open: "" }; // id of the bar whose list is open

/** @returns {Bar} */
const views = (/** @type {Act} */ act) => ({
  id: "views",
  name: t("view"),
  buttons: [
    { text: t("fit"), key: "F", act: act.fit, rank: 0 },
    ...Object.entries(VIEWS).map(([name, { text, key }]) => ({
      text,
      key,
      act: () => act.view(name),
      rank: RANKS[/** @type {keyof typeof RANKS} */ (name)],
    })),
    {
      ...{ text: t("parallel"), key: "O", act: act.parallel, rank: 4 },
      pressed: page.state.camera?.parallel ?? false,
    },
  ],
});

/** @returns {Bar} */
const ofPage = (/** @type {Act} */ act) => ({
  id: "page",
  name: t("page"),
  buttons: [
    { text: t("link"), key: "L", act: act.share, rank: 4 },
    ...(page.mayShare
      ? [{ text: t("share"), key: t("with-guest"), act: act.invite, rank: 6 }]
      : []),
    { text: t("full-window"), key: t("full-screen"), act: act.whole, rank: 5 },
    { text: t("panel"), key: "T", act: act.panel, rank: 0, pressed: page.panel },
    { text: "?", key: t("keys-small"), act: act.help, rank: 0 },
  ],
});

/** @returns {Bar} */
function tools(/** @type {Act} */ act) {
  const { tool: current, measuring, flight, mayProcess } = page;
  const kinds = /** @type {Array<[MeasureKind, string]>} */ ([
    ["distance", "M"],
    ["height", "H"],
    ["angle", "A"],
    ["area", "Q"],
    ["point", "I"],
    ["profile", "R"],
    ["volume", "V"],
  ]);
  /** @type {Array<[import("./page.js").Tool, string, string, number]>} */
  const others = [
    ["box", t("box"), "B", 5],
    ["section", t("section"), "X", 4],
    ["note", t("note"), "N", 2],
    ["stand", t("stand-here"), "G", 1],
  ];
  return {
    id: "tools",
    name: t("tools"),
    buttons: [
      ...kinds.map(([kind, key]) => ({
        ...{ text: KINDS[kind].text, key, act: () => act.tool("measure", kind) },
        ...{ rank: RANKS[kind], pressed: current === "measure" && measuring === kind },
      })),
      ...others
        .filter(([tool]) => tool !== "note" || mayProcess)
        .map(([tool, text, key, rank]) => ({
          ...{ text, key, act: () => act.tool(tool), rank, pressed: current === tool },
        })),
      { text: t("fly"), key: "P", act: act.fly, rank: 3, pressed: flight.on },
    ],
  };
}

/**
 * @param {Button} button
 * @param {() => void} [after]
 */
const drawButton = ({ text, key, act, pressed }, after) =>
  html`<button
    type="button"
    title=${`${text} (${key})`}
    aria-keyshortcuts=${key.length === 1 ? key : nothing}
    aria-pressed=${pressed === undefined ? nothing : String(pressed)}
    @click=${() => {
      after?.();
      act();
    }}
  >
    ${text}
  </button>`;

/**
 * A bar; where some of its buttons have no room, with a button that opens the list of them.
 * @param {Bar} bar
 * @param {boolean[]} shown which of its buttons have room
 * @param {(id: string) => void} openList
 */
function drawOne({ id, name, buttons }, shown, openList) {
  const listed = buttons.filter((_, k) => !shown[k]);
  const opened = list.open === id && listed.length > 0;
  return html`<div class="group" data-bar=${id}>
    <div role="toolbar" aria-label=${name}>
      ${repeat(
        buttons.filter((_, k) => shown[k]),
        ({ text }) => text,
        (one) => drawButton(one),
      )}
      <button
        type="button"
        class="more"
        ?hidden=${!listed.length}
        aria-expanded=${String(opened)}
        @click=${() => openList(opened ? "" : id)}
      >
        ${t("more-tools")}
      </button>
    </div>
    ${
      opened
        ? html`<div class="list" role="group" aria-label=${`${name}: ${t("more-tools")}`}>
            ${listed.map((one) => drawButton(one, () => openList("")))}
          </div>`
        : nothing
    }
  </div>`;
}

export function drawBar(/** @type {HTMLElement} */ element, /** @type {Act} */ act) {
  const rows = [[views(act), ofPage(act)], [tools(act)]];
  const openList = (/** @type {string} */ id) => {
    list.open = id;
    drawBar(element, act);
  };
  if (!rows.flat().every(({ buttons }) => buttons.every(({ text }) => widths.has(text))))
    measure(element, rows.flat());
  const drawn = rows.flatMap((row) => {
    const buttons = row.flatMap((bar, k) => bar.buttons.map((one) => fitted(one, k)));
    const width = element.clientWidth - BORDERS_PX * row.length;
    const more = widths.get(t("more-tools")) ?? 0;
    const shown = fitting(buttons, { width, gap: GAP_PX, more });
    return row.map((bar) => drawOne(bar, shown.splice(0, bar.buttons.length), openList));
  });
  render(drawn, element);
  closeAside(element, () => list.open && openList(""));
}

/** A button as its row sees it: what is on stays in sight. */
const fitted = (/** @type {Button} */ { text, rank, pressed }, /** @type {number} */ bar) => ({
  ...{ bar, width: widths.get(text) ?? 0 },
  rank: pressed ? 0 : rank,
});

/** Notes how wide all buttons are. */
function measure(/** @type {HTMLElement} */ element, /** @type {Bar[]} */ bars) {
  const more = t("more-tools");
  const texts = [...bars.flatMap(({ buttons }) => buttons.map(({ text }) => text)), more];
  const drawn = texts.map(
    (one) => html`<button class=${one === more ? "more" : ""}>${one}</button>`,
  );
  render(html`<div role="toolbar">${drawn}</div>`, element);
  const buttons = element.querySelectorAll("button");
  texts.forEach((text, k) => widths.set(text, buttons[k].getBoundingClientRect().width));
}

/** @type {WeakSet<HTMLElement>} */
const listening = new WeakSet();

/**
 * A press elsewhere and Esc close an open list.
 * @param {HTMLElement} element
 * @param {() => unknown} close
 */
function closeAside(element, close) {
  if (listening.has(element)) return;
  listening.add(element);
  addEventListener("pointerdown", (event) => {
    if (!targetOf(event).closest?.("#bar")) close();
  });
  element.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !list.open) return;
    event.stopPropagation();
    const id = list.open;
    close();
    within(element, `[data-bar="${id}"] .more`).focus();
  });
}
