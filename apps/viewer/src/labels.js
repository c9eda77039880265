// SPDX-License-Identifier: BSD-3-Clause
//
// The labels of the box: of each axis its name and what it has at its ends. They stand along edges of the box's outline,
// outside of it, so that they cover nothing that is shown, and none covers another, nor the legend. What has no room is
// left out.
import { ends } from './time.js';

const OPPOSITE = { R: 'L', L: 'R', A: 'P', P: 'A', S: 'I', I: 'S' };
const KINDS = ['lowest', 'highest', 'name'];
/** Where on its edge (0 ... 1) a label may stand, the best place first; and how far away from it, in pixels. */
const PLACES = { lowest: [0.03, 0.08, 0.13, -0.05], highest: [0.97, 0.92, 0.87, 1.05],
  name: [0.5, 0.42, 0.58, 0.34, 0.66, 0.27, 0.73] };
const DISTANCES = { lowest: [5, 17, 30], highest: [5, 17, 30], name: [5, 14, 24, 36, 50] };
/** What it costs to leave a label out. */
const MISSED = { lowest: 60, highest: 60, name: 80 };
const MARGIN = 3; // between labels, and to what is around the picture

const overlaps = (a, b) => Math.abs(a.x - b.x) < a.halfWidth + b.halfWidth + MARGIN &&
  Math.abs(a.y - b.y) < a.halfHeight + b.halfHeight + MARGIN;

export class AxisLabels {
  /** `world`: "RAS" or the like, or null: what of a patient the axes grow towards. */
  constructor(host, { axes, lower, upper, extents, world, isFlat }) {
    this.isFlat = isFlat;
    this.obstacles = [];
    this.all = axes.map((axis, a) => {
      const text = ends(lower[a], upper[a], extents[a] / 4);
      return KINDS.map((kind) => {
        const element = document.createElement('span');
        element.className = `axis-label ${kind}`;
        let unit = null;
        if (kind === 'name') {
          element.textContent = axis.name;
          unit = document.createElement('span');
          unit.textContent = axis.unit ? ` (${axis.unit})` : '';
          element.append(unit);
        } else element.textContent = text(kind === 'lowest' ? lower[a] : upper[a]);
        if (kind !== 'name' && world) {
          const side = document.createElement('b');
          side.textContent = kind === 'highest' ? world[a] : OPPOSITE[world[a]];
          element.prepend(side, ' ');
        }
        host.append(element);
        return { kind, element, unit, place: null };
      });
    });
  }

  /** How large they are. */
  measure() {
    for (const label of this.all.flat()) {
      if (label.unit) label.unit.hidden = false;
      label.sizes = [{ width: label.element.offsetWidth, height: label.element.offsetHeight, isShort: false }];
      if (!label.unit?.textContent) continue;
      label.unit.hidden = true;
      label.sizes.push({ width: label.element.offsetWidth, height: label.element.offsetHeight, isShort: true });
    }
  }

  /** How much of a picture of this size they need at the left and right, and above and below. */
  room(width, height) {
    const flat = this.all.flat();
    const widest = Math.max(...flat.filter(({ kind }) => kind !== 'name').map((label) => label.sizes[0].width));
    const { height: line } = flat[0].sizes[0];
    return { x: Math.min(widest + 2.2 * line, 0.21 * width), y: Math.min(2.4 * line, 0.18 * height) };
  }

  hide() {
    for (const label of this.all.flat()) this.show(label, null);
  }

  show(label, place) {
    label.place = place;
    label.element.style.visibility = place ? '' : 'hidden';
    if (!place) return;
    if (label.unit) label.unit.hidden = place.isShort;
    label.element.style.transform = `translate(-50%, -50%) translate(${place.x.toFixed(1)}px, ${place.y.toFixed(1)}px)` +
      (place.isUpright ? ' rotate(-90deg)' : '');
  }

  /** Places them. `edges[a]`: edges of the outline along axis a, each from its lowest end { x, y } to its highest, on the
   *  screen; `middle`: that of the box; `width`, `height`: of the picture. */
  place(edges, middle, width, height) {
    const view = { middle, width, height };
    let best = null;
    // A few choices of an edge for each axis: all of them are tried.
    const choose = (a, chosen) => {
      if (a === edges.length) {
        const found = this.along(chosen, view);
        if (!best || found.cost < best.cost) best = found;
        return;
      }
      if (edges[a].length === 0) return choose(a + 1, [...chosen, null]);
      edges[a].forEach((edge) => choose(a + 1, [...chosen, { ...edge, ...this.liking(a, edge, edges[a]) }]));
    };
    choose(0, []);
    for (const label of this.all.flat()) this.show(label, best.places.get(label) ?? null);
  }

  /** Below, and those of upright axes at the left, are where labels are looked for. */
  liking(a, edge, others) {
    const isUpright = a === 2 || (this.isFlat && a === 1);
    const at = ({ from, to }) => (isUpright ? from.x + to.x : -from.y - to.y);
    return { cost: others.some((other) => at(other) < at(edge) - 1) ? 4 : 0 };
  }

  along(chosen, view) {
    const places = new Map();
    let cost = chosen.reduce((sum, edge) => sum + (edge?.cost ?? 0), 0);
    for (const kind of KINDS)
      this.all.forEach((labels, a) => {
        if (!chosen[a]) return;
        const label = labels.find((one) => one.kind === kind);
        const found = this.find(label, chosen[a], view, [...this.obstacles, ...places.values()]);
        cost += found ? found.cost : MISSED[kind];
        if (found) places.set(label, found);
      });
    return { cost, places };
  }

  /** The best place of a label at an edge, apart from `taken`; null if there is none. */
  find(label, { from, to }, view, taken) {
    const along = { x: to.x - from.x, y: to.y - from.y };
    const length = Math.hypot(along.x, along.y);
    if (length < 12) return null;
    let [nx, ny] = [along.y / length, -along.x / length]; // outwards
    if (nx * (from.x + to.x - 2 * view.middle.x) + ny * (from.y + to.y - 2 * view.middle.y) < 0) [nx, ny] = [-nx, -ny];
    let best = null;
    label.sizes.forEach(({ width, height, isShort }) => {
      const isUpright = label.kind === 'name' && Math.abs(along.x) < 0.35 * Math.abs(along.y) && width > 1.5 * height;
      const [halfWidth, halfHeight] = (isUpright ? [height, width] : [width, height]).map((x) => x / 2);
      // So far away that the whole label is beyond the edge, and so outside of the outline.
      const least = Math.abs(nx) * halfWidth + Math.abs(ny) * halfHeight;
      DISTANCES[label.kind].forEach((distance, i) => PLACES[label.kind].forEach((share, j) => {
        const cost = 2 * i + j + (isShort ? 12 : 0);
        if (best && best.cost <= cost) return;
        const x = from.x + share * along.x + nx * (least + distance);
        const y = from.y + share * along.y + ny * (least + distance);
        const isIn = Math.min(x, view.width - x) >= halfWidth + 2 && Math.min(y, view.height - y) >= halfHeight + 2;
        const at = { x, y, halfWidth, halfHeight, isUpright, isShort, cost };
        if (isIn && !taken.some((other) => overlaps(at, other))) best = at;
      }));
    });
    return best;
  }
}
