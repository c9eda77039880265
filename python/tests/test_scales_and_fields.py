# SPDX-License-Identifier: BSD-3-Clause
"""Scale spaces and samples of fields."""

import math

import numpy as np
import pytest
import tegl


def test_layers_of_a_scale_space_are_discrete_gaussians():
    array = np.random.default_rng(1).random((9, 10, 11))
    scales = tegl.scale_space(array, [1.0, 2.0], spacing=(1, 2, 1), axis_names=("z", "y", "x"))
    assert scales.array.shape == (2, 9, 10, 11) and scales.axis_names == ("log2_sigma", "z", "y", "x")
    assert scales.time_axis == 0 and scales.coords[0].tolist() == [0.0, 1.0]
    np.testing.assert_array_equal(scales.array[1], tegl.filter(array, discrete_gaussian=2.0, spacing=(1, 2, 1)))
    last = tegl.scale_space(array.T, [1.0, 2.0], spacing=(1, 2, 1), time_axis=-1)
    assert last.time_axis == 3
    np.testing.assert_array_equal(last.array, scales.array.T)


def test_contours_run_over_the_scale():
    picture = tegl.sample("metaballs", 48, ndim=2, parameters={"width": 0.08, "count": 30})
    sigmas = np.geomspace(0.7, 9, 12)
    scales = tegl.scale_space(picture, sigmas)
    surface = tegl.contour(scales, 0.0)
    assert surface.check().is_manifold and len(surface.track().tracks) > 1
    assert surface.slice(log2_sigma=1.0).ndim == 2
    sizes = [tegl.contour(layer, 0.0, allow_empty=True).measure().size for layer in scales.array]
    sigma, change = tegl.most_stable_scale(sigmas, sizes)
    assert sigma in sigmas and abs(change) < 1
    assert math.isnan(tegl.most_stable_scale([1, 2], [1, 1])[0])


def test_an_affine_map_and_factors():
    array = np.random.default_rng(2).random((5, 6))
    affine = np.array([[0.0, 2.0, 3.0], [1.0, 0.0, 4.0]])
    scales = tegl.scale_space(array, [1, 2, 3], affine=affine, factors=(0, 1), samples=True)
    np.testing.assert_array_equal(scales.affine, [[1, 0, 0, 0], [0, 0, 2, 3], [0, 1, 0, 4]])
    np.testing.assert_array_equal(scales.array[2], tegl.filter(array, discrete_gaussian=(0, 3), samples=True))


def test_a_blob_has_its_scale():
    y, x = np.mgrid[-40:41, -40:41]
    disc = np.clip(8.5 - np.hypot(x, y), 0, 1)
    sigmas = np.geomspace(2, 16, 60)
    middle = tegl.scale_space(disc, sigmas, laplacian=True).array[:, 40, 40]
    assert sigmas[middle.argmax()] == pytest.approx(8 / math.sqrt(2), rel=0.05)


def test_of_four_axes_gives_five():
    scales = tegl.scale_space(np.random.default_rng(3).random((4, 4, 4, 4)), [0.5, 1])
    assert tegl.contour(scales, 0.5).ndim == 5
    with pytest.raises(ValueError, match="5 axes"):
        tegl.scale_space(np.zeros((2, 2, 2, 2, 2)), [0.5, 1])


def test_fields():
    assert tegl.fields()["ball"] == {"radius": 0.8}
    ball = tegl.sample("ball", (10, 20, 30))
    assert ball.shape == (10, 20, 30) and ball.dtype == np.float32
    np.testing.assert_allclose(ball[0, 0, 0], 0.8 - math.sqrt(3), rtol=1e-6)
    assert tegl.sample("merging", 6, ndim=4).shape == (6, 6, 6, 6)
    lattice = tegl.sample("torus", (57, 30, 30), lattice="bcc")
    contour = tegl.contour(lattice, 0.0, lattice="bcc", spacing=(1 / 29, 2 / 29, 2 / 29), origin=-1)
    assert contour.check().euler == 0
    # one number: as many layers as the limits need; and the regular step
    assert tegl.sample("ball", 8, lattice="triangular").shape == (9, 8)
    for lattice, ndim in (("fcc", 3), ("bcc", 3), ("d4", 4), ("triangular", 2), ("fcc_in_time", 4)):
        ball = tegl.sample("ball", 10, lattice=lattice)
        assert ball.ndim == ndim
        contour = tegl.contour(ball, 0.0, lattice=lattice)
        assert contour.check().boundary_simplices == 0
        low, high = contour.vertices.min(0), contour.vertices.max(0)
        np.testing.assert_allclose(high - low, 0.8 * 9, atol=0.5)


def test_masks_and_labels():
    labels = np.zeros((12, 13, 14), np.int16)
    labels[3:9, 3:9, 3:9] = 7
    labels[3:9, 3:9, 9:12] = 9
    seven = tegl.contour(labels, label=7, positions="relaxed")
    same = tegl.contour((labels == 7).astype(np.uint8), 0.5, positions="relaxed")
    np.testing.assert_array_equal(seven.vertices, same.vertices)
    np.testing.assert_array_equal(tegl.contour(labels == 7, positions="relaxed").vertices, same.vertices)
    np.testing.assert_array_equal(tegl.contour(60 * (labels == 7), positions="relaxed").vertices, same.vertices)
    assert tegl.contour(labels, label=9).measure().content == pytest.approx(
        tegl.contour((labels == 9).astype(float), 0.5).measure().content)
    missing = labels.astype(float)
    missing[3, 5, 5] = np.nan
    assert not tegl.contour(missing, label=7).check().is_closed  # a missing sample is neither inside nor outside
    masked = np.ma.masked_array(labels.astype(float), mask=labels == 9)
    masked[0, 0, 0] = np.nan
    assert not tegl.contour(masked, label=7).check().is_closed  # nor is a masked one
    for wrong, message in ((dict(label=8), "label is 8"), (dict(level=1, label=7), "expected one of the two"),
                           (dict(positions="relaxed"), "not exactly two values")):
        with pytest.raises(ValueError, match=message):
            tegl.contour(labels, **wrong)
    with pytest.raises(TypeError, match="level is missing"):
        tegl.contour(labels)


def test_expressions():
    try:
        found = tegl.sample("0.8 - r", 20)
    except ValueError as error:
        pytest.skip(str(error))
    np.testing.assert_array_equal(found, tegl.sample("ball", 20))


@pytest.mark.parametrize("arguments, message", [
    (("cube",), "no field 'cube'; expected ball"),
    (("ball", 1), "shape"),
    (("ball", (2, 2, 2, 2, 2, 2)), "6 axes; expected 2 to 5"),
])
def test_errors_of_samples(arguments, message):
    with pytest.raises(ValueError, match=message):
        tegl.sample(*arguments)


@pytest.mark.parametrize("arguments, options, message", [
    (("x + y",), {"parameters": {"a": 1}}, "parameters with an expression"),
    (("x + y",), {"seed": 3}, "seed 3 with an expression"),
    (("gyroid",), {"seed": 3}, "'gyroid' with the seed 3; expected 0"),
    (("ball", (3, 4)), {"ndim": 3}, "ndim is 3, but shape has 2 axes"),
])
def test_options_of_samples_that_would_be_ignored(arguments, options, message):
    with pytest.raises(ValueError, match=message):
        tegl.sample(*arguments, **options)


def test_errors_of_scales():
    with pytest.raises(ValueError, match="expected ascending scales"):
        tegl.scale_space(np.zeros((4, 4)), [2, 1])
    with pytest.raises(ValueError, match="3 factors of the scale; expected one for each of 2 axes"):
        tegl.scale_space(np.zeros((4, 4)), [1, 2], factors=(1, 1, 1))
