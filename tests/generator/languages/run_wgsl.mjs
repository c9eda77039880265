// SPDX-License-Identifier: BSD-3-Clause
//
// Runs the emitted WGSL in an interpreter of shaders (wgsl_reflect) and holds it against the JSON tables:
//   node run_wgsl.mjs FOLDER-OF-TABLES
// All signatures in 2D and 3D; in 4D, where the interpreter would need minutes, every STEP-th one.
import fs from 'node:fs';
import path from 'node:path';
import { WgslExec, WgslParser } from 'wgsl_reflect/wgsl_reflect.module.js';

const kStep = 331;
const folder = process.argv[2];

/// A signature's contour by the JSON table: [simplices, cones, sides, vertices..., mask words...].
function decode(table, signature) {
  const n = table.dim;
  const corners = 2 ** n;
  const row = table.lists.rows[table.list_of[signature]];
  const [first, count, cones, sides, firstSide] = row;
  const byClass = table.layout === 'class';
  const element = byClass ? table.element_of[signature] : 0;
  const moved = (place) => table.permutations[element * table.permutation_stride + place];
  const result = [count, cones, sides];
  for (let i = 0; i < count; ++i) {
    const simplex = table.simplices.slice((first + i) * n, (first + i + 1) * n).map((v) => {
      if (!byClass || v >= table.first_tile_vertex) return v;
      const to = moved(corners + v);
      return to < table.edge_count ? to : to ^ ((table.slot_swaps[signature] >> ((to - table.edge_count) >> 1)) & 1);
    });
    if (byClass && table.reverses[element]) simplex.push(...simplex.splice(n - 2).reverse());
    result.push(...simplex);
  }
  for (let k = 0; k < sides; ++k) {
    let mask = 0n;
    for (let b = 0; b < corners + table.edge_count; ++b) {
      if (!((BigInt(table.side_masks[firstSide + k]) >> BigInt(b)) & 1n)) continue;
      const to = !byClass ? b : b < corners ? moved(b) : corners + moved(b);
      mask |= 1n << BigInt(to);
    }
    result.push(Number(mask & 0xffffffffn), Number(mask >> 32n));
  }
  return result;
}

/// A shader that writes the same for signature s at result[s x stride].
function shader(text, prefix, n, stride, wide) {
  const storage = wide ? `@group(0) @binding(2) var<storage, read> ${prefix}_words : array<u32>;\n` : '';
  const sides = wide ? `${prefix}_side_vertices(s)` : '0u';
  const masks = wide ? `for (var k = 0u; k < sides; k = k + 1u) {
      result[at] = ${prefix}_side_mask(s, k, 0u);
      result[at + 1u] = ${prefix}_side_mask(s, k, 1u);
      at = at + 2u;
    }` : '';
  return `${storage}${text}
  @group(0) @binding(0) var<storage, read_write> result : array<u32>;
  @group(0) @binding(1) var<storage, read> chosen : array<u32>;
  @compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id : vec3<u32>) {
    let s = chosen[id.x];
    let count = ${prefix}_simplex_count(s);
    let sides = ${sides};
    var at = id.x * ${stride}u;
    result[at] = count;
    result[at + 1u] = ${prefix}_cone_vertices(s);
    result[at + 2u] = sides;
    at = at + 3u;
    for (var i = 0u; i < count; i = i + 1u) {
      for (var j = 0u; j < ${n}u; j = j + 1u) {
        result[at] = ${prefix}_vertex(s, i, j);
        at = at + 1u;
      }
    }
    ${masks}
  }`;
}

function check(name) {
  const table = JSON.parse(fs.readFileSync(path.join(folder, `${name}.json`), 'utf8'));
  const text = fs.readFileSync(path.join(folder, `${name}.wgsl`), 'utf8');
  const wide = table.dim === 4;
  const stride = 3 + table.max_simplices * table.dim + 2 * 64;
  const chosen = new Uint32Array(table.list_of.map((_, s) => s).filter((s) => !wide || s % kStep === 7));
  const result = new Uint32Array(chosen.length * stride);
  const bindings = { 0: result, 1: chosen };
  if (wide) {
    const file = fs.readFileSync(path.join(folder, `${name}.u32`));
    bindings[2] = new Uint32Array(file.buffer.slice(file.byteOffset, file.byteOffset + file.length));
  }
  const program = new WgslExec(new WgslParser().parse(shader(text, `tegl_${name}`, table.dim, stride, wide)));
  program.dispatchWorkgroups('main', chosen.length, { 0: bindings });
  chosen.forEach((signature, i) => {
    const expected = decode(table, signature);
    const actual = Array.from(result.subarray(i * stride, i * stride + expected.length));
    if (actual.join() !== expected.join()) {
      throw new Error(`${name}, signature ${signature}: got ${actual}, expected ${expected}`);
    }
  });
  console.log(`${name}: ${chosen.length} signatures agree`);
}

/// The builder of the cube against the table of all resolutions: [triangles, own vertices, vertices..., masks...].
function checkCubeBuilder() {
  const table = JSON.parse(fs.readFileSync(path.join(folder, 'tile3_resolved.json'), 'utf8'));
  const text = fs.readFileSync(path.join(folder, 'builder3.wgsl'), 'utf8');
  const chosen = [];
  const expected = [];
  for (let s = 0; s < 256; ++s) {
    const ambiguous = table.ambiguous_squares[s];
    let entry = table.first_entry[s];
    for (let high = 0, first = true; first || high !== 0; high = (high - ambiguous) & ambiguous, first = false) {
      const row = table.entries.rows[entry++];
      for (let centre = 0; centre < 3; ++centre) {
        const [from, count, own, mask] = row.slice(1 + 4 * centre);
        chosen.push(s, high, centre);
        expected.push([count, own, ...table.triangles.slice(3 * from, 3 * (from + count)),
          ...table.masks.slice(mask, mask + own)]);
      }
    }
  }
  const stride = 2 + 3 * 24 + 4;
  const result = new Uint32Array(expected.length * stride);
  const shader = `${text}
  @group(0) @binding(0) var<storage, read_write> result : array<u32>;
  @group(0) @binding(1) var<storage, read> chosen : array<u32>;
  @compute @workgroup_size(1) fn main(@builtin(global_invocation_id) id : vec3<u32>) {
    let contour = tegl_builder3_build(chosen[3u * id.x], chosen[3u * id.x + 1u], chosen[3u * id.x + 2u]);
    var at = id.x * ${stride}u;
    result[at] = contour.triangles;
    result[at + 1u] = contour.own_vertices;
    at = at + 2u;
    for (var i = 0u; i < 3u * contour.triangles; i = i + 1u) {
      result[at] = contour.vertices[i];
      at = at + 1u;
    }
    for (var j = 0u; j < contour.own_vertices; j = j + 1u) {
      result[at] = contour.masks[j];
      at = at + 1u;
    }
  }`;
  const program = new WgslExec(new WgslParser().parse(shader));
  program.dispatchWorkgroups('main', expected.length, { 0: { 0: result, 1: new Uint32Array(chosen) } });
  expected.forEach((numbers, i) => {
    const actual = Array.from(result.subarray(i * stride, i * stride + numbers.length));
    if (actual.join() !== numbers.join()) {
      throw new Error(`builder3, ${chosen.slice(3 * i, 3 * i + 3)}: got ${actual}, expected ${numbers}`);
    }
  });
  console.log(`builder3: ${expected.length} contours agree`);
}

checkCubeBuilder();
for (const dim of [2, 3, 4]) for (const t of ['barycentric', 'compact']) check(`tile${dim}_${t}`);
