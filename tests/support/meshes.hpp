// SPDX-License-Identifier: BSD-3-Clause
//
// Meshes for tests: the cells of a grid as they are, or split into other cells so that neighbours meet in whole faces.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "tegl/complex.hpp"

namespace tegl::test {

/// Points, types and corners of a mesh, as the constructor of Complex takes them.
template <int N>
struct MeshData {
  std::array<std::size_t, N> sizes{};         ///< points of the grid along each axis
  std::vector<std::array<double, N>> points;  ///< those of the grid first, axis 0 fastest; then added ones
  std::vector<CellType> types;
  std::vector<Index> corners;

  void add(CellType type, std::initializer_list<Index> of) {
    types.push_back(type);
    corners.insert(corners.end(), of);
  }
  [[nodiscard]] Complex<N> complex() const { return Complex<N>(points, types, corners); }
  /// The number of a point of the grid.
  [[nodiscard]] Index at(const std::array<std::size_t, N>& index) const {
    std::size_t number = 0;
    for (int a = N - 1; a >= 0; --a) number = number * sizes[a] + index[a];
    return static_cast<Index>(number);
  }
  /// Corner v of the grid's cell at `index`: bit a of v is the step along axis a.
  [[nodiscard]] Index corner(std::array<std::size_t, N> index, unsigned v) const {
    for (int a = 0; a < N; ++a) index[a] += v >> a & 1u;
    return at(index);
  }
};

/// Calls visit(index) for the cells of a grid.
template <int N, class Visit>
void for_each_grid_cell(const std::array<std::size_t, N>& sizes, const Visit& visit) {
  std::array<std::size_t, N> index{};
  std::size_t count = 1;
  for (const std::size_t size : sizes) count *= size - 1;
  for (std::size_t i = 0; i < count; ++i) {
    visit(index);
    for (int a = 0; a < N && ++index[a] == sizes[a] - 1; ++a) index[a] = 0;
  }
}

/// Whether a point of the grid is on its border.
template <int N>
bool is_on_border(const MeshData<N>& mesh, std::size_t point) {
  for (int a = 0; a < N; ++a) {
    const std::size_t i = point % mesh.sizes[a];
    if (i == 0 || i + 1 == mesh.sizes[a]) return true;
    point /= mesh.sizes[a];
  }
  return false;
}

/// The points of a grid, in [-1, 1] along each axis. Points inside are moved by up to `jitter` steps.
template <int N>
MeshData<N> grid_points(const std::array<std::size_t, N>& sizes, double jitter = 0.0, std::uint64_t seed = 1) {
  MeshData<N> mesh;
  mesh.sizes = sizes;
  std::size_t count = 1;
  for (const std::size_t size : sizes) count *= size;
  mesh.points.resize(count);
  std::mt19937_64 random(seed);
  for (std::size_t p = 0; p < count; ++p) {
    std::size_t rest = p;
    for (int a = 0; a < N; ++a) {
      const double step = 2.0 / static_cast<double>(sizes[a] - 1);
      const double shift = is_on_border(mesh, p) ? 0.0 : 2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0;
      mesh.points[p][a] = -1.0 + step * (static_cast<double>(rest % sizes[a]) + jitter * shift);
      rest /= sizes[a];
    }
  }
  return mesh;
}

/// The grid's own cells, as pixels and voxels or in the order around borders.
template <int N>
MeshData<N> cube_mesh(MeshData<N> mesh, bool around = false) {
  static constexpr CellType kTypes[3][2] = {{CellType::pixel, CellType::quadrilateral},
                                            {CellType::voxel, CellType::hexahedron},
                                            {CellType::voxel_prism, CellType::hexahedron_prism}};
  for_each_grid_cell<N>(mesh.sizes, [&](const std::array<std::size_t, N>& index) {
    mesh.types.push_back(kTypes[N - 2][around ? 1 : 0]);
    for (unsigned v = 0; v < 1u << N; ++v) mesh.corners.push_back(mesh.corner(index, around ? v ^ (v >> 1 & 1u) : v));
  });
  return mesh;
}

/// Each cell as N! simplices along the diagonal from its first to its last corner (Kuhn, 1960).
template <int N>
MeshData<N> kuhn_mesh(MeshData<N> mesh) {
  static constexpr CellType kTypes[3] = {CellType::triangle, CellType::tetrahedron, CellType::simplex4};
  for_each_grid_cell<N>(mesh.sizes, [&](const std::array<std::size_t, N>& index) {
    std::array<int, N> axes;
    std::iota(axes.begin(), axes.end(), 0);
    do {
      mesh.types.push_back(kTypes[N - 2]);
      unsigned v = 0;
      mesh.corners.push_back(mesh.corner(index, v));
      for (const int a : axes) mesh.corners.push_back(mesh.corner(index, v |= 1u << a));
    } while (std::next_permutation(axes.begin(), axes.end()));
  });
  return mesh;
}

/// Each cube as 5 tetrahedra, mirrored from cube to cube.
inline MeshData<3> five_tetrahedra_mesh(MeshData<3> mesh) {
  for_each_grid_cell<3>(mesh.sizes, [&](const std::array<std::size_t, 3>& index) {
    const unsigned flip = (index[0] + index[1] + index[2]) % 2 == 0 ? 0 : 7;
    const auto c = [&](unsigned v) { return mesh.corner(index, v ^ flip); };
    mesh.add(CellType::tetrahedron, {c(0), c(3), c(5), c(6)});
    for (const unsigned v : {1u, 2u, 4u, 7u}) mesh.add(CellType::tetrahedron, {c(v), c(v ^ 1u), c(v ^ 2u), c(v ^ 4u)});
  });
  return mesh;
}

/// Each cube as 2 wedges; the triangles are across axis 2.
inline MeshData<3> wedge_mesh(MeshData<3> mesh) {
  for_each_grid_cell<3>(mesh.sizes, [&](const std::array<std::size_t, 3>& index) {
    const auto c = [&](unsigned v) { return mesh.corner(index, v); };
    mesh.add(CellType::wedge, {c(0), c(1), c(3), c(4), c(5), c(7)});
    mesh.add(CellType::wedge, {c(0), c(3), c(2), c(4), c(7), c(6)});
  });
  return mesh;
}

/// Adds a point at the middle of a cube and the cells between it and the cube's faces: a pyramid, or two tetrahedra
/// where splits(face as axis, side) holds.
template <class Splits>
void add_star(MeshData<3>& mesh, const std::array<std::size_t, 3>& index, const Splits& splits) {
  const auto middle = static_cast<Index>(mesh.points.size());
  std::array<double, 3> sum{};
  for (unsigned v = 0; v < 8; ++v)
    for (std::size_t i = 0; i < 3; ++i) sum[i] += mesh.points[mesh.corner(index, v)][i] / 8;
  mesh.points.push_back(sum);
  for (unsigned axis = 0; axis < 3; ++axis)
    for (unsigned side = 0; side < 2; ++side) {
      const unsigned a = 1u << (axis + 1) % 3, b = 1u << (axis + 2) % 3, base = side << axis;
      const Index p = mesh.corner(index, base), q = mesh.corner(index, base | a), r = mesh.corner(index, base | a | b),
                  s = mesh.corner(index, base | b);
      if (splits(axis, side)) {
        mesh.add(CellType::tetrahedron, {p, q, r, middle});
        mesh.add(CellType::tetrahedron, {p, r, s, middle});
      } else {
        mesh.add(CellType::pyramid, {p, q, r, s, middle});
      }
    }
}

/// Each cube as 6 pyramids.
inline MeshData<3> pyramid_mesh(MeshData<3> mesh) {
  const auto sizes = mesh.sizes;
  for_each_grid_cell<3>(sizes, [&](const std::array<std::size_t, 3>& index) {
    add_star(mesh, index, [](unsigned, unsigned) { return false; });
  });
  return mesh;
}

/// Columns of hexahedra, of wedges, and of stars of pyramids and tetrahedra, at random. Two stars share a quadrilateral
/// or two triangles, at random.
inline MeshData<3> mixed_mesh(MeshData<3> mesh, std::uint64_t seed) {
  const auto sizes = mesh.sizes;
  const auto random = [seed](std::uint64_t key) { return std::mt19937_64(seed * 1000003 + key)(); };
  enum Kind : std::uint8_t { hexahedron, wedge, star };
  const auto kind = [&](std::size_t i, std::size_t j) {  // of a column; outside of the mesh a star
    if (i >= sizes[0] - 1 || j >= sizes[1] - 1) return star;
    return static_cast<Kind>(random(i + sizes[0] * j) % 3);
  };
  for_each_grid_cell<3>(sizes, [&](const std::array<std::size_t, 3>& index) {
    const auto [i, j, k] = index;
    const auto c = [&](unsigned v) { return mesh.corner(index, v); };
    if (kind(i, j) == hexahedron) mesh.add(CellType::hexahedron, {c(0), c(1), c(3), c(2), c(4), c(5), c(7), c(6)});
    if (kind(i, j) == wedge) {
      mesh.add(CellType::wedge, {c(0), c(1), c(3), c(4), c(5), c(7)});
      mesh.add(CellType::wedge, {c(0), c(3), c(2), c(4), c(7), c(6)});
    }
    if (kind(i, j) != star) return;
    add_star(mesh, index, [&, i = i, j = j](unsigned axis, unsigned side) {
      const std::size_t step = side == 0 ? std::size_t{0} - 1 : 1;
      const Kind other = axis == 0 ? kind(i + step, j) : axis == 1 ? kind(i, j + step) : star;
      std::array<std::size_t, 3> at = index;
      at[axis] += side;  // the face's own place, the same from both sides
      return other == star && random(7919 * (mesh.at(at) + 1) + axis) % 2 == 0;
    });
  });
  return mesh;
}

/// Values of the points: noise in [0, 1), below 0 on the border of the grid, so that contours at isovalues in [0, 1)
/// are closed.
template <int N>
std::vector<double> closed_noise(const MeshData<N>& mesh, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::size_t grid = 1;
  for (const std::size_t size : mesh.sizes) grid *= size;
  std::vector<double> values(mesh.points.size());
  for (std::size_t p = 0; p < values.size(); ++p) {
    const double value = static_cast<double>(random() >> 11) * 0x1p-53;
    values[p] = p < grid && is_on_border(mesh, p) ? -1.0 : value;
  }
  return values;
}

/// A field at the points of a mesh: MeshData, FacedMesh or FacetedMesh.
template <class Mesh, class Field>
std::vector<double> values_of(const Mesh& mesh, const Field& field) {
  std::vector<double> values;
  for (const auto& point : mesh.points) values.push_back(field(point));
  return values;
}

}  // namespace tegl::test
