// SPDX-License-Identifier: MIT OR Apache-2.0
// Colors of faces, each [red, green, blue] in [0, 1].

export const CLAY = [0.85, 0.78, 0.66];
export const FLIPPED = [0.55, 0.1, 0.75];
const AREAS = [[0.13, 0.4, 0.67], [0.97, 0.97, 0.955], [0.7, 0.09, 0.17]];
const SHEARS = [[0.97, 0.955, 0.92], [0.965, 0.64, 0.3], [0.486, 0.114, 0.31]];

// Areas from half to twice the fair share; shear from 1 to 2.
export const LEGENDS = {
  area: ["too small (½)", "too large (2×)"],
  shear: ["1", "2"],
};

// The colors of faces, (m) of them, as a flat array.
export function faceColors(shading, { areaRatios, shears, islands }) {
  const color = {
    area: (face) => ramp(AREAS, (areaRatios[face] + 1) / 2),
    shear: (face) => ramp(SHEARS, shears[face] - 1),
    islands: (face) => islandColor(islands[face]),
    checker: (face) => islandColor(islands[face]),
  }[shading];
  const colors = new Float32Array(3 * islands.length);
  for (let face = 0; face < islands.length; face += 1) {
    const isFlipped = !Number.isFinite(areaRatios[face]);
    colors.set(isFlipped && shading !== "islands" ? FLIPPED : color(face), 3 * face);
  }
  return colors;
}

// Neighboring numbers have hues far apart.
export function islandColor(island) {
  const hue = (0.52 + 0.381966 * island) % 1;
  const channel = (shift) => 0.5 + 0.5 * Math.cos(2 * Math.PI * (hue + shift));
  return [0, -1 / 3, 1 / 3].map((shift) => 0.62 + 0.28 * channel(shift));
}

function ramp(stops, at) {
  const place = Math.min(Math.max(at, 0), 1) * (stops.length - 1);
  const low = Math.min(Math.floor(place), stops.length - 2);
  return stops[low].map((value, k) => value + (place - low) * (stops[low + 1][k] - value));
}
