// Where a surveyed point was measured, and in which directions. No DOM, no network.

const ALONG = 0.02; // of a unit vector outside of known directions: shorter is none of its own

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const plus = (a, b, times = 1) => a.map((x, k) => x + times * b[k]);

/** The part of a vector in the directions of orthonormal rows. */
const within = (rows, v) => rows.reduce((sum, row) => plus(sum, row, dot(row, v)), [0, 0, 0]);

/** Orthonormal rows that span `known` (orthonormal) and further directions. */
function extended(known, directions) {
  const rows = [...known];
  for (const one of directions) {
    const unit = one.map((x) => x / Math.hypot(...one));
    const rest = plus(unit, within(rows, unit), -1);
    const length = Math.hypot(...rest);
    if (rows.length < 3 && length > ALONG) rows.push(rest.map((x) => x / length));
  }
  return rows;
}

/**
 * A measurement {p, along} and an earlier one of the same point: the new one counts in its own
 * directions, the earlier one in those that the new one leaves open.
 */
export function combined(earlier, later) {
  const own = extended([], later.along);
  if (!earlier) return { p: later.p, along: own };
  const all = extended(own, earlier.along);
  const open = all.slice(own.length);
  return { p: plus(later.p, within(open, plus(earlier.p, later.p, -1))), along: all };
}
