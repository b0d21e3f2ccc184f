// The badge with the state of a project or job: mark and word, never color alone.

import { make } from "./dom.js";
import { STATES } from "./format.js";

export function badge(state) {
  const { mark, word } = STATES[state];
  return make(
    "span",
    { className: `badge ${state}` },
    make("span", { ariaHidden: "true" }, mark),
    ` ${word}`,
  );
}
