// SPDX-License-Identifier: BSD-3-Clause
//
// One contour of the page: its numbers in textures, its cut at a time, its colours.
import * as THREE from 'three';

import { arrayOf, simplicesOf } from './data.js';
import { CASES, Cuts } from './cut.js';
import { PART_COLORS } from './colors.js';
import { FRAGMENT, ROW, VERTEX } from './shaders.js';

const NONE = 0xffffffff;
const CORNERS = { 2: 6, 3: 3, 4: 6 }; // of what is drawn for a simplex

/** A texture with an item in each texel; `values`: rows x width, of a type that the format says. */
function texture(values, width, format, type, internalFormat) {
  const rows = values.length / width;
  const height = Math.max(1, Math.ceil(rows / ROW));
  const padded = new values.constructor(ROW * height * width);
  padded.set(values);
  const result = new THREE.DataTexture(padded, ROW, height, format, type);
  result.internalFormat = internalFormat;
  result.unpackAlignment = 1;
  result.needsUpdate = true;
  return result;
}
const floats = (values, width) => width === 1
  ? texture(values, 1, THREE.RedFormat, THREE.FloatType, 'R32F')
  : texture(values, 4, THREE.RGBAFormat, THREE.FloatType, 'RGBA32F');
const wholes = (values, width) => width === 1
  ? texture(values, 1, THREE.RedIntegerFormat, THREE.UnsignedIntType, 'R32UI')
  : texture(values, 4, THREE.RGBAIntegerFormat, THREE.UnsignedIntType, 'RGBA32UI');

/** rows x width as rows x 4. */
function widened(values, width, Type, fourth = () => 0) {
  const rows = values.length / width;
  const result = new Type(4 * rows);
  for (let i = 0; i < rows; ++i) {
    for (let k = 0; k < width; ++k) result[4 * i + k] = values[width * i + k];
    if (width < 4) result[4 * i + 3] = fourth(i);
  }
  return result;
}

export class Layer {
  constructor(description, bytes, index) {
    this.description = description;
    this.bytes = bytes;
    this.index = index;
    this.dim = description.dim;
    this.name = description.file.replace(/^.*\//, '');
    this.isVisible = true;
    this.source = null;
    const arrays = description.arrays;
    const space = this.dim === 2 ? 2 : 3;
    const places = arrayOf(bytes, arrays.places);
    let simplices = simplicesOf(bytes, arrays.simplices);
    let fourth = () => 0;
    const itself = (i) => i;
    if (this.dim === 4) {
      const times = arrayOf(bytes, arrays.times);
      const ranks = arrayOf(bytes, arrays.ranks);
      this.cuts = new Cuts({ times, ranks, simplices });
      simplices = this.cuts.simplices;
      this.firstTime = times[0];
      this.lastTime = times[times.length - 1];
      fourth = (i) => times[ranks[i]] - this.firstTime;
    }
    const uniforms = {
      uSimplices: { value: wholes(widened(simplices, this.dim, Uint32Array, itself), 4) },
      uPlaces: { value: floats(widened(places, space, Float32Array, fourth), 4) },
      uNormals: { value: null },
      uValues: { value: floats(new Float32Array(1), 1) },
      uOffset: { value: new THREE.Vector3() },
      uScale: { value: new THREE.Vector3(1, 1, 1) },
      uSegments: { value: floats(this.segments(arrays), 4) },
      uAfter: { value: floats(new Float32Array(1), 1) },
      uTime: { value: 0 },
      uSource: { value: 0 },
      uValue: { value: 0 },
      uRange: { value: new THREE.Vector2(0, 1) },
      uPalette: { value: 0 },
      uColor: { value: new THREE.Color() },
      uColors: { value: null },
      uSmooth: { value: true },
      uFront: { value: 1 },
      uLower: { value: new THREE.Vector3(-Infinity, -Infinity, -Infinity) },
      uUpper: { value: new THREE.Vector3(Infinity, Infinity, Infinity) },
    };
    const normals = arrays.normals ? arrayOf(bytes, arrays.normals) : new Int8Array(3);
    uniforms.uNormals.value =
      texture(widened(normals, 3, Int8Array), 4, THREE.RGBAFormat, THREE.ByteType, 'RGBA8_SNORM');
    if (this.dim === 4)
      Object.assign(uniforms, { uKeys: { value: wholes(this.cuts.keys, 1) }, uThreshold: { value: 0 },
        uCases: { value: CASES } });
    if (this.dim === 2) Object.assign(uniforms, { uViewport: { value: new THREE.Vector2(1, 1) }, uWidth: { value: 2 } });
    this.uniforms = uniforms;
    this.material = new THREE.RawShaderMaterial({ glslVersion: THREE.GLSL3, defines: { DIM: this.dim }, uniforms,
      vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.DoubleSide });
    this.geometry = new THREE.BufferGeometry();
    this.geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), Infinity);
    this.mesh = new THREE.Mesh(this.geometry, [this.material]);
    this.mesh.frustumCulled = false;
    this.drawn = 0;
    if (this.dim !== 4) this.draw([[0, description.simplices]]);
    // Faces of the cut that no tetrahedron below has: as triangles of their own, at times of vertices alone.
    if (this.dim === 4) this.addFaces();
  }

  /** Of each segment of the graph of tracks: its end, the segment that it becomes, the number of its track, whether it
   *  splits. */
  segments(arrays) {
    if (!arrays.segment_ends) return new Float32Array(4);
    const [ends, next, tracks, splits] = ['ends', 'next', 'tracks', 'splits'].map((name) =>
      arrayOf(this.bytes, arrays[`segment_${name}`]));
    const result = new Float32Array(4 * Math.max(1, ends.length));
    for (let s = 0; s < ends.length; ++s)
      result.set([ends[s] - this.firstTime, next[s] === NONE ? -1 : next[s], tracks[s] % PART_COLORS, splits[s]], 4 * s);
    return result;
  }

  addFaces() {
    this.faceUniforms = { ...this.uniforms, uSimplices: { value: wholes(new Uint32Array(4), 4) } };
    const material = this.material.clone();
    material.defines = { DIM: 3 };
    material.uniforms = this.faceUniforms;
    this.faceGeometry = new THREE.BufferGeometry();
    this.faceGeometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), Infinity);
    this.faces = new THREE.Mesh(this.faceGeometry, [material]);
    this.faces.frustumCulled = false;
    this.mesh.add(this.faces);
    this.setFaces([]);
  }

  setFaces(faces) {
    this.faceGeometry.clearGroups();
    this.faces.visible = faces.length > 0;
    if (faces.length === 0) return;
    const old = this.faceUniforms.uSimplices.value;
    this.faceUniforms.uSimplices.value = wholes(Uint32Array.from(faces.flat()), 4);
    old.dispose();
    this.faceGeometry.addGroup(0, 3 * faces.length, 0);
  }

  draw(ranges) {
    const corners = CORNERS[this.dim];
    this.geometry.clearGroups();
    this.drawn = 0;
    for (const [from, to] of ranges) {
      this.geometry.addGroup(corners * from, corners * (to - from), 0);
      this.drawn += to - from;
    }
    this.ranges = ranges.length;
  }

  /** Cuts at time t; nothing to do for contours without time. */
  setTime(t) {
    if (this.dim !== 4) return;
    this.level = this.cuts.level(t);
    this.uniforms.uThreshold.value = this.level.threshold;
    this.uniforms.uTime.value = this.level.t - this.firstTime;
    this.draw(this.cuts.touched(this.level));
    this.setFaces([]);
    if (this.source && this.source.id === 'time') this.uniforms.uValue.value = t;
  }

  /** Triangles of the cut as shown while time flows. */
  quickCount() {
    return this.dim === 4 ? this.cuts.quickCount(this.level) : this.description.simplices;
  }

  /** How many simplices the library says there are; shows what only times of vertices have. */
  settle() {
    if (this.dim !== 4) return this.description.simplices;
    if (!this.level.isOn) return this.cuts.count(this.level);
    const { count, faces } = this.cuts.cutAt(this.level);
    this.setFaces(faces);
    return count;
  }

  /** What it can be coloured by. */
  sources() {
    const { axes, arrays, components } = this.description;
    const list = [{ id: 'plain', name: 'One colour', kind: 'plain' }];
    list.push({ id: 'component', name: 'Component', kind: 'parts', array: arrays.component, of: 'vertex', count: components });
    if (arrays.segment)
      list.push({ id: 'track', name: 'Track', kind: 'parts', array: arrays.segment, of: 'simplex',
        count: this.description.tracks_found });
    axes.forEach((axis, a) => {
      const isTime = this.dim === 4 && a === 3;
      list.push({ id: isTime ? 'time' : `axis${a}`, name: axis.name, unit: axis.unit, kind: 'numbers', axis: a,
        lowest: axis.lowest, highest: axis.highest });
    });
    for (const of of ['vertex', 'simplex'])
      this.description[`${of}_attributes`].forEach((attribute, i) =>
        list.push({ id: `${of}${i}`, kind: 'numbers', of, array: attribute.values, ...attribute }));
    return list;
  }

  values(source) {
    let values = arrayOf(this.bytes, source.array);
    if (source.kind === 'parts')
      values = Float32Array.from(values, (part) =>
        part === NONE ? -1 : source.id === 'track' ? part : part % PART_COLORS);
    if (source.of !== 'simplex' || !this.cuts) return values;
    return Float32Array.from(this.cuts.order, (s) => values[s]);
  }

  colorBy(id) {
    const source = this.sources().find((one) => one.id === id);
    this.source = source;
    const { uniforms } = this;
    uniforms.uPalette.value = { plain: 0, numbers: 1, parts: 2 }[source.kind];
    uniforms.uSource.value = 0;
    if (source.array) {
      const old = uniforms.uValues.value;
      uniforms.uValues.value = floats(this.values(source), 1);
      old.dispose();
      if (source.id === 'track' && !this.hasAfter) {
        uniforms.uAfter.value = floats(this.values({ ...source, array: this.description.arrays.segment_after }), 1);
        this.hasAfter = true;
      }
      uniforms.uSource.value = source.id === 'track' ? 6 : source.of === 'simplex' ? 2 : 1;
    } else if (source.id === 'time') {
      uniforms.uValue.value = this.level ? this.level.t : source.lowest;
    } else if (source.kind === 'numbers') {
      uniforms.uSource.value = 3 + source.axis;
    }
    if (source.kind === 'numbers') {
      const shift = source.id.startsWith('axis') ? this.sceneCenter[source.axis] : 0;
      uniforms.uRange.value.set(source.lowest - shift, source.highest - shift);
    }
  }

  /** `center`: the middle of all that is shown, which is the origin; `scale`: of the axes there. */
  place(center, scale) {
    this.sceneCenter = center;
    const own = this.description.center;
    this.uniforms.uOffset.value.set(...[0, 1, 2].map((a) => (a < own.length ? own[a] - center[a] : 0)));
    this.uniforms.uScale.value.set(...scale);
    this.uniforms.uFront.value = Math.sign(scale[0] * scale[1] * scale[2]);
  }
}
