# SPDX-License-Identifier: BSD-3-Clause
"""tegl.marching_cubes does what scikit-image's documentation and tests expect of skimage.measure.marching_cubes, and
what it itself does, where it is installed."""

import inspect
import itertools

import numpy as np
import pytest
import tegl
from conftest import assert_closed_manifold, noise

try:
    import skimage
    from skimage.measure import marching_cubes as of_skimage
except ImportError:
    of_skimage = None

needs_skimage = pytest.mark.skipif(of_skimage is None, reason="scikit-image is not installed")


def area(verts, faces):
    a, b, c = (verts[faces[:, corner]] for corner in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def volume(verts, faces):
    """Positive where triangles turn counterclockwise seen from outside."""
    return np.linalg.det(verts[faces].astype(np.float64)).sum() / 6


def ellipsoid(a, b, c, spacing=(1.0, 1.0, 1.0)):
    """Below 0 inside, with a free sample or more on each side."""
    axes = [np.arange(-np.ceil((half + 2 * step) / step), np.ceil((half + 2 * step) / step) + 1) * step
            for half, step in zip((a, b, c), spacing)]
    z, y, x = np.meshgrid(*axes, indexing="ij", sparse=True)
    return (z / a) ** 2 + (y / b) ** 2 + (x / c) ** 2 - 1.0


def ellipsoid_area(a, b, c, steps=400):
    """By integration over the parameters."""
    theta, phi = np.meshgrid((np.arange(steps) + 0.5) * np.pi / steps, (np.arange(2 * steps) + 0.5) * np.pi / steps,
                             indexing="ij")
    along_theta = np.stack([a * np.cos(theta) * np.cos(phi), b * np.cos(theta) * np.sin(phi), -c * np.sin(theta)], -1)
    along_phi = np.stack([-a * np.sin(theta) * np.sin(phi), b * np.sin(theta) * np.cos(phi), 0 * theta], -1)
    return np.linalg.norm(np.cross(along_theta, along_phi), axis=-1).sum() * (np.pi / steps) ** 2


def test_the_signature_is_scikit_images():
    expected = {"level": None, "spacing": (1.0, 1.0, 1.0), "gradient_direction": "descent", "step_size": 1,
                "allow_degenerate": True, "method": "lewiner", "mask": None}
    parameters = inspect.signature(tegl.marching_cubes).parameters
    assert list(parameters) == ["volume", *expected]
    assert {name: parameters[name].default for name in expected} == expected
    assert [parameters[name].kind for name in parameters] == [inspect.Parameter.POSITIONAL_OR_KEYWORD] * 2 + \
        [inspect.Parameter.KEYWORD_ONLY] * 6
    if of_skimage is not None:
        mine = inspect.signature(tegl.marching_cubes).replace(return_annotation=inspect.Signature.empty)
        assert str(inspect.signature(of_skimage)) == str(mine)


@pytest.mark.parametrize("method", ["lewiner", "lorensen", "_lorensen"])
def test_the_area_of_an_ellipsoid_is_a_little_too_small(method):
    field = ellipsoid(6, 10, 16)
    true = ellipsoid_area(6, 10, 16)
    verts, faces, _, _ = tegl.marching_cubes(field, 0.0, method=method)
    assert 0.99 * true < area(verts, faces) < true


@pytest.mark.parametrize("method", ["lewiner", "lorensen"])
def test_the_area_of_an_ellipsoid_on_an_anisotropic_grid(method):
    spacing = (1.0, 10 / 6, 16 / 6)
    verts, faces, _, _ = tegl.marching_cubes(ellipsoid(6, 10, 16, spacing), 0.0, spacing=spacing, method=method)
    true = ellipsoid_area(6, 10, 16)
    assert 0.985 * true < area(verts, faces) < true
    tegl.marching_cubes(ellipsoid(6, 10, 16, spacing), 0, spacing=spacing, allow_degenerate=False)


@pytest.mark.parametrize("volume, arguments, error, text", [
    (np.zeros((2, 2, 1)), dict(level=0), ValueError, "Input array must be at least 2x2x2."),
    (np.zeros((2, 2, 1)), dict(level=1), ValueError, "Input array must be at least 2x2x2."),
    (np.ones((3, 3, 3)), dict(level=1, spacing=(1, 2)), ValueError, "`spacing` must consist of three floats."),
    (np.zeros((20, 20)), dict(level=0), ValueError, "Input volume should be a 3D numpy array."),
    ([[[0, 1]]], dict(level=0), ValueError, "Input volume should be a 3D numpy array."),
    (ellipsoid(2, 2, 2), dict(level=1e9), ValueError, "Surface level must be within volume data range."),
    (ellipsoid(2, 2, 2), dict(level=-5), ValueError, "Surface level must be within volume data range."),
    (ellipsoid(2, 2, 2), dict(step_size=0), ValueError, "step_size must be at least one."),
    (ellipsoid(2, 2, 2), dict(gradient_direction="up"), ValueError, "Incorrect input up in `gradient_direction`"),
    (ellipsoid(2, 2, 2), dict(method="other"), ValueError, "method should be one of 'lewiner', 'lorensen' or '_lore"),
    (ellipsoid(2, 2, 2), dict(mask=np.array([])), ValueError, "volume and mask must have the same shape."),
    (ellipsoid(2, 2, 2), dict(mask=np.array([]), method="_lorensen"), NotImplementedError, "`mask` is not impl"),
    (np.ones((3, 3, 3)), dict(level=1), RuntimeError, "No surface found at the given iso value."),
    (ellipsoid(2, 2, 2), dict(mask=np.zeros((9, 9, 9), bool)), RuntimeError, "No surface found at the given iso"),
])
def test_what_is_refused_is_refused_in_the_same_words(volume, arguments, error, text):
    with pytest.raises(error) as mine:
        tegl.marching_cubes(volume, **arguments)
    assert text in str(mine.value)
    if of_skimage is not None:
        with pytest.raises(error) as theirs:
            of_skimage(volume, **arguments)
        assert str(mine.value) == str(theirs.value)


def test_the_default_level_is_the_middle():
    field = noise((8, 9, 10), 1)
    middle = 0.5 * (float(field.min()) + float(field.max()))
    for mine, expected in zip(tegl.marching_cubes(field), tegl.marching_cubes(field, middle)):
        assert np.array_equal(mine, expected)


def test_types_and_shapes_of_what_comes_back():
    verts, faces, normals, values = tegl.marching_cubes(ellipsoid(3, 4, 5), 0.0)
    assert verts.dtype == np.float32 and faces.dtype == np.int32
    assert normals.dtype == np.float32 and values.dtype == np.float32
    assert verts.shape == normals.shape == (len(verts), 3) and values.shape == (len(verts),)
    assert faces.shape[1] == 3 and faces.min() == 0 and faces.max() == len(verts) - 1
    for array in (verts, faces, normals, values):
        assert array.flags.writeable
        array += 1
    assert np.allclose(np.linalg.norm(normals - 1, axis=1), 1, atol=1e-5)


@pytest.mark.parametrize("sign", [1, -1])
def test_directions_and_normals(sign):
    """Faces of an object that is higher than what is around it turn clockwise seen from outside with "descent"."""
    field = -sign * ellipsoid(5, 6, 7)
    for direction in ("descent", "ascent"):
        verts, faces, normals, _ = tegl.marching_cubes(field, 0.0, gradient_direction=direction)
        outside = volume(verts - verts.mean(axis=0), faces)
        assert np.sign(outside) == (-sign if direction == "descent" else sign)
        outwards = (normals * (verts - verts.mean(axis=0))).sum(axis=1)
        assert (np.sign(outwards) == sign).all()  # towards low, in any case
        if of_skimage is not None:
            theirs = of_skimage(field, 0.0, gradient_direction=direction)
            assert volume(theirs[0] - theirs[0].mean(axis=0), theirs[1]) == pytest.approx(outside, rel=1e-3)
            assert (np.sign((theirs[2] * (theirs[0] - theirs[0].mean(axis=0))).sum(axis=1)) == sign).all()


def test_masked_cubes_are_left_out():
    field = ellipsoid(6, 10, 16)
    mask = np.ones(field.shape, dtype=bool)
    whole = tegl.marching_cubes(field, 0)
    for mine, expected in zip(tegl.marching_cubes(field, 0, mask=mask), whole):
        assert np.array_equal(mine, expected)
    mask[:10] = False
    mask[:, :, 19:] = False
    verts, faces, _, _ = tegl.marching_cubes(field, 0, mask=mask)
    assert verts[:, 0].min() == 9 and verts[:, 2].max() == 18
    assert 0 < area(verts, faces) < area(*whole[:2])
    one = np.zeros(field.shape, dtype=bool)
    cube = (int(np.argwhere(np.diff(np.sign(field[:, 12, 18])) != 0)[0, 0]) + 1, 12, 18)
    one[cube] = True
    verts = tegl.marching_cubes(field, 0, mask=one)[0]
    assert (verts >= np.subtract(cube, 1)).all() and (verts <= cube).all()
    if of_skimage is not None:
        for which in (mask, one):
            mine, theirs = tegl.marching_cubes(field, 0, mask=which), of_skimage(field, 0, mask=which)
            assert area(*mine[:2]) == pytest.approx(area(*theirs[:2]), rel=1e-3)


@pytest.mark.parametrize("dtype", [np.float32, np.float64, np.uint8, np.int16, np.int32])
@pytest.mark.parametrize("step", [1, 2, 3, 40])
def test_masked_cubes_are_those_of_the_mask_whatever_the_strides(dtype, step):
    """Against every cube by itself: triangles lie in the cubes of the mask that the surface passes, and each of these has
    some. The shape is none that words of 8 cubes divide."""
    field = (noise((9, 12, 37), 5, np.float64) * 40 + 100).astype(dtype)
    mask = np.random.default_rng(6).random(field.shape) < 0.3
    if field.dtype.kind == "f":
        field[3, 4, 5] = np.nan
    found = None
    for volume, chosen in ((field, mask), (np.asfortranarray(field), mask[::-1][::-1]), (field, np.asfortranarray(mask)),
                           (field, mask.astype(float))):
        if step == 40:
            with pytest.raises(RuntimeError):
                tegl.marching_cubes(volume, 100, mask=chosen, step_size=step)
            continue
        result = tegl.marching_cubes(volume, 100, mask=chosen, step_size=step)
        found = found or result
        assert all(np.array_equal(one, other) for one, other in zip(found, result))
    if step == 40:
        return
    coarse, cubes = field[::step, ::step, ::step].astype(float), mask[::step, ::step, ::step][1:, 1:, 1:]
    corners = np.stack([coarse[i:i + cubes.shape[0], j:j + cubes.shape[1], k:k + cubes.shape[2]]
                        for i, j, k in itertools.product((0, 1), repeat=3)])
    active = (corners.min(axis=0) <= 100) & (corners.max(axis=0) > 100) & cubes  # NaN is neither
    middles = found[0][found[1]].mean(axis=1) / step
    inside = np.zeros_like(active)
    at = np.floor(middles).astype(int)
    strictly = (np.abs(middles - np.round(middles)) > 1e-3).all(axis=1)  # others lie in a face of a cube
    inside[tuple(at[strictly].T)] = True
    assert not (inside & ~active).any()
    if field.dtype.kind == "f":
        assert (inside == active).all()


def test_the_values_are_the_largest_ranges_of_the_cubes_around():
    field = noise((6, 7, 9), 4)
    field[2, 3, 4] = np.nan
    verts, _, _, values = tegl.marching_cubes(field, 0.1)
    ranges = np.stack([field[i:5 + i, j:6 + j, k:8 + k] for i, j, k in itertools.product((0, 1), repeat=3)])
    ranges = np.fmax.reduce(ranges, axis=0) - np.fmin.reduce(ranges, axis=0)
    for vert, value in zip(verts, values):
        low = np.clip(np.ceil(vert) - 1, 0, np.array(ranges.shape) - 1).astype(int)
        high = np.clip(np.floor(vert), 0, np.array(ranges.shape) - 1).astype(int) + 1
        assert value == np.nanmax(ranges[tuple(slice(a, b) for a, b in zip(low, high))])


def without_degenerate(verts, faces, normals, values):
    """What allow_degenerate=False leaves, from all: places as a set, and triangles as places of their corners."""
    places, number = np.unique(verts, axis=0, return_inverse=True)
    corners = number.reshape(-1)[faces]
    proper = (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2]) & (corners[:, 2] != corners[:, 0])
    return places[np.unique(corners[proper])], places[corners[proper]]


@pytest.mark.parametrize("arguments", [{}, dict(spacing=(1, 2, 0.3)), dict(step_size=2), dict(gradient_direction="ascent")])
@pytest.mark.parametrize("seed", range(4))
def test_what_is_left_without_degenerate_triangles(seed, arguments):
    field = np.round(noise((11, 12, 13), seed) * 2)
    mask = np.random.default_rng(seed).random(field.shape) < 0.5
    for more in ({}, dict(mask=mask)):
        whole = tegl.marching_cubes(field, 0.0, **arguments, **more)
        clean = tegl.marching_cubes(field, 0.0, allow_degenerate=False, **arguments, **more)
        places, triangles = without_degenerate(*whole)
        assert np.array_equal(np.unique(clean[0], axis=0), places) and len(clean[0]) == len(places) < len(whole[0])
        assert np.array_equal(clean[0][clean[1]], triangles)
        first = {tuple(place): i for i, place in reversed(list(enumerate(whole[0].tolist())))}
        kept = [first[tuple(place)] for place in clean[0].tolist()]
        assert kept == sorted(kept), "vertices stay in their order"
        assert np.array_equal(clean[2], whole[2][kept]) and np.array_equal(clean[3], whole[3][kept])
        assert clean[0].dtype == whole[0].dtype and clean[1].dtype == np.int32


def test_degenerate_triangles_can_be_left_out():
    field = np.round(noise((8, 8, 8), 2) * 2)
    verts, faces, _, _ = tegl.marching_cubes(field, 0.0)
    clean = tegl.marching_cubes(field, 0.0, allow_degenerate=False)
    assert len(np.unique(verts, axis=0)) < len(verts)
    assert len(np.unique(clean[0], axis=0)) == len(clean[0]) == len(clean[2]) == len(clean[3])
    assert len(clean[1]) < len(faces)
    corners = clean[0][clean[1]]
    assert all((corners[:, a] != corners[:, b]).any(axis=1).all() for a, b in itertools.combinations(range(3), 2))
    assert area(*clean[:2]) == pytest.approx(area(verts, faces), rel=1e-5)


def test_steps():
    field = ellipsoid(12, 12, 12)
    fine, coarse = tegl.marching_cubes(field, 0.0), tegl.marching_cubes(field, 0.0, step_size=2)
    assert len(coarse[0]) < len(fine[0]) / 3
    assert area(*coarse[:2]) == pytest.approx(area(*fine[:2]), rel=0.02)
    assert np.allclose(coarse[0].mean(axis=0), fine[0].mean(axis=0), atol=1)


def test_a_volume_of_zeros_and_ones_has_a_surface_at_zero():
    """As label images are often asked for: samples above the level are inside."""
    labels = np.zeros((6, 6, 6), dtype=np.uint8)
    labels[2:4, 2:4, 2:4] = 1
    verts, faces, _, _ = tegl.marching_cubes(labels, 0)
    assert verts.min() == 1 and verts.max() == 4
    assert_closed_manifold(faces)
    with pytest.raises(RuntimeError, match="No surface"):
        tegl.marching_cubes(labels, 1)


@pytest.mark.parametrize("method", ["lewiner", "lorensen"])
def test_surfaces_of_noise_are_closed(method):
    field = np.pad(noise((9, 9, 9), 6), 1, constant_values=-10)
    assert_closed_manifold(tegl.marching_cubes(field, 0.0, method=method)[1])


@needs_skimage
@pytest.mark.parametrize("method", ["lewiner", "lorensen"])
def test_smooth_surfaces_have_the_same_vertices_as_scikit_images(method):
    axes = np.ogrid[0:3:21j, 0:3:22j, 0:3:23j]
    field = np.sin(axes[0] * 2.1) * np.cos(axes[1] * 1.9) + np.sin(axes[1] * 2.2) * np.cos(axes[2]) + axes[0] / 7
    mine, theirs = tegl.marching_cubes(field, 0.31, method=method), of_skimage(field, 0.31, method=method)
    assert len(mine[0]) == len(theirs[0]) and len(mine[1]) == len(theirs[1])
    order = [np.lexsort(np.round(result[0], 3).T) for result in (mine, theirs)]
    assert np.allclose(mine[0][order[0]], theirs[0][order[1]], atol=1e-4)
    assert np.allclose(mine[3][order[0]], theirs[3][order[1]], atol=1e-5)
    inner = ((mine[0][order[0]] > 1) & (mine[0][order[0]] < np.array(field.shape) - 2)).all(axis=1)
    cosines = (mine[2][order[0]] * theirs[2][order[1]]).sum(axis=1)[inner]
    assert np.median(cosines) > 0.99 and cosines.min() > 0.5
    assert area(*mine[:2]) == pytest.approx(area(*theirs[:2]), rel=1e-3)


@needs_skimage
def test_the_values_of_noise_are_scikit_images():
    field = noise((7, 8, 9), 12)
    mine, theirs = tegl.marching_cubes(field, 0.2), of_skimage(field, 0.2)
    places = {tuple(place): value for place, value in zip(np.round(theirs[0], 4).tolist(), theirs[3])}
    shared = [(value, places[tuple(place)]) for place, value in zip(np.round(mine[0], 4).tolist(), mine[3])
              if tuple(place) in places]
    assert len(shared) > 0.9 * len(mine[0])
    assert np.allclose(*np.array(shared).T, atol=1e-5)


@needs_skimage
def test_spacing_and_euler_characteristic_are_scikit_images():
    rings = [np.hypot(np.hypot(*np.ogrid[-6:6:25j, -6:6:25j])[:, :, None] - 4, z) for z in [np.linspace(-3, 3, 13)]]
    mine, theirs = (f(rings[0], 1.3, spacing=(0.5, 0.5, 0.5)) for f in (tegl.marching_cubes, of_skimage))
    for verts, faces, _, _ in (mine, theirs):
        edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)
        assert len(np.unique(faces)) - len(edges) + len(faces) == 0  # a torus
    assert mine[0].dtype == theirs[0].dtype
    assert area(*mine[:2]) == pytest.approx(area(*theirs[:2]), rel=1e-3)


@pytest.mark.parametrize("step, spacing, expected", [(1, (1, 1, 1), np.float32), (2, (1, 1, 1), np.float32),
                                                     (1, (1, 2, 1), np.float64), (2, (1, 2, 1), np.float64)])
def test_vertices_are_of_the_type_that_scikit_images_are(step, spacing, expected):
    volume = noise((12, 13, 14), 3)
    verts = tegl.marching_cubes(volume, 0.1, step_size=step, spacing=spacing)[0]
    assert verts.dtype == expected
    if of_skimage is not None:
        assert of_skimage(volume, 0.1, step_size=step, spacing=spacing)[0].dtype == expected
    coarse = tegl.contour(volume[::step, ::step, ::step], 0.1, ambiguity="saddle", spacing=np.multiply(step, spacing))
    assert np.allclose(np.sort(verts, axis=0), np.sort(coarse.vertices, axis=0), atol=1e-4)
