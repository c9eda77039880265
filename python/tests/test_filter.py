# SPDX-License-Identifier: BSD-3-Clause
"""Filters: the axes of the array, units, images, errors."""

import os
import pathlib

import numpy as np
import pytest
import tegl

OCEAN = pathlib.Path(os.environ["TEGL_SOURCE_DIR"]) / "examples/data/ocean_temperature.nc"
ARRAY = np.random.default_rng(1).random((6, 7, 8)).astype(np.float32)


def test_a_kernel_is_its_direct_sum():
    kernel = np.arange(15.0).reshape(5, 1, 3)
    found = tegl.filter(ARRAY, kernel=kernel)
    padded = np.pad(ARRAY, ((2, 2), (0, 0), (1, 1)), mode="edge")
    wanted = sum(kernel[a, 0, b] * padded[a:a + 6, :, b:b + 8] for a in range(5) for b in range(3))
    assert found.dtype == np.float32 and found.shape == ARRAY.shape
    np.testing.assert_allclose(found, wanted, rtol=1e-5)


@pytest.mark.parametrize("turn", [lambda a: a, np.asfortranarray, lambda a: a[:, ::-1]])
def test_sigmas_are_in_the_order_of_the_axes(turn):
    array = turn(ARRAY).astype(np.float64)
    along = tegl.filter(array, gaussian=(0, 0, 1.0))
    alone = np.stack([[tegl.filter(np.stack([row, row]), gaussian=(0, 1.0))[0] for row in plane] for plane in array])
    np.testing.assert_allclose(along, alone, atol=1e-14)
    np.testing.assert_array_equal(along, tegl.filter(array, gaussian=(0, 0, 3.0), spacing=(1, 1, 3)))
    np.testing.assert_array_equal(along, tegl.filter(array, gaussian=(0, 0, 1.0), spacing=(1, 1, 3), samples=True))
    np.testing.assert_array_equal(along, tegl.filter(array, gaussian=(0, 0, 1.0), time_axis=-1))


def test_missing_samples_stay_or_are_filled():
    array = ARRAY.copy()
    array[2, 3, 4] = np.nan
    assert np.isnan(tegl.filter(array, median=1)).sum() == 1
    assert not np.isnan(tegl.filter(array, median=1, fill=True)).any()


def test_a_step_survives_a_bilateral_filter():
    step = np.where(np.arange(20) < 10, 0.0, 9.0) * np.ones((5, 1))
    np.testing.assert_array_equal(tegl.filter(step, bilateral=2, value_sigma=0.5), step)


def test_a_contextual_filter_keeps_sides():
    mask = (ARRAY > 0.5).astype(np.uint8)
    np.testing.assert_array_equal(tegl.filter(mask, contextual=0.5) >= 0.5, mask == 1)


def test_balls_shrink_by_curvature_flow():
    z, y, x = np.ogrid[-10:10:41j, -12:12:49j, -11:11:45j]
    distance = 8 - np.sqrt(x**2 + y**2 + z**2)
    flow = tegl.filter(distance, curvature=6, spacing=0.5)
    content = tegl.contour(flow, 0, spacing=0.5).measure().content
    assert content == pytest.approx(4 / 3 * np.pi * (64 - 24)**1.5, rel=0.02)
    assert np.array_equal(tegl.filter(distance, curvature=1.5, samples=True), tegl.filter(distance, curvature=1.5))
    with pytest.raises(ValueError, match="the time of the flow is -1"):
        tegl.filter(distance, curvature=-1)


def test_borders_by_axis():
    array = np.arange(12.0).reshape(3, 4)
    found = tegl.filter(array, kernel=[[0, 0, 0], [0, 0, 1], [0, 0, 0]], border=("extended", "cyclic"))
    np.testing.assert_array_equal(found, np.roll(array, -1, axis=1))


def test_an_image_keeps_its_coordinates():
    image = tegl.read(OCEAN)
    found = tegl.filter(image, discrete_gaussian=(0.5, 0, 1, 1), samples=True,
                        border=("cyclic", "extended", "extended", "cyclic"))
    assert isinstance(found, tegl.Image) and found.axis_names == image.axis_names
    np.testing.assert_array_equal(np.isnan(found.array), np.isnan(image.array))
    assert len(found.contour(20.0).simplices) > 0


@pytest.mark.parametrize("arguments, message", [
    ({}, "no filter; expected one of gaussian"),
    ({"gaussian": 1, "median": 1}, "gaussian and median; expected one of"),
    ({"gaussian": (1, 2)}, "gaussian has 2 numbers; expected one, or one for each of 3 axes"),
    ({"gaussian": -1}, "sigma is -1 samples; expected a number from 0"),
    ({"bilateral": 1}, "bilateral without value_sigma"),
    ({"median": 1, "value_sigma": 2}, "value_sigma with median"),
    ({"median": 1, "samples": True}, "samples with median"),
    ({"kernel": [1, 2, 1]}, "kernel has 1 axes; expected 3"),
    ({"kernel": np.ones((2, 1, 1))}, "2 weights along axis 0; expected an odd number"),
    ({"median": 1, "border": "round"}, "border is 'round'; expected one of 'extended'"),
    ({"median": 1, "border": ("cyclic", "cyclic")}, "2 borders; expected one for each of 3 axes"),
])
def test_errors_name_the_argument(arguments, message):
    with pytest.raises(ValueError, match=message.replace("(", r"\(")):
        tegl.filter(ARRAY, **arguments)


def test_can_be_cancelled():
    with pytest.raises(tegl.Cancelled):
        tegl.filter(np.zeros((60, 60, 60), np.float32), median=2, progress=lambda fraction: False)
