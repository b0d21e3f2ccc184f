// Captions and units of the review page, and its keys. No DOM, no network.

export const VERDICTS = {
  accepted: { mark: "✓", word: "Accepted" },
  rejected: { mark: "✕", word: "Rejected" },
  unverified: { mark: "◌", word: "Unverified" },
};

export const KINDS = {
  accept: "accepted",
  reject: "rejected",
  restore: "restored the automatic decision on",
  replace: "registered again",
  add: "added",
  undo: "undid",
  redo: "redid",
  approve: "approved the map",
};

/** What each key does; the help sheet is made of this. */
export const KEYS = [
  ["J", "Next pair"],
  ["K", "Previous pair"],
  ["A", "Accept, once the points of this pair are drawn"],
  ["R", "Reject, once the points of this pair are drawn"],
  ["U or Backspace", "Restore the automatic decision"],
  ["Ctrl Z", "Undo"],
  ["Ctrl Y", "Redo"],
  ["Arrows", "Move the second place by 5 cm (Shift: 1 cm, Alt: 50 cm)"],
  [", and .", "Turn it by 1° (Shift: 0.1°, Alt: 10°)"],
  ["Page up, Page down", "Lift it, lower it"],
  ["P", "Pick the same three points in both places"],
  ["Enter", "Refine from here; once more: create the edge"],
  ["Escape", "Drop the new alignment"],
  ["L", "Add a loop closure between any two multiframes"],
  ["V", "Next view: above, side, free, cut"],
  ["B", "Compare: odometry, graph, aligned"],
  ["D", "Difference: in color only what one place has alone"],
  ["[ and ]", "Move the cut"],
  ["+ and −", "Zoom"],
  ["W", "Write a reason"],
  ["?", "This list"],
  [
    "A key held down",
    "Acts once, except for moving, turning, cut and zoom. " +
      "After a decision A and R act again once another pair is drawn",
  ],
];

export const seconds = (s) =>
  s < 60
    ? `${s.toFixed(1)} s`
    : `${Math.floor(s / 60)}:${(s % 60).toFixed(0).padStart(2, "0")} min`;

export function length(m) {
  if (m === null || m === undefined) return "–";
  if (m < 0.0995) return `${(m * 1000).toFixed(m < 0.00995 ? 1 : 0)} mm`;
  return m < 0.995 ? `${(m * 100).toFixed(0)} cm` : `${m.toFixed(2)} m`;
}

export const degrees = (rad, digits = 1) => `${((rad * 180) / Math.PI).toFixed(digits)}°`;
export const percent = (v) => (v === null || v === undefined ? "–" : `${Math.round(v * 100)} %`);
export const plain = (v, digits = 3) =>
  v === null || v === undefined ? "–" : Number(v.toPrecision(digits)).toString();
export const keyOf = ([i, j]) => `${i}-${j}`;
