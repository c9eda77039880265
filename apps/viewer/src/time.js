// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers with their units, and times as the data mean them: dates where the unit says since when, months by name.

const MONTHS = ['January', 'February', 'March', 'April', 'May', 'June', 'July', 'August', 'September', 'October',
  'November', 'December'];
const SECONDS = { s: 1, sec: 1, second: 1, min: 60, minute: 60, h: 3600, hr: 3600, hour: 3600, d: 86400, day: 86400 };

/** As many digits as are needed to tell values within `span` apart; without a span as many as the value needs. `most`:
 *  the largest of those that it stands beside, which are to look alike. */
export function number(value, span, most = Math.abs(value)) {
  if (!Number.isFinite(value)) return '–';
  const size = span ?? Math.abs(value);
  const digits = size > 0 ? 2 - Math.floor(Math.log10(size)) : 2;
  if (most >= 1e7 || digits > 7) {
    const before = most > 0 ? Math.floor(Math.log10(most)) : 0;
    return value.toExponential(Math.min(15, Math.max(3, digits + before))).replace(/-/g, '−');
  }
  const text = value.toFixed(Math.max(0, digits));
  return (digits > 0 && span === undefined ? text.replace(/\.?0+$/, '') : text).replace(/^-(0(\.0+)?)$/, '$1').replace('-', '−');
}

/** How values from `lowest` to `highest` are written, those at both ends with as many digits. */
export function ends(lowest, highest, span = highest - lowest) {
  const most = Math.max(Math.abs(lowest), Math.abs(highest));
  return (value) => number(value, span || 1, most);
}

export const grouped = (count) => String(count).replace(/\B(?=(\d{3})+$)/g, '\u202f');

/** The date that "<unit>s since <date>" gives a number; null where there is none. */
function dateOf(value, unit) {
  if (/\([^)]+\)\s*$/.test(unit)) return null; // of another calendar: "days since 1950-01-01 (noleap)"
  const found = /^\s*([a-z]+?)s?\s+since\s+(\d{1,4})-(\d{1,2})-(\d{1,2})(?:[T ](\d{1,2}):(\d{1,2})(?::(\d{1,2}))?)?/i
    .exec(unit);
  if (!found) return null;
  const [, name, year, month, day, hour = 0, minute = 0, second = 0] = found;
  const start = new Date(0);
  start.setUTCFullYear(+year, +month - 1, +day);
  start.setUTCHours(+hour, +minute, +second);
  const lower = name.toLowerCase();
  if (lower === 'month' || lower === 'year') {
    const months = value * (lower === 'year' ? 12 : 1);
    const whole = Math.floor(months);
    const next = (count) => new Date(start).setUTCMonth(start.getUTCMonth() + count);
    return new Date(next(whole) + (months - whole) * (next(whole + 1) - next(whole)));
  }
  return lower in SECONDS ? new Date(start.getTime() + value * SECONDS[lower] * 1000) : null;
}

/** How the times of an axis are written. `first` and `last`: the ends of what is shown. */
export class TimeFormat {
  constructor(axis, first, last) {
    this.name = axis.name;
    this.unit = axis.unit;
    this.write = ends(first, last, (last - first) / 10);
    this.isMonth = /^months?$/i.test(axis.unit.trim()) && first >= 0.5 && last < 12.5;
    const from = dateOf(first, axis.unit);
    const to = dateOf(last, axis.unit);
    this.days = from && to ? (to - from) / 86400e3 : 0;
  }

  value(t) {
    return this.write(t);
  }

  /** "7.30 month". */
  text(t) {
    const short = this.unit.replace(/\s+since.*$/i, '');
    return `${this.name} ${this.value(t)}${short ? ' ' + short : ''}`;
  }

  /** What the number means: a date, or the name of a month; may be empty. */
  meaning(t) {
    const date = dateOf(t, this.unit);
    if (date && !Number.isNaN(date.getTime())) {
      const year = date.getUTCFullYear(); // 0 and 1 stand for a year of means, which is no year
      const text = `${date.getUTCDate()} ${MONTHS[date.getUTCMonth()].slice(0, 3)}${year > 1 ? ` ${year}` : ''}`;
      const clock = `${String(date.getUTCHours()).padStart(2, '0')}:${String(date.getUTCMinutes()).padStart(2, '0')}`;
      return this.days < 40 ? `${text}, ${clock}` : text;
    }
    return this.isMonth ? MONTHS[Math.min(11, Math.max(0, Math.round(t) - 1))] : '';
  }
}

/** About `count` round numbers in [first, last]. */
export function ticks(first, last, count) {
  if (!(last > first)) return [first];
  const rough = (last - first) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= rough * 0.999);
  const result = [];
  for (let i = Math.ceil(first / step - 1e-9); i * step <= last + 1e-9 * step; ++i) result.push(i * step);
  return result;
}
