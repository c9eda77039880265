// SPDX-License-Identifier: BSD-3-Clause
//
// The picture: camera, box with its axes, clipping, and when to draw.
import * as THREE from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

import { colorTexels } from './colors.js';
import { AxisLabels } from './labels.js';

const GROUNDS = { light: 0xf6f7f9, dark: 0x11151c };
const EDGES = { light: 0x8a94a6, dark: 0x5b6678 };

/** How long a unit of each axis is drawn: alike where units are, else so that the box has good proportions. */
function scales(axes, extents) {
  const units = axes.map((axis) => axis.unit.trim().toLowerCase());
  const result = extents.map((_, a) => {
    const alike = extents.map((extent, b) => (units[b] === units[a] ? extent : 0));
    const wanted = units[a] === units[0] ? 2 : axes.length === 2 ? 1.3 : 0.7;
    return wanted / (Math.max(...alike) || 1);
  });
  while (result.length < 3) result.push(result[0]);
  return result.map((scale, a) => (axes[a]?.down ? -scale : scale));
}

export class Stage {
  constructor(canvas, labels, layers) {
    const context = canvas.getContext('webgl2', { antialias: true, powerPreference: 'high-performance' });
    if (!context)
      throw new Error('this browser shows no WebGL 2, which the picture is drawn with; expected one that has it ' +
        'enabled, on a computer with a graphics driver');
    this.renderer = new THREE.WebGLRenderer({ canvas, context });
    this.canvas = canvas;
    this.labels = labels;
    this.layers = layers;
    this.isFlat = layers.every((layer) => layer.dim === 2);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(30, 1, 0.01, 200);
    this.camera.up.set(0, this.isFlat ? 1 : 0, this.isFlat ? 0 : 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.enableRotate = !this.isFlat;
    this.controls.screenSpacePanning = true;
    this.controls.zoomToCursor = true;
    if (this.isFlat) {
      this.controls.mouseButtons.LEFT = THREE.MOUSE.PAN;
      this.controls.touches.ONE = THREE.TOUCH.PAN;
    }
    this.controls.addEventListener('change', () => this.redraw());
    this.stretch = 1;
    this.isFlipped = false;
    this.frames = 0;
    this.marker = null;
    this.measure();
    const colors = new THREE.DataTexture(colorTexels(), 256, 2);
    colors.needsUpdate = true;
    for (const layer of layers) {
      layer.uniforms.uColors.value = colors;
      this.scene.add(layer.mesh);
    }
    this.addBox();
    this.arrange();
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.keepClear([...canvas.parentElement.querySelectorAll('#legend, #notice')]);
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => this.redraw());
  }

  /** The box around all contours in space. */
  measure() {
    // Where axes point is what the first of the files says that says anything.
    const axes = this.layers[0].description.axes.slice(0, this.isFlat ? 2 : 3).map((axis, a) => ({ ...axis,
      down: this.layers.map(({ description }) => description.axes[a].down).find((down) => down !== null) ?? false }));
    this.axes = axes;
    this.lower = axes.map((_, a) => Math.min(...this.layers.map((layer) => layer.description.axes[a].lowest)));
    this.upper = axes.map((_, a) => Math.max(...this.layers.map((layer) => layer.description.axes[a].highest)));
    this.center = axes.map((_, a) => (this.lower[a] + this.upper[a]) / 2);
    this.extents = axes.map((_, a) => this.upper[a] - this.lower[a]);
    // What is towards the right, the front and the head of a patient, if these are coordinates of one.
    const worlds = new Set(this.layers.map(({ description }) => description.world).filter(Boolean));
    this.worlds = [...worlds];
    this.world = worlds.size === 1 && !this.isFlat ? this.worlds[0] : null;
  }

  addBox() {
    const edges = new THREE.EdgesGeometry(new THREE.BoxGeometry(1, 1, 1));
    this.boxMaterial = new THREE.LineBasicMaterial({ transparent: true, opacity: 0.55 });
    this.box = new THREE.LineSegments(edges, this.boxMaterial);
    this.scene.add(this.box);
    this.axisLabels = new AxisLabels(this.labels, this);
    this.markerElement = document.createElement('div');
    this.markerElement.className = 'marker';
    this.markerElement.hidden = true;
    this.labels.append(this.markerElement);
  }

  /** Places all by the scale of the axes. */
  arrange() {
    this.scale = scales(this.axes, this.extents);
    // x, y and z are drawn right-handed: a left-handed world would be its mirror image.
    const isLeftHanded = [...(this.world ?? '')].filter((letter) => 'LPI'.includes(letter)).length % 2 === 1;
    if (isLeftHanded) this.scale[0] *= -1;
    this.scale[this.isFlat ? 1 : 2] *= this.isFlipped ? -this.stretch : this.stretch;
    this.isMirrored = this.scale.filter((scale) => scale < 0).length % 2 === 1 !== isLeftHanded;
    for (const layer of this.layers) layer.place(this.center, this.scale);
    this.sides = this.extents.map((extent, a) => Math.max(1e-6, Math.abs(extent * this.scale[a])));
    this.box.scale.set(this.sides[0], this.sides[1], this.sides[2] ?? 1e-6);
    this.redraw();
  }

  reset() {
    const flat = !this.isFlat && this.sides[2] < 0.5 * Math.max(this.sides[0], this.sides[1]);
    const direction = this.isFlat ? new THREE.Vector3(0, 0, 1) : new THREE.Vector3(0.55, -1.5, flat ? 1.15 : 0.75);
    // Patients are seen from the front.
    if (this.world?.[1] === 'A') direction.multiply(new THREE.Vector3(-1, -1, 1));
    // What is left of the last movement is not to go on.
    this.controls.enableDamping = false;
    this.controls.update();
    this.controls.enableDamping = true;
    this.controls.target.set(0, 0, 0);
    this.camera.position.copy(direction.normalize());
    this.camera.lookAt(this.controls.target);
    this.camera.updateMatrix();
    this.camera.position.multiplyScalar(this.fittingDistance());
    this.controls.update();
    this.redraw();
  }

  /** A step of the keyboard: turns what is seen, to the right and upwards, or moves it. */
  turn(right, up, isMove) {
    const { camera, controls } = this;
    const offset = camera.position.clone().sub(controls.target);
    if (isMove || this.isFlat) {
      const step = 0.05 * offset.length();
      const along = new THREE.Vector3(right * step, up * step, 0).applyQuaternion(camera.quaternion);
      controls.target.sub(along);
      camera.position.sub(along);
    } else {
      const STEP = Math.PI / 36;
      const toTop = new THREE.Quaternion().setFromUnitVectors(camera.up, new THREE.Vector3(0, 1, 0));
      const place = new THREE.Spherical().setFromVector3(offset.applyQuaternion(toTop));
      place.theta -= right * STEP;
      place.phi += up * STEP;
      camera.position.setFromSpherical(place.makeSafe()).applyQuaternion(toTop.invert()).add(controls.target);
    }
    this.afterKey();
  }

  /** By a factor farther away. */
  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.afterKey();
  }

  /** Without what is left of a movement by hand. */
  afterKey() {
    this.controls.enableDamping = false;
    this.controls.update();
    this.controls.enableDamping = true;
    this.redraw();
  }

  /** How far from the middle the box fills the picture, with room for its labels. */
  fittingDistance() {
    const [right, up, back] = [0, 1, 2].map((k) => new THREE.Vector3().setFromMatrixColumn(this.camera.matrix, k));
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    const tangent = Math.tan((this.camera.fov * Math.PI) / 360);
    const needed = this.axisLabels.room(width, height);
    // A plane fills all: where it would reach the legend, it stays above it.
    for (const { x, halfWidth, halfHeight } of this.isFlat ? this.axisLabels.obstacles : []) {
      const left = (width - (this.sides[0] / this.sides[1]) * (height - 2 * needed.y)) / 2 - needed.x;
      if (left < x + halfWidth) needed.y = Math.max(needed.y, Math.min(2 * halfHeight + 18, 0.22 * height));
    }
    const room = [1 - (2 * needed.x) / width, 1 - (2 * needed.y) / height];
    let distance = 1e-3;
    for (const x of [-0.5, 0.5])
      for (const y of [-0.5, 0.5])
        for (const z of [-0.5, 0.5]) {
          const corner = new THREE.Vector3(x * this.sides[0], y * this.sides[1], z * (this.sides[2] ?? 0));
          const depth = corner.dot(back);
          distance = Math.max(distance, depth + Math.abs(corner.dot(right)) / (tangent * this.camera.aspect * room[0]),
            depth + Math.abs(corner.dot(up)) / (tangent * room[1]));
        }
    return distance;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.axisLabels.measure();
    const before = this.camera.aspect;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    for (const layer of this.layers)
      if (layer.dim === 2) {
        layer.uniforms.uViewport.value.set(width, height);
        layer.uniforms.uWidth.value = 2.5;
      }
    this.lookAround();
    if (!this.wasReset || Math.abs(before - this.camera.aspect) > 0.3) this.reset();
    this.wasReset = true;
    this.redraw();
  }

  /** Labels do not stand under these elements, wherever they are. */
  keepClear(elements) {
    this.obstacles = elements;
    const observer = new ResizeObserver(() => this.lookAround());
    for (const element of [...elements, this.canvas]) observer.observe(element);
  }

  /** Where there is no place for labels: to be called when that has changed. */
  lookAround() {
    const { left, top } = this.canvas.getBoundingClientRect();
    const boxes = this.obstacles.map((element) => element.getBoundingClientRect()).filter(({ width }) => width > 0);
    this.axisLabels.obstacles = boxes.map(({ x, y, width, height }) => ({ x: x - left + width / 2, y: y - top + height / 2,
      halfWidth: width / 2, halfHeight: height / 2 }));
    this.redraw();
  }

  setTheme(theme) {
    this.renderer.setClearColor(GROUNDS[theme], 1);
    this.boxMaterial.color.set(EDGES[theme]);
    this.redraw();
  }

  /** Shows only the part from lower[a] to upper[a]. */
  setClip(lower, upper) {
    // A little more than the box, as its own sides are rounded.
    const margin = (a) => 1e-5 * (this.extents[a] || 1);
    for (const { uniforms } of this.layers) {
      uniforms.uLower.value.set(...[0, 1, 2].map((a) => (a < lower.length ? lower[a] - this.center[a] - margin(a) : -1)));
      uniforms.uUpper.value.set(...[0, 1, 2].map((a) => (a < upper.length ? upper[a] - this.center[a] + margin(a) : 1)));
    }
    this.redraw();
  }

  setMarker(place) {
    this.marker = place;
    this.markerElement.hidden = place === null;
    this.redraw();
  }

  redraw() {
    this.isDirty = true;
  }

  /** Draws if anything has changed; true if it did. */
  frame() {
    this.controls.update();
    if (!this.isDirty || !this.wasReset) return false;
    this.isDirty = false;
    this.render();
    return true;
  }

  render() {
    ++this.frames;
    this.renderer.render(this.scene, this.camera);
    this.placeLabels();
  }

  /** Where on the screen a point of the box is, by its place there (each from -1/2 to 1/2). */
  onScreen(share) {
    const point = new THREE.Vector3(...[0, 1, 2].map((a) => share[a] * (this.sides[a] ?? 0))).project(this.camera);
    const { clientWidth, clientHeight } = this.canvas;
    return { x: ((point.x + 1) / 2) * clientWidth, y: ((1 - point.y) / 2) * clientHeight, z: point.z };
  }

  /** The edges of the box's outline along an axis, as seen: exactly one of their two faces is towards the eye. */
  outline(a) {
    const others = [0, 1, 2].filter((b) => b !== a);
    const faces = (b, side) => side * this.camera.position.getComponent(b) > (this.sides[b] ?? 0) / 2;
    const edges = [];
    for (const i of [-1, 1])
      for (const j of this.isFlat ? [0] : [-1, 1]) {
        if (!this.isFlat && faces(others[0], i) === faces(others[1], j)) continue;
        const [from, to] = [-1, 1].map((end) => {
          const share = [0, 0, 0];
          share[a] = (end * Math.sign(this.scale[a])) / 2;
          share[others[0]] = i / 2;
          share[others[1]] = j / 2;
          return this.onScreen(share);
        });
        if (from.z < 1 && to.z < 1) edges.push({ from, to });
      }
    return edges;
  }

  placeLabels() {
    const { clientWidth, clientHeight } = this.canvas;
    if (this.box.visible)
      this.axisLabels.place(this.axes.map((_, a) => this.outline(a)), this.onScreen([0, 0, 0]), clientWidth, clientHeight);
    else this.axisLabels.hide();
    if (!this.marker) return;
    const at = this.onScreen(this.marker.map((x, a) =>
      ((x - this.center[a]) / (this.extents[a] || 1)) * Math.sign(this.scale[a])));
    this.markerElement.style.transform = `translate(-50%, -50%) translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
  }
}
