# SPDX-License-Identifier: BSD-3-Clause
"""The values of options, for type checkers. The lists of the library are authoritative; tests compare both."""

import typing

Triangulation = typing.Literal["compact", "barycentric"]
PolygonTriangulation = typing.Literal["fan", "zigzag", "halving-chord", "halving-kink", "barycentric"]
Ambiguity = typing.Literal["low", "high", "mean", "saddle", "squares", "decider"]
Direction = typing.Literal["descent", "ascent"]
#: Of vertices along the array's gradient, by differences, by a kernel or by context, or from the simplices around them;
#: or of simplices.
Normals = typing.Literal["gradient", "sobel", "prewitt", "context", "forward", "backward", "geometric", "flat"]
Gradient = typing.Literal["differences", "sobel"]
SimplifyMethod = typing.Literal["quadric", "facets", "vertices", "fast"]
SimplifyBorder = typing.Literal["fixed", "within"]
SimplifyEnd = typing.Literal["count", "error", "shape", "rounds"]
IndexMethod = typing.Literal["full-scan", "interval-tree", "span-space", "min-max-tree", "seed-set"]
SeriesOrder = typing.Literal["name", "time", "given"]
ElementAxes = typing.Literal["time_first", "as_is"]
ElementComponents = typing.Literal["covariant", "contravariant"]
EventKind = typing.Literal["begin", "birth", "enter", "end", "death", "leave", "merge", "split", "exchange"]
AxisDirection = typing.Literal["up", "down", "unknown"]
Samples = typing.Literal["points", "cells", "file"]
Positions = typing.Literal["linear", "filtered", "gravitation", "relaxed"]
FilterBorder = typing.Literal["extended", "cyclic", "missing"]
Lattice = typing.Literal["triangular", "fcc", "bcc", "d4", "fcc_in_time"]
Division = typing.Literal["kuhn", "alternating", "symmetric", "hybrid"]
