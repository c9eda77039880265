# SPDX-License-Identifier: BSD-3-Clause
"""Dates and durations as numbers on an axis, by the unit that it has: "hours since 1900-1-1 00:00:0.0 UTC".

Units are spelled as in UDUNITS, like in netCDF and xarray; calendars are as in the CF conventions (section 4.4.1).
Supported calendars: the standard one, which is Julian before 1582-10-15 and Gregorian from then on, and the proleptic
Gregorian one of NumPy and Python.
"""

from __future__ import annotations

import datetime
import re
import typing

import numpy as np

_SECOND = 10**9  # nanoseconds, in which all is counted exactly
_UNITS = {name: length for names, length in (
    ("d day days", 86400 * _SECOND), ("h hr hrs hour hours", 3600 * _SECOND),
    ("min mins minute minutes", 60 * _SECOND), ("s sec secs second seconds", _SECOND),
    ("ms msec msecs millisecond milliseconds", _SECOND // 1000),
    ("us microsec microsecs microsecond microseconds", _SECOND // 10**6), ("week weeks", 7 * 86400 * _SECOND),
) for name in names.split()}
_SINCE = re.compile(r"^\s*(?P<unit>[A-Za-z]+)\s+since\s+(?P<start>[^()]*?)\s*(?:\((?P<calendar>[^()]*)\))?\s*$",
                    re.IGNORECASE)
_START = re.compile(r"^(?P<year>[+-]?\d{1,6})-(?P<month>\d{1,2})-(?P<day>\d{1,2})"
                    r"(?:[T\s]\s*(?P<hour>\d{1,2})(?::(?P<minute>\d{1,2})(?::(?P<second>\d{1,2})(?:\.(?P<part>\d*))?)?)?)?"
                    r"\s*(?P<zone>Z|UTC|GMT|[+-]\d{1,2}(?::?\d{2})?)?$", re.IGNORECASE)
_COMMON = ("standard", "gregorian")
_PROLEPTIC = "proleptic_gregorian"
_REFORM = (1582, 10, 15)  # the first day of the Gregorian calendar; the one before was 1582-10-04


def unit_with_calendar(unit: str, calendar: str) -> str:
    """A unit with its calendar, if that makes a difference, in the form of tegl's readers."""
    calendar = calendar.lower()
    found = _SINCE.match(unit)
    if not calendar or calendar in _COMMON or found is None or found["calendar"] is not None:
        return unit
    start = _START.match(found["start"])
    is_late = start is not None and (int(start["year"]), int(start["month"]), int(start["day"])) >= _REFORM
    return unit if calendar == _PROLEPTIC and is_late else f"{unit} ({calendar})"


def dates_as_numbers(times: np.ndarray, axis: str) -> tuple[np.ndarray, str]:
    """Days since the second of the first of these dates, and the unit with that start."""
    if np.isnat(times).any():
        raise ValueError(f"coordinate {int(np.argmax(np.isnat(times)))} of '{axis}' is not a date (NaT); expected dates")
    times = times.astype("datetime64[ns]")
    start = times.min().astype("datetime64[s]")
    return (times - start) / np.timedelta64(1, "D"), f"days since {start}"


def _day_number(year: int, month: int, day: int, is_julian: bool) -> int:
    """Days from a fixed day to one of the Julian or the proleptic Gregorian calendar. E. G. Richards, Mapping Time, 1998,
    chapter 25."""
    before = (14 - month) // 12
    y, m = year + 4800 - before, month + 12 * before - 3
    days = day + (153 * m + 2) // 5 + 365 * y + y // 4
    return days - 32083 if is_julian else days - y // 100 + y // 400 - 32045


def _nanoseconds(what: str, date: tuple[int, int, int], rest: int, is_mixed: bool) -> int:
    """Of a date and the nanoseconds of the day, from a fixed moment. `what`: its name in errors."""
    is_julian = is_mixed and date < _REFORM
    if is_mixed and (1582, 10, 4) < date < _REFORM:
        raise ValueError(f"{what} is a day that the standard calendar skips; expected no day from 1582-10-05 to 14")
    number = _day_number(*date, is_julian)
    after = _day_number(date[0] + date[1] // 12, date[1] % 12 + 1, 1, is_julian) if 1 <= date[1] <= 12 else 0
    if not (1 <= date[1] <= 12 and date[2] >= 1 and number < after):
        raise ValueError(f"{what} is not a day of the calendar; expected an existing day")
    return number * 86400 * _SECOND + rest


def _start(unit: str, text: str, is_mixed: bool) -> int:
    """The moment from which a unit counts."""
    found = _START.match(text)
    if found is None:
        raise ValueError(f"the unit '{unit}' counts from '{text}', which is not a known form of dates; expected such as "
                         "2000-1-1 12:00:00 UTC, or a number for the coordinate")
    hour, minute, second = (int(found[part] or 0) for part in ("hour", "minute", "second"))
    if hour > 23 or minute > 59 or second > 59:
        raise ValueError(f"the unit '{unit}' counts from '{text}'; expected a time of day from 0:00:00 to 23:59:59")
    rest = (hour * 3600 + minute * 60 + second) * _SECOND + int((found["part"] or "").ljust(9, "0")[:9])
    zone = (found["zone"] or "Z").upper()
    if zone[0] in "+-":
        digits = zone[1:].replace(":", "")
        hours, minutes = (int(digits), 0) if len(digits) <= 2 else (int(digits[:-2]), int(digits[-2:]))
        rest -= (1 if zone[0] == "+" else -1) * (hours * 3600 + minutes * 60) * _SECOND
    year = int(found["year"])
    if is_mixed and year == 0:
        raise ValueError(f"the unit '{unit}' counts from the year 0, which the standard calendar lacks; expected another "
                         "year, or a number for the coordinate")
    # In that calendar the year -1 comes before the year 1; calculations use 0 for it.
    date = (year + 1 if is_mixed and year < 0 else year, int(found["month"]), int(found["day"]))
    return _nanoseconds(f"the start of the unit '{unit}'", date, rest, is_mixed)


def as_date(at: object) -> np.datetime64 | None:
    """A date in any of its forms: NumPy's, xarray's, pandas', Python's, or text. None for other objects."""
    is_date = isinstance(at, (str, datetime.date)) or (
        getattr(getattr(at, "dtype", None), "kind", "") == "M" and np.ndim(typing.cast(float, at)) == 0)
    if not is_date:
        return None
    if isinstance(at, datetime.datetime) and at != at:  # pandas' NaT
        date = np.datetime64("NaT")
    elif isinstance(at, (str, datetime.date)):
        if isinstance(at, datetime.datetime) and at.tzinfo is not None:  # pandas' timestamps are datetimes
            at = at.astimezone(datetime.timezone.utc).replace(tzinfo=None)
        try:
            date = np.datetime64(typing.cast(str, at))
        except ValueError:
            raise ValueError(f"the coordinate {at!r} is neither a number nor a date; expected one of them") from None
    else:
        date = typing.cast(np.datetime64, np.asarray(at)[()])
    if np.isnat(date):
        raise ValueError("the coordinate is not a date (NaT); expected a date")
    return date


def date_on_axis(at: object, date: np.datetime64, unit: str) -> float:
    """A date as a number of an axis with this unit. `at`: its name in errors."""
    found = _SINCE.match(unit)
    if found is None:
        raise ValueError(f"the coordinate {at!r} is a date, and the axis has the unit '{unit}'; expected a number")
    length = _UNITS.get(found["unit"].lower())
    if length is None:
        raise ValueError(f"the coordinate {at!r} is a date, and the axis has '{unit}', whose '{found['unit']}' have no fixed "
                         "length; expected a number, or days, hours, minutes or seconds since a date")
    calendar = (found["calendar"] or "standard").lower()
    if calendar not in (*_COMMON, _PROLEPTIC):
        raise ValueError(f"the coordinate {at!r} is a date, and the axis has '{unit}', in another calendar; expected a "
                         "number")
    is_mixed = calendar != _PROLEPTIC
    day = date.astype("datetime64[D]")
    year = int(day.astype("datetime64[Y]").astype(int)) + 1970
    month = int(day.astype("datetime64[M]").astype(int)) % 12 + 1
    rest = int((date - day).astype("timedelta64[ns]").astype(int))
    number = int((day - day.astype("datetime64[M]")).astype(int)) + 1
    moment = _nanoseconds(f"the coordinate {at!r}", (year, month, number), rest, is_mixed)
    return (moment - _start(unit, found["start"], is_mixed)) / length


def duration_of(at: object) -> int | None:
    """The nanoseconds of a duration: NumPy's, xarray's, pandas' or Python's. None for other objects."""
    is_numpy = getattr(getattr(at, "dtype", None), "kind", "") == "m" and np.ndim(typing.cast(float, at)) == 0
    if not is_numpy and not isinstance(at, datetime.timedelta):
        return None
    length: typing.Any = np.asarray(at)[()] if is_numpy else np.timedelta64(typing.cast(datetime.timedelta, at))
    if np.isnat(length):
        raise ValueError("the coordinate is not a duration (NaT); expected a duration")
    return int(length.astype("timedelta64[ns]").astype(int))


def duration_on_axis(at: object, duration: int, unit: str) -> float:
    """A duration as a number of an axis that counts them."""
    length = _UNITS.get(unit.strip().lower())
    if length is None:
        raise ValueError(f"the coordinate {at!r} is a duration, and the axis has the unit '{unit}'; expected a number" +
                         (", or a date" if _SINCE.match(unit) else ""))
    return duration / length
