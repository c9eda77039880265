# SPDX-License-Identifier: BSD-3-Clause
"""What is done with contours: checks, components, measures, elements, simplification, tracking, indexes."""

import copy
import datetime
import inspect
import itertools
import json
import math
import pickle

import numpy as np
import pytest
import tegl
from conftest import assert_same, ball, face_counts, noise


# Checks, components, measures.

def test_check_finds_what_is_wrong():
    contour = tegl.contour(ball(3), 0.0)
    report = contour.check()
    assert report.is_manifold and report.is_closed and report.euler == 2 and report.components == 1
    turned = np.array(contour.simplices)
    turned[0] = turned[0, ::-1]
    broken = tegl.Contour(contour.vertices, turned).check()
    assert broken.orientation_conflicts == 3 and not broken.is_manifold
    away = np.array(contour.vertices)
    away[1, 0], away[2, 1] = np.nan, np.inf
    assert report.nonfinite_vertices == 0
    assert tegl.Contour(away, contour.simplices).check().nonfinite_vertices == 2
    assert not tegl.Contour(contour.vertices, contour.simplices[1:]).check().is_closed


def test_intersections_are_found_with_their_places():
    embedded = tegl.contour(ball(3), 0.0).intersections()
    assert embedded.is_embedded and embedded.count == 0 and embedded.tiles == 0
    assert embedded.pairs.shape == (0, 2) and embedded.places.shape == (0, 3) and embedded.depths.shape == (0,)
    # a triangle in the plane z = 0 (the last column), pierced by another; one far away; a flat one
    vertices = np.array([[0, 0, 0], [9, 0, 0], [0, 9, 0], [2, 2, -1], [2, 2, 1], [-9, 9, 3], [20, 0, 0], [21, 0, 0], [20, 1, 0],
                         [5, 5, 5], [6, 6, 6], [7, 7, 7]], float)
    contour = tegl.Contour(vertices, np.arange(12, dtype=np.uint32).reshape(4, 3))
    found = tegl.intersections(contour, tile=[10, 10, 2], origin=0.5)
    assert (found.simplices, found.count, found.intersecting, found.flat) == (4, 1, 2, 1) and not found.is_embedded
    assert np.array_equal(found.pairs, [[0, 1]]) and found.pairs.dtype == np.uint32
    x, y, z = found.places[0]
    assert abs(z) < 1e-12 and x >= -1e-12 and y >= -1e-12 and x + y <= 9 + 1e-12
    assert found.depths[0] == pytest.approx(1.0)  # the second reaches 1 below the first
    assert found.tiles == 4 and found.tiles_hit == 2
    assert contour.intersections(most_listed=0).count == 1 and len(contour.intersections(most_listed=0).pairs) == 0
    with pytest.raises(ValueError, match="tile has 2 numbers; expected 3"):
        contour.intersections(tile=[1, 1])
    with pytest.raises(ValueError, match="size of tiles along axis 0 is 0"):
        contour.intersections(tile=0)
    with pytest.raises(ValueError, match="2 to 4 dimensions"):
        tegl.contour(noise((3, 3, 3, 3, 3), 1), 0.0).intersections()


@pytest.mark.parametrize("ndim", [2, 3, 4, 5])
def test_measures_are_those_of_a_ball(ndim):
    size = {2: 101, 3: 41, 4: 21, 5: 7}[ndim]
    step = 2 / (size - 1)
    contour = tegl.contour(ball(ndim, size), 0.0, spacing=step, origin=np.linspace(-1, 1, ndim), dtype=np.float64)
    measures = contour.measure()
    volume = math.pi ** (ndim / 2) / math.gamma(ndim / 2 + 1) * 0.7**ndim
    error = 1.5 * step**2 * 4
    assert measures.content == pytest.approx(volume, rel=error)
    assert measures.size == pytest.approx(ndim * volume / 0.7, rel=error)
    assert measures.centroid == pytest.approx(np.linspace(0, 2, ndim), abs=1e-4)
    assert measures.lowest == pytest.approx(np.linspace(0, 2, ndim) - 0.7, abs=error)
    assert measures.highest == pytest.approx(np.linspace(0, 2, ndim) + 0.7, abs=error)
    assert tegl.contour(np.arange(8.0).reshape(2, 2, 2), 3.5).measure().content is None


def test_measures_of_cuts_are_those_of_the_cuts_that_slice_makes(balls):
    times = [0.5, 3.3, 5.0]
    measures = tegl.measure(balls, at=times)
    for name in ("at", "size", "content"):
        assert np.array_equal(getattr(balls.measure(at=times), name), getattr(measures, name))
    assert balls.measure(at=3.3).size[0] == measures.size[1]
    for time, size, content in zip(times, measures.size, measures.content):
        cut = balls.slice(time).measure()
        assert size == pytest.approx(cut.size) and content == pytest.approx(cut.content)
    assert np.array_equal(measures.at, times)


def test_components(moving_balls):
    contour = tegl.contour(moving_balls[0], 0.0, spacing=(1, 1, 2), dtype=np.float64)
    found = contour.components()
    assert len(found) == 2 and [one.label for one in found] == [0, 1]
    assert found.vertex_labels.shape == (len(contour.vertices),) and found.simplex_labels.max() == 1
    for label, (one, part) in enumerate(zip(found, found.split())):
        assert part.check().euler == one.euler == 2 and one.boundary_simplices == 0
        assert len(part.simplices) == one.simplices == (found.simplex_labels == label).sum()
        assert part.measure().content == pytest.approx(one.content)
        assert one.centroid == pytest.approx(part.measure().centroid)
        assert (part.vertices.min(axis=0) == one.lowest).all() and (part.vertices.max(axis=0) == one.highest).all()
    assert abs(found[0].centroid[2] - found[1].centroid[2]) > 30, "the columns are the array's"
    assert_same(found.select([1]), found.split()[1])
    assert_same(found.select([False, True]), found.split()[1])
    assert len(found.largest().components()) == 1
    with pytest.raises(ValueError, match="expected 0 to 1"):
        found.select([2])
    with pytest.raises(ValueError, match="3"):
        found.select([True, True, True])


# Incidence.

def dicts_of(results):
    """Of dataclasses, for comparison: arrays become bytes."""
    return [{name: value.tobytes() if isinstance(value, np.ndarray) else value for name, value in vars(one).items()}
            for one in results]


@pytest.mark.parametrize("time_axis", [0, -1])
@pytest.mark.parametrize("ndim", [2, 3, 4, 5])
def test_results_with_an_incidence_are_those_without(ndim, time_axis):
    contour = tegl.contour(noise((6, 7, 5, 4)[:ndim] if ndim < 5 else (4, 4, 3, 3, 3), 3), 0.2 if ndim < 5 else 1.0,
                           time_axis=time_axis)
    shared = tegl.Incidence(contour, threads=2)
    assert contour.check(incidence=shared) == contour.check() == tegl.check(contour, incidence=shared)
    alone = dicts_of([contour.measure()])
    assert dicts_of([contour.measure(incidence=shared), tegl.measure(contour, incidence=shared)]) == alone * 2
    parts = contour.components()
    for found in (contour.components(incidence=shared), tegl.components(contour, incidence=shared)):
        assert len(found) > 1 and dicts_of(found) == dicts_of(parts)
        assert np.array_equal(found.simplex_labels, parts.simplex_labels)
    graph = contour.track(times=3)
    for found in (contour.track(times=3, incidence=shared), tegl.track(contour, times=3, incidence=shared)):
        assert len(found.events) > 1 and json.dumps(found.to_dict()) == json.dumps(graph.to_dict())  # NaN is "NaN"


@pytest.mark.parametrize("time_axis", [0, -1])
@pytest.mark.parametrize("ndim", [2, 3, 4, 5])
def test_an_incidence_tells_simplices_around_vertices_and_across_faces(ndim, time_axis):
    contour = tegl.contour(noise((6, 6, 5, 3)[:ndim] if ndim < 5 else (3,) * 5, 2), 0.2 if ndim < 5 else 1.0,
                           time_axis=time_axis)
    simplices, shared = contour.simplices, tegl.Incidence(contour)
    assert (shared.vertex_count, shared.simplex_count) == (len(contour.vertices), len(simplices))
    for vertex in range(0, len(contour.vertices), 7):
        assert np.array_equal(shared.around(vertex), np.flatnonzero((simplices == vertex).any(axis=1)))
    faces = {}
    for number, simplex in enumerate(simplices.tolist()):
        for corner in range(ndim):
            faces.setdefault(frozenset(simplex[:corner] + simplex[corner + 1:]), []).append((number, corner))
    expected = np.full(simplices.shape, 2**32 - 1)
    for sides in faces.values():
        if len(sides) == 2:
            expected[sides[0]], expected[sides[1]] = sides[1][0], sides[0][0]
    assert np.array_equal(shared.across, expected) and shared.across.dtype == np.uint32
    assert (expected == 2**32 - 1).any() and (expected < 2**32 - 1).any()


def test_an_incidence_tells_faces_in_several_simplices():
    fan = tegl.Contour(np.eye(5, 3), [[0, 1, 2], [0, 1, 3], [1, 0, 4]])
    shared = tegl.Incidence(fan)
    assert shared.across.tolist() == [[2**32 - 1, 2**32 - 1, 2**32 - 2]] * 3
    assert fan.check(incidence=shared) == fan.check() and fan.check().nonmanifold_simplices == 1


def test_the_arrays_of_an_incidence_outlive_it_and_the_contour():
    across, around = (lambda shared: (shared.across, shared.around(0)))(tegl.Incidence(tegl.contour(ball(3), 0.0)))
    again = tegl.Incidence(tegl.contour(ball(3), 0.0))
    assert np.array_equal(across, again.across) and np.array_equal(around, again.around(0)) and len(around) > 2
    for array in (across, around):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_an_incidence_fits_contours_with_the_same_simplices():
    contour = tegl.contour(ball(3), 0.0)
    shared = tegl.Incidence(contour)
    moved = tegl.Contour(contour.vertices * 2, contour.simplices)
    changed = np.array(contour.simplices)
    changed[5] = np.roll(changed[5], 1)
    others = [tegl.Contour(contour.vertices, changed), tegl.Contour(contour.vertices, contour.simplices[1:]),
              tegl.Contour(np.vstack([contour.vertices, [[0, 0, 0]]]), contour.simplices), tegl.contour(ball(3, 13), 0.0)]
    assert shared.fits(contour) and shared.fits(moved) and shared.fits(pickle.loads(pickle.dumps(contour)))
    assert moved.measure(incidence=shared).content == moved.measure().content
    for other in others:
        assert not shared.fits(other)
        for call in (other.check, other.measure, other.components, other.track):
            with pytest.raises(ValueError, match="an incidence of .*; expected that of this contour"):
                call(incidence=shared)
    flat = tegl.contour(ball(2), 0.0)
    assert not shared.fits(flat)
    for call in (flat.check, flat.measure, flat.components, flat.track):
        with pytest.raises(ValueError, match="an incidence of a 3D contour; expected that of this contour, of 2D"):
            call(incidence=shared)


def test_what_is_no_incidence_is_said():
    contour = tegl.contour(ball(3), 0.0)
    shared = tegl.Incidence(contour)
    for call in (contour.check, contour.measure, contour.components, contour.track, lambda **k: tegl.check(contour, **k)):
        with pytest.raises(TypeError, match="incidence is True; expected a tegl.Incidence of the contour, or None"):
            call(incidence=True)
    with pytest.raises(ValueError, match="incidence with at=; expected one of them"):
        contour.measure(at=5, incidence=shared)
    with pytest.raises(ValueError, match=f"vertex is {len(contour.vertices)}; expected a number below"):
        shared.around(len(contour.vertices))
    with pytest.raises(ValueError, match="vertex is -1; expected 0 or more"):
        shared.around(-1)
    with pytest.raises(TypeError, match="ndarray is not a contour"):
        shared.fits(contour.vertices)
    with pytest.raises(TypeError, match="pickle"):
        pickle.dumps(shared)
    empty = tegl.Incidence(tegl.contour(ball(3), 9.0, allow_empty=True))
    assert empty.across.shape == (0, 3) and empty.vertex_count == 0


# Elements.

@pytest.mark.parametrize("time_axis", [0, -1])
def test_the_normals_of_a_closed_contour_sum_to_zero(moving_balls, time_axis):
    contour = tegl.contour(moving_balls, 0.0, close=True, spacing=(0.5, 1, 2, 3), time_axis=time_axis, dtype=np.float64)
    for by_cell in (False, True):
        elements = contour.elements(by_cell=by_cell)
        total = elements.sum()
        assert np.abs(elements.normals.sum(axis=0)).max() < 1e-9 * total.absolute.max()
        assert total.closure_error < 1e-12
        assert total.measure == pytest.approx(contour.measure().size)
        # Gauss: the flux of the position is N times the content; d sigma points out of what is high.
        flux = (elements.centroids * elements.normals).sum()
        assert flux == pytest.approx(4 * contour.measure().content, rel=1e-2 if by_cell else 1e-9)
    assert len(elements) < len(contour.simplices) and elements.counts.sum() == len(contour.simplices)
    with pytest.raises(ValueError, match="grid is not known"):
        contour.slice(2.0).elements(by_cell=True)


def test_elements_keep_attributes_and_are_written(tmp_path):
    made = tegl.contour(ball(3), 0.0, dtype=np.float64)
    contour = tegl.Contour(made.vertices, made.simplices, vertex_attributes={"height": made.vertices[:, 0]})
    elements = contour.elements()
    assert elements.attributes["height"] == pytest.approx(elements.centroids[:, 0])
    elements.save(tmp_path / "surface.dat")
    table = np.loadtxt(tmp_path / "surface.dat")
    assert table.shape == (len(elements), 7)
    assert np.array_equal(table[:, :3], elements.centroids[:, [0, 2, 1]])  # the time axis first, then x y
    with pytest.raises(ValueError, match=".xyz"):
        elements.save(tmp_path / "surface.xyz")


def test_other_fields_are_sampled_at_the_vertices(moving_balls):
    contour = tegl.contour(moving_balls, 0.0, spacing=(0.5, 1, 2, 3), dtype=np.float64)
    t, z, y, x = np.indices((4, 17, 17, 33), dtype=np.float64)  # every other time
    height = contour.sample(2 * z + y - x + t, "height", spacing=(1, 1, 2, 3))
    places = contour.vertices / (1, 1, 2, 3)
    inside = contour.vertices[:, 0] <= 3
    assert height[inside] == pytest.approx((places @ [1, 2, 1, -1])[inside])
    assert np.isnan(height[~inside]).all() and not inside.all()
    assert np.array_equal(contour.vertex_attributes["height"], height, equal_nan=True)
    cut = contour.slice(1.25)
    assert cut.vertex_attributes["height"] == pytest.approx(1.25 + (cut.vertices / (1, 2, 3)) @ [2, 1, -1])
    assert "height" in contour.elements().attributes
    with pytest.raises(ValueError, match="already has an attribute 'height'"):
        contour.sample(z, "height", spacing=(1, 1, 2, 3))
    with pytest.raises(ValueError, match="3 axes; expected 4"):
        contour.sample(z[0], "other")


# Normals, by the name of their kind.

@pytest.mark.parametrize("ndim", [2, 3, 4])
@pytest.mark.parametrize("time_axis", [0, -1])
def test_normals_are_of_the_kind_that_is_named(ndim, time_axis):
    array = ball(ndim, {2: 41, 3: 21, 4: 13}[ndim], 0.69)
    options = dict(spacing=(1.0, 2.0, 3.0, 1.5)[:ndim], time_axis=time_axis, dtype=np.float64)
    plain, gradient = tegl.contour(array, 0.0, **options), tegl.contour(array, 0.0, normals=True, **options)
    assert plain.normals is None and tegl.contour(array, 0.0, normals=False, **options).normals is None
    assert np.array_equal(tegl.contour(array, 0.0, normals="gradient", **options).normals, gradient.normals)
    sobel = tegl.contour(array, 0.0, normals=True, gradient="sobel", **options).normals
    assert not np.array_equal(sobel, gradient.normals)
    for more in (dict(normals="sobel"), dict(normals="sobel", gradient="sobel"), dict(normals="gradient", gradient="sobel")):
        assert np.array_equal(tegl.contour(array, 0.0, **more, **options).normals, sobel)
    index = tegl.Index(array, spacing=options["spacing"], time_axis=time_axis)
    assert np.array_equal(index.contour(0.0, normals="sobel", dtype=np.float64).normals, sobel)
    prewitt = tegl.contour(array, 0.0, normals="prewitt", **options)
    kernel = np.broadcast_to(np.arange(-1, 2).reshape((3,) + (1,) * (ndim - 1)), (3,) * ndim)
    assert np.allclose(tegl.contour(array, 0.0, normals=kernel, **options).normals, prewitt.normals, atol=1e-12)
    forward = np.zeros((ndim,) + (3,) * ndim)  # a kernel for each axis of the array
    middle = (1,) * ndim
    for axis in range(ndim):
        forward[(axis,) + middle], forward[(axis,) + middle[:axis] + (2,) + middle[axis + 1:]] = -1, 1
    one_sided = tegl.contour(array, 0.0, normals="forward", **options)
    assert np.allclose(tegl.contour(array, 0.0, normals=forward, **options).normals, one_sided.normals, atol=1e-12)
    assert not np.allclose(one_sided.normals, tegl.contour(array, 0.0, normals="backward", **options).normals, atol=1e-3)
    by_context = tegl.contour(array, 0.0, normals="context", **options)
    uncertainty = by_context.vertex_attributes["normal_uncertainty"]
    assert len(uncertainty) == len(by_context.vertices) and 0 <= uncertainty.min() and uncertainty.max() < 0.5
    assert (by_context.normals * gradient.normals).sum(axis=1).min() > 0.99
    from_index = index.contour(0.0, normals="context", dtype=np.float64)
    assert np.array_equal(from_index.normals, by_context.normals)
    assert np.array_equal(from_index.vertex_attributes["normal_uncertainty"], uncertainty)

    # From the contour's own shape: across the simplices, towards what is low.
    flat = tegl.contour(array, 0.0, normals="flat", **options)
    assert_same(flat, plain)
    assert flat.normals is None
    normal = flat.simplex_attributes["normal"]
    size = np.linalg.norm(normal, axis=1)
    has_size = size > 0  # a few tetrahedra of compact 4D contours are flat
    assert normal.shape == flat.simplices.shape and size[has_size] == pytest.approx(1) and has_size.mean() > 0.99
    corners = flat.vertices[flat.simplices]
    for side in range(1, ndim):
        assert np.abs(((corners[:, side] - corners[:, 0]) * normal).sum(axis=1)).max() < 1e-9
    middle = (np.array(array.shape) - 1) / 2 * options["spacing"]
    assert ((corners.mean(axis=1) - middle) * normal).sum(axis=1)[has_size].min() > 0
    geometric = tegl.contour(array, 0.0, normals="geometric", **options)
    assert_same(geometric, plain)
    assert not np.array_equal(geometric.normals, gradient.normals)
    cosines = (geometric.normals * gradient.normals).sum(axis=1)
    assert np.median(cosines) > 0.98
    for one in (index.contour(0.0, normals="geometric", dtype=np.float64),
                index.pick(middle, 0.0, normals="geometric", dtype=np.float64)):
        assert np.array_equal(one.normals, geometric.normals)


def test_normals_of_simplices_have_the_columns_of_vertices_wherever_they_go(tmp_path):
    flat = tegl.contour(ball(3, 15)[:, :-2], 0.0, normals="flat", spacing=(1, 2, 3), dtype=np.float64)
    normal = flat.simplex_attributes["normal"]
    flat.save(tmp_path / "flat.vtkhdf")
    for other in (pickle.loads(pickle.dumps(flat)), tegl.load(tmp_path / "flat.vtkhdf"), flat.components().split()[0],
                  tegl.Contour(flat.vertices, flat.simplices, simplex_attributes={"normal": normal})):
        assert np.array_equal(other.simplex_attributes["normal"], normal)
    turned = tegl.load(tmp_path / "flat.vtkhdf", time_axis=-1)
    assert np.array_equal(turned.simplex_attributes["normal"], normal[:, ::-1])
    assert np.array_equal(flat.elements().attributes["normal"], normal)
    dsigma = flat.elements()
    assert np.allclose(dsigma.normals / dsigma.measures[:, None], normal)
    direct = tegl.slice(ball(3, 15), 0.0, at=7.0, normals="flat", dtype=np.float64)
    along = direct.vertices[direct.simplices[:, 1]] - direct.vertices[direct.simplices[:, 0]]
    assert np.abs((along * direct.simplex_attributes["normal"]).sum(axis=1)).max() < 1e-9
    assert tegl.slice(ball(4, 9), 0.0, at=4.0, normals="geometric").normals.shape[1] == 3


# Simplification.

def test_merged_vertices_and_their_report():
    z, y, x = np.ogrid[0:7, 0:7, 0:13]
    across = np.hypot(y - 3, z - 3)
    touching = 2.3125 - np.minimum(np.hypot(x - 3.6875, across), np.hypot(x - 8.3125, across))  # in (3, 3, 6)
    contour = tegl.contour(touching, 0.0, dtype=np.float64)
    merged, report = contour.merge_vertices()
    assert (report.pinched_vertices, report.pinched_faces, report.euler_before, report.euler_after) == (1, 0, 2, 3)
    assert merged.vertices[report.vertices[0]].tolist() == [3, 3, 6]
    assert len(merged.vertices) == report.vertices_before - report.merged_vertices
    assert merged.measure().content == pytest.approx(contour.measure().content)
    assert_same(tegl.merge_vertices(contour, 0.0, threads=1)[0], merged)
    bridge = np.zeros((7, 7, 12))
    bridge[2:5, 2:5, 2:5] = bridge[2:5, 2:5, 7:10] = 2
    bridge[3, 3, 5:7] = 1
    cut, report = tegl.contour(bridge, 1).merge_vertices()
    assert (report.components_before, report.components_after, report.pinched_vertices) == (1, 2, 0)
    assert report.shrunk_places == 2 and report.shrunk.tolist() == [[3, 3, 5], [3, 3, 6]]
    assert cut.check().components == 2
    single = np.zeros((4, 5, 6))
    single[1, 2, 3] = 1
    nothing, report = tegl.contour(single, 1).merge_vertices(most_listed=5)
    assert len(nothing.simplices) == 0 and report.vanished_components == 1 and report.vanished.tolist() == [[1, 2, 3]]
    with pytest.raises(ValueError, match="the tolerance is -1; expected a finite number, 0 or more"):
        contour.merge_vertices(-1)


def test_simplification_takes_the_ratio_first():
    contour = tegl.contour(ball(3, 31), 0.0, dtype=np.float64)
    for call in (lambda **more: contour.simplify(0.1, **more), lambda **more: tegl.simplify(contour, 0.1, **more)):
        assert_same(call(), contour.simplify(ratio=0.1))
        assert call(return_stats=True)[1].simplices_after <= 0.1 * len(contour.simplices)
    with pytest.raises(TypeError):
        contour.simplify(0.1, 0.2)


def test_simplification_keeps_contours_embedded_on_request():
    contour = tegl.contour(noise((14, 14, 14), 3), 0.0, dtype=np.float64)
    assert contour.intersections().count == 0
    assert contour.simplify(0.3, measure=False).intersections().count > 0
    kept = contour.simplify(0.3, measure=False, keep_embedded=True)
    assert kept.intersections().count == 0 and len(kept.simplices) < 0.4 * len(contour.simplices)
    with pytest.raises(ValueError, match="keep_embedded for the method fast"):
        contour.simplify(0.3, method="fast", keep_embedded=True)


@pytest.mark.parametrize("function, method", [(tegl.simplify, tegl.Contour.simplify), (tegl.track, tegl.Contour.track),
                                              (tegl.measure, tegl.Contour.measure)])
def test_methods_have_the_options_of_the_functions_by_name(function, method):
    of_function, of_method = (list(inspect.signature(one).parameters.values())[1:] for one in (function, method))
    assert of_function == of_method
    assert not any(one.kind in (one.VAR_KEYWORD, one.VAR_POSITIONAL) for one in of_method)
    with pytest.raises(TypeError, match="unexpected keyword argument 'ratios'"):
        method(tegl.contour(ball(3), 0.0), ratios=0.5)


def test_simplified_contours_keep_their_topology_and_their_bound():
    contour = tegl.contour(ball(3, 31), 0.0, dtype=np.float64)
    coarse, stats = contour.simplify(max_error=0.2, return_stats=True)
    assert len(coarse.simplices) < len(contour.simplices) / 4
    assert coarse.check().is_manifold and coarse.check().euler == 2
    assert max(stats.error_of_original, stats.error_of_result) <= 0.2
    assert stats.simplices_after == len(coarse.simplices)
    assert stats.end == "error" and stats.rounds > 0
    assert contour.simplify(ratio=0.5, return_stats=True)[1].end == "count"
    assert contour.simplify(ratio=0.0, measure=False, return_stats=True)[1].end == "shape"
    radii = np.linalg.norm(coarse.vertices - 15, axis=1)
    assert np.abs(radii - 10.5).max() < 0.25
    assert coarse.vertex_attributes["simplification_error"].max() <= 0.2
    assert len(contour.simplify(count=100).simplices) <= 110
    assert tegl.simplify(contour, ratio=0.5, method="vertices", measure=False).vertex_attributes == {}


def test_scales_of_simplification_are_by_axis_of_the_array():
    contour = tegl.contour(ball(3, 21), 0.0, spacing=(100, 1, 1), axis_units=["s", "mm", "mm"], dtype=np.float64)
    scaled, stats = contour.simplify(ratio=0.3, scale=(0.01, 1, 1), return_stats=True)
    assert stats.error_of_result < 1
    assert contour.simplify(ratio=0.3, scale="auto").check().is_closed and scaled.check().is_closed
    with pytest.raises(ValueError, match="scale has 2 numbers"):
        contour.simplify(ratio=0.5, scale=(1, 1))
    with pytest.raises(ValueError, match="expected 'auto'"):
        contour.simplify(ratio=0.5, scale="other")
    with pytest.raises(ValueError):
        contour.simplify()


# Tracking.

def test_events_of_balls_that_meet(balls, tmp_path):
    graph = balls.track(times=8, first=0.0, last=7.0)
    assert [event.kind for event in graph.events] == ["begin", "begin", "merge", "end"]
    merge = graph.events[2]
    assert 3.5 < merge.time < 5.5 and merge.segments_in == [0, 1] and merge.segments_out == [2]
    # They meet in the middle of y and z; x is the last of the array's axes.
    assert merge.place == pytest.approx([8, 8, 16], abs=0.6)
    assert graph.time_unit == "h" and (graph.first, graph.last) == (0.0, 7.0)
    assert len(graph.segments) == 3 and len(graph.tracks) == 2
    for segment in graph.segments:
        for sample in segment.samples:
            cut = balls.slice(sample.time).components()
            near = min(cut, key=lambda one: np.linalg.norm(one.centroid - sample.centroid))
            assert near.size == pytest.approx(sample.measure) and near.content == pytest.approx(sample.content)
    assert json.loads(json.dumps(graph.to_dict()))["events"][2]["kind"] == "merge"
    graph.save(tmp_path / "graph.json")
    assert len(json.loads((tmp_path / "graph.json").read_text())["events"]) == 4
    assert not balls.track(label_simplices=True).simplex_segments.size == 0
    networkx = pytest.importorskip("networkx")
    nodes = graph.to_networkx()
    assert nodes.nodes[2]["kind"] == "merge" and nodes.in_degree(2) == 2 and nodes.out_degree(2) == 1
    assert networkx.is_directed_acyclic_graph(nodes)


def test_tracking_goes_along_the_time_axis(moving_balls):
    first = tegl.contour(moving_balls, 0.0).track()
    last = tegl.contour(np.moveaxis(moving_balls, 0, -1), 0.0, time_axis=-1).track()
    assert [event.kind for event in first.events] == [event.kind for event in last.events]
    for one, other in zip(first.events, last.events):
        assert one.time == pytest.approx(other.time, abs=1e-5)


# Indexes.

@pytest.mark.parametrize("method", ["interval-tree", "span-space", "min-max-tree", "seed-set", "full-scan"])
@pytest.mark.parametrize("time_axis", [0, -1])
def test_contours_by_an_index_are_the_contours(method, time_axis, tmp_path):
    array = noise((7, 8, 9), 8)
    index = tegl.Index(array, method, spacing=(1, 2, 3), time_axis=time_axis)
    assert index.method == method and "7 x 8 x 9" in repr(index)
    for level in (-1.0, 0.0, 0.7):
        assert_same(index.contour(level), tegl.contour(array, level, spacing=(1, 2, 3), time_axis=time_axis))
    path = tmp_path / "noise.tindex"
    index.save(path)
    loaded = tegl.Index.load(path, array, spacing=(1, 2, 3), time_axis=time_axis)
    assert_same(loaded.contour(0.3, normals=True), index.contour(0.3, normals=True))
    assert (loaded.active_tiles(0.3) == index.active_tiles(0.3)).all()
    with pytest.raises(ValueError):
        tegl.Index.load(path, array + 1, time_axis=time_axis)


def test_active_tiles_are_those_that_the_level_passes():
    array = noise((5, 6, 7), 2)
    corners = np.stack([array[i:4 + i, j:5 + j, k:6 + k] for i, j, k in itertools.product((0, 1), repeat=3)])
    expected = np.argwhere((corners.min(axis=0) < 0.5) & (corners.max(axis=0) >= 0.5))
    found = tegl.Index(array).active_tiles(0.5)
    assert sorted(map(tuple, found.tolist())) == sorted(map(tuple, expected.tolist()))
    assert tegl.Index(array).active_tiles(99.0).shape == (0, 3)


def test_an_index_keeps_its_array():
    index = tegl.Index(noise((20, 20, 20), 8), "seed-set")  # looks at the values when asked
    expected = tegl.contour(noise((20, 20, 20), 8), 0.2)
    noise((20, 20, 20), 9)
    assert_same(index.contour(0.2), expected)
    with pytest.raises(ValueError, match="method is 'other'; expected one of"):
        tegl.Index(ball(3), "other")


def test_picking_gives_the_component_at_a_point(moving_balls):
    index = tegl.Index(moving_balls[0], spacing=(1, 1, 0.5))
    whole = tegl.contour(moving_balls[0], 0.0, spacing=(1, 1, 0.5)).components()
    for one, part in zip(whole, whole.split()):
        picked, report = index.pick(one.centroid, 0.0, return_report=True)
        assert_same(picked, part)
        assert report.found and report.components == 1 and len(report.tile) == 3
    assert len(index.pick((0, 0, 0), 0.0).components()) == 1
    with pytest.raises(ValueError):
        index.pick((0, 0, 99), 0.0)
    with pytest.raises(ValueError, match="the point has 2 numbers"):
        index.pick((0, 0), 0.0)


def test_the_nearest_component_of_any_contour(moving_balls):
    lattice = tegl.contour(moving_balls[0], 0.0, lattice="fcc", spacing=(0.5**0.5, 1, 1))
    parts = lattice.components()
    assert len(parts) == 2
    for label, one in enumerate(parts):
        assert parts.nearest(one.centroid) == label
        assert_same(parts.select(parts.nearest(one.centroid)), parts.split()[label])
    # a long step makes distances along its axis short
    segments = tegl.contour(np.array([[0, 0, 0, 0], [1, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1]], dtype=float), 0.5)
    both = segments.components()
    assert [both.nearest((1, 1.9), steps=steps) for steps in (1, (9, 1))] == [0, 1]
    with pytest.raises(ValueError, match="3 numbers; expected one for each of 2 axes"):
        both.nearest((1, 2, 3))
    with pytest.raises(ValueError, match=r"nearest to \(1, 2\), with steps of \(3, 0\); .*steps above 0"):
        both.nearest((1, 2), steps=(3, 0))
    with pytest.raises(ValueError, match="the contour is empty"):
        tegl.contour(moving_balls[0], 99.0, allow_empty=True).components().nearest((0, 0, 0))


def test_whatever_is_cut_open_is_open_at_the_border_alone():
    contour = tegl.contour(noise((6, 7, 8, 5), 1), 0.0)
    cut = contour.slice(2.5)
    count, _ = face_counts(cut.simplices)
    for face in (face for face, times in count.items() if times == 1):
        corners = cut.vertices[list(face)]
        assert ((corners == 0).all(axis=0) | (corners == np.array([6, 7, 4])).all(axis=0)).any()


def test_dates_in_any_form_are_the_same_place():
    xarray = pytest.importorskip("xarray")
    pandas = pytest.importorskip("pandas")
    times = pandas.date_range("2020-01-01", periods=6, freq="D")
    data = xarray.DataArray(noise((6, 9, 9, 9), 4), dims=("time", "z", "y", "x"), coords={"time": times})
    contour = tegl.contour(data, 0.0)
    expected = contour.slice(2.5)
    assert len(expected.simplices) > 100
    noon = np.datetime64("2020-01-03T12:00")
    for at in (noon, "2020-01-03T12:00", pandas.Timestamp(noon), datetime.datetime(2020, 1, 3, 12),
               datetime.datetime(2020, 1, 3, 14, tzinfo=datetime.timezone(datetime.timedelta(hours=2))),
               xarray.DataArray(noon)):
        assert_same(contour.slice(at), expected)
    third = contour.slice(2.0)
    assert_same(contour.slice(data.time[2]), third)
    assert_same(contour.slice(datetime.date(2020, 1, 3)), third)
    for at in (data.time[1:4], times[1:4], list(data.time[1:4]), data.time.values[1:4]):
        assert_same(contour.slice(at)[1], third)
    assert contour.measure().size > 0 and tegl.measure(contour, at=times[1:3]).size[1] > 0
    assert len(contour.track(times=times[1:3]).segments) > 0
    with pytest.raises(ValueError, match="NaT"):
        contour.slice(np.datetime64("NaT"))
    with pytest.raises(ValueError, match="duration"):
        contour.slice(np.timedelta64(1, "D"))
    with pytest.raises(ValueError, match="is a date"):
        contour.slice(x=noon)
    with pytest.raises(ValueError, match="NaT"):
        contour.slice(pandas.NaT)
    assert len(contour.track(first="2020-01-02", last=times[4]).segments) > 0


def test_dates_of_other_calendars_are_refused():
    contour = tegl.contour(noise((6, 9, 9), 4), 0.0, axis_names=("time", "y", "x"),
                           axis_units=("days since 2000-01-01 (noleap)", "", ""))
    assert len(contour.slice(2.5).simplices) > 0
    with pytest.raises(ValueError, match="calendar"):
        contour.slice("2000-01-03")


def test_a_time_between_other_axes_is_not_passed_over():
    xarray = pytest.importorskip("xarray")
    data = xarray.DataArray(noise((5, 6, 7), 4), dims=("member", "time", "x"),
                            coords={"time": np.arange("2020-01-01", "2020-01-07", dtype="datetime64[D]").astype("M8[ns]")})
    with pytest.raises(ValueError, match="the time 'time' is between.*transpose"):
        tegl.contour(data, 0.0)
    assert tegl.contour(data, 0.0, time_axis=-1).time_axis == 2
    assert tegl.contour(data.transpose("time", ...), 0.0).axis_names[0] == "time"


def test_contours_are_pickled_and_copied():
    contour = tegl.contour(noise((7, 8, 9), 2), 0.0, normals=True, axis_names="tyx", axis_units=("s", "mm", "mm"))
    contour.sample(noise((7, 8, 9), 3), "other", "K")
    for other in (pickle.loads(pickle.dumps(contour)), copy.deepcopy(contour)):
        assert_same(other, contour)
        assert np.array_equal(other.normals, contour.normals)
        assert np.array_equal(other.vertex_attributes["other"], contour.vertex_attributes["other"]) and other.attribute_units == contour.attribute_units
        assert (other.axis_names, other.axis_units, other.isovalue, other.time_axis) == \
            (contour.axis_names, contour.axis_units, contour.isovalue, contour.time_axis)


def test_what_is_no_contour_or_no_array_is_a_type_error():
    array = noise((5, 6, 7), 1)
    for call in (tegl.check, tegl.intersections, tegl.measure, tegl.components, tegl.elements, tegl.track, tegl.Incidence,
                 lambda value: tegl.simplify(value, ratio=0.5)):
        with pytest.raises(TypeError, match="ndarray is not a contour; expected a tegl.Contour"):
            call(array)
    with pytest.raises(TypeError, match="is a path; expected an array"):
        tegl.contour("ocean.nc", 20.0)
    xarray = pytest.importorskip("xarray")
    with pytest.raises(TypeError, match="a dataset of 'v'; expected one"):
        tegl.contour(xarray.Dataset({"v": (("z", "y", "x"), array)}), 0.0)


def test_named_dimensions_are_not_taken_by_their_places():
    xarray = pytest.importorskip("xarray")
    data = xarray.DataArray(noise((8, 8, 8), 1), dims=("z", "y", "x"))
    mask = xarray.DataArray(noise((8, 8, 8), 2) > -0.5, dims=("z", "y", "x"))
    contour = tegl.contour(data, 0.0, mask=mask)
    assert_same(tegl.contour(data, 0.0, mask=mask.transpose("x", "z", "y")), contour)
    with pytest.raises(ValueError, match="mask has the dimensions a, y, x"):
        tegl.contour(data, 0.0, mask=mask.rename(z="a"))
    with pytest.raises(ValueError, match="expected the contour's order, z, y, x"):
        contour.sample(data.transpose("x", "y", "z"), "other")
