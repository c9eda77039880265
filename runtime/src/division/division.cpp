// SPDX-License-Identifier: BSD-3-Clause
//
// Divides the cells of a grid into simplices.
#include "tegl/division.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "complex/contour_numbers.hpp"
#include "complex/image_points.hpp"
#include "division/divided_cell.hpp"
#include "division/divided_contour.hpp"
#include "tegl/error.hpp"

namespace tegl {
namespace {

constexpr CellType kSimplex[] = {CellType::triangle, CellType::tetrahedron, CellType::simplex4};

constexpr std::pair<Division, const char*> kNames[] = {{Division::kuhn, "kuhn"},
                                                       {Division::alternating, "alternating"},
                                                       {Division::symmetric, "symmetric"},
                                                       {Division::hybrid, "hybrid"}};

/// Collects the cells of a divided image, and the centres of faces.
template <int N>
class Divider {
 public:
  using Sample = std::array<std::size_t, N>;
  static constexpr unsigned kAll = (1u << N) - 1;

  Divider(const Grid<N>& grid, std::vector<double> values)
      : grid_(grid), sizes_(grid.sizes()), values_(std::move(values)) {
    for (int a = 1; a < N; ++a) strides_[a] = strides_[a - 1] * sizes_[a - 1];
    points_.reserve(values_.size());
    detail::for_each_sample<N>(sizes_, [&](const Sample& index) { points_.push_back(place(index, {})); });
  }

  /// Calls work(lowest corner) for all cells.
  template <class Work>
  void for_cells(const Work& work) const {
    Sample cells = sizes_;
    for (std::size_t& size : cells) --size;
    detail::for_each_sample<N>(cells, work);
  }

  [[nodiscard]] Complex<N> complex() && {
    Complex<N> result = types_.empty() ? Complex<N>(std::move(points_), kSimplex[N - 2], corners_)
                                       : Complex<N>(std::move(points_), types_, corners_);
    result.set_values(std::move(values_));
    return result;
  }

  /// The simplices of a cell that is divided as all others.
  void add_divided(const Sample& at, const detail::DividedCell<N>& cell) {
    numbers_.clear();
    for (const detail::FacePoint& point : cell.points) numbers_.push_back(number(at, point));
    for (const auto& numbers : cell.simplices) {
      std::array<Index, N + 1> simplex;
      for (int j = 0; j <= N; ++j) simplex[j] = numbers_[numbers[j]];
      append(simplex);
    }
  }

  /// The corners of one parity and their simplices; in the middle, in 3D, the simplex of the other corners.
  void add_alternating(const Sample& at) {
    const auto odd = static_cast<unsigned>(std::accumulate(at.begin(), at.end(), std::size_t{0}) % 2);
    std::vector<Index> middle;
    for (unsigned v = 0; v <= kAll; ++v) {
      if (static_cast<unsigned>(std::popcount(v)) % 2 == odd) {
        if (N == 3) middle.push_back(corner(at, v));
        continue;
      }
      std::array<Index, N + 1> simplex{corner(at, v)};
      for (int a = 0; a < N; ++a) simplex[a + 1] = corner(at, v ^ 1u << a);
      append(simplex);
    }
    if (N == 3) append(middle);
  }

  /// The cell whole or, if it is ambiguous, as a cone from its centre over whole faces and cones of ambiguous ones.
  void add_hybrid(const Sample& at, double isovalue) {
    if (!is_ambiguous(signature(at, {0, kAll}, isovalue), N)) {
      append_cell(N == 2 ? CellType::pixel : CellType::voxel, at, {0, kAll}, nullptr);
      return;
    }
    const Index apex = centre(at, {0, kAll});
    detail::for_each_facet({0, kAll}, [&](detail::FacePoint facet) {
      if (N > 2 && !is_ambiguous(signature(at, facet, isovalue), N - 1)) {
        append_cell(CellType::pyramid, at, facet, &apex);
        return;
      }
      std::vector<detail::FacePoint> apexes{{0, kAll}};
      detail::for_each_cone(facet, apexes, [&](std::span<const detail::FacePoint> points) {
        types_.push_back(kSimplex[N - 2]);
        std::array<Index, N + 1> simplex;
        for (int j = 0; j <= N; ++j) simplex[j] = number(at, points[j]);
        append(simplex);
      });
    });
  }

 private:
  [[nodiscard]] std::array<double, N> place(const Sample& at, detail::FacePoint point) const {
    std::array<double, N> x;
    for (int a = 0; a < N; ++a) {
      const std::size_t i = at[a] + (point.low >> a & 1u);
      x[a] = grid_.axes[a][i];
      if ((point.axes >> a & 1u) != 0) x[a] = 0.5 * (x[a] + grid_.axes[a][i + 1]);
    }
    return detail::place_in_world<N>(grid_, x);
  }
  [[nodiscard]] Index corner(const Sample& at, unsigned mask) const {
    std::size_t number = 0;
    for (int a = 0; a < N; ++a) number += (at[a] + (mask >> a & 1u)) * strides_[a];
    return static_cast<Index>(number);
  }
  [[nodiscard]] Index number(const Sample& at, detail::FacePoint point) {
    return point.axes == 0 ? corner(at, point.low) : centre(at, point);
  }
  [[nodiscard]] unsigned signature(const Sample& at, detail::FacePoint face, double isovalue) const {
    unsigned result = 0;
    const std::vector<unsigned> masks = detail::corner_masks(face);
    for (std::size_t v = 0; v < masks.size(); ++v) result |= (values_[corner(at, masks[v])] >= isovalue ? 1u : 0u) << v;
    return result;
  }
  /// Whether the high or the low corners of a face are not connected along its edges.
  static bool is_ambiguous(unsigned high, int dim) {
    const unsigned all = (1u << (1u << dim)) - 1;
    const auto is_connected = [&](unsigned corners) {
      unsigned reached = corners & (~corners + 1);
      for (unsigned before = 0; reached != before;) {
        before = reached;
        for (int v = 0; v < 1 << dim; ++v)
          for (int a = 0; a < dim && (before >> v & 1u) != 0; ++a) reached |= 1u << (v ^ 1 << a) & corners;
      }
      return reached == corners;
    };
    return !is_connected(high) || !is_connected(all & ~high);
  }

  /// The centre of a face. Its value is the mean of the corners.
  Index centre(const Sample& at, detail::FacePoint face) {
    const auto [found, is_new] =
        centres_[face.axes].try_emplace(corner(at, face.low), static_cast<Index>(points_.size()));
    if (!is_new) return found->second;
    if (points_.size() >= std::numeric_limits<Index>::max())
      throw Error(ErrorCode::TooLarge, "2^32 points of a divided image or more; expected fewer");
    points_.push_back(place(at, face));
    std::vector<double> values;
    for (const unsigned mask : detail::corner_masks(face)) values.push_back(values_[corner(at, mask)]);
    values_.push_back(detail::mean_of_corners(values));
    return found->second;
  }

  void append(std::span<const Index> corners) {
    corners_.insert(corners_.end(), corners.begin(), corners.end());
    if (corners_.size() / (N + 1) >= std::numeric_limits<Index>::max())
      throw Error(ErrorCode::TooLarge, "2^32 cells of a divided image or more; expected fewer");
  }
  void append_cell(CellType type, const Sample& at, detail::FacePoint face, const Index* apex) {
    types_.push_back(type);
    std::vector<Index> corners;
    for (const unsigned mask : detail::corner_masks(face)) corners.push_back(corner(at, mask));
    if (apex != nullptr) {
      std::swap(corners[2], corners[3]);  // around the base
      corners.push_back(*apex);
    }
    append(corners);
  }

  const Grid<N>& grid_;
  Sample sizes_, strides_{1};
  std::vector<std::array<double, N>> points_;
  std::vector<double> values_;
  std::vector<CellType> types_;  ///< empty: all cells are simplices
  std::vector<Index> corners_;
  std::vector<Index> numbers_;                                      ///< of the points of a cell
  std::array<std::unordered_map<Index, Index>, kAll + 1> centres_;  ///< by axes and lowest corner
};

template <int N>
Complex<N> divided(const Grid<N>& grid, std::vector<double> values, Division division, double isovalue) {
  const detail::DividedCell<N> cell(division);
  Divider<N> divider(grid, std::move(values));
  divider.for_cells([&](const std::array<std::size_t, N>& at) {
    switch (division) {
      case Division::kuhn:
      case Division::symmetric:
        return divider.add_divided(at, cell);
      case Division::alternating:
        return divider.add_alternating(at);
      case Division::hybrid:
        return divider.add_hybrid(at, isovalue);
    }
  });
  return std::move(divider).complex();
}

}  // namespace

std::string_view name_of(Division division) noexcept {
  const auto* const found =
      std::find_if(std::begin(kNames), std::end(kNames), [&](const auto& each) { return each.first == division; });
  return found == std::end(kNames) ? "unknown" : found->second;
}

namespace {

/// Throws InvalidArgument for divisions that the dimension does not have.
void require_division(Division division, int dim) {
  if (dim >= 4 && (division == Division::alternating || division == Division::hybrid))
    throw Error(ErrorCode::InvalidArgument,
                fmt::format("division {} of a {}D image; expected kuhn or symmetric", name_of(division), dim));
}

/// Throws the errors of options that 5D contours of divided images do not have.
void require_options_in_5d(double isovalue, const ExtractOptions& options) {
  detail::check_complex_options(isovalue, options);
  if (options.normals != Normals::none)
    throw Error(ErrorCode::InvalidArgument, "normals of a divided 5D image; expected none");
  if (options.triangulation != Triangulation::compact)
    throw Error(ErrorCode::InvalidArgument, "triangulation barycentric of a divided 5D image; expected compact");
}

/// The contour of a 5D image, or its size if `contour` is null.
template <Value T, class Real>
ExtractedSize extract_in_5d(const Image<T, 5>& image, Division division, double isovalue, const ExtractOptions& options,
                            Contour<5, Real>* contour) {
  require_division(division, 5);
  require_options_in_5d(isovalue, options);
  return detail::extract_divided_cells<5, Real>(
      image.grid(),
      [&](const std::array<std::size_t, 5>& from, std::size_t count, double* out) {
        std::array<std::size_t, 5> at = from;
        for (std::size_t i = 0; i < count; ++i, ++at[0]) out[i] = static_cast<double>(image(at));
      },
      division, isovalue, options, contour);
}

}  // namespace

template <Value T, int N>
requires DimensionBetween<N, 2, 4> Complex<N> divided_complex(const Image<T, N>& image, Division division,
                                                              double isovalue) {
  require_division(division, N);
  (void)detail::count_samples(image.grid(), "a divided image");
  return divided(image.grid(), detail::values_of(image), division, isovalue);
}

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 5> Extraction<N, Real> extract_divided_with_stats(const Image<T, N>& image,
                                                                                  Division division, double isovalue,
                                                                                  const ExtractOptions& options) {
  if constexpr (N <= 4) {
    return extract_with_stats<Real>(divided_complex(image, division, isovalue), isovalue, options);
  } else {
    Extraction<N, Real> result;
    for (int a = 0; a < N; ++a) {
      result.contour.axis_names[a] = image.grid().axes[a].name;
      result.contour.axis_units[a] = image.grid().axes[a].unit;
    }
    result.contour.direction = options.direction;
    result.stats = extract_in_5d(image, division, isovalue, options, &result.contour).stats;
    return result;
  }
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> ContourSize count_divided(const Image<T, N>& image, Division division,
                                                             double isovalue, const ExtractOptions& options) {
  if constexpr (N <= 4)
    return count(divided_complex(image, division, isovalue), isovalue, options);
  else
    return extract_in_5d<T, float>(image, division, isovalue, options, nullptr).size;
}

#define TEGL_INSTANTIATE(T)                                                        \
  template Complex<2> divided_complex<T, 2>(const Image<T, 2>&, Division, double); \
  template Complex<3> divided_complex<T, 3>(const Image<T, 3>&, Division, double); \
  template Complex<4> divided_complex<T, 4>(const Image<T, 4>&, Division, double);
#include "base/instantiate.hpp"

#define TEGL_INSTANTIATE_DIMENSIONS(T, N)                                                                       \
  template Extraction<N, float> extract_divided_with_stats<float, T, N>(const Image<T, N>&, Division, double,   \
                                                                        const ExtractOptions&);                 \
  template Extraction<N, double> extract_divided_with_stats<double, T, N>(const Image<T, N>&, Division, double, \
                                                                          const ExtractOptions&);               \
  template ContourSize count_divided<T, N>(const Image<T, N>&, Division, double, const ExtractOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl
