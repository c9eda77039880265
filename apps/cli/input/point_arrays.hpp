// SPDX-License-Identifier: BSD-3-Clause
//
// The option --attribute with meshes of cells: other arrays at the points of the mesh that is contoured.
#pragma once

#include <string>
#include <vector>

#include "input/attributes.hpp"
#include "input/mesh_input.hpp"

namespace tegl::cli {

/// An array with a number for each point of a mesh, at one time or at all its times.
struct PointArray {
  std::string name;
  CellMesh mesh;  ///< its values, with the points and the times that they belong to
};

/// Reads the meshes among the files of --attribute. One that is the first of `files` stands for all of them, at their
/// times. Throws UnsupportedData for a mesh with other points, cells or times than `input`; InvalidArgument for two
/// arrays of one name; and errors of the readers.
std::vector<PointArray> read_point_arrays(const AttributeOptions& attributes, const CellMesh& input,
                                          const std::vector<std::string>& files, const ImageOptions& images,
                                          ProgressBar& bar);

/// Interpolates the arrays to the vertices of a contour of `input`, made with the same isovalue and options.
template <int N, class Real>
void add_point_arrays(Contour<N, Real>& contour, const MeshInput& input, double isovalue, const ExtractOptions& options,
                      const std::vector<PointArray>& arrays) {
  if constexpr (N <= 4) {
    const auto& complex = std::get<Complex<N>>(input.complex);
    for (const PointArray& array : arrays) {
      std::vector<double> numbers;  // a mesh at one time has the same values at all times
      while (numbers.size() < complex.points().size())
        numbers.insert(numbers.end(), array.mesh.values.begin(), array.mesh.values.end());
      contour.vertex_attributes.push_back(interpolate_points(complex, isovalue, numbers, array.name, "", options));
    }
  }
}

}  // namespace tegl::cli
