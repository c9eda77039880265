// SPDX-License-Identifier: BSD-3-Clause
//
// What is below the picture: the slider, and the graph of the components with its events.
import { css, ofPart } from './colors.js';
import { crowdsOf, widthOf } from './crowds.js';
import { counted, ends, grouped, number, ticks } from './time.js';

const SVG = 'http://www.w3.org/2000/svg';
const INSET = 9; // half of the slider's thumb
const LANE = 9;
const STEPS = { ArrowLeft: -1, ArrowRight: 1 };
const AXIS = 20;

/** What components do at an event, one and several. */
const WHAT = { begin: ['exists at the start', 'exist at the start'], birth: ['is born', 'are born'],
  enter: ['enters at the border', 'enter at the border'], end: ['exists at the end', 'exist at the end'],
  death: ['dies', 'die'], leave: ['leaves at the border', 'leave at the border'], merge: ['merges', 'merge'] };
/** Kinds of events, one and several, the most important first. */
const KINDS = { merge: ['merge', 'merges'], split: ['split', 'splits'], exchange: ['exchange', 'exchanges'],
  birth: ['birth', 'births'], death: ['death', 'deaths'], enter: ['entry', 'entries'], leave: ['exit', 'exits'],
  begin: ['start', 'starts'], end: ['end', 'ends'] };

function make(name, attributes, parent) {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  parent.append(element);
  return element;
}

/** A lane for each track, such that tracks of one lane do not overlap. `gap`: least time between them. */
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
      'aria-label': 'Components over time, with their events' }, this.holder);
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
    const places = [];
    const linked = new Map(); // column of pixels -> [top, bottom] of what is drawn there
    graph.events.forEach((event, i) => {
      const lanesOf = [...event.in, ...event.out].map((s) => graph.segments[s]).filter(Boolean).map((s) => y(s.track));
      if (lanesOf.length === 0) return;
      const x = this.x(event.time);
      const [top, bottom] = [Math.min(...lanesOf), Math.max(...lanesOf)];
      if (bottom > top) {
        const [from, to] = linked.get(Math.round(x)) ?? [top, bottom];
        linked.set(Math.round(x), [Math.min(from, top), Math.max(to, bottom)]);
      }
      places.push({ i, event, x, y: event.in.length === 1 && event.out.length > 1 ? lanesOf[0] : lanesOf.at(-1) });
    });
    for (const [x, [y1, y2]] of linked) make('line', { x1: x, x2: x, y1, y2 }, links);
    const marks = crowdsOf(places);
    const stop = Math.max(0, marks.findIndex(({ members }) => members.some(({ i }) => i === this.focused)));
    marks.forEach((mark, m) => this.drawMark(svg, mark, m === stop));
  }

  /** A dot for one event, or, for a crowd of events, a plate with their number. `isStop`: whether the tab key stops there:
   *  it does once, and arrows go on from mark to mark. */
  drawMark(svg, { x, y, members }, isStop) {
    const [{ event, i }] = members;
    const isCrowd = members.length > 1;
    const kind = isCrowd ? this.mostImportant(members) : event.kind;
    const label = isCrowd ? this.describeCrowd(members) : `${this.format.text(event.time)}: ${this.describe(event)}`;
    const mark = make('g', { class: `event ${kind}${isCrowd ? ' crowd' : ''}`, tabindex: isStop ? 0 : -1, role: 'button',
      'aria-label': label, 'data-event': i, 'data-count': members.length, transform: `translate(${x} ${y})` }, svg);
    if (isCrowd) this.drawPlate(mark, members.length);
    else {
      make('circle', { class: 'reach', r: 9 }, mark);
      make('circle', { class: 'dot', r: 3.6 }, mark);
    }
    make('title', {}, mark).textContent = isCrowd ? label : `${event.kind} at ${this.format.text(event.time)}`;
    mark.addEventListener('click', () => this.choose(members));
    mark.addEventListener('keydown', (key) => {
      if (key.key !== 'Enter' && !(key.key in STEPS)) return;
      key.stopPropagation();
      key.preventDefault();
      if (key.key === 'Enter') this.choose(members);
      else this.focus(svg, mark, STEPS[key.key]);
    });
    mark.addEventListener('focus', () => (this.focused = i));
  }

  drawPlate(mark, count) {
    const width = widthOf(count);
    make('rect', { class: 'reach', x: -width / 2 - 2, y: -9, width: width + 4, height: 18, rx: 9 }, mark);
    make('rect', { class: 'plate', x: -width / 2, y: -5, width, height: 10, rx: 5 }, mark);
    make('text', { class: 'number', y: 2.9, 'text-anchor': 'middle' }, mark).textContent = count;
  }

  /** Goes to the event of a mark; of a crowd to the next one after the time that is shown, and after the last to the first. */
  choose(members) {
    this.onEvent((members.find(({ event }) => event.time > this.now) ?? members[0]).event);
  }

  mostImportant(members) {
    const order = Object.keys(KINDS);
    return order[Math.min(...members.map(({ event }) => order.indexOf(event.kind)))];
  }

  /** "41 events, t 3.1 to t 3.4: 30 merges, 11 births". */
  describeCrowd(members) {
    const times = [members[0], members.at(-1)].map(({ event }) => this.format.text(event.time));
    const kinds = Object.entries(KINDS).map(([kind, [one, several]]) => {
      const count = members.filter(({ event }) => event.kind === kind).length;
      return count > 0 ? counted(count, one, several) : '';
    }).filter(Boolean);
    return `${grouped(members.length)} events, ${times[0] === times[1] ? times[0] : times.join(' to ')}: ${kinds.join(', ')}`;
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

  /** What happened, in words, with the numbers of all components: of how many the tracks are drawn is said where it differs. */
  describe(event) {
    const { kind, parts_in: before, parts_out: after } = event;
    const where = event.place.map((value) => number(value)).join(', ');
    // Those that the event is about: what comes of a split, what was there before a merge, and the only ones of a birth.
    const isOfLater = kind === 'split' || before === 0;
    const [all, drawn] = isOfLater ? [after, event.out.length] : [before, event.in.length];
    const parts = kind === 'split' ? `a component splits into ${after}` : kind === 'exchange'
      ? `${counted(before, 'component')} meet and become ${after}`
      : all === 1 ? `a component ${WHAT[kind][0]}` : `${counted(all, 'component')} ${WHAT[kind][1]}`;
    return `${parts}${drawn < all ? ` (${drawn === 0 ? 'none' : drawn} of them drawn)` : ''} at (${where})`;
  }
}
