// The profile of a strip of the map between two points, as a plot below the map.

import { idHere } from "../shared/address.js";
import { readSlice, sliceFileUrl, slicesUrl } from "../shared/api.js";
import { asError, byId, html, nothing, render, svg, targetOf } from "../shared/dom.js";
import { askFirst } from "../shared/download.js";
import { count } from "../shared/format.js";
import { roundStep } from "../shared/scale_bar.js";
import { t, written } from "../shared/texts.js";
import { sliceQuery } from "./clip.js";
import { PROFILE_M } from "./measure.js";
import { heightsShown, page } from "./page.js";

/**
 * @import {SliceImageView, WindowSpec} from "../shared/http_types"
 * @import {Measurement} from "./measure.js"
 * @typedef {object} ProfileView
 * @property {Measurement} of
 * @property {SliceImageView | null} image
 * @property {string} problem
 */

const id = idHere();
const [LEAST_PX, MOST_PX] = [16, 4096]; // of an image, across or up
const LEAST_UP_PX = 120;
const MARGIN = { left: 46, bottom: 24, top: 8, right: 12 };
const TICK_PX = { across: 120, up: 60 };
/** What the plot leaves of half of the window, for its buttons and captions. */
const AROUND_PX = 240;
/** What is beside the plot with the panel of the map, and without: as in map.css. */
const BESIDE_PX = { panel: 360, alone: 50 };
const NARROW_PX = 800;
const BEYOND_M = 0.05;

/** The strip of a profile, as the slices take it: u counts from the first point. */
function stripOf(/** @type {Measurement} */ { points: [a, b], figure }) {
  const [low, high] = heightsShown();
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  return {
    plane: {
      kind: /** @type {const} */ ("vertical"),
      a_m: /** @type {[number, number]} */ ([a[0], a[1]]),
      b_m: /** @type {[number, number]} */ ([b[0], b[1]]),
      thickness_m: figure ?? PROFILE_M,
    },
    window: { left: 0, right: length, bottom: low - BEYOND_M, top: high + BEYOND_M },
  };
}

/**
 * Pixels of the screen that the image of a profile takes: a larger image would lose thin lines.
 * @param {{right: number, bottom: number, top: number}} window of the plane [m]; left is 0
 * @param {number[]} most pixels of the page across and up
 */
function pixelsOf({ right, bottom, top }, [across, up]) {
  const pixel_m = Math.max(right / across, (top - bottom) / up);
  const px = (/** @type {number} */ m) =>
    Math.min(MOST_PX, Math.max(LEAST_PX, Math.round((m / pixel_m) * globalThis.devicePixelRatio)));
  return { wide: px(right), tall: px(top - bottom) };
}

/**
 * What shows a profile.
 * @param {{draw: () => void, dark: () => boolean,
 *   change: (of: Measurement, width: number) => Measurement}} on
 */
export function profileOf({ draw, dark, change }) {
  async function show(/** @type {Measurement} */ of) {
    const shown = (page.profile = /** @type {ProfileView} */ ({ of, image: null, problem: "" }));
    draw();
    try {
      const { plane, window } = stripOf(of);
      const { wide, tall } = pixelsOf(window, room());
      shown.image = await readSlice(id, {
        plane,
        window,
        color: "intensity",
        width: wide,
        height: tall,
        ground: dark() ? "dark" : "light",
      });
    } catch (error) {
      shown.problem = asError(error).message;
    }
    draw();
  }
  return {
    show,
    close() {
      page.profile = null;
      draw();
    },
    widen: (/** @type {number} */ width) => page.profile && show(change(page.profile.of, width)),
  };
}

/**
 * Draws the plot; without a profile nothing.
 * @param {HTMLElement} element
 * @param {ReturnType<typeof profileOf>} act
 */
export function drawProfile(element, act) {
  const { profile } = page;
  element.hidden = !profile;
  if (!profile) return render(nothing, element);
  const { of, image, problem } = profile;
  const ask = { ...stripOf(of), flat: true };
  const places = () => ({ message: byId("message"), status: byId("status") });
  const link = (/** @type {string} */ ending, /** @type {string} */ text) =>
    html`<a class="button" href=${sliceFileUrl(id, ending, ask)} download @click=${askFirst(places)}
      >${text}</a
    >`;
  return render(
    html`<h2 id="profile-title">${of.name}</h2>
      <div class="buttons">
        <label
          ><span>${t("strip-width")}</span
          ><input
            type="number"
            min="0.01"
            max="100"
            step="0.05"
            .value=${String(of.figure ?? PROFILE_M)}
            @change=${(/** @type {Event} */ event) => {
              const width = Number(targetOf(event).value);
              if (width > 0 && width <= 100) act.widen(width);
            }}
        /></label>
        ${link("csv", "CSV")} ${link("dxf", "DXF")}
        <a class="button" href="${slicesUrl(id)}?${sliceQuery(ask.plane)}">${t("open-as-slice")}</a>
        <button type="button" @click=${act.close}>${t("close")}</button>
      </div>
      ${problem ? html`<p class="error" role="alert">${problem}</p>` : nothing}
      ${
        image ? plot(image, room()) : problem ? nothing : html`<p class="quiet">${t("drawing")}</p>`
      }`,
    element,
  );
}

/** Most pixels of a plot across and up: it is drawn in pixels of the screen, with its labels. */
function room() {
  const { left, right } = MARGIN;
  const beside = page.panel && innerWidth > NARROW_PX ? BESIDE_PX.panel : BESIDE_PX.alone;
  return [
    Math.max(200, innerWidth - beside - left - right),
    Math.min(300, Math.max(LEAST_UP_PX, innerHeight / 2 - AROUND_PX)),
  ];
}

/**
 * The image with its axes: distance from the first point, and height.
 * @param {SliceImageView} image
 * @param {number[]} most pixels across and up
 */
function plot({ png, window, points }, [across, up]) {
  const [length, height] = [window.right - window.left, window.top - window.bottom];
  const pixel_m = Math.max(length / across, height / up);
  const [wide, tall] = [length / pixel_m, height / pixel_m];
  const { left, right, top, bottom } = MARGIN;
  const x = (/** @type {number} */ u) => left + (u - window.left) / pixel_m;
  const y = (/** @type {number} */ z) => top + (window.top - z) / pixel_m;
  const ticks = (
    /** @type {number} */ from,
    /** @type {number} */ to,
    /** @type {number} */ most,
  ) => {
    const step = roundStep((to - from) / most);
    const [first, last] = [Math.ceil(from / step), Math.floor(to / step)];
    return Array.from({ length: Math.max(0, last - first + 1) }, (_, k) => (first + k) * step);
  };
  const text = (/** @type {number} */ value) => written(String(Number(value.toPrecision(6))));
  return html`<svg
      width=${wide + left + right}
      height=${tall + top + bottom}
      role="img"
      aria-label=${t("profile-label", { points: count(points), range: rangeText(window) })}
    >
      <image x=${left} y=${top} width=${wide} height=${tall} href="data:image/png;base64,${png}" />
      ${ticks(window.left, window.right, Math.max(1, wide / TICK_PX.across)).map(
        (u) =>
          svg`<line x1=${x(u)} x2=${x(u)} y1=${top} y2=${top + tall + 5} />
            <text x=${x(u)} y=${top + tall + 19} text-anchor="middle">${text(u)}</text>`,
      )}
      ${ticks(window.bottom, window.top, Math.max(1, tall / TICK_PX.up)).map(
        (z) =>
          svg`<line x1=${left - 5} x2=${left + wide} y1=${y(z)} y2=${y(z)} />
            <text x=${left - 8} y=${y(z) + 4} text-anchor="end">${text(z)}</text>`,
      )}
    </svg>
    <p class="quiet">${t("profile-axes", { points: count(points) })}</p>`;
}

const rangeText = (/** @type {WindowSpec} */ { right, left, bottom, top }) =>
  t("profile-range", { length: right - left, low: bottom, high: top });
