// SPDX-License-Identifier: BSD-3-Clause
//
// Writes contours as segments, polygons and polyhedra to VTU and VTKHDF.
#include "meshes/facets.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "base/common.hpp"
#include "meshes/vtkhdf_names.hpp"
#include "meshes/vtkhdf_writer.hpp"
#include "meshes/vtu_writer.hpp"
#include "tegl/io/facets.hpp"

namespace tegl {
namespace {

namespace fs = std::filesystem;
using io_detail::ByteSink;
using io_detail::VtuArray;

/// VTK's cell types of line, polygon and polyhedron, by dimension.
constexpr std::array<unsigned char, 4> kFacetTypes = {1, 3, 7, 42};

/// The facets of the highest dimension as cells of a VTK file.
template <int N, class Real>
class FacetCells {
 public:
  static constexpr int kDim = N - 1;

  explicit FacetCells(const FacetHierarchy<N, Real>& facets) : facets_(facets), point_counts_(facets.count(kDim)) {
    for (std::size_t f = 0; f < point_counts_.size(); ++f) {
      // Segments and polygons: the number of boundary facets equals the number of points.
      const std::size_t points = kDim < 3 ? facets.down(kDim, f).size() : facets.points_of(kDim, f).size();
      point_counts_[f] = static_cast<Index>(points);
      points_ += points;
    }
  }

  [[nodiscard]] std::size_t count() const noexcept { return point_counts_.size(); }
  [[nodiscard]] std::uint64_t point_numbers() const noexcept { return points_; }
  [[nodiscard]] std::vector<Index> points(std::size_t f) const { return facets_.points_of(kDim, f); }
  [[nodiscard]] Index point_count(std::size_t f) const noexcept { return point_counts_[f]; }

  /// VTK's description of a polyhedron: the number of polygons; for each the number of points, then the points.
  [[nodiscard]] std::vector<Index> polygons(std::size_t f) const {
    const auto down = facets_.down(kDim, f);
    const auto signs = facets_.down_signs(kDim, f);
    std::vector<Index> result{static_cast<Index>(down.size())};
    for (std::size_t i = 0; i < down.size(); ++i) {
      std::vector<Index> polygon = facets_.points_of(2, down[i]);
      if (signs[i] < 0) std::reverse(polygon.begin(), polygon.end());
      result.push_back(static_cast<Index>(polygon.size()));
      result.insert(result.end(), polygon.begin(), polygon.end());
    }
    return result;
  }
  /// Length of polygons(f).
  [[nodiscard]] std::size_t polygons_size(std::size_t f) const noexcept {
    const auto down = facets_.down(kDim, f);
    std::size_t size = 1 + down.size();
    for (const Index polygon : down) size += facets_.down(2, polygon).size();
    return size;
  }

 private:
  const FacetHierarchy<N, Real>& facets_;
  std::vector<Index> point_counts_;
  std::uint64_t points_ = 0;
};

/// The first three coordinates, which VTK stores as a point.
template <int N, class Real>
std::array<Real, 3> first_three(const std::array<Real, N>& row) noexcept {
  std::array<Real, 3> result{};
  std::copy_n(row.begin(), std::min(N, 3), result.begin());
  return result;
}

template <int N, class Real>
void add_rows(const Buffer<std::array<Real, N>>& rows, const char* name, const char* fourth, VtuArray& three,
              std::vector<VtuArray>& arrays) {
  constexpr const char* kType = std::is_same_v<Real, float> ? "Float32" : "Float64";
  three = {name, kType, 3, rows.size(), sizeof(Real), rows.size(), [&rows](ByteSink& sink, std::size_t v) {
             for (const Real x : first_three<N, Real>(rows[v])) sink.put(x);
           }};
  if constexpr (N == 4)
    arrays.push_back({fourth, kType, 1, rows.size(), sizeof(Real), rows.size(),
                      [&rows](ByteSink& sink, std::size_t v) { sink.put(rows[v][3]); }});
}

/// The arrays of vertex numbers, with values of type `Id`.
template <class Id, int N, class Real>
std::vector<VtuArray> topology_of(const FacetCells<N, Real>& cells) {
  const std::size_t count = cells.count();
  constexpr const char* kType = sizeof(Id) == sizeof(std::int32_t) ? "Int32" : "Int64";
  std::vector<VtuArray> arrays;
  arrays.push_back(
      {"connectivity", kType, 1, cells.point_numbers(), sizeof(Id), count, [&cells](ByteSink& sink, std::size_t f) {
         for (const Index point : cells.points(f)) sink.put(static_cast<Id>(point));
       }});
  arrays.push_back({"offsets", kType, 1, count, sizeof(Id), count,
                    [&cells, end = std::int64_t{0}](ByteSink& sink, std::size_t f) mutable {
                      sink.put(static_cast<Id>(end += cells.point_count(f)));
                    }});
  arrays.push_back(
      {"types", "UInt8", 1, count, 1, count, [](ByteSink& sink, std::size_t) { sink.put(kFacetTypes[N - 1]); }});
  if constexpr (N == 4) {
    std::uint64_t size = 0;
    for (std::size_t f = 0; f < count; ++f) size += cells.polygons_size(f);
    arrays.push_back({"faces", kType, 1, size, sizeof(Id), count, [&cells](ByteSink& sink, std::size_t f) {
                        for (const Index number : cells.polygons(f)) sink.put(static_cast<Id>(number));
                      }});
    arrays.push_back({"faceoffsets", kType, 1, count, sizeof(Id), count,
                      [&cells, end = std::int64_t{0}](ByteSink& sink, std::size_t f) mutable {
                        sink.put(static_cast<Id>(end += static_cast<std::int64_t>(cells.polygons_size(f))));
                      }});
  }
  return arrays;
}

/// Whether vertex numbers and the length of the longest array of them fit into 32 bits.
template <int N, class Real>
bool fits_int32(const FacetHierarchy<N, Real>& facets, const FacetCells<N, Real>& cells) {
  std::uint64_t most = std::max<std::uint64_t>(facets.vertices.size(), cells.point_numbers());
  if constexpr (N == 4) {
    std::uint64_t faces = 0;
    for (std::size_t f = 0; f < cells.count(); ++f) faces += cells.polygons_size(f);
    most = std::max(most, faces);
  }
  return most <= static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max());
}

template <int N, class Real>
void write_vtu_facets(const FacetHierarchy<N, Real>& facets, const PendingPath& file, const WriteOptions& options) {
  const FacetCells<N, Real> cells(facets);
  io_detail::VtuGrid grid;
  grid.points = facets.vertices.size();
  grid.cells = cells.count();
  grid.axis_names.assign(facets.axis_names.begin(), facets.axis_names.end());
  grid.axis_units.assign(facets.axis_units.begin(), facets.axis_units.end());
  grid.periods = period_numbers(facets.periods);
  add_rows<N, Real>(facets.vertices, "Points", io_detail::kFurtherCoordinates[0], grid.coordinates, grid.point_arrays);
  if (!facets.normals.empty()) {
    grid.normals = io_detail::kNormals;
    VtuArray normals;
    add_rows<N, Real>(facets.normals, io_detail::kNormals, io_detail::kFurtherNormals[0], normals, grid.point_arrays);
    grid.point_arrays.push_back(std::move(normals));
  }
  // cell arrays
  const auto& places = facets.levels[N - 1].places;
  const auto add_cell_array = [&](const char* name, const char* type, unsigned bytes, auto put) {
    grid.cell_arrays.push_back({name, type, 1, places.size(), bytes, places.size(), put});
  };
  add_cell_array(facets.cells > 0 ? "cell" : "sample", "Int64", sizeof(std::int64_t),
                 [&places](ByteSink& sink, std::size_t f) { sink.put(static_cast<std::int64_t>(places[f].base)); });
  add_cell_array("signature", "Int32", sizeof(std::int32_t),
                 [&places](ByteSink& sink, std::size_t f) { sink.put(std::int32_t{places[f].signature}); });
  add_cell_array("cap", "UInt8", 1,
                 [&places](ByteSink& sink, std::size_t f) { sink.put(std::uint8_t{places[f].is_cap}); });
  const bool narrow = std::is_same_v<Real, float> && fits_int32(facets, cells);
  grid.topology = narrow ? topology_of<std::int32_t>(cells) : topology_of<std::int64_t>(cells);
  io_detail::write_vtu(grid, file, options);
}

/// Appends the cells from ... to - 1. `end`: number of their points so far.
template <int N, class Real>
void append_cells(const FacetCells<N, Real>& cells, std::size_t from, std::size_t to, std::int64_t& end,
                  io_detail::VtkhdfWriter& writer) {
  std::vector<Index> ids;
  std::vector<std::int64_t> ends;
  for (std::size_t f = from; f < to; ++f) {
    const std::vector<Index> points = cells.points(f);
    ids.insert(ids.end(), points.begin(), points.end());
    ends.push_back(end += static_cast<std::int64_t>(points.size()));
  }
  writer.append_cells(kFacetTypes[N - 1], ids, ends);
}

template <class Places, class Value>
Attribute attribute_of_places(const char* name, const Places& places, const Value& value) {
  Attribute attribute{name, "", 1, {}};
  attribute.values.resize(places.size());
  std::transform(places.begin(), places.end(), attribute.values.begin(), value);
  return attribute;
}

template <int N, class Real>
io_detail::VtkhdfLayout vtkhdf_layout(const FacetHierarchy<N, Real>& facets, const FacetCells<N, Real>& cells,
                                      Compression compression) {
  constexpr bool kSingle = std::is_same_v<Real, float>;
  return {N - 1,
          N,
          {facets.axis_names.begin(), facets.axis_names.end()},
          {facets.axis_units.begin(), facets.axis_units.end()},
          facets.vertices.size(),
          cells.count(),
          {},
          kSingle,
          kSingle && fits_int32(facets, cells),
          compression,
          period_numbers(facets.periods)};
}

template <int N, class Real>
void write_vtkhdf_facets(const FacetHierarchy<N, Real>& facets, const PendingPath& file, const WriteOptions& options) {
  const FacetCells<N, Real> cells(facets);
  io_detail::VtkhdfWriter writer(file, vtkhdf_layout(facets, cells, options.compression));
  const double all = static_cast<double>(facets.vertices.size() + facets.normals.size() + 4 * cells.count() + 1);
  double done = 0;
  /// Calls append(from, to) for blocks of 0 ... count - 1.
  const auto in_blocks = [&](std::size_t count, const auto& append) {
    for (std::size_t from = 0; from < count; from += io_detail::kMostRows) {
      io_detail::tick(options.work.progress, (done + static_cast<double>(from)) / all, file.target());
      append(from, std::min(count, from + io_detail::kMostRows));
    }
    done += static_cast<double>(count);
  };
  std::vector<double> numbers;
  const auto gather_rows = [&](const auto& rows, std::size_t from, std::size_t to) {
    numbers.clear();
    for (std::size_t v = from; v < to; ++v) numbers.insert(numbers.end(), rows[v].begin(), rows[v].end());
  };
  // points and normals
  in_blocks(facets.vertices.size(), [&](std::size_t from, std::size_t to) {
    gather_rows(facets.vertices, from, to);
    writer.append_vertices(numbers);
  });
  in_blocks(facets.normals.size(), [&](std::size_t from, std::size_t to) {
    gather_rows(facets.normals, from, to);
    writer.append_normals(numbers);
  });
  // cells
  std::int64_t end = 0;
  in_blocks(cells.count(), [&](std::size_t from, std::size_t to) { append_cells(cells, from, to, end, writer); });
  // cell arrays
  const auto& places = facets.levels[N - 1].places;
  std::size_t order = 0;
  const auto add_cell_array = [&](const char* name, const auto& value) {
    const Attribute attribute = attribute_of_places(name, places, value);
    io_detail::H5Table table = writer.attribute_table("CellData", attribute, order++);
    in_blocks(places.size(), [&](std::size_t from, std::size_t to) {
      table.append(H5T_NATIVE_DOUBLE, attribute.values.data() + from, to - from);
    });
  };
  add_cell_array(facets.cells > 0 ? "cell" : "sample",
                 [](const FacetPlace& place) { return static_cast<double>(place.base); });
  add_cell_array("signature", [](const FacetPlace& place) { return static_cast<double>(place.signature); });
  add_cell_array("cap", [](const FacetPlace& place) { return place.is_cap ? 1.0 : 0.0; });
  io_detail::tick(options.work.progress, 1.0, file.target());
  writer.close();
}

/// Throws UnsupportedFormat unless the extension stands for a format of facets.
void require_facet_format(const fs::path& path, int dimension) {
  const std::string extension = io_detail::lower(path.extension().string());
  if (extension != ".vtu" && extension != ".vtkhdf")
    io_detail::fail(ErrorCode::UnsupportedFormat, path,
                    "'{}' cannot hold a contour without triangulation; expected .vtu, or in 2D and 3D .vtkhdf",
                    path.extension().string());
  if (extension == ".vtkhdf" && dimension == 4)
    io_detail::fail(ErrorCode::UnsupportedFormat, path,
                    "VTKHDF files that VTK 9.1 reads cannot hold polyhedra; expected .vtu");
}

}  // namespace

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void write_facets(const FacetHierarchy<N, Real>& facets, const PendingPath& file, const WriteOptions& options) {
  require_facet_format(file.target(), N);
  if constexpr (N < 4) {
    if (io_detail::lower(file.target().extension().string()) == ".vtkhdf")
      return write_vtkhdf_facets(facets, file, options);
  }
  write_vtu_facets(facets, file, options);
}

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4>
void write_facets(const FacetHierarchy<N, Real>& facets, const fs::path& path, const WriteOptions& options) {
  require_facet_format(path, N);
  write_complete_file(path, [&](const PendingPath& file) { write_facets(facets, file, options); });
}

#define TEGL_INSTANTIATE(N, Real)                                                                               \
  template void write_facets<N, Real>(const FacetHierarchy<N, Real>&, const PendingPath&, const WriteOptions&); \
  template void write_facets<N, Real>(const FacetHierarchy<N, Real>&, const fs::path&, const WriteOptions&);
TEGL_INSTANTIATE(2, float)
TEGL_INSTANTIATE(2, double)
TEGL_INSTANTIATE(3, float)
TEGL_INSTANTIATE(3, double)
TEGL_INSTANTIATE(4, float)
TEGL_INSTANTIATE(4, double)
#undef TEGL_INSTANTIATE

}  // namespace tegl
