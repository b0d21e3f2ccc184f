// Where to cut and what to show: the fields beside the slice. No network.

import { html, nothing, targetOf } from "../shared/dom.js";
import { language, t } from "../shared/texts.js";
import { sourceText } from "./captions.js";
import { choice } from "./columns.js";
import { anglesOf, COLORS, normalFrom, SURFACES } from "./state.js";

/**
 * @import {Content} from "../shared/dom.js"
 * @import {SliceFacts} from "../shared/http_types"
 * @import {Color, Kind, SliceState, Surface} from "./state.js"
 * @typedef {object} Act
 * @property {(next: Partial<SliceState>, how?: {keep?: boolean}) => void} change
 * @property {(kind: Kind) => void} toKind
 */

/** @type {Array<[Kind, string, string]>} */
const KINDS = [
  ["horizontal", t("horizontal"), "H"],
  ["vertical", t("vertical"), "V"],
  ["free", t("free"), "F"],
];
const ALL_COLORS = /** @type {Array<[Color, string]>} */ (Object.entries(COLORS));
const ALL_SURFACES = /** @type {Array<[Surface, string]>} */ (Object.entries(SURFACES));

/**
 * @param {string} text
 * @param {Content} control
 */
const field = (text, control) => html`<label><span>${text}</span>${control}</label>`;

/**
 * A field of a number; `onValue` is called when a person has changed it.
 * @param {string} text
 * @param {number | undefined} value
 * @param {number} step
 * @param {(value: number) => unknown} onValue
 */
function number(text, value = 0, step, onValue) {
  const change = (/** @type {Event} */ event) => {
    const given = targetOf(event).valueAsNumber;
    if (Number.isFinite(given)) onValue(given);
  };
  return field(
    text,
    html`<input
      type="number"
      step=${step}
      inputmode="decimal"
      .value=${String(Number(value.toFixed(4)))}
      @change=${change}
    />`,
  );
}

/**
 * Buttons of which one is pressed.
 * @template T
 * @param {string} label
 * @param {Array<{value: T, text: string, title?: string}>} options
 * @param {T} chosen
 * @param {(value: T) => void} choose
 */
const segmented = (label, options, chosen, choose) =>
  html`<div class="segmented" role="group" aria-label=${label}>
    ${options.map(
      ({ value, text, title }) =>
        html`<button
          type="button"
          aria-pressed=${value === chosen}
          title=${title ?? nothing}
          @click=${() => choose(value)}
        >
          ${text}
        </button>`,
    )}
  </div>`;

/**
 * The fields beside the slice.
 * @param {SliceState} state
 * @param {SliceFacts | null} facts
 * @param {Act} act
 */
export const controls = (state, facts, act) =>
  html`${segmented(
      t("kind-of-slice"),
      KINDS.map(([value, text, key]) => ({ value, text, title: `${text}  ${key}` })),
      state.kind,
      act.toKind,
    )}
    <div class="where">${PLACES[state.kind](state, facts, act)}</div>
    <div class="how">${looks(state, facts, act)}</div>`;

/**
 * The fields of the plane, by kind.
 * @type {Record<Kind, (state: SliceState, facts: SliceFacts | null, act: Act) => Content>}
 */
const PLACES = {
  horizontal({ z }, facts, { change }) {
    const [low, high] = facts ? facts.bounds_m.map((p) => p[2]) : [-5, 5];
    const slide = (/** @type {Event} */ event) => change({ z: Number(targetOf(event).value) });
    return html`${number(t("height-z"), z, 0.01, (value) => change({ z: value }))}
      <input
        type="range"
        min=${low ?? nothing}
        max=${high ?? nothing}
        step="0.01"
        aria-label=${t("height")}
        .value=${String(z)}
        @input=${slide}
      />`;
  },
  vertical(state, _, { change }) {
    const end = (/** @type {"a" | "b"} */ key, /** @type {number} */ axis) =>
      number(`${key.toUpperCase()} ${"xy"[axis]} [m]`, state[key][axis], 0.01, (x) =>
        change({ [key]: state[key].map((old, k) => (k === axis ? x : old)) }),
      );
    return html`<div class="pair">${end("a", 0)}${end("a", 1)}${end("b", 0)}${end("b", 1)}</div>`;
  },
  free({ n, o }, _, { change }) {
    const angles = anglesOf(n);
    const turn = (/** @type {"azimuth" | "tilt"} */ key) => (/** @type {number} */ degrees) =>
      change({ n: normalFrom({ ...angles, [key]: degrees }) });
    const through = (/** @type {number} */ axis) =>
      number(`${"xyz"[axis]} [m]`, o[axis], 0.01, (x) =>
        change({ o: o.map((old, k) => (k === axis ? x : old)) }),
      );
    return html`<div class="pair">
      ${number(t("azimuth"), angles.azimuth, 1, turn("azimuth"))}
      ${number(t("tilt-from-level"), angles.tilt, 1, turn("tilt"))}
      ${through(0)}${through(1)}${through(2)}
    </div>`;
  },
};

/**
 * @param {SliceState} state
 * @param {SliceFacts | null} facts
 * @param {Act} act
 */
function looks(state, facts, { change }) {
  const keep = { keep: true };
  const setColor = (/** @type {string} */ color) =>
    change({ color: /** @type {Color} */ (color), lo: null, hi: null }, keep);
  const colors = ALL_COLORS.filter(
    ([key]) =>
      (key !== "normalized" || !facts || facts.fields.includes("intensity_normalized")) &&
      (key !== "distance" || state.ref),
  );
  const setThickness = (/** @type {number} */ cm) => cm > 0 && change({ t: cm / 100 }, keep);
  const setStep = (/** @type {number} */ step) => step > 0 && change({ step }, keep);
  return html`<div class="pair">
      ${number(t("thickness"), state.t * 100, 1, setThickness)}
      ${number(t("step"), state.step, 0.01, setStep)}
    </div>
    ${segmented(
      t("usual-thickness"),
      [
        { value: 0.02, text: t("thin") },
        { value: 0.1, text: t("thick") },
      ],
      state.t,
      (t) => change({ t }, keep),
    )}
    ${
      facts?.surface === "fitted"
        ? segmented(
            t("where-drawn"),
            ALL_SURFACES.map(([value, text]) => ({
              value,
              text: t("points-where", { surface: text }),
              title: `${t("points-where", { surface: text })}  R`,
            })),
            state.surface,
            (surface) => change({ surface }, keep),
          )
        : nothing
    }
    ${field(t("color-by"), choice(t("color-by"), colors, state.color, setColor))}
    ${facts?.references.length ? referenceField(state, facts, change) : nothing}`;
}

/**
 * @param {SliceState} state
 * @param {SliceFacts} facts
 * @param {Act["change"]} change
 */
function referenceField({ ref: chosen, color: before }, { references }, change) {
  const set = (/** @type {string} */ ref) => {
    const color = ref ? "distance" : before === "distance" ? "height" : before;
    change({ ref, color, lo: null, hi: null }, { keep: true });
  };
  /** @type {Array<[string, string]>} */
  const options = [["", t("no-reference")]];
  for (const one of references) options.push([one.id, one.name]);
  return field(t("reference"), choice(t("reference"), options, chosen, set));
}

/**
 * The choices of map and color of the second slice.
 * @param {SliceState} state
 * @param {SliceFacts | null} facts
 * @param {Act} act
 */
export function besideFields(state, facts, { change }) {
  /** @type {Array<[string, string]>} */
  const sources = [["", t("this-map")]];
  for (const one of facts?.sources ?? []) sources.push([one.id, sourceText(one)]);
  /** @type {Array<[string, string]>} */
  const colors = [["", state.beside ? t("same-color") : t("one-slice")]];
  for (const [key, text] of ALL_COLORS)
    if (key !== "distance" || state.ref)
      colors.push([
        key,
        t("beside-color", { color: language() === "en" ? text.toLowerCase() : text }),
      ]);
  return [
    choice(t("map-beside"), sources, state.beside, (beside) => change({ beside }, { keep: true })),
    choice(t("color-beside"), colors, state.besideColor, (color) =>
      change({ besideColor: /** @type {Color | ""} */ (color) }, { keep: true }),
    ),
  ];
}
