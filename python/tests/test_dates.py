# SPDX-License-Identifier: BSD-3-Clause
"""Dates and durations as numbers of an axis: cftime's, which netCDF4 goes by, whatever way units are written."""

import copy
import datetime

import numpy as np
import pytest
import tegl
from conftest import assert_same, noise
from tegl import _arguments

number = _arguments.number_on_axis


@pytest.mark.parametrize("unit", [
    "days since 2000-01-01", "days since 2000-1-1", "Days since 2000-1-1 0:0:0.0", "day since 2000-01-01 00:00:00 UTC",
    "days since 2000-01-01T00:00:00Z", "d since 2000-01-01 00", "days  since  2000-01-01 00:00",
    "days since 2000-01-01 02:00:00 +02:00", "days since 1999-12-31 19:00 -5", "days since 2000-01-01 05:30 +0530",
    "days since 2000-01-01 00:00:00 GMT", "days since 2000-01-01 00:00:00.000000 (standard)",
    "days since 2000-01-01 (proleptic_gregorian)"])
def test_units_are_read_however_they_are_written(unit):
    assert number("2000-01-03T12:00", unit) == 2.5
    hours = unit.lower().replace("days", "hours").replace("day ", "hour ").replace("d since", "h since")
    assert number("2000-01-03T12:00", hours) == 60
    assert number(datetime.datetime(2000, 1, 3, 12), hours.replace("hours ", "minutes ").replace("hour ", "min ").replace(
        "h since", "mins since")) == 3600
    assert number("1999-12-31", unit) == -1


@pytest.mark.parametrize("calendar", ["standard", "proleptic_gregorian"])
def test_dates_are_cftimes(calendar):
    cftime = pytest.importorskip("cftime")
    random = np.random.default_rng(7)
    for start in ("0001-01-01", "1-1-1", "1500-2-29" if calendar == "standard" else "1500-2-28", "1582-10-4 06:00:00",
                  "1582-10-15", "1800-1-1", "1970-01-01 00:00:00"):
        for length in ("days", "hours", "seconds"):
            unit = f"{length} since {start}"
            for _ in range(20):
                day = np.datetime64("0001-03-01") + int(random.integers(0, 800000))
                if np.datetime64("1582-10-05") <= day < np.datetime64("1582-10-15"):
                    continue
                date = day + np.timedelta64(int(random.integers(0, 86400)), "s")
                expected = cftime.date2num(cftime.datetime(*map(int, str(day).split("-")), *map(
                    int, str(date).split("T")[1].split(":")), calendar=calendar), unit, calendar)
                assert number(date, f"{unit} ({calendar})") == pytest.approx(expected, abs=1e-9, rel=1e-12), (date, unit)
                if calendar == "standard":
                    assert number(date, unit) == number(date, f"{unit} (standard)")


def test_julian_days_are_those_of_astronomers():
    # The days since noon of 4713-01-01 before Christ; those of the first day of 2000 are known.
    assert number("2000-01-01T12:00", "days since -4713-01-01 12:00:00") == 2451545
    assert number("2000-01-01T12:00", "days since -4713-11-24 12:00:00 (proleptic_gregorian)") == 2451545


@pytest.mark.parametrize("at, unit, text", [
    ("2000-01-03", "days since then", "the unit 'days since then' counts from 'then', which is not a known form of dates; "
     "expected such as 2000-1-1 12:00:00 UTC"),
    ("2000-01-03", "days since 2000-13-1", "the start of the unit 'days since 2000-13-1' is not a day"),
    ("2000-01-03", "days since 2001-2-29", "is not a day of the calendar; expected an existing day"),
    ("2000-01-03", "days since 2000-1-1 24:00", "expected a time of day from 0:00:00 to 23:59:59"),
    ("2000-01-03", "days since 2000-1-1 CET", "counts from '2000-1-1 CET', which is not a known form of dates"),
    ("2000-01-03", "months since 2000-1-1", "whose 'months' have no fixed length; expected a number"),
    ("2000-01-03", "days since 2000-01-01 (360_day)", "in another calendar; expected a number"),
    ("2000-01-03", "days since 0000-01-01", "counts from the year 0, which the standard calendar lacks"),
    ("1582-10-10", "days since 1-1-1", "a day that the standard calendar skips"),
    ("2000-01-03", "h", "is a date, and the axis has the unit 'h'; expected a number"),
    ("in May", "days since 2000-1-1", "the coordinate 'in May' is neither a number nor a date; expected one of them"),
    (np.datetime64("NaT"), "days since 2000-1-1", "is not a date (NaT)"),
    (np.timedelta64(3, "h"), "mm", "is a duration, and the axis has the unit 'mm'; expected a number"),
    (np.timedelta64(3, "h"), "days since 2000-1-1", "is a duration, and the axis has the unit 'days since 2000-1-1'; "
     "expected a number, or a date"),
    (np.timedelta64("NaT"), "h", "is not a duration (NaT)")])
def test_what_is_no_place_is_said(at, unit, text):
    with pytest.raises(ValueError) as raised:
        number(at, unit)
    assert text in str(raised.value)


def test_durations_are_numbers_of_an_axis_that_counts_them():
    assert number(np.timedelta64(90, "m"), "hours") == 1.5 and number(datetime.timedelta(days=2), "h") == 48
    assert number(datetime.timedelta(milliseconds=1500), "s") == 1.5
    pandas = pytest.importorskip("pandas")
    xarray = pytest.importorskip("xarray")
    assert number(pandas.Timedelta(hours=36), "days") == 1.5
    data = xarray.DataArray(noise((6, 9, 9), 4), dims=("lead", "y", "x"),
                            coords={"lead": np.arange(6) * np.timedelta64(12, "h").astype("m8[ns]")})
    contour = tegl.contour(data, 0.0, time_axis=0)
    assert contour.axis_units[0] == "days"
    for at in (np.timedelta64(30, "h"), pandas.Timedelta(hours=30), datetime.timedelta(hours=30)):
        assert_same(contour.slice(lead=at), contour.slice(1.25))
    assert_same(contour.slice(data.lead[2]), contour.slice(1.0))


def test_cuts_at_dates_that_start_within_a_second():
    """An axis counts from what its unit says, to the nanosecond."""
    xarray = pytest.importorskip("xarray")
    start = np.datetime64("2000-01-01T00:00:00.500000000")
    data = xarray.DataArray(noise((6, 9, 9), 4), dims=("time", "y", "x"),
                            coords={"time": start + np.arange(6) * np.timedelta64(100, "ms")})
    contour = tegl.contour(data, 0.0, dtype=np.float64)
    assert contour.axis_units[0] == "days since 2000-01-01T00:00:00"
    since = (data.time.values - np.datetime64("2000-01-01")) / np.timedelta64(1, "D")
    for k in range(6):
        assert_same(contour.slice(data.time[k]), contour.slice(since[k]))
    assert_same(contour.slice(data.time[3]), tegl.contour(data.values, 0.0, dtype=np.float64, coords=[
        since, None, None]).slice(since[3]))
    assert len(contour.slice(start + np.timedelta64(250, "ms")).simplices) > 10
    early = data.assign_coords(time=np.datetime64("1960-01-01T00:00:00.250", "ns") + np.arange(6) * np.timedelta64(1, "s"))
    assert tegl.contour(early, 0.0).axis_units[0] == "days since 1960-01-01T00:00:00"
    gone = data.assign_coords(time=np.where(np.arange(6) == 3, np.datetime64("NaT"), data.time.values))
    with pytest.raises(ValueError, match=r"coordinate 3 of 'time' is not a date \(NaT\)"):
        tegl.contour(gone, 0.0)


def test_files_are_cut_by_the_dates_that_their_units_say(tmp_path):
    netcdf = pytest.importorskip("netCDF4")
    for index, (unit, calendar, dated) in enumerate((
            ("days since 0001-1-1 00:00:00", "standard", True), ("hours since 1800-1-1 00:00:0.0", "gregorian", True),
            ("days since 0001-01-01", "proleptic_gregorian", True), ("days since 1900-1-1", "proleptic_gregorian", True),
            ("days since 2000-01-01", "noleap", False))):
        path = tmp_path / f"{index}.nc"
        with netcdf.Dataset(path, "w") as file:
            for name, size in (("time", 6), ("lat", 8), ("lon", 9)):
                file.createDimension(name, size)
            time = file.createVariable("time", "f8", ("time",))
            time.units, time.calendar = unit, calendar
            time[:] = netcdf.date2num([datetime.datetime(2000, 1, day) for day in range(1, 7)], unit, calendar)
            file.createVariable("v", "f4", ("time", "lat", "lon"))[:] = noise((6, 8, 9), 1)
        contour = tegl.read(path).contour(0.0, dtype=np.float64)
        first = float(tegl.read(path).coords[0][0])
        step = float(tegl.read(path).coords[0][1]) - first
        if dated:
            assert_same(contour.slice("2000-01-03T12:00"), contour.slice(first + 2.5 * step))
        else:
            with pytest.raises(ValueError, match="in another calendar"):
                contour.slice("2000-01-03")


def test_calendars_of_an_xarray_that_was_not_decoded_are_kept():
    xarray = pytest.importorskip("xarray")
    data = xarray.DataArray(noise((6, 9, 9), 4), dims=("time", "y", "x"), coords={
        "time": ("time", np.arange(6.0), {"units": "days since 2000-01-01", "calendar": "noleap"})})
    with pytest.raises(ValueError, match="in another calendar"):
        tegl.contour(data, 0.0).slice("2000-01-03")
    data.time.attrs["calendar"] = "standard"
    assert_same(tegl.contour(data, 0.0).slice("2000-01-03"), tegl.contour(data, 0.0).slice(2.0))


# An axis by the name of an argument; masks by what lies where; copies of what users derive.


def test_an_axis_named_level_is_cut_by_its_name():
    names = ("level", "offset", "lon")
    volume = noise((6, 9, 9), 4)
    contour = tegl.contour(volume, 0.0, axis_names=names)
    assert_same(contour.slice(level=2.5), contour.slice(2.5))
    assert_same(tegl.slice(contour, level=2.5), contour.slice(2.5))
    with pytest.raises(ValueError, match="offset without normal; expected both, or at=, with axis='offset'"):
        contour.slice(offset=3.5)
    assert_same(contour.slice(3.5, axis="offset"), contour.slice(3.5, axis=1))
    assert_same(tegl.slice(volume, 0.0, axis_names=names, at=2.5, axis="level"), tegl.slice(volume, 0.0, at=2.5))
    with pytest.raises(ValueError, match="level is 2.5 and the first argument a contour, which has its level"):
        tegl.slice(tegl.contour(volume, 0.0), level=2.5)


def test_masks_are_aligned_by_their_coordinates():
    xarray = pytest.importorskip("xarray")
    data = xarray.DataArray(noise((5, 6, 7), 4), dims=("z", "y", "x"),
                            coords={"z": np.arange(5) * 2.0, "y": np.arange(6), "x": np.arange(7)[::-1]})
    mask = (data.z > 3) | (data.x > 4) | (data.y < 2)
    expected = tegl.contour(data, 0.0, mask=mask.transpose("z", "y", "x"))
    assert_same(tegl.contour(data, 0.0, mask=mask[::-1]), expected)
    assert_same(tegl.contour(data, 0.0, mask=mask.isel(x=[3, 1, 0, 2, 6, 5, 4]).transpose("x", "z", "y")), expected)
    assert_same(tegl.contour(data, 0.0, mask=mask.drop_vars("z")), expected)
    with pytest.raises(ValueError, match="mask has NaN, which is neither True nor False; expected one of these"):
        tegl.contour(data, 0.0, mask=mask.where(mask))
    with pytest.raises(ValueError, match="mask has other coordinates along 'z' than the array, 1.0 to 9.0; expected those"):
        tegl.contour(data, 0.0, mask=mask.assign_coords(z=mask.z + 1))


class Mine(tegl.Contour):
    """Someone's own."""


def test_copies_are_of_the_same_class():
    mine = Mine(np.eye(3), [[0, 1, 2]])
    mine.note = "here"  # type: ignore[attr-defined]
    other = copy.deepcopy(mine)
    assert type(other) is Mine and other.note == "here"
    assert_same(other, mine)
