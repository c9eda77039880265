# SPDX-License-Identifier: BSD-3-Clause
"""Longitudes of regions, of turned and tripolar grids, in moving frames, and times that are longitudes."""

import numpy as np
import pytest
import tegl

from test_curved import GLOBE, globe


def turned(values, lat, lon):
    """An xarray whose first dimension runs along the longitudes."""
    xarray = pytest.importorskip("xarray")
    dims = ["ni", "nj"]
    return xarray.DataArray(values.T, dims=dims, coords={"TLAT": (dims, lat.T, {"units": "degrees_north"}),
                                                         "TLONG": (dims, lon.T, {"units": "degrees_east"})})


@pytest.mark.parametrize("columns", [20, 29])
def test_names_of_longitudes_stand_for_the_axis_along_which_they_grow(columns):
    region = turned(*(one[:, :columns] for one in globe(60)))
    for periodic in ("lon", "TLONG"):
        with pytest.raises(ValueError, match=f"longitudes.*span {6 * (columns - 1)}"):
            tegl.contour(region, 12.3, periodic=periodic)


def test_other_values_in_repeated_columns_of_a_turned_grid_are_errors():
    values, lat, lon = globe(62)
    expected = tegl.contour(turned(values, lat, lon), 12.3, periodic="TLONG")
    assert len(expected.periods) == 1
    values[7, 61] += 0.5
    for periodic in ("lon", "TLONG"):
        with pytest.raises(ValueError, match=r"at the longitudes of the first, 360 degrees further, but with other values"):
            tegl.contour(turned(values, lat, lon), 12.3, periodic=periodic)


def test_given_periods_of_turned_grids_are_along_longitudes():
    expected = tegl.contour(turned(*globe(60)), 12.3, periodic="TLONG")
    for columns in (60, 61):
        found = tegl.contour(turned(*globe(columns)), 12.3, periodic={"TLONG": 360})
        assert np.array_equal(found.periods, expected.periods)
        assert np.array_equal(found.vertices, expected.vertices)


def test_fine_axes_with_a_sample_less_do_not_span_the_globe():
    lat = np.linspace(-80, 80, 9)
    for columns in (1439, 1440):
        lon = 0.25 * np.arange(columns)
        values = np.cos(np.radians(lon)) * np.cos(np.radians(lat))[:, None]
        found = tegl.contour(values, 0.5, periodic="auto", coords=[lat, lon], **GLOBE)
        assert len(found.periods) == (columns == 1440)


def test_slanted_regions_are_not_periodic():
    j, i = np.meshgrid(np.arange(12.0), np.arange(12.0), indexing="ij")
    lon, lat = -60 + 10 * i - 11 * j, 5 * j + 4 * i
    for periodic, span in (("lon", 110), (1, 110), (0, 121), ("all", "1[12][01]")):
        with pytest.raises(ValueError, match=f"longitudes.*span {span}"):
            tegl.contour(lat - 0.01 * lon, 45.0, curved={0: lat, 1: lon}, periodic=periodic, **GLOBE)
    lon = -60 + 20 * i - 11 * j  # more than half of the globe along one axis
    with pytest.raises(ValueError, match="longitudes.*span 121"):
        tegl.contour(lat - 0.01 * lon, 45.0, curved={0: lat, 1: lon}, periodic=0, **GLOBE)


def test_longitudes_of_a_moving_frame_have_their_period():
    values = (np.cos(np.radians(10.0 * np.arange(36))) + 0.1 * np.arange(5)[:, None] + 0.05 * np.arange(4)[:, None, None])
    units = {"axis_names": ["t", "lat", "lon"], "axis_units": ["s", "degrees_north", "degrees_east"]}
    affine = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [3.0, 0, 10, 0]])
    for shear in (3.0, 1e-17, 0.0):
        affine[2, 0] = shear
        for periodic in ("lon", "auto"):
            assert np.array_equal(tegl.contour(values, 0.5, periodic=periodic, affine=affine, **units).periods, [[0, 0, 360]])


def test_values_of_a_formula_may_have_other_rounding_a_turn_further():
    lon, lat = np.arange(361.0), np.linspace(-80, 80, 17)
    values = np.cos(np.radians(lon)) * np.cos(np.radians(lat))[:, None]
    values[3, 360] = np.nextafter(values[3, 0], 2)
    assert len(tegl.contour(values, 0.5, periodic="lon", coords=[lat, lon], **GLOBE).periods) == 1


def test_times_that_are_longitudes_keep_their_order_and_their_numbers():
    z, y, lon = np.ogrid[0:5, 0:6, 0:36]
    values = np.cos(lon * np.pi / 18) - 0.1 * z + 0.05 * y
    found = tegl.contour(values, 0.3, axis_names=["z", "lat", "lon"], axis_units=["m", "degrees_north", "degrees_east"],
                         coords=[np.arange(5), np.arange(6), np.arange(36) * 10.0], time_axis=-1)
    assert len(found.track(times=[340, 365], allow_empty=True).segments) == 2
    with pytest.raises(ValueError, match="365"):
        found.track(times=[340, 365])
    here, away = (found.track(times=[75 + turn, 80 + turn]).segments for turn in (0, 360))
    assert {sample.time for one in away for sample in one.samples} == {435, 440}
    assert ([sample.measure for one in away for sample in one.samples]
            == [sample.measure for one in here for sample in one.samples])


def test_periods_whose_squares_are_no_numbers_are_errors():
    values = np.random.default_rng(2).random((8, 8, 8))
    with pytest.raises(ValueError, match="the period of axis . .*; expected a length from 1e-150 to 1e150"):
        tegl.contour(values, 0.5, periodic="all", dtype=float, affine=np.hstack([np.eye(3) * 1e160, np.zeros((3, 1))]))
