// What the server takes of a brush. No DOM, no network.

export const MOST_PLACES = 2000;
export const RADII_M = { least: 0.005, most: 5 };
