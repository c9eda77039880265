// SPDX-License-Identifier: BSD-3-Clause
//
// Analytic fields by name or as an expression, sampled on grids and lattices: test images of known shape.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tegl/image.hpp"
#include "tegl/lattice.hpp"
#include "tegl/layers.hpp"
#include "tegl/work.hpp"

namespace tegl {

/// A number that a field depends on.
struct FieldParameter {
  std::string name = {};     ///< such as "radius"
  double value = 0;          ///< default
  std::string meaning = {};  ///< a few words
};

/// A field that make_field knows.
struct FieldInfo {
  std::string name = {};                        ///< such as "gyroid"
  std::string meaning = {};                     ///< a sentence
  int least_dim = 2;                            ///< lowest dimension
  int most_dim = 5;                             ///< highest dimension
  std::vector<FieldParameter> parameters = {};  ///< in the order of the documentation
  bool has_seed = false;                        ///< whether it depends on a seed
};

/// The fields of make_field.
[[nodiscard]] std::vector<FieldInfo> fields();

/// A function of 2 to 5 coordinates. Copies share their data. Thread-safe.
class Field {
 public:
  /// Writes the values at start + i * (step, 0, ...), i < count.
  using Row = std::function<void(const double* start, double step, std::size_t count, double* out)>;

  /// A field of `dim` coordinates, computed row by row. `row` must be thread-safe.
  Field(int dim, Row row) : dim_(dim), row_(std::move(row)) {}
  /// Number of coordinates.
  [[nodiscard]] int dim() const noexcept { return dim_; }
  /// The value at a point of dim() coordinates.
  [[nodiscard]] double operator()(const double* point) const {
    double value = 0;
    row_(point, 0.0, 1, &value);
    return value;
  }
  /// Writes the values at start + i * (step, 0, ...), i < count.
  void row(const double* start, double step, std::size_t count, double* out) const { row_(start, step, count, out); }

 private:
  int dim_;
  Row row_;
};

/// A field of `fields()` in `dim` dimensions, with these parameters instead of the defaults. Fields are made for
/// coordinates from -1 to 1, and positive inside: their contour is at 0, except orbitals. `seed`: of the places of
/// metaballs and of noise. Errors: InvalidArgument (another name, dimension, or parameter; a value out of its range; a
/// seed other than 0 for another field).
[[nodiscard]] Field make_field(std::string_view name, int dim,
                               const std::vector<std::pair<std::string, double>>& parameters = {},
                               std::uint64_t seed = 0);

/// A field by an expression of x, y, z, t, u (as many as there are dimensions) and r, the distance from the origin, as
/// in "x^2 + y^2 < 0.5 ? 1 : -1". Operators and functions of muParser: + - * / ^, comparisons, ?:, sin, exp, sqrt, abs,
/// min, max, _pi and others. For constructive geometry: ball(x, y, z, radius) and other numbers of coordinates,
/// box(x, a, y, b, ...) with half widths, and torus(x, y, z, ring, tube) are positive inside; max joins, min
/// intersects, and min(a, -b) subtracts. Errors: InvalidArgument (a syntax error, with its position), UnsupportedData
/// if the library was built without muParser.
[[nodiscard]] Field make_expression(const std::string& text, int dim);
/// Whether the library was built with muParser.
[[nodiscard]] bool has_expressions() noexcept;

namespace detail {

/// 64 well mixed bits of a number: splitmix64 (Steele, Lea, Flood: Fast splittable pseudorandom number generators,
/// 2014).
constexpr std::uint64_t mixed_bits(std::uint64_t z) noexcept {
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}
/// A number in [0, 1) by its index.
constexpr double mixed_unit(std::uint64_t index) noexcept {
  return static_cast<double>(mixed_bits(index) >> 11U) * 0x1p-53;
}

/// Writes a layer of samples. `axes` and `layer`: of the grid; `shifted`: the axis whose odd layers are shifted, or -1.
void sample_field_layer(const Field& field, const std::vector<const Axis*>& axes, int shifted, std::size_t layer,
                        unsigned threads, float* out);
/// Throws InvalidArgument unless the field has this dimension, and the lattice too.
void require_field(const Field& field, int dim, std::optional<Lattice> lattice);

}  // namespace detail

/// Samples of a field as layers, computed when they are read: at the coordinates of the axes, before the world map.
/// With a lattice, odd layers are shifted by half a step along the axes before (tegl/lattice.hpp). Errors:
/// InvalidArgument (a field or lattice of another dimension).
template <int N>
requires DimensionBetween<N, 2, 5>
class FieldLayers final : public LayerReader<float, N> {
 public:
  /// The samples of `field` on `grid`. `threads`: 0 for all of the machine; the samples do not depend on it.
  FieldLayers(Field field, Grid<N> grid, std::optional<Lattice> lattice = {}, unsigned threads = 0)
      : field_(std::move(field)), grid_(std::move(grid)), threads_(threads) {
    detail::require_field(field_, N, lattice);
    if (lattice) shifted_ = *lattice == Lattice::fcc_in_time ? N - 2 : N - 1;
  }
  /// The grid of the samples.
  [[nodiscard]] const Grid<N>& grid() const noexcept override { return grid_; }
  /// Computes layer k.
  void read(std::size_t k, float* to) override {
    std::vector<const Axis*> axes;
    for (const Axis& axis : grid_.axes) axes.push_back(&axis);
    detail::sample_field_layer(field_, axes, shifted_, k, threads_, to);
  }

 private:
  Field field_;
  Grid<N> grid_;
  int shifted_ = -1;
  unsigned threads_;
};

/// Samples a field: see FieldLayers. Errors: also Cancelled.
template <int N>
requires DimensionBetween<N, 2, 5>
[[nodiscard]] OwnedImage<float, N> sample_field(const Field& field, const Grid<N>& grid,
                                                std::optional<Lattice> lattice = {}, const WorkOptions& work = {}) {
  FieldLayers<N> layers(field, grid, lattice, work.threads);
  std::size_t size = 1;
  for (int a = 0; a + 1 < N; ++a) size *= grid.axes[a].size();
  const std::size_t count = grid.axes[N - 1].size();
  std::vector<float> values(size * count);
  for (std::size_t k = 0; k < count; ++k) {
    if (work.progress && !work.progress(static_cast<double>(k) / static_cast<double>(count)))
      throw Error(ErrorCode::Cancelled, "cancelled by the progress callback");
    layers.read(k, values.data() + k * size);
  }
  if (work.progress) work.progress(1.0);
  return {grid, std::move(values)};
}

}  // namespace tegl
