// SPDX-License-Identifier: BSD-3-Clause
//
// The page of `tegl view`: contours of images, those with time cut by the GPU at the time of a slider, every frame.
// M. Liversage, thesis, 1994, 10.2.11: turn the knob, and time flows, not from frame to frame.
import { ofPart } from './colors.js';
import { unpack } from './data.js';
import { Layer } from './layer.js';
import { interfaceOf } from './interface.js';
import { Panel } from './panel.js';
import { savePicture } from './picture.js';
import { Stage } from './stage.js';
import { counted, grouped, TimeFormat } from './time.js';
import { Timeline } from './timeline.js';

const $ = (id) => document.getElementById(id);
const SECONDS = 12; // from the first time to the last, at speed 1
const REST = 120; // milliseconds without a change of time, after which the exact count is made

const KEYS = [['space', 'play, pause'], ['← →', 'step back, forward (with shift: ten steps)'],
  ['home, end', 'first, last time'], [', .', 'previous event, next event'], ['[ ]', 'slower, faster'], ['l', 'loop'],
  ['g', 'tracks, if the page is low'], ['c', 'next colouring'], ['d', 'light, dark'], ['m', 'panel'], ['r', 'reset the view'],
  ['tab to the picture, then ← → ↑ ↓', 'rotate (with shift: move)'], ['+ −', 'zoom in, zoom out'], ['s', 'save a picture'],
  ['?', 'this list']];

/** Where the panel lies over the picture, as page.css has it. */
const SMALL = matchMedia('(max-width: 720px), (max-height: 440px)');

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

/** Keys that move the knob of a slider, or the choice in a list. */
const MOVES = ['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown', 'Home', 'End', 'PageUp', 'PageDown'];

/** Whether what has the focus takes a key itself: a button and a box the space, a slider the keys that move its knob, a list
 *  these and letters. The keys of the slider of the time are those of the page. */
function isOwnKey(target, key) {
  if (target.id === 'slider') return false;
  if (target.closest('select')) return MOVES.includes(key) || /^[\p{L}\p{N} ]$/u.test(key);
  if (target.closest('input[type="range"]')) return MOVES.includes(key);
  return key === ' ' && target.closest('button, input') !== null;
}

/** "temperature = 15, 20 degC": each variable once, with what of it is shown. */
function isovaluesOf(layers) {
  const values = new Map();
  for (const { isovalue, variable, unit } of layers) {
    if (isovalue === null) continue;
    const key = JSON.stringify([variable || 'isovalue', unit]);
    values.set(key, (values.get(key) ?? new Set()).add(+isovalue.toPrecision(7)));
  }
  return [...values].map(([key, numbers]) => {
    const [name, unit] = JSON.parse(key);
    return `${name} = ${[...numbers].join(', ')}${unit ? ` ${unit}` : ''}`;
  }).join('; ');
}

class App {
  constructor(description, bytes) {
    this.description = description;
    this.layers = description.layers.map((layer, i) => new Layer(layer, bytes, i));
    this.stage = new Stage($('canvas'), $('labels'), this.layers);
    this.inTime = this.layers.filter((layer) => layer.dim === 4);
    this.current = this.inTime[0] ?? this.layers[0];
    this.isPlaying = false;
    this.loops = true;
    this.speed = 1;
    this.event = null;
    this.setTheme(matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
    this.showTitles();
    if (this.inTime.length > 0) this.addTime();
    this.panel = new Panel(this);
    for (const layer of this.layers) this.setColors(layer);
    this.choose(this.current);
    if (this.inTime.length > 0) this.setTime(this.first + (this.last - this.first) * 0.5);
    else this.count();
    this.listen();
    this.togglePanel(!SMALL.matches);
    this.before = performance.now();
    requestAnimationFrame((now) => this.frame(now));
  }

  showTitles() {
    const { title, layers, program } = this.description;
    document.title = $('title').textContent = title;
    const parts = layers.reduce((sum, layer) => sum + layer.components, 0);
    $('subtitle').textContent = [isovaluesOf(layers), counted(parts, 'component'),
      program].filter(Boolean).join(' · ');
    const left = layers.filter((layer) => layer.components < layer.of_components).map((layer) =>
      `${layer.file.replace(/^.*\//, '')}: too large to show all. Shown ` +
      `${layer.components === 1 ? 'is the largest' : `are the ${grouped(layer.components)} largest`} of ` +
      `${grouped(layer.of_components)} components, ${grouped(layer.simplices)} of ${grouped(layer.of_simplices)} simplices.`);
    const { worlds } = this.stage;
    if (worlds.length > 1)
      left.push(`The files have different world frames, ${worlds.join(' and ')}: their relative positions differ from ` +
        'those in the patient, and no sides are shown.');
    if (left.length === 0) return;
    $('notice').textContent = left.join(' ');
    const close = document.createElement('button');
    close.textContent = '×';
    close.setAttribute('aria-label', 'Close');
    close.addEventListener('click', () => ($('notice').hidden = true));
    $('notice').append(close);
    $('notice').hidden = false;
  }

  addTime() {
    this.first = Math.min(...this.inTime.map((layer) => layer.firstTime));
    this.last = Math.max(...this.inTime.map((layer) => layer.lastTime));
    this.format = new TimeFormat(this.current.description.axes[3], this.first, this.last);
    $('time').hidden = false;
    this.timeline = new Timeline({ slider: $('slider'), graph: $('graph'), format: this.format, first: this.first,
      last: this.last, onTime: (t) => this.setTime(t), onEvent: (event) => this.goTo(event) });
  }

  setColors(layer) {
    layer.uniforms.uColor.value.setRGB(...ofPart(layer.index).map((channel) => channel / 255), '');
    const id = this.layers.length > 1 || layer.description.components < 2 ? 'plain' : 'component';
    layer.colorBy(layer.description.arrays.segment && this.layers.length === 1 ? 'track' : id);
  }

  choose(layer) {
    this.current = layer;
    this.panel.show(layer);
    if (!this.timeline) return;
    this.timeline.show(layer);
    const { graph, tracks_found: found } = layer.description;
    $('graph-note').textContent = !graph || graph.tracks.length === found ? ''
      : `${grouped(graph.tracks.length)} of ${counted(found, 'track')}, those with the longest lifetime, with ` +
        `${grouped(graph.events.length)} of ${counted(layer.description.events_found, 'event')}.`;
    $('before').hidden = $('after').hidden = this.timeline.events().length === 0;
  }

  colorBy(id) {
    this.current.colorBy(id);
    this.panel.show(this.current);
    this.stage.redraw();
  }

  setSmooth(isSmooth) {
    for (const layer of this.layers) layer.uniforms.uSmooth.value = isSmooth;
    this.stage.redraw();
  }

  setVisible(layer, isVisible) {
    layer.isVisible = layer.mesh.visible = isVisible;
    this.count();
    this.stage.redraw();
  }

  setTime(t) {
    if (!this.timeline) return;
    this.t = Math.min(this.last, Math.max(this.first, t));
    for (const layer of this.inTime) layer.setTime(this.t);
    this.timeline.setTime(this.t);
    this.panel.setTime(this.t);
    if (this.event && this.event.time !== this.t) this.setEvent(null);
    const meaning = this.event ? this.describeEvent() : this.format.meaning(this.t);
    $('now').textContent = this.format.text(this.t);
    if (meaning) $('now').append(' ', Object.assign(document.createElement('small'), { textContent: meaning }));
    this.panel.showCount(this.visible().reduce((sum, layer) => sum + layer.quickCount(), 0),
      this.inTime.every((layer) => !layer.level.isOn));
    clearTimeout(this.rest);
    if (!this.isPlaying) this.rest = setTimeout(() => this.count(), REST);
    this.stage.redraw();
  }

  visible() {
    return this.layers.filter((layer) => layer.isVisible);
  }

  /** The exact number of simplices shown. */
  count() {
    clearTimeout(this.rest);
    const count = this.visible().reduce((sum, layer) => sum + layer.settle(), 0);
    this.panel.showCount(count, true);
    this.stage.redraw();
    return count;
  }

  /** The event that is shown, and how many others there are at its time. */
  describeEvent() {
    const others = this.timeline.events().filter(({ time }) => time === this.event.time).length - 1;
    return this.timeline.describe(this.event) + (others > 0 ? `, and ${counted(others, 'other event')} at this time` : '');
  }

  setEvent(event) {
    this.event = event;
    this.stage.setMarker(event ? event.place : null);
  }

  goTo(event) {
    this.play(false);
    this.setEvent(event);
    this.setTime(event.time);
  }

  nextEvent(step) {
    const times = this.timeline.events();
    const found = step > 0 ? times.find(({ time }) => time > this.t) : times.findLast(({ time }) => time < this.t);
    if (found) this.goTo(found);
  }

  play(isPlaying) {
    if (!this.timeline) return;
    if (isPlaying && this.t >= this.last) this.setTime(this.first);
    this.isPlaying = isPlaying;
    $('play').setAttribute('aria-pressed', isPlaying);
    $('play').setAttribute('aria-label', isPlaying ? 'Pause' : 'Play');
    if (!isPlaying) this.count();
  }

  advance(seconds) {
    let t = this.t + ((this.last - this.first) / SECONDS) * this.speed * seconds;
    if (t >= this.last) {
      if (this.loops) t = this.first + ((t - this.first) % (this.last - this.first || 1));
      else {
        this.setTime(this.last);
        return this.play(false);
      }
    }
    this.setTime(t);
  }

  frame(now) {
    const seconds = Math.min(0.25, (now - this.before) / 1000);
    this.before = now;
    if (this.isPlaying) this.advance(seconds);
    this.stage.frame();
    requestAnimationFrame((next) => this.frame(next));
  }

  setTheme(theme) {
    document.documentElement.dataset.theme = theme;
    this.theme = theme;
    this.stage.setTheme(theme);
  }

  togglePanel(isShown = $('app').classList.contains('no-panel')) {
    $('app').classList.toggle('no-panel', !isShown);
    $('more').setAttribute('aria-expanded', isShown);
  }

  /** The graph of a low page. */
  toggleTracks() {
    $('tracks').setAttribute('aria-expanded', $('app').classList.toggle('tracks'));
  }

  toggleLoop() {
    this.loops = !this.loops;
    $('loop').setAttribute('aria-pressed', this.loops);
  }

  changeSpeed(step) {
    const { options, selectedIndex } = $('speed');
    $('speed').selectedIndex = Math.min(options.length - 1, Math.max(0, selectedIndex + step));
    this.speed = Number($('speed').value);
  }

  nextColor() {
    const sources = this.current.sources();
    this.colorBy(sources[(sources.findIndex(({ id }) => id === this.current.source.id) + 1) % sources.length].id);
  }

  picture() {
    return savePicture(this);
  }

  listen() {
    const on = (id, action) => $(id).addEventListener('click', action);
    on('theme', () => this.toggleTheme());
    on('shot', () => this.picture());
    on('reset', () => this.stage.reset());
    on('help', () => $('keys').showModal());
    on('more', () => this.togglePanel());
    on('play', () => this.play(!this.isPlaying));
    on('loop', () => this.toggleLoop());
    on('tracks', () => this.toggleTracks());
    on('before', () => this.nextEvent(-1));
    on('after', () => this.nextEvent(1));
    $('speed').addEventListener('change', () => this.changeSpeed(0));
    $('canvas').addEventListener('pointerdown', () => SMALL.matches && this.togglePanel(false));
    SMALL.addEventListener('change', () => this.togglePanel(!SMALL.matches));
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', ({ matches }) =>
      this.setTheme(matches ? 'dark' : 'light'));
    for (const [key, what] of KEYS)
      for (const [name, text] of [['dt', key], ['dd', what]])
        $('key-list').append(Object.assign(document.createElement(name), { textContent: text }));
    addEventListener('keydown', (event) => this.key(event));
  }

  toggleTheme() {
    this.setTheme(this.theme === 'dark' ? 'light' : 'dark');
  }

  key(event) {
    const { target, key, shiftKey } = event;
    if (event.ctrlKey || event.metaKey || event.altKey || $('keys').open) return;
    const step = ((this.last - this.first) / 400) * (shiftKey ? 10 : 1);
    const ofTime = { ' ': () => this.play(!this.isPlaying), ArrowLeft: () => this.setTime(this.t - step),
      ArrowRight: () => this.setTime(this.t + step), Home: () => this.setTime(this.first),
      End: () => this.setTime(this.last), ',': () => this.nextEvent(-1), '.': () => this.nextEvent(1),
      '[': () => this.changeSpeed(-1), ']': () => this.changeSpeed(1), l: () => this.toggleLoop(),
      g: () => this.toggleTracks() };
    const always = { d: () => this.toggleTheme(), s: () => this.picture(), r: () => this.stage.reset(),
      '+': () => this.stage.zoom(1 / 1.15), '=': () => this.stage.zoom(1 / 1.15), '-': () => this.stage.zoom(1.15),
      c: () => this.nextColor(), m: () => this.togglePanel(), '?': () => $('keys').showModal() };
    const inPicture = target.id === 'canvas' && ARROWS[key];
    const action = inPicture ? () => this.stage.turn(...ARROWS[key], shiftKey)
      : always[key] ?? (this.timeline ? ofTime[key] : undefined);
    if (!action || isOwnKey(target, key)) return;
    event.preventDefault();
    action();
  }
}

window.teglStarted = true; // the page has come as far as this, whole

async function start() {
  // The first paint comes before the work.
  await new Promise((done) => setTimeout(done, 0));
  const description = JSON.parse($('scene').textContent);
  const bytes = await unpack($('numbers').textContent);
  $('numbers').remove();
  const app = new App(description, bytes);
  $('busy').hidden = true;
  window.tegl = interfaceOf(app);
}

start().catch((error) => {
  document.documentElement.dataset.theme = matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
  $('fatal').querySelector('p').textContent = error.message;
  $('fatal').hidden = false;
  window.teglError = error.message;
});
