// Where to cut and what to show: the fields beside the slice. No network.

import { fill, make } from "../shared/dom.js";
import { anglesOf, COLORS, normalFrom, SURFACES } from "./state.js";

/** @type {Array<[string, string, string]>} */
const KINDS = [
  ["horizontal", "Horizontal", "H"],
  ["vertical", "Vertical", "V"],
  ["free", "Free", "F"],
];

const field = (text, control) => make("label", {}, make("span", {}, text), control);

function number(text, value, step, onValue) {
  const input = make("input", {
    type: "number",
    step: String(step),
    value: String(Number(value.toFixed(4))),
    inputMode: "decimal",
  });
  input.addEventListener(
    "change",
    () => Number.isFinite(input.valueAsNumber) && onValue(input.valueAsNumber),
  );
  return field(text, input);
}

function select(options, value, onValue) {
  const element = make(
    "select",
    {},
    ...options.map(([key, text]) => make("option", { value: key }, text)),
  );
  element.value = value;
  element.addEventListener("change", () => onValue(element.value));
  return element;
}

/** Fills the panel; `show(state)` and `facts(facts)` update it. */
export function controls(root, { change, toKind }) {
  const kinds = make("div", { className: "segmented", role: "group", ariaLabel: "Kind of slice" });
  const where = make("div", { className: "where" });
  const how = make("div", { className: "how" });
  const besideMap = make("select", { ariaLabel: "Map beside" });
  const besideColor = make("select", { ariaLabel: "Color beside" });
  let facts = null;
  root.append(kinds, where, how);
  besideMap.addEventListener("change", () => change({ beside: besideMap.value }, { keep: true }));
  besideColor.addEventListener("change", () =>
    change({ besideColor: besideColor.value }, { keep: true }),
  );

  function places(state) {
    if (state.kind === "horizontal") {
      const [low, high] = facts ? facts.bounds_m.map((p) => p[2]) : [-5, 5];
      const slider = make("input", {
        type: "range",
        min: low,
        max: high,
        step: 0.01,
        value: state.z,
        ariaLabel: "Height",
      });
      slider.addEventListener("input", () => change({ z: Number(slider.value) }));
      return [number("Height z [m]", state.z, 0.01, (z) => change({ z })), slider];
    }
    if (state.kind === "vertical") {
      const end = (key, axis) =>
        number(`${key.toUpperCase()} ${"xy"[axis]} [m]`, state[key][axis], 0.01, (x) =>
          change({ [key]: state[key].map((old, k) => (k === axis ? x : old)) }),
        );
      return [
        make("div", { className: "pair" }, end("a", 0), end("a", 1), end("b", 0), end("b", 1)),
      ];
    }
    const angles = anglesOf(state.n);
    const turn = (key) => (degrees) => change({ n: normalFrom({ ...angles, [key]: degrees }) });
    const through = (axis) =>
      number(`${"xyz"[axis]} [m]`, state.o[axis], 0.01, (x) =>
        change({ o: state.o.map((old, k) => (k === axis ? x : old)) }),
      );
    return [
      make(
        "div",
        { className: "pair" },
        number("Azimuth of the normal [°]", angles.azimuth, 1, turn("azimuth")),
        number("Tilt from level [°]", angles.tilt, 1, turn("tilt")),
        through(0),
        through(1),
        through(2),
      ),
    ];
  }

  function kindButton([kind, text, key], state) {
    return make(
      "button",
      {
        type: "button",
        ariaPressed: String(state.kind === kind),
        title: `${text}  ${key}`,
        onclick: () => toKind(kind),
      },
      text,
    );
  }

  const thick = (state, text, t) =>
    make(
      "button",
      {
        type: "button",
        ariaPressed: String(state.t === t),
        onclick: () => change({ t }, { keep: true }),
      },
      text,
    );

  const points = (state) =>
    make(
      "div",
      { className: "segmented", role: "group", ariaLabel: "Where points are drawn" },
      ...Object.entries(SURFACES).map(([surface, text]) =>
        make(
          "button",
          {
            type: "button",
            ariaPressed: String(state.surface === surface),
            title: `Points ${text}  R`,
            onclick: () => change({ surface }, { keep: true }),
          },
          `Points ${text}`,
        ),
      ),
    );

  function looks(state) {
    const colors = Object.entries(COLORS).filter(
      ([key]) => key !== "normalized" || !facts || facts.fields.includes("intensity_normalized"),
    );
    const able = colors.filter(([key]) => key !== "distance" || state.ref);
    const references = [
      ["", "None"],
      ...(facts?.references ?? []).map((one) => [one.id, one.name]),
    ];
    return [
      make(
        "div",
        { className: "pair" },
        number(
          "Thickness [cm]",
          state.t * 100,
          1,
          (cm) => cm > 0 && change({ t: cm / 100 }, { keep: true }),
        ),
        number("Step [m]", state.step, 0.01, (m) => m > 0 && change({ step: m }, { keep: true })),
      ),
      make(
        "div",
        { className: "segmented", role: "group", ariaLabel: "Usual thickness" },
        thick(state, "Thin, 2 cm", 0.02),
        thick(state, "Thick, 10 cm", 0.1),
      ),
      facts?.surface === "fitted" ? points(state) : null,
      field(
        "Color by",
        select(able, state.color, (color) => change({ color, lo: null, hi: null }, { keep: true })),
      ),
      references.length > 1
        ? field(
            "Reference",
            select(references, state.ref, (ref) =>
              change(
                {
                  ref,
                  color: ref ? "distance" : state.color === "distance" ? "height" : state.color,
                  lo: null,
                  hi: null,
                },
                { keep: true },
              ),
            ),
          )
        : null,
    ];
  }

  function options(element, pairs, value) {
    fill(element, ...pairs.map(([key, text]) => make("option", { value: key }, text)));
    element.value = value;
  }

  let last = null;

  function show(state) {
    last = state;
    fill(kinds, ...KINDS.map(() => null));
    kinds.replaceChildren(...KINDS.map((kind) => kindButton(kind, state)));
    if (!where.contains(document.activeElement) || where.dataset.kind !== state.kind)
      where.replaceChildren(...places(state));
    where.dataset.kind = state.kind;
    if (!how.contains(document.activeElement) || !document.activeElement.matches("input, select"))
      how.replaceChildren(...looks(state).filter(Boolean));
    const sources = [["", "This map"], ...(facts?.sources ?? []).map((one) => [one.id, one.label])];
    options(besideMap, sources, state.beside);
    const colors = Object.entries(COLORS).filter(([key]) => key !== "distance" || state.ref);
    options(
      besideColor,
      [
        ["", state.beside ? "Same color" : "One slice"],
        ...colors.map(([key, text]) => [key, `Beside: ${text.toLowerCase()}`]),
      ],
      state.besideColor,
    );
  }

  return {
    show,
    facts(fresh) {
      facts = fresh;
      if (last) show(last);
    },
    beside: [besideMap, besideColor],
  };
}
