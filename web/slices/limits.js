// The limits of a job at its control and check points. No network.

import { make } from "../shared/dom.js";

/** @type {Array<[string, string]>} */
const FIELDS = [
  ["mean_horizontal_m", "Mean horizontal"],
  ["mean_height_m", "Mean height"],
  ["max_horizontal_m", "Largest horizontal"],
  ["max_height_m", "Largest height"],
  ["distances_m", "Distances between points"],
  ["survey_sd_m", "Standard deviation of survey and picking"],
];

/** The form of the limits; `keep(limits)` when a person sets them, null = the usual ones. */
export function limitsForm(limits, text, keep) {
  const inputs = FIELDS.map(([key, label]) =>
    make("input", {
      type: "number",
      min: 0.1,
      max: 10_000,
      step: "any",
      value: limits[key] === null ? "" : String(Number((limits[key] * 100).toPrecision(6))),
      placeholder: "not required",
      required: key === "survey_sd_m",
      ariaLabel: `${label} [cm]`,
    }),
  );
  const set = () =>
    Object.fromEntries(
      FIELDS.map(([key], k) => [
        key,
        inputs[k].value === "" ? null : Number((inputs[k].valueAsNumber / 100).toPrecision(9)),
      ]),
    );
  const form = make(
    "form",
    {
      className: "limits",
      onsubmit: (event) => {
        event.preventDefault();
        keep(set());
      },
    },
    ...FIELDS.map(([, label], k) =>
      make("label", {}, make("span", {}, `${label} [cm]`), inputs[k]),
    ),
    make(
      "div",
      { className: "buttons" },
      make("button", {}, "Set limits"),
      make("button", { type: "button", onclick: () => keep(null) }, "Usual limits"),
    ),
  );
  return make(
    "details",
    {},
    make("summary", {}, `Limits: ${text}`),
    make(
      "p",
      { className: "quiet" },
      "They hold for this project, and stand on the sheet and in the CSV. Empty = not required. ",
      "A residual more than 3 standard deviations of survey and map together is flagged.",
    ),
    form,
  );
}
