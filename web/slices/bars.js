// The bars of a histogram. No DOM, no network.

export const HEIGHT = 100;

/** Bars [x, y, width, height] in a box of width 1 a class and height 100. */
export function bars(/** @type {number[]} */ classes) {
  const most = Math.max(...classes);
  return classes.map((n, k) => {
    const height = most ? (HEIGHT * n) / most : 0;
    return [k, HEIGHT - height, 1, height];
  });
}
