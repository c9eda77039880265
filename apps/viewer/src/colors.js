// SPDX-License-Identifier: BSD-3-Clause
//
// Colours: of numbers (viridis by S. van der Walt and N. Smith, CC0, at a few places of it), and of parts.

const VIRIDIS = [[68, 1, 84], [71, 36, 117], [65, 68, 135], [53, 95, 141], [42, 120, 142], [33, 145, 140], [34, 168, 132],
  [68, 191, 112], [122, 209, 81], [189, 223, 38], [253, 231, 37]];

/** The colour [r, g, b] of a share 0 ... 1. */
export function ofShare(share) {
  const at = Math.min(1, Math.max(0, share)) * (VIRIDIS.length - 1);
  const i = Math.min(VIRIDIS.length - 2, Math.floor(at));
  return VIRIDIS[i].map((from, k) => Math.round(from + (at - i) * (VIRIDIS[i + 1][k] - from)));
}

/** How many colours parts have before they repeat. */
export const PART_COLORS = 64;

// Six of Okabe and Ito, which colour-blind people tell apart, and a violet; then hues by the golden angle, from where
// the next ones are least like these.
const FIRST = [[86, 160, 220], [230, 159, 0], [0, 158, 115], [204, 121, 167], [213, 94, 0], [240, 228, 66], [134, 104, 214]];

/** The colour [r, g, b] of the i-th part. */
export function ofPart(i) {
  const place = i % PART_COLORS;
  if (place < FIRST.length) return FIRST[place];
  const hue = (place * 137.508 + 291) % 360;
  const light = 0.45 + 0.08 * (place % 4);
  const channel = (n) => {
    const k = (n + hue / 30) % 12;
    return Math.round(255 * (light - 0.55 * Math.min(light, 1 - light) * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return [channel(0), channel(8), channel(4)];
}

export const css = ([r, g, b]) => `rgb(${r} ${g} ${b})`;

/** 256 texels of the map of numbers, then those of parts: a texture of two rows. */
export function colorTexels() {
  const texels = new Uint8Array(2 * 256 * 4);
  for (let i = 0; i < 256; ++i) {
    texels.set([...ofShare(i / 255), 255], 4 * i);
    texels.set([...ofPart(i), 255], 4 * (256 + i));
  }
  return texels;
}
