# SPDX-License-Identifier: BSD-3-Clause
"""Contours (isolines, isosurfaces, space-time isosurfaces) of 2D to 5D arrays. They are oriented manifolds, open only
at the border of the array and at missing values. The contour of a 4D array can be sliced at any time.

    import numpy, tegl

    t, z, y, x = numpy.ogrid[0:12, -1:1:40j, -1:1:40j, -1:1:40j]
    array = 0.6 + 0.02 * t - numpy.sqrt(x**2 + y**2 + z**2)
    contour = tegl.contour(array, 0.0)           # tetrahedra in space and time
    surface = contour.slice(7.3)                 # triangles: the surface at t = 7.3
    print(surface.measure().content, surface.check().is_closed)
    surface.save("surface.ply")

`tegl.marching_cubes` replaces the function of scikit-image. docs/python.md has more.
"""

from . import _tegl
from ._contour import Components, Contour, load
from ._curved import CurvedGrid
from ._facets import FacetLevel, FacetReport, Facets
from ._fields import fields, sample
from ._filter import filter, most_stable_scale, scale_space
from ._functions import check, components, elements, frame_of, intersections, measure, merge_vertices, simplify, track
from ._image import ContourSize, Image, contour, contour_facets, count, read, slice
from ._incidence import Incidence
from ._index import Index, PickReport
from ._mesh import (Mesh, MeshIndex, contour_mesh, contour_mesh_facets, contour_points, count_mesh,
                    read_mesh)
from ._results import (Component, CutMeasures, Elements, ElementSum, Frame, Intersections, Measures, MergeReport,
                       MeshReport, SimplifyStats)
from ._skimage import marching_cubes
from ._tegl import Cancelled, __version__
from ._track import Track, TrackEvent, TrackGraph, TrackHandle, TrackSample, TrackSegment

__all__ = [
    "Cancelled", "Component", "Components", "Contour", "ContourSize", "CurvedGrid", "CutMeasures", "Elements",
    "ElementSum", "FacetLevel", "FacetReport", "Facets", "Frame", "Image", "Incidence", "Index", "Intersections",
    "Measures", "MergeReport", "Mesh", "MeshIndex", "MeshReport", "PickReport", "SimplifyStats", "Track",
    "TrackEvent", "TrackGraph", "TrackHandle", "TrackSample", "TrackSegment", "__version__", "check", "components",
    "contour", "contour_facets", "contour_mesh", "contour_mesh_facets", "contour_points", "count", "count_mesh",
    "elements", "fields", "filter", "frame_of", "intersections", "load", "marching_cubes", "measure",
    "merge_vertices", "most_stable_scale", "read", "read_mesh", "sample", "scale_space", "simplify", "slice",
    "track",
]
