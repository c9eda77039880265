// SPDX-License-Identifier: BSD-3-Clause
//
// Which tetrahedra of a 4D contour a time cuts, and into how many triangles: by the rule of tegl::slice
// (runtime/src/cut/closed_cut.cpp), so that the numbers are the library's at every time, those of vertices included.
//
// Times are compared as whole numbers. A vertex's rank is the place of its time among all different ones; its key is
// twice that, plus 1 if it counts as above a cut at its own time. A cut between two times, or at one, is then a
// threshold on keys, exact although the GPU computes in single precision.

/** The places 0 ... 3 with those of `high` first, by an even permutation. */
function highFirst(high) {
  const sorted = [0, 1, 2, 3];
  const isFirst = (i) => ((high >> sorted[i]) & 1) !== 0;
  let odd = false;
  for (let i = 1; i < 4; ++i)
    for (let j = i; j > 0 && isFirst(j) && !isFirst(j - 1); --j) {
      [sorted[j - 1], sorted[j]] = [sorted[j], sorted[j - 1]];
      odd = !odd;
    }
  const count = sorted.filter((place) => (high >> place) & 1).length;
  if (odd && count >= 2) [sorted[0], sorted[1]] = [sorted[1], sorted[0]];
  if (odd && count < 2) [sorted[2], sorted[3]] = [sorted[3], sorted[2]];
  return sorted;
}

/** For each set of high corners the edges [below, above] that the cut's polygon has its points on, oriented. */
const POLYGONS = Array.from({ length: 16 }, (_, high) => {
  const order = highFirst(high);
  const count = order.filter((place) => (high >> place) & 1).length;
  const pairs = [[], [[0, 1], [0, 2], [0, 3]], [[0, 2], [0, 3], [1, 3], [1, 2]], [[0, 3], [1, 3], [2, 3]], []][count];
  return pairs.map(([above, below]) => [order[below], order[above]]);
});

/** The same as triangles, for the shader: 4 bits for each corner (below, then above), and the number of corners. */
export const CASES = Uint32Array.from(POLYGONS, (polygon) => {
  const corners = polygon.length === 4 ? [0, 1, 2, 0, 2, 3] : polygon.length === 3 ? [0, 1, 2] : [];
  let code = corners.length << 24;
  corners.forEach((corner, i) => (code |= (polygon[corner][0] | (polygon[corner][1] << 2)) << (4 * i)));
  return code >>> 0;
});

class Sets {
  constructor(count) {
    this.parent = Uint32Array.from({ length: count }, (_, i) => i);
  }
  find(i) {
    while (this.parent[i] !== i) i = this.parent[i] = this.parent[this.parent[i]];
    return i;
  }
  join(a, b) {
    a = this.find(a);
    b = this.find(b);
    if (a === b) return false;
    this.parent[Math.max(a, b)] = Math.min(a, b);
    return true;
  }
}

/** The first place of an ascending array (or part of it) whose value is not below `value`. */
export function lowerBound(array, value, from = 0, to = array.length) {
  while (from < to) {
    const middle = (from + to) >>> 1;
    if (array[middle] < value) from = middle + 1;
    else to = middle;
  }
  return from;
}

/** An order of the tetrahedra in which those that a time cuts are few ranges: a tree over the ranks, each node of which
 *  has what reaches over its middle. The middle is where the fewest do, which between layers of an image is none. */
class Ranges {
  constructor(least, most, rankCount) {
    this.least = least;
    this.most = most;
    this.order = new Uint32Array(least.length);
    this.sortedLeast = new Uint32Array(least.length);
    this.placed = 0;
    const starts = new Uint32Array(rankCount + 1);
    for (const rank of least) ++starts[rank + 1];
    for (let i = 0; i < rankCount; ++i) starts[i + 1] += starts[i];
    const sorted = new Uint32Array(least.length);
    for (let s = 0; s < least.length; ++s) sorted[starts[least[s]]++] = s;
    this.root = this.node(sorted, 0);
  }

  place(list) {
    const from = this.placed;
    for (const s of list) {
      this.sortedLeast[this.placed] = this.least[s];
      this.order[this.placed++] = s;
    }
    return { from, to: this.placed };
  }

  node(list, depth) {
    const FEW = 1024;
    const DEEP = 16;
    const split = list.length > FEW && depth < DEEP ? this.split(list) : -1;
    if (split < 0) return { ...this.place(list), split: -1 };
    const left = list.filter((s) => this.most[s] <= split);
    const right = list.filter((s) => this.least[s] >= split && this.most[s] > split);
    const across = list.filter((s) => this.least[s] < split && this.most[s] > split);
    const node = { ...this.place(across), split };
    node.left = this.node(left, depth + 1);
    node.right = this.node(right, depth + 1);
    return node;
  }

  /** The rank to split at; -1 where that does not help. */
  split(list) {
    let first = Infinity;
    let last = 0;
    for (const s of list) {
      first = Math.min(first, this.least[s]);
      last = Math.max(last, this.most[s]);
    }
    const ends = new Uint32Array(last - first + 1);
    const begins = new Uint32Array(last - first + 2);
    for (const s of list) {
      ++ends[this.most[s] - first];
      ++begins[this.least[s] - first];
    }
    let best = 0.9 * list.length;
    let at = -1;
    let left = 0;
    let begun = 0;
    for (let i = 0; i < ends.length; ++i) {
      left += ends[i]; // those with most <= i
      const right = list.length - begun; // those with least >= i
      const across = list.length - left - right;
      const cost = across + Math.max(left, right) / 2;
      if (left > 0 && right > 0 && left < list.length && cost < best) {
        best = cost;
        at = first + i;
      }
      begun += begins[i];
    }
    return at;
  }

  /** The [from, to) of what a cut between ranks `rank` - 1 and `rank`, or at `rank`, may touch; few more than that. */
  at(rank, isOn) {
    const ranges = [];
    const most = isOn ? rank : rank - 1;
    const visit = (node) => {
      const to = lowerBound(this.sortedLeast, most + 1, node.from, node.to);
      if (to > node.from) {
        const last = ranges[ranges.length - 1];
        if (last && last[1] === node.from) last[1] = to;
        else ranges.push([node.from, to]);
      }
      if (node.split < 0) return;
      if (isOn ? rank <= node.split : rank <= node.split) visit(node.left);
      if (isOn ? rank >= node.split : rank > node.split) visit(node.right);
    };
    visit(this.root);
    return ranges;
  }
}

/** The cuts of a 4D contour. `simplices`: #S x 4 vertex numbers; they are put into another order, `order`. */
export class Cuts {
  constructor({ times, ranks, simplices }) {
    this.times = times;
    this.ranks = ranks;
    this.areSingle = times.every((t) => Math.fround(t) === t);
    const count = simplices.length / 4;
    const least = new Uint32Array(count);
    const most = new Uint32Array(count);
    // Triangles between the ranks r - 1 and r: a running sum of what begins and ends at each.
    const steps = new Int32Array(times.length + 1);
    const four = new Uint32Array(4);
    for (let s = 0; s < count; ++s) {
      for (let k = 0; k < 4; ++k) four[k] = ranks[simplices[4 * s + k]];
      four.sort();
      least[s] = four[0];
      most[s] = four[3];
      ++steps[four[0] + 1];
      ++steps[four[1] + 1];
      --steps[four[2] + 1];
      --steps[four[3] + 1];
    }
    this.between = new Uint32Array(steps.length);
    for (let r = 0, sum = 0; r < steps.length; ++r) this.between[r] = sum += steps[r];
    this.ranges = new Ranges(least, most, times.length);
    this.order = this.ranges.order;
    this.simplices = new Uint32Array(simplices.length);
    for (let s = 0; s < count; ++s) {
      const from = 4 * this.order[s];
      for (let k = 0; k < 4; ++k) this.simplices[4 * s + k] = simplices[from + k];
    }
    this.isLow = this.findLow();
    this.keys = Uint32Array.from(ranks, (rank, v) => 2 * rank + (this.isLow[v] ? 0 : 1));
    this.exact = new Map();
  }

  /** The vertices that a cut at their own time has below it: groups of equal time without a way down. */
  findLow() {
    const { simplices, ranks } = this;
    const groups = new Sets(ranks.length);
    const reaches = new Uint8Array(ranks.length);
    for (let i = 0; i < simplices.length; i += 4) {
      const first = Math.min(ranks[simplices[i]], ranks[simplices[i + 1]], ranks[simplices[i + 2]], ranks[simplices[i + 3]]);
      for (let j = i; j < i + 4; ++j) {
        if (ranks[simplices[j]] > first) reaches[simplices[j]] = 1;
        for (let k = i; k < j; ++k)
          if (ranks[simplices[j]] === ranks[simplices[k]]) groups.join(simplices[j], simplices[k]);
      }
    }
    for (let v = 0; v < reaches.length; ++v) if (reaches[v]) reaches[groups.find(v)] = 1;
    return Uint8Array.from(reaches, (_, v) => (reaches[groups.find(v)] ? 0 : 1));
  }

  /** Where a cut at time t lies among the ranks. */
  level(t) {
    let at = t;
    // A time that means a vertex's in single precision, such as 0.1, as tegl slice takes it.
    if (this.areSingle && Math.fround(t) !== t) {
      const single = Math.fround(t);
      if (this.times[lowerBound(this.times, single)] === single) at = single;
    }
    const rank = lowerBound(this.times, at);
    const isOn = rank < this.times.length && this.times[rank] === at;
    return { t: at, rank, isOn, threshold: isOn ? 2 * rank + 1 : 2 * rank };
  }

  /** The ranges of `simplices` that may be cut, as [from, to). */
  touched(level) {
    return this.ranges.at(level.rank, level.isOn);
  }

  /** How many triangles the cut has; at times of vertices just below, which `count` knows better. */
  quickCount(level) {
    return this.between[level.rank];
  }

  /** How many triangles the library's cut has. */
  count(level) {
    return level.isOn ? this.cutAt(level).count : this.between[level.rank];
  }

  /** The cut at a time of vertices: its number of triangles, and `faces`, those of them that no tetrahedron below has,
   *  each with the tetrahedron above. */
  cutAt(level) {
    if (!this.exact.has(level.rank)) this.exact.set(level.rank, new CutAtVertices(this, level.rank).result());
    return this.exact.get(level.rank);
  }
}

/** The cut at a time of vertices; see runtime/src/cut/closed_cut.cpp for why it is as it is. */
class CutAtVertices {
  constructor(cuts, rank) {
    this.cuts = cuts;
    this.rank = rank;
    this.vertexCount = cuts.ranks.length;
    this.touching = [];
    this.owners = new Map();
    for (const [from, to] of cuts.touched({ rank, isOn: true }))
      for (let s = from; s < to; ++s) {
        const sides = this.sides(s);
        if (sides.on || (sides.below && sides.above)) this.touching.push({ s, ...sides });
      }
  }

  /** Bits for the corners below, on and above, and for those that count as above. */
  sides(s) {
    const { simplices, ranks, isLow } = this.cuts;
    const sides = { below: 0, on: 0, above: 0, high: 0 };
    for (let k = 0; k < 4; ++k) {
      const v = simplices[4 * s + k];
      const r = ranks[v];
      if (r < this.rank) sides.below |= 1 << k;
      else if (r > this.rank) sides.above |= 1 << k;
      else sides.on |= 1 << k;
      if (r > this.rank || (r === this.rank && !isLow[v])) sides.high |= 1 << k;
    }
    return sides;
  }

  key(below, above) {
    return below * this.vertexCount + above;
  }
  below(key) {
    return Math.floor(key / this.vertexCount);
  }
  above(key) {
    return key % this.vertexCount;
  }
  /** The end of a point's edge that lies in the cut; -1 if none does. */
  onEnd(key) {
    const { ranks } = this.cuts;
    if (ranks[this.above(key)] === this.rank) return this.above(key);
    if (ranks[this.below(key)] === this.rank) return this.below(key);
    return -1;
  }

  polygon(s, high) {
    const { simplices } = this.cuts;
    return POLYGONS[high].map(([below, above]) => this.key(simplices[4 * s + below], simplices[4 * s + above]));
  }

  /** The polygon in each tetrahedron. Points around a vertex of the cut become one, unless `isApart`. */
  pieces(isApart) {
    const result = [];
    for (const { s, on, high } of this.touching) {
      if (high === 0 || high === 15) continue;
      const piece = this.polygon(s, high);
      if (on === 0) {
        result.push(piece);
        continue;
      }
      const drawn = [];
      piece.forEach((point, k) => {
        const v = this.onEnd(point);
        const key = v >= 0 && !isApart(v) ? this.key(v, v) : point;
        const repeats = drawn.length > 0 &&
          (drawn[drawn.length - 1] === key || (k === piece.length - 1 && drawn[0] === key));
        if (!repeats) drawn.push(key);
      });
      if (drawn.length >= 3) result.push(drawn);
    }
    return result;
  }

  /** Boundary faces among vertices of the cut, whose tetrahedron lies above. */
  facesFromAbove() {
    const { simplices, ranks, isLow } = this.cuts;
    const faces = new Map();
    for (const { s, on } of this.touching) {
      let onHigh = 0;
      for (let k = 0; k < 4; ++k) if ((on >> k) & 1 && !isLow[simplices[4 * s + k]]) onHigh |= 1 << k;
      for (let omitted = 0; omitted < 4; ++omitted) {
        if ((onHigh | (1 << omitted)) !== 15) continue;
        const face = [0, 1, 2, 3].filter((k) => k !== omitted).map((k) => simplices[4 * s + k]);
        const name = face.sort((a, b) => a - b).join();
        if (!faces.has(name)) faces.set(name, []);
        faces.get(name).push([s, omitted]);
      }
    }
    const result = [];
    for (const met of faces.values()) {
      const [s, omitted] = met[0];
      if (met.length !== 1 || !(ranks[simplices[4 * s + omitted]] > this.rank)) continue;
      const face = this.polygon(s, 1 << omitted).map((point) => this.key(this.below(point), this.below(point)));
      this.owners.set(face, s);
      result.push(face);
    }
    return result;
  }

  /** The points around which the pieces are no fan. */
  pinched(pieces) {
    const around = new Map();
    for (const piece of pieces)
      piece.forEach((key, k) => {
        if (!around.has(key)) around.set(key, []);
        around.get(key).push([piece[(k + piece.length - 1) % piece.length], piece[(k + 1) % piece.length]]);
      });
    const result = new Set();
    for (const [key, sides] of around) if (!isFan(sides)) result.add(key);
    return result;
  }

  result() {
    const MOST_ROUNDS = 16;
    let faces = this.facesFromAbove();
    const apart = new Set();
    const isApart = (v) => apart.has(v);
    let excused = new Set();
    for (let round = 0; ; ++round) {
      const pieces = [...this.pieces(isApart), ...faces];
      const pinched = this.pinched(pieces);
      if (round === 0 && pinched.size > 0) excused = this.pinched(this.pieces(() => true));
      const kept = faces.filter((face) =>
        !face.some((key) => apart.has(this.above(key)) && pinched.has(key)));
      const dropsFaces = kept.length < faces.length;
      faces = kept;
      if (dropsFaces || this.leaveApart(pinched, excused, round >= MOST_ROUNDS, apart)) continue;
      return { count: pieces.reduce((sum, piece) => sum + piece.length - 2, 0),
        faces: faces.map((face) => [...face.map((key) => this.above(key)), this.owners.get(face)]) };
    }
  }

  leaveApart(pinched, excused, all, apart) {
    const candidates = new Set();
    if (all && pinched.size > 0)
      for (const { s, on } of this.touching)
        for (let k = 0; k < 4; ++k) if ((on >> k) & 1) candidates.add(this.cuts.simplices[4 * s + k]);
    for (const key of pinched) if (this.above(key) === this.below(key)) candidates.add(this.above(key));
    for (const key of excused) candidates.delete(this.onEnd(key));
    const before = apart.size;
    for (const v of candidates) apart.add(v);
    return apart.size > before;
  }
}

/** Whether polygons at a point, each by its neighbours there, are one fan. */
function isFan(sides) {
  const met = new Map();
  const sets = new Sets(sides.length);
  let parts = sides.length;
  for (let i = 0; i < sides.length; ++i)
    for (const end of sides[i]) {
      const others = met.get(end);
      if (!others) met.set(end, [i]);
      else if (others.push(i) > 2) return false;
      else if (sets.join(others[0], i)) --parts;
    }
  return parts === 1;
}
