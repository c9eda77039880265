// SPDX-License-Identifier: BSD-3-Clause
//
// The panel at the side: which contours are shown, their colours and legend, clipping.
import { css, ofPart, ofShare } from './colors.js';
import { ends, grouped } from './time.js';

const $ = (id) => document.getElementById(id);
const COUNTED = { 2: 'segments', 3: 'triangles', 4: 'tetrahedra' };

function element(name, attributes = {}, ...children) {
  const result = document.createElement(name);
  Object.assign(result, attributes);
  result.append(...children);
  return result;
}

export class Panel {
  constructor(app) {
    this.app = app;
    this.fillLayers();
    this.fillClips();
    this.showWorld();
    $('color').addEventListener('change', () => app.colorBy($('color').value));
    $('smooth').addEventListener('change', () => app.setSmooth($('smooth').checked));
    $('box').addEventListener('change', () => {
      app.stage.box.visible = $('box').checked;
      app.stage.redraw();
    });
    const { stage } = app;
    const last = stage.axes[stage.isFlat ? 1 : 2];
    $('stretch-name').textContent = last.name;
    $('stretch').addEventListener('input', () => {
      stage.stretch = 10 ** Number($('stretch').value);
      stage.arrange();
    });
    $('flip').addEventListener('change', () => {
      stage.isFlipped = $('flip').checked;
      stage.arrange();
      this.showWorld();
    });
    $('stretch').addEventListener('dblclick', () => {
      $('stretch').value = 0;
      $('stretch').dispatchEvent(new Event('input'));
    });
    $('smooth-row').hidden = stage.isFlat;
  }

  fillLayers() {
    const { layers } = this.app;
    $('layers').classList.toggle('several', layers.length > 1);
    $('layers').replaceChildren(...layers.map((layer) => {
      const eye = element('input', { type: 'checkbox', checked: true, ariaLabel: `show ${layer.name}` });
      eye.addEventListener('change', () => this.app.setVisible(layer, eye.checked));
      const choose = element('button', { type: 'button', textContent: layer.name, title: layer.description.file });
      choose.addEventListener('click', () => this.app.choose(layer));
      const swatch = element('b');
      swatch.style.background = css(ofPart(layer.index));
      return layers.length > 1 ? element('li', {}, eye, swatch, choose) : element('li', {}, choose);
    }));
  }

  /** Shows the settings of a layer. */
  show(layer) {
    [...$('layers').children].forEach((item, i) => item.classList.toggle('current', this.app.layers[i] === layer));
    $('color').replaceChildren(...layer.sources().map(({ id, name }) =>
      element('option', { value: id, textContent: name, selected: layer.source?.id === id })));
    this.showLegend(layer);
    this.app.stage.lookAround();
  }

  showLegend(layer) {
    const { source } = layer;
    const legend = $('legend');
    legend.replaceChildren();
    if (!source || source.kind === 'plain') return;
    const unit = source.unit ? ` (${source.unit})` : '';
    legend.append(element('div', { className: 'legend-title', textContent: source.name + unit }));
    if (source.kind === 'parts') this.addSwatches(legend, source);
    else this.addBar(legend, source);
  }

  addSwatches(legend, { count, id }) {
    const MOST = 8;
    const swatches = element('div', { className: 'swatches' });
    for (let i = 0; i < Math.min(count, MOST); ++i) {
      const swatch = element('b');
      swatch.style.background = css(ofPart(i));
      swatches.append(element('span', {}, swatch, String(i + 1)));
    }
    if (count > MOST) swatches.append(`… ${grouped(count)}`);
    swatches.append(element('span', { textContent: id === 'track' ? '1: longest lifetime' : '1: largest' }));
    legend.append(swatches);
  }

  addBar(legend, { lowest, highest, id }) {
    const bar = element('div', { className: 'bar' });
    const stops = Array.from({ length: 11 }, (_, i) => css(ofShare(i / 10)));
    bar.style.background = `linear-gradient(to right, ${stops.join(', ')})`;
    this.mark = id === 'time' ? bar.appendChild(element('i')) : null;
    const span = highest - lowest || 1;
    const write = ends(lowest, highest);
    legend.append(bar, element('div', { className: 'ends' }, ...[lowest, (lowest + highest) / 2, highest].map((value) =>
      element('span', { textContent: write(value) }))));
    this.markSpan = [lowest, span];
    this.setTime(this.app.t);
  }

  setTime(t) {
    if (!this.mark || this.app.current.source?.id !== 'time') return;
    const [lowest, span] = this.markSpan;
    this.mark.style.left = `${Math.min(100, Math.max(0, (100 * (t - lowest)) / span))}%`;
  }

  /** `count`: simplices of the cuts and contours that are shown; `isExact`: whether the library would say the same. */
  showCount(count, isExact) {
    const { layers } = this.app;
    const shown = layers.filter((layer) => layer.isVisible);
    const dim = this.app.stage.isFlat ? 2 : 3;
    const drawn = shown.filter((layer) => layer.dim === 4);
    let text = `${isExact ? '' : '≈ '}${grouped(count)} ${COUNTED[dim]}${this.isClipped() ? ' before clipping' : ''}`;
    if (drawn.length > 0) {
      const sum = (of) => drawn.reduce((total, layer) => total + of(layer), 0);
      text += `, from ${grouped(sum((layer) => layer.drawn))} of ${grouped(sum((layer) => layer.description.simplices))} tetrahedra`;
    }
    $('count').textContent = text;
    $('count').dataset.count = count;
    $('count').dataset.exact = isExact;
    this.counted = [count, isExact];
  }

  /** What the letters at the ends of the axes mean, or that nothing says where a patient's sides are. */
  showWorld() {
    const { stage } = this.app;
    const isScan = !stage.isFlat && stage.axes.every(({ unit }) => unit.trim().toLowerCase() === 'mm');
    $('world').textContent = stage.world
      ? `Sides of the patient, as the file says (${stage.world}): R right, L left; A front, P back; S head, I feet.${
        stage.isMirrored ? ' The view is a mirror image: an axis is reversed.' : ''}`
      : stage.worlds.length > 1 ? `Sides of the patient: the files differ (${stage.worlds.join(', ')}).`
      : isScan ? 'Left and right are unknown: no file contains them (saved contours never do; tegl view --world RAS).' : '';
  }

  fillClips() {
    const { stage } = this.app;
    const clips = (this.clips = stage.axes.map((axis, a) => {
      const from = element('input', { type: 'range', min: 0, max: 1, step: 0.002, value: 0, ariaLabel: `${axis.name} from` });
      const to = element('input', { type: 'range', min: 0, max: 1, step: 0.002, value: 1, ariaLabel: `${axis.name} to` });
      const range = element('span', { className: 'range' });
      for (const [input, other, sign] of [[from, to, 1], [to, from, -1]])
        input.addEventListener('input', () => {
          if (sign * (Number(other.value) - Number(input.value)) < 0) other.value = input.value;
          this.clip();
        });
      return { axis, a, from, to, range };
    }));
    $('clips').replaceChildren(...clips.map(({ axis, from, to, range }) =>
      element('div', { className: 'clip' }, element('span', { textContent: axis.name }), range, from, to)));
    $('unclip').addEventListener('click', () => {
      for (const { from, to } of clips) [from.value, to.value] = [0, 1];
      this.clip();
    });
    this.clip();
  }

  isClipped() {
    return this.clips.some(({ from, to }) => Number(from.value) > 0 || Number(to.value) < 1);
  }

  clip() {
    const { stage } = this.app;
    const at = (a, input) => stage.lower[a] + Number(input.value) * stage.extents[a];
    const lower = this.clips.map(({ a, from }) => at(a, from));
    const upper = this.clips.map(({ a, to }) => at(a, to));
    this.clips.forEach(({ a, range }) => {
      const write = ends(stage.lower[a], stage.upper[a], stage.extents[a] / 10);
      range.textContent = `${write(lower[a])} … ${write(upper[a])}`;
    });
    $('unclip').hidden = !this.isClipped();
    stage.setClip(lower, upper);
    if (this.counted) this.showCount(...this.counted);
  }

  setClip(a, from, to) {
    this.clips[a].from.value = from;
    this.clips[a].to.value = to;
    this.clip();
  }
}
