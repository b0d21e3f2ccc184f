// Findings in slices: double walls, distances, control points, classes; and exported files.

import { classesPanel } from "./classes.js";
import { controlPanel } from "./control.js";
import { doublesPanel } from "./doubles.js";
import { exportPanel } from "./export.js";
import { referencePanel } from "./reference.js";
import { html, render } from "../shared/dom.js";
import { t } from "../shared/texts.js";

/**
 * @import {PickView, SliceFacts, SliceImageRequest} from "../shared/http_types"
 * @import {Brush} from "./brush.js"
 * @import {KnownPlace} from "./ellipses.js"
 * @import {Liking} from "./liking.js"
 * @import {SliceState} from "./state.js"
 * @typedef {object} SlicesPage what the panels need of the page
 * @property {string} id of the project
 * @property {(next: Partial<SliceState>, how?: {keep?: boolean}) => void} change
 * @property {() => SliceState} state
 * @property {() => SliceImageRequest} ask the request of the slice on the screen
 * @property {(place: number[] | null) => void} point marks a place on the map from above
 * @property {() => Promise<void>} reload
 * @property {() => PickView | null} measured the picked point
 * @property {(action?: "draw" | "back" | "clear") => Outline} outline changes the polygon
 * @property {(next?: Partial<Brush>) => Brush} brush changes the brush
 * @property {(next?: Partial<Liking>) => Liking} like changes the thing that is picked
 * @property {(places: KnownPlace[]) => void} known shows the error ellipses of surveyed points
 * @typedef {object} Outline the polygon whose points get another class
 * @property {Array<[number, number]>} corners u, v [m]
 * @property {boolean} drawing whether clicks are its corners
 * @typedef {object} Panel
 * @property {() => void} [show] the slice has changed
 * @property {(facts: SliceFacts) => void} [facts] what is known of the map has changed
 */

/** @type {Array<[string, (host: HTMLElement, page: SlicesPage) => Panel]>} */
const PANELS = [
  [t("double-walls"), doublesPanel],
  [t("compare-reference"), referencePanel],
  [t("control-points"), controlPanel],
  [t("correct-classes"), classesPanel],
  [t("export"), exportPanel],
];

/** Which panels are open, while the page is loaded again for a new map. */
const OPEN = "recon4 open panels";

/** Opens the same panels when the page is loaded again. */
export function keepOpenPanels() {
  const panels = [...document.querySelectorAll("#findings > details")];
  const open = panels.flatMap((one, k) => (one.hasAttribute("open") ? [k] : []));
  sessionStorage.setItem(OPEN, open.join(" "));
}

/** What a person opens is scrolled into view: a panel above may be longer than the window. */
function showOpened(/** @type {Event} */ event) {
  const panel = /** @type {HTMLElement} */ (event.currentTarget).closest("details");
  const show = () => panel?.open && panel.scrollIntoView({ block: "nearest" });
  panel?.addEventListener("toggle", show, { once: true });
}

/**
 * Fills the section; returns callbacks for changes of the slice and of the map.
 * @param {HTMLElement} root
 * @param {SlicesPage} page
 * @returns {Required<Panel>}
 */
export function findings(root, page) {
  render(
    PANELS.map(
      ([text]) =>
        html`<details class="panel">
          <summary @click=${showOpened}>${text}</summary>
          <div></div>
        </details>`,
    ),
    root,
  );
  const kept = sessionStorage.getItem(OPEN);
  sessionStorage.removeItem(OPEN);
  root.querySelectorAll("details").forEach((one, k) => (one.open = (kept ?? "").includes(`${k}`)));
  const hosts = [...root.querySelectorAll("div")];
  const panels = PANELS.map(([, fill], k) => fill(/** @type {HTMLElement} */ (hosts[k]), page));
  return {
    show: () => panels.forEach((panel) => panel.show?.()),
    facts: (facts) => panels.forEach((panel) => panel.facts?.(facts)),
  };
}
