// The panel of the map: colors, layers, clip, measurements, views.

import { html, nothing, render, targetOf } from "../shared/dom.js";
import { projectUrl, slicesUrl } from "../shared/api.js";
import { idHere } from "../shared/address.js";
import { classText } from "../shared/class_words.js";
import { shareText } from "../shared/format.js";
import { decimal, t, written } from "../shared/texts.js";
import { numberField as field } from "./number_field.js";
import { classColor, css, endText, rampOf } from "./colors.js";
import { compareSection, differencesLegend } from "./compare.js";
import { corrections } from "./corrections.js";
import { measuredSection } from "./measured_panel.js";
import { notesSection } from "./notes.js";
import { colorShown, colorsOf, endsShown, heightsOf, heightsShown, page } from "./page.js";
import { exportQuery, exportedClip, sliceQuery } from "./clip.js";
import { placesSections } from "./places_panel.js";
import { savedSection } from "./saved.js";
import { COLORS, LAYERS } from "./state.js";

/**
 * @import {Act} from "./bar.js"
 * @import {ColorBy, Layer} from "./state.js"
 * @import {MapIndex} from "../shared/http_types"
 */

const SPEEDS = [1, 2, 4, 8, 16]; // of a flight, times that of the walk
/** Layers that a guest does not get. @type {Layer[]} */
const OF_THE_TEAM = ["marks", "notes"];

export function drawPanel(/** @type {HTMLElement} */ element, /** @type {Act} */ act) {
  const { index, panel } = page;
  element.hidden = !panel || !index;
  if (!index || !panel) return;
  render(
    html`<section aria-labelledby="colors-title">
        <h2 id="colors-title">${t("colors")}</h2>
        ${colors(index, act)}
      </section>
      <section aria-labelledby="clip-title">
        <h2 id="clip-title">${t("shown-part")}</h2>
        ${clip(index, act)}
      </section>
      <section aria-labelledby="layers-title">
        <h2 id="layers-title">${t("layers")}</h2>
        ${layers(act)}
      </section>
      ${placesSections(act)} ${measuredSection(act)}
      ${
        page.guest
          ? nothing
          : [notesSection(act), savedSection(act), compareSection(act), corrections(index, act)]
      }`,
    element,
  );
}

function colors(/** @type {MapIndex} */ index, /** @type {Act} */ act) {
  const { state } = page;
  const shown = colorShown();
  const choose = (/** @type {Event} */ event) =>
    act.change({ color: /** @type {ColorBy} */ (targetOf(event).value), lo: null, hi: null });
  const usual = () =>
    html`<label
        ><span class="unseen">${t("color-by")}</span
        ><select @change=${choose}>
          ${colorsOf(index).map(
            (color) =>
              html`<option value=${color} ?selected=${color === shown}>${COLORS[color]}</option>`,
          )}
        </select></label
      >
      ${legend(index, act)}`;
  return html`${differencesLegend() ?? usual()}
    <label class="check"
      ><input
        type="checkbox"
        .checked=${state.depth}
        @change=${() => act.change({ depth: !state.depth })}
      /><span>${t("shade-edges")}</span></label
    >
    <label
      ><span>${t("point-size")}</span
      ><input
        type="range"
        min="-2"
        max="2"
        step="0.25"
        .value=${String(Math.log2(state.size))}
        @input=${(/** @type {Event} */ event) =>
          act.change({ size: 2 ** Number(targetOf(event).value) })}
    /></label>`;
}

function share(/** @type {MapIndex} */ { class_percent }, /** @type {string} */ code) {
  return code in class_percent ? `, ${shareText(class_percent[code])}` : "";
}

/** What the colors mean. */
function legend(/** @type {MapIndex} */ index, /** @type {Act} */ act) {
  const { state } = page;
  const color = colorShown();
  if (color === "plain") return nothing;
  if (color === "class")
    return html`<ul class="classes">
      ${Object.entries(index.classes).map(([code, name]) => {
        const color = css(classColor(Number(code)));
        return html`<li>
          <i .style=${`background: ${color}`}></i>${classText(name)}${share(index, code)}
        </li>`;
      })}
    </ul>`;
  const { ends, unit } = endsShown();
  const stops = rampOf(color).map(css).join(", ");
  return html`<div class="ramp" .style=${`background: linear-gradient(to right, ${stops})`}></div>
    <p class="ends"><span>${endText(ends[0], unit)}</span><span>${endText(ends[1], unit)}</span></p>
    <details>
      <summary>${t("range-of-colors")}</summary>
      <div class="pair">
        ${field(t("low-end"), state.lo, (lo) => act.change({ lo }), {
          usual: written(ends[0].toPrecision(3)),
        })}
        ${field(t("high-end"), state.hi, (hi) => act.change({ hi }), {
          usual: written(ends[1].toPrecision(3)),
        })}
      </div>
    </details>`;
}

function clip(/** @type {MapIndex} */ index, /** @type {Act} */ act) {
  const { clip: shown } = page.state;
  const [low, high] = shown.heights;
  const [lowest, highest] = heightsShown().map((z) => decimal(z, 2));
  const heights = (/** @type {[number | null, number | null]} */ next) =>
    act.change({ clip: { ...shown, heights: next }, cutCeiling: false });
  return html`<div class="pair">
      ${field(t("from-height"), low, (z) => heights([z, high]), { usual: lowest })}
      ${field(t("to-height"), high, (z) => heights([low, z]), { usual: highest })}
    </div>
    <div class="buttons">
      <button type="button" @click=${() => heights([null, null])}>${t("all-heights")}</button>
      ${index.storeys.map(
        (storey) =>
          html`<button
            type="button"
            title=${t("floor-at", { m: storey.floor_m })}
            @click=${() => heights(heightsOf(storey))}
          >
            ${t("storey", { name: storey.name })}
          </button>`,
      )}
      <a
        class="button"
        href="${slicesUrl(idHere())}?kind=horizontal&z=${sliceHeight(index).toFixed(3)}"
        >${t("slice-at-height")}</a
      >
    </div>
    ${boxFields(act)} ${sectionFields(act)}
    ${
      page.guest
        ? nothing
        : html`<div class="buttons">
            <a class="button" href=${exportAddress(index)}>${t("export-this-part")}</a>
          </div>`
    }`;
}

/** The form of exports, filled with what the clip leaves. */
const exportAddress = (/** @type {MapIndex} */ index) => {
  const boxes = exportedClip(page.state.clip, index);
  return `${projectUrl(idHere())}?${exportQuery(boxes)}`;
};

/** Height of a slice of what is shown: a hand below its upper end. */
const sliceHeight = (/** @type {MapIndex} */ { high_m }) =>
  (page.state.clip.heights[1] ?? high_m[2]) - 0.7;

const turn = (/** @type {number} */ deg) => (deg * Math.PI) / 180;

function boxFields(/** @type {Act} */ act) {
  const { clip: shown } = page.state;
  const { box } = shown;
  if (!box) return nothing;
  const set = (/** @type {Partial<typeof box>} */ next) =>
    act.change({ clip: { ...shown, box: { ...box, ...next } } });
  const part = (/** @type {"center" | "size"} */ name, /** @type {number} */ axis) =>
    field(
      t(name === "center" ? "middle-axis" : "size-axis", { axis: "xyz"[axis] }),
      box[name][axis],
      (value) => {
        if (value === null || (name === "size" && value <= 0)) return;
        const next = /** @type {[number, number, number]} */ ([...box[name]]);
        next[axis] = value;
        set({ [name]: next });
      },
    );
  return html`<details open>
    <summary>${t("clip-box")}</summary>
    <div class="three">
      ${[0, 1, 2].map((axis) => part("center", axis))}
      ${[0, 1, 2].map((axis) => part("size", axis))}
    </div>
    ${field(t("turned-by"), (box.yaw * 180) / Math.PI, (deg) => set({ yaw: turn(deg ?? 0) }), {
      step: 5,
    })}
    <div class="buttons">
      <button type="button" @click=${() => act.change({ clip: { ...shown, box: null } })}>
        ${t("remove-box")}
      </button>
    </div>
  </details>`;
}

function sectionFields(/** @type {Act} */ act) {
  const { clip: shown } = page.state;
  const { section } = shown;
  if (!section) return nothing;
  const { thickness } = section;
  const set = (/** @type {Partial<typeof section>} */ next) =>
    act.change({ clip: { ...shown, section: { ...section, ...next } } });
  const move = (/** @type {number} */ times) => {
    const [dx, dy] = [section.b[0] - section.a[0], section.b[1] - section.a[1]];
    const step = (times * section.thickness) / (Math.hypot(dx, dy) || 1);
    const by = [dy * step, -dx * step];
    set({
      a: [section.a[0] + by[0], section.a[1] + by[1]],
      b: [section.b[0] + by[0], section.b[1] + by[1]],
    });
  };
  const query = sliceQuery({ a_m: section.a, b_m: section.b, thickness_m: section.thickness });
  return html`<details open>
    <summary>${t("section")}</summary>
    ${field(t("thickness"), thickness, (m) => m && m > 0 && set({ thickness: m }), { step: 0.05 })}
    <div class="buttons">
      <button type="button" @click=${() => move(-1)}>${t("step-back")}</button
      ><button type="button" @click=${() => move(1)}>${t("step-forward")}</button
      ><button type="button" @click=${act.faceSection}>${t("look-at-it")}</button
      ><a class="button" href="${slicesUrl(idHere())}?${query}">${t("open-as-slice")}</a
      ><button type="button" @click=${() => act.change({ clip: { ...shown, section: null } })}>
        ${t("remove-section")}
      </button>
    </div>
  </details>`;
}

function layers(/** @type {Act} */ act) {
  const { state, flight, walk } = page;
  const toggle = (/** @type {Layer} */ layer) =>
    act.change({
      layers: state.layers.includes(layer)
        ? state.layers.filter((one) => one !== layer)
        : [...state.layers, layer],
    });
  const seek = (/** @type {Event} */ event) => act.seek(Number(targetOf(event).value));
  const every = /** @type {Array<[Layer, string]>} */ (Object.entries(LAYERS));
  const names = every.filter(([layer]) => !page.guest || !OF_THE_TEAM.includes(layer));
  return html`${names.map(
    ([layer, text]) =>
      html`<label class="check"
        ><input
          type="checkbox"
          .checked=${state.layers.includes(layer)}
          @change=${() => toggle(layer)}
        /><span>${text}</span></label
      >`,
  )}
  ${
    walk?.t_s.length
      ? html`<label
            ><span>${t("along-walk")}</span
            ><input
              type="range"
              min="0"
              step="0.1"
              max=${walk.t_s.at(-1) ?? 0}
              .value=${String(flight.time)}
              @input=${seek} /></label
          ><label
            ><span>${t("flight-speed")}</span
            ><select
              @change=${(/** @type {Event} */ event) =>
                (flight.speed = Number(targetOf(event).value))}
            >
              ${SPEEDS.map(
                (speed) =>
                  html`<option value=${speed} ?selected=${speed === flight.speed}>
                    ${t("times-walk", { speed })}
                  </option>`,
              )}
            </select></label
          >`
      : nothing
  }`;
}
