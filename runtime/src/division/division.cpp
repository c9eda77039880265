// SPDX-License-Identifier: BSD-3-Clause
//
// Divides the cells of a grid into simplices.
#include "tegl/division.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "complex/contour_numbers.hpp"
#include "complex/image_points.hpp"
#include "complex/point_gradients.hpp"
#include "division/divided_cell.hpp"
#include "division/divided_contour.hpp"
#include "division/stored_division.hpp"
#include "image/line_kernel.hpp"
#include "image/row_source.hpp"
#include "kernel/extract_normals.hpp"
#include "periodic/periodic_layers.hpp"
#include "periodic/periods.hpp"
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

  /// The faces whose centres are points, in their order behind the samples: the axes, and the lowest corner.
  [[nodiscard]] const std::vector<std::pair<unsigned, Index>>& centres() const noexcept { return faces_; }

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
    faces_.emplace_back(face.axes, corner(at, face.low));
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
  std::vector<std::pair<unsigned, Index>> faces_;                   ///< see `centres`
  std::array<std::unordered_map<Index, Index>, kAll + 1> centres_;  ///< by axes and lowest corner
};

using detail::DividedImage;

template <int N>
DividedImage<N> divided(const Grid<N>& grid, std::vector<double> values, Division division, double isovalue) {
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
  auto centres = divider.centres();
  return {std::move(divider).complex(), std::move(centres)};
}

/// The cells of an image with periodic axes: those of a longer one, of which samples and centres of the last layer are
/// those of the first.
template <Value T, int N>
DividedImage<N> divided_periodic(const Image<T, N>& image, Division division, double isovalue,
                                 const AxisPeriods<N>& periods) {
  const Grid<N>& grid = image.grid();
  const Grid<N> longer = detail::longer_grid(grid, periods);
  (void)detail::count_samples(longer, "a divided image with periodic axes");
  const auto sizes = grid.sizes(), longer_sizes = longer.sizes();
  const auto wrapped = [&](std::array<std::size_t, N> index) {
    for (int a = 0; a < N; ++a) index[a] %= sizes[a];
    return index;
  };
  std::vector<double> values;
  std::vector<Index> number;
  detail::for_each_sample<N>(longer_sizes, [&](const std::array<std::size_t, N>& index) {
    values.push_back(static_cast<double>(image(wrapped(index))));
    number.push_back(static_cast<Index>(detail::number_of<N>(grid, wrapped(index))));
  });
  const DividedImage<N> of_longer = divided(longer, std::move(values), division, isovalue);
  // the points, without those of the last layers
  std::vector<std::pair<unsigned, Index>> centres;
  std::vector<std::array<double, N>> points(detail::count_samples(grid, "a divided image"));
  std::vector<double> of_points(points.size());
  for (std::size_t p = 0; p < number.size(); ++p) {
    const auto index = detail::index_of<N>(p, longer_sizes);
    if (index != wrapped(index)) continue;
    points[number[p]] = of_longer.complex.points()[p];
    of_points[number[p]] = of_longer.complex.values()[p];
  }
  std::map<std::pair<unsigned, Index>, Index> known;
  for (const auto& [axes, lowest] : of_longer.centres) {
    const std::pair face{axes, number[lowest]};
    const auto [at, is_new] = known.try_emplace(face, static_cast<Index>(points.size()));
    if (is_new) {
      points.push_back(of_longer.complex.points()[number.size()]);
      of_points.push_back(of_longer.complex.values()[number.size()]);
      centres.push_back(face);
    }
    number.push_back(at->second);
  }
  return {detail::ComplexAccess::identified<N>(of_longer.complex, std::move(points), std::move(of_points), number),
          std::move(centres)};
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

}  // namespace

namespace detail {

template <int N>
void check_division_arguments(const Grid<N>& grid, Division division, double isovalue, const ExtractOptions& options,
                              const AxisPeriods<N>& periods) {
  require_division(division, N);
  ExtractOptions of_complexes = options;
  of_complexes.normals = Normals::none;
  check_complex_options(isovalue, of_complexes);
  if (options.normals == Normals::context)
    throw Error(ErrorCode::InvalidArgument, "normals context of a divided image; expected gradients of other kinds");
  if (N == 5 && options.triangulation != Triangulation::compact)
    throw Error(ErrorCode::InvalidArgument, "triangulation barycentric of a divided 5D image; expected compact");
  if (options.normals == Normals::kernel) (void)line_kernel_of<N>(options.kernel);
  if (!any_periodic<N>(periods)) return;
  check_periods<N>(grid, periods, options);
  for (int a = 0; a < N; ++a)
    if (division == Division::alternating && periods[a] != 0.0 && grid.axes[a].size() % 2 != 0)
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("division alternating: {} is periodic and has {} samples; expected an even number, as "
                              "neighbouring cells are mirror images",
                              label_of_axis(grid.axes[a], a), grid.axes[a].size()));
}

template <Value T, int N>
DividedImage<N> divide_image(const Image<T, N>& image, Division division, double isovalue,
                             const AxisPeriods<N>& periods) {
  if (any_periodic<N>(periods)) return divided_periodic(image, division, isovalue, periods);
  return divided(image.grid(), values_of(image), division, isovalue);
}

}  // namespace detail

namespace {

using detail::any_periodic;
using detail::ImageGradients;

/// Extracts the contour of a complex of a divided image.
template <class Real, Value T, int N>
Extraction<N, Real> extract_stored(const Image<T, N>& image, Division division, double isovalue,
                                   const ExtractOptions& options, const AxisPeriods<N>& periods) {
  const detail::StoredDivision<T, N> stored(image, division, isovalue, options, periods);
  return detail::extract_in<Real>(stored.complex(), isovalue, stored.options(options), stored.surroundings());
}

/// The contour of a 5D image, or its size if `contour` is null.
template <class Real, Value T>
ExtractedSize extract_in_5d(const Image<T, 5>& image, Division division, double isovalue, const ExtractOptions& options,
                            const AxisPeriods<5>& periods, Contour<5, Real>* contour) {
  const Grid<5>& grid = image.grid();
  const Grid<5> longer = detail::longer_grid(grid, periods);
  detail::DividedSamples<5> samples{longer};
  for (int a = 0; a < 5; ++a) samples.periodic |= unsigned{periods[a] != 0.0} << a;
  if (samples.periodic != 0) samples.periods = detail::world_periods<5>(grid, periods);
  std::optional<ImageGradients<T, 5>> gradients;
  std::optional<detail::ImageSource<T, 5>> source;
  if (options.normals != Normals::none && contour != nullptr) {
    gradients.emplace(image, periods);
    source.emplace(gradients->view(), isovalue, options.epsilon);
    samples.gradients = &*source;
    samples.gradient_grid = &gradients->view().grid();
    samples.before = gradients->before();
  }
  return detail::extract_divided_cells<5, Real>(
      samples,
      [&](const std::array<std::size_t, 5>& from, std::size_t count, double* out) {
        std::array<std::size_t, 5> at = from;
        for (int a = 0; a < 5; ++a) at[a] %= image.size(a);
        for (std::size_t i = 0; i < count; ++i) {
          out[i] = static_cast<double>(image(at));
          if (++at[0] == image.size(0)) at[0] = 0;
        }
      },
      division, isovalue, options, contour);
}

}  // namespace

template <Value T, int N>
requires DimensionBetween<N, 2, 4> Complex<N> divided_complex(const Image<T, N>& image, Division division,
                                                              double isovalue) {
  require_division(division, N);
  (void)detail::count_samples(image.grid(), "a divided image");
  return divided(image.grid(), detail::values_of(image), division, isovalue).complex;
}

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 5> Extraction<N, Real> extract_divided_with_stats(const Image<T, N>& image,
                                                                                  Division division, double isovalue,
                                                                                  const ExtractOptions& options,
                                                                                  const AxisPeriods<N>& periods) {
  detail::check_division_arguments<N>(image.grid(), division, isovalue, options, periods);
  if constexpr (N <= 4) {
    return extract_stored<Real>(image, division, isovalue, options, periods);
  } else {
    Extraction<N, Real> result;
    for (int a = 0; a < N; ++a) {
      result.contour.axis_names[a] = image.grid().axes[a].name;
      result.contour.axis_units[a] = image.grid().axes[a].unit;
    }
    result.contour.direction = options.direction;
    result.stats = extract_in_5d<Real>(image, division, isovalue, options, periods, &result.contour).stats;
    return result;
  }
}

template <Value T, int N>
requires DimensionBetween<N, 2, 5> ContourSize count_divided(const Image<T, N>& image, Division division,
                                                             double isovalue, const ExtractOptions& asked,
                                                             const AxisPeriods<N>& periods) {
  detail::check_division_arguments<N>(image.grid(), division, isovalue, asked, periods);
  ExtractOptions options = asked;
  options.normals = Normals::none;  // not counted: one per vertex
  if constexpr (N == 5) {
    return extract_in_5d<float>(image, division, isovalue, options, periods, nullptr).size;
  } else {
    if (!any_periodic<N>(periods)) return count(divided_complex(image, division, isovalue), isovalue, options);
    const Contour<N, float> contour = extract_stored<float>(image, division, isovalue, options, periods).contour;
    return {contour.vertices.size(), contour.simplices.size()};
  }
}

#define TEGL_INSTANTIATE_DIVIDE(T, N)                                                               \
  template detail::DividedImage<N> detail::divide_image<T, N>(const Image<T, N>&, Division, double, \
                                                              const AxisPeriods<N>&);
#define TEGL_INSTANTIATE(T)                                                        \
  TEGL_INSTANTIATE_DIVIDE(T, 2)                                                    \
  TEGL_INSTANTIATE_DIVIDE(T, 3)                                                    \
  TEGL_INSTANTIATE_DIVIDE(T, 4)                                                    \
  template Complex<2> divided_complex<T, 2>(const Image<T, 2>&, Division, double); \
  template Complex<3> divided_complex<T, 3>(const Image<T, 3>&, Division, double); \
  template Complex<4> divided_complex<T, 4>(const Image<T, 4>&, Division, double);
#include "base/instantiate.hpp"
#undef TEGL_INSTANTIATE_DIVIDE

template void detail::check_division_arguments<2>(const Grid<2>&, Division, double, const ExtractOptions&,
                                                  const AxisPeriods<2>&);
template void detail::check_division_arguments<3>(const Grid<3>&, Division, double, const ExtractOptions&,
                                                  const AxisPeriods<3>&);
template void detail::check_division_arguments<4>(const Grid<4>&, Division, double, const ExtractOptions&,
                                                  const AxisPeriods<4>&);

#define TEGL_INSTANTIATE_DIMENSIONS(T, N)                                                                              \
  template Extraction<N, float> extract_divided_with_stats<float, T, N>(const Image<T, N>&, Division, double,          \
                                                                        const ExtractOptions&, const AxisPeriods<N>&); \
  template Extraction<N, double> extract_divided_with_stats<double, T, N>(                                             \
      const Image<T, N>&, Division, double, const ExtractOptions&, const AxisPeriods<N>&);                             \
  template ContourSize count_divided<T, N>(const Image<T, N>&, Division, double, const ExtractOptions&,                \
                                           const AxisPeriods<N>&);
#include "base/instantiate.hpp"

}  // namespace tegl
