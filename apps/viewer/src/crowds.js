// SPDX-License-Identifier: BSD-3-Clause
//
// Events that are drawn on top of each other: crowds, each drawn as one mark with a number.

const APART = 8;   // pixels: dots that are nearer to each other cannot be told apart
const WIDEST = 22; // pixels that a mark stands for, at most

/** The width of a mark with a number, in pixels. */
export const widthOf = (count) => Math.min(WIDEST - 1, 7 + 5 * String(count).length);

/** Members from x to x + WIDEST as one mark each; what is alone stays where it is. */
function split(chain) {
  const from = chain[0].x;
  const extent = chain.at(-1).x - from;
  const count = Math.max(1, Math.ceil(extent / WIDEST));
  const size = extent / count || 1;
  const bins = Array.from({ length: count }, () => []);
  for (const place of chain) bins[Math.min(count - 1, Math.floor((place.x - from) / size))].push(place);
  return bins.map((members, b) => ({ members, y: chain[0].y,
    x: members.length === 1 ? members[0].x : count === 1 ? from + extent / 2 : from + (b + 0.5) * size }))
    .filter(({ members }) => members.length > 0);
}

/** Marks { x, y, members } for places { x, y, ... } in the order of x, members in the order of time. Places of one y that
 *  are near each other make a mark together. */
export function crowdsOf(places) {
  const lanes = new Map();
  for (const place of places) lanes.set(place.y, [...(lanes.get(place.y) ?? []), place]);
  const marks = [];
  for (const lane of lanes.values()) {
    lane.sort((a, b) => a.x - b.x || a.i - b.i);
    let chain = [];
    for (const place of lane) {
      if (chain.length > 0 && place.x - chain.at(-1).x >= APART) marks.push(...split(chain.splice(0)));
      chain.push(place);
    }
    marks.push(...split(chain));
  }
  return marks.sort((a, b) => a.members[0].i - b.members[0].i);
}
