// The legend of a slice: colors with their range, which may be changed. No network.

import { make } from "../shared/dom.js";
import { COLORS } from "./state.js";

const UNITS = { height: "m", time: "s", distance: "cm" };

/** Fills the legend; `onRange(low, high)` when a person changes its ends, nulls = automatic. */
export function legend(root, { state, shown, facts, onRange }) {
  if (root.contains(document.activeElement)) return;
  const scale = state.color === "distance" ? 100 : 1;
  const unit = UNITS[state.color] ? ` [${UNITS[state.color]}]` : "";
  const head = make("span", { className: "what" }, `${COLORS[state.color]}${unit}`);
  const green = state.ref
    ? make(
        "span",
        { className: "reference" },
        make("i", {}),
        facts.references.find((one) => one.id === state.ref)?.name ?? "Reference",
      )
    : null;
  if (state.color === "sensor") {
    const names = facts.sensors.length ? facts.sensors : ["1", "2"];
    const swatch = (name, k) => {
      const mark = make("i", {});
      mark.style.background = shown.colors[k % shown.colors.length];
      return make("span", { className: "swatch" }, mark, name);
    };
    root.replaceChildren(...[head, ...names.map(swatch), green].filter(Boolean));
    return;
  }
  const end = (value, text, which) => {
    const input = make("input", {
      type: "number",
      step: "any",
      value: String(Number((value * scale).toPrecision(4))),
      ariaLabel: text,
    });
    input.addEventListener("change", () => {
      const x = input.valueAsNumber / scale;
      const range = which ? [state.lo ?? shown.low, x] : [x, state.hi ?? shown.high];
      input.blur();
      if (Number.isFinite(x) && range[1] > range[0]) onRange(...range);
    });
    return input;
  };
  const bar = make("span", { className: "ramp" });
  bar.style.background = `linear-gradient(90deg, ${shown.colors.join(", ")})`;
  const usual =
    state.lo !== null || state.hi !== null
      ? make("button", { type: "button", onclick: () => onRange(null, null) }, "Usual range")
      : null;
  root.replaceChildren(
    ...[
      head,
      end(shown.low, "Low end of the colors", 0),
      bar,
      end(shown.high, "High end of the colors", 1),
      usual,
      green,
    ].filter(Boolean),
  );
}
