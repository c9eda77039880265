// SPDX-License-Identifier: BSD-3-Clause
//
// What is below the picture: the slider, and the graph of the parts with its events.
import { css, ofPart } from './colors.js';
import { ends, number, ticks } from './time.js';

const SVG = 'http://www.w3.org/2000/svg';
const INSET = 9; // half of the slider's thumb
const LANE = 9;
const STEPS = { ArrowLeft: -1, ArrowRight: 1 };
const AXIS = 20;

const WHAT = { begin: 'is there from the start', birth: 'is born', enter: 'comes in at the border', end: 'is there at the end',
  death: 'dies', leave: 'leaves at the border', merge: 'merge', split: 'splits', exchange: 'exchange' };

function make(name, attributes, parent) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  parent.append(element);
  return element;
}

/** A lane for each track, such that those of one lane do not overlap. `gap`: least time between them. */
function lanesOf(tracks, gap) {
  const ends = [];
  const lanes = new Map();
  for (const track of [...tracks].sort((a, b) => a.start - b.start || b.end - a.end)) {
    let lane = ends.findIndex((end) => end + gap < track.start);
    if (lane < 0) lane = ends.push(0) - 1;
    ends[lane] = track.end;
    lanes.set(track.track, lane);
  }
  return { lanes, count: ends.length };
}

export class Timeline {
  /** `onTime(t)`, `onEvent(event)`: what to do when someone chooses. */
  constructor({ slider, graph, format, first, last, onTime, onEvent }) {
    Object.assign(this, { slider, holder: graph, format, first, last, onTime, onEvent, layer: null });
    slider.addEventListener('input', () => onTime(this.timeAt(Number(slider.value))));
    graph.addEventListener('click', (event) => {
      if (event.target.closest('.event')) return;
      const box = graph.getBoundingClientRect();
      const share = (event.clientX - box.left - INSET) / (graph.clientWidth - 2 * INSET);
      onTime(this.timeAt(Math.min(1, Math.max(0, share))));
    });
    new ResizeObserver(() => this.show(this.layer)).observe(graph);
  }

  timeAt(share) {
    return share <= 0 ? this.first : share >= 1 ? this.last : this.first + share * (this.last - this.first);
  }
  shareOf(t) {
    return this.last > this.first ? (t - this.first) / (this.last - this.first) : 0;
  }
  x(t) {
    return INSET + this.shareOf(t) * (this.width - 2 * INSET);
  }

  setTime(t) {
    this.slider.value = this.shareOf(t);
    this.slider.setAttribute('aria-valuetext', `${this.format.text(t)} ${this.format.meaning(t)}`.trim());
    this.now = t;
    if (!this.cursor) return;
    this.cursor.setAttribute('x1', this.x(t));
    this.cursor.setAttribute('x2', this.x(t));
  }

  /** The events of the graph that is shown, by time. */
  events() {
    return this.layer?.description.graph?.events ?? [];
  }

  /** Draws the graph of a layer. */
  show(layer) {
    this.layer = layer;
    this.width = this.holder.clientWidth;
    if (!this.width) return;
    const graph = layer?.description.graph;
    const tracks = graph ? graph.tracks : [];
    const { lanes, count } = lanesOf(tracks, (this.last - this.first) * 0.012);
    const height = tracks.length > 0 ? count * LANE + 8 : 0;
    this.holder.replaceChildren();
    const scale = make('svg', { class: 'scale', width: this.width, height: AXIS }, this.holder);
    const svg = make('svg', { width: this.width, height, role: 'group',
      'aria-label': 'Parts over time, with their events' }, this.holder);
    this.drawTicks(scale, svg, height);
    if (tracks.length > 0) this.drawTracks(svg, graph, lanes);
    this.cursor = make('line', { class: 'cursor', y1: 0, y2: height }, svg);
    this.setTime(this.now ?? this.first);
  }

  drawTicks(scale, svg, height) {
    const values = ticks(this.first, this.last, Math.max(2, Math.floor(this.width / 90)));
    const step = values.length > 1 ? values[1] - values[0] : 1;
    const write = ends(values[0], values.at(-1), step * 20);
    for (const t of values) {
      const x = this.x(t);
      make('line', { class: 'tick', x1: x, x2: x, y1: 0, y2: height }, svg);
      make('line', { class: 'tick', x1: x, x2: x, y1: 15, y2: AXIS }, scale);
      const label = make('text', { class: 'tick-label', x, y: 12,
        'text-anchor': x < 24 ? 'start' : x > this.width - 24 ? 'end' : 'middle' }, scale);
      label.textContent = write(t);
    }
  }

  drawTracks(svg, graph, lanes) {
    const y = (track) => 7 + lanes.get(track) * LANE;
    const rank = new Map([...graph.tracks].sort((a, b) => b.end - b.start - (a.end - a.start) || a.track - b.track)
      .map((track, i) => [track.track, i]));
    const links = make('g', { class: 'links' }, svg);
    for (const track of graph.tracks)
      make('line', { class: 'track', x1: this.x(track.start), x2: Math.max(this.x(track.end), this.x(track.start) + 1),
        y1: y(track.track), y2: y(track.track), stroke: css(ofPart(rank.get(track.track))) }, svg);
    graph.events.forEach((event, i) => {
      const places = [...event.in, ...event.out].map((s) => graph.segments[s]).filter(Boolean).map((s) => y(s.track));
      if (places.length === 0) return;
      const x = this.x(event.time);
      const [top, bottom] = [Math.min(...places), Math.max(...places)];
      if (bottom > top) make('line', { x1: x, x2: x, y1: top, y2: bottom }, links);
      this.drawEvent(svg, event, i, x, event.in.length === 1 && event.out.length > 1 ? places[0] : places.at(-1));
    });
  }

  drawEvent(svg, event, i, x, y) {
    const text = `${event.kind} at ${this.format.text(event.time)}`;
    // One stop for the tab key: from event to event it goes by arrows.
    const mark = make('g', { class: `event ${event.kind}`, tabindex: i === (this.focused ?? 0) ? 0 : -1, role: 'button',
      'aria-label': `${this.format.text(event.time)}: ${this.describe(event)}`,
      'data-event': i, transform: `translate(${x} ${y})` }, svg);
    make('circle', { class: 'reach', r: 9 }, mark);
    make('circle', { class: 'dot', r: 3.6 }, mark);
    make('title', {}, mark).textContent = text;
    mark.addEventListener('click', () => this.onEvent(event));
    mark.addEventListener('keydown', (key) => {
      if (key.key !== 'Enter' && !(key.key in STEPS)) return;
      key.stopPropagation();
      key.preventDefault();
      if (key.key === 'Enter') this.onEvent(event);
      else this.focus(svg, mark, STEPS[key.key]);
    });
    mark.addEventListener('focus', () => (this.focused = i));
  }

  /** Goes to another mark, so many on by time. */
  focus(svg, mark, step) {
    const marks = [...svg.querySelectorAll('.event')];
    const next = marks[marks.indexOf(mark) + step];
    if (!next) return;
    mark.setAttribute('tabindex', -1);
    next.setAttribute('tabindex', 0);
    next.focus();
  }

  /** What happened, in words. */
  describe(event) {
    const where = event.place.map((value) => number(value)).join(', ');
    const parts = event.kind === 'merge' ? `${event.in.length} parts merge` : event.kind === 'split'
      ? `a part splits in ${event.out.length}` : event.kind === 'exchange' ? 'parts meet and part'
      : `a part ${WHAT[event.kind]}`;
    return `${parts} at (${where})`;
  }
}
