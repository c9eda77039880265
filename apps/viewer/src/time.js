// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers with their units, and times as the data mean them: dates where the unit says since when, months by name.

const MONTHS = ['January', 'February', 'March', 'April', 'May', 'June', 'July', 'August', 'September', 'October',
  'November', 'December'];
const SECONDS = { ms: 1e-3, msec: 1e-3, millisecond: 1e-3, s: 1, sec: 1, second: 1, min: 60, minute: 60, h: 3600, hr: 3600, hour: 3600, d: 86400, day: 86400, week: 604800 };

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

/** "1 component", "12 components". */
export const counted = (count, one, several = `${one}s`) => `${grouped(count)} ${count === 1 ? one : several}`;

export const grouped = (count) => String(count).replace(/\B(?=(\d{3})+$)/g, '\u202f');

const SINCE = new RegExp(String.raw`^\s*([a-z]+)\s+since\s+(\d{1,4})-(\d{1,2})-(\d{1,2})` +
  String.raw`(?:[T\s]\s*(\d{1,2})(?::(\d{1,2})(?::(\d{1,2})(?:\.\d*)?)?)?)?\s*(?:Z|UTC|GMT|([+-])(\d{1,2}):?(\d{2})?)?\s*$`, 'i');
const CALENDARS = ['standard', 'gregorian', 'proleptic_gregorian'];
const DAY = 86400e3;
/** The first day of the Gregorian calendar; those before it are Julian in the standard calendar of netCDF. */
const REFORM = Date.UTC(1582, 9, 15);
/** Days from the beginning of the Julian calendar's four years that begin on 1 March of its year 0 to 1970-01-01. */
const MARCH_0 = 719470;

/** The moment of a day of the standard calendar, or the proleptic Gregorian one, in milliseconds as Date has them. */
function momentOf(year, month, day, isGregorian) {
  const date = new Date(0);
  date.setUTCFullYear(year, month - 1, day);
  if (date.getTime() >= REFORM || isGregorian) return date.getTime();
  const y = month < 3 ? year - 1 : year;
  const m = (month + 9) % 12;
  return (Math.floor(1461 * y / 4) + Math.floor((153 * m + 2) / 5) + day - 1 - MARCH_0) * DAY;
}

/** Year, month (from 0) and day of a moment in either calendar, and its time of day. */
function fieldsOf(moment, isGregorian) {
  const date = new Date(moment);
  const clock = { moment, hour: date.getUTCHours(), minute: date.getUTCMinutes() };
  if (moment >= REFORM || isGregorian)
    return { ...clock, year: date.getUTCFullYear(), month: date.getUTCMonth(), day: date.getUTCDate() };
  const days = Math.floor(moment / DAY) + MARCH_0;
  const y = Math.floor((4 * days + 3) / 1461);
  const rest = days - Math.floor(1461 * y / 4);
  const m = Math.floor((5 * rest + 2) / 153);
  return { ...clock, year: m < 10 ? y : y + 1, month: (m + 2) % 12, day: rest - Math.floor((153 * m + 2) / 5) + 1 };
}

/** The date that "<unit>s since <date>" gives a number; null where there is none. */
export function dateOf(value, unit) {
  const [, text, calendar = 'standard'] = /^(.*?)\s*(?:\(([^()]*)\)\s*)?$/s.exec(unit);
  const found = SINCE.exec(text);
  if (!found || !CALENDARS.includes(calendar.toLowerCase())) return null; // "days since 1950-01-01 (noleap)"
  const [, name, year, month, day, hour = 0, minute = 0, second = 0, sign, zone = 0, minutes = 0] = found;
  const isGregorian = calendar.toLowerCase() === 'proleptic_gregorian' || +year === 0; // 0: there is none, but of means
  const start = momentOf(+year, +month, +day, isGregorian) +
    1000 * (3600 * hour + 60 * minute + +second - (sign === '-' ? -1 : 1) * (3600 * zone + 60 * minutes));
  const lower = name.toLowerCase() in SECONDS ? name.toLowerCase() : name.toLowerCase().replace(/s$/, '');
  if (lower === 'month' || lower === 'year') {
    const from = fieldsOf(start, isGregorian);
    const months = value * (lower === 'year' ? 12 : 1);
    const whole = Math.floor(months);
    const next = (count) => {
      const at = from.month + count;
      return momentOf(from.year + Math.floor(at / 12), (at % 12 + 12) % 12 + 1, from.day, isGregorian) + from.hour * 3600e3 +
        from.minute * 60e3;
    };
    return fieldsOf(next(whole) + (months - whole) * (next(whole + 1) - next(whole)), isGregorian);
  }
  const moment = start + value * (SECONDS[lower] ?? NaN) * 1000;
  return Number.isFinite(moment) && Math.abs(moment) <= 8.64e15 ? fieldsOf(moment, isGregorian) : null;
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
    this.days = from && to ? (to.moment - from.moment) / DAY : 0;
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
    if (date) {
      const { year } = date; // 0 and 1 stand for a year of means, which is no year
      const text = `${date.day} ${MONTHS[date.month].slice(0, 3)}${year > 1 ? ` ${year}` : ''}`;
      const clock = `${String(date.hour).padStart(2, '0')}:${String(date.minute).padStart(2, '0')}`;
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
