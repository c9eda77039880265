// SPDX-License-Identifier: BSD-3-Clause
//
// Converts the result of a reader to an image of the library's value types and dimensions.
#include "base/raw_image.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include <Eigen/LU>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace {

template <class T>
constexpr bool kIsWide =
    std::is_same_v<T, std::uint32_t> || std::is_same_v<T, std::int64_t> || std::is_same_v<T, std::uint64_t>;

template <class To, class From>
ValueVector<To> converted(const ValueVector<From>& from) {
  ValueVector<To> to(from.size());
  std::transform(from.begin(), from.end(), to.begin(), [](From value) { return static_cast<To>(value); });
  return to;
}

template <class T>
bool fits_int32(const ValueVector<T>& values) {
  constexpr std::int64_t kMax = std::numeric_limits<std::int32_t>::max();
  return std::all_of(values.begin(), values.end(), [](T value) {
    if constexpr (std::is_signed_v<T>) return value >= -kMax - 1 && value <= kMax;
    return value <= static_cast<T>(kMax);
  });
}

template <int N>
AnyImageN<N> with_dimension(RawImage&& image) {
  const Grid<N> grid = fixed_grid<N>(image.grid);
  return std::visit(
      [&]<class T>(ValueVector<T>& values) -> AnyImageN<N> {
        if constexpr (!kIsWide<T>) {
          return OwnedImage<T, N>{grid, std::move(values)};
        } else {
          if (fits_int32(values)) return OwnedImage<std::int32_t, N>{grid, converted<std::int32_t>(values)};
          return OwnedImage<double, N>{grid, converted<double>(values)};
        }
      },
      image.values);
}

/// Whether axis a is not coupled with other axes: its row and column are zero off the diagonal.
bool is_decoupled(const Eigen::MatrixXd& matrix, Eigen::Index a) {
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    if (i != a && (matrix(i, a) != 0.0 || matrix(a, i) != 0.0)) return false;
  return true;
}

/// Throws unless all samples have finite coordinates, along the axes and in the world.
void require_finite_samples(const RawGrid& grid, const std::filesystem::path& path) {
  const auto n = static_cast<Eigen::Index>(grid.axes.size());
  Eigen::VectorXd farthest(n);
  for (Eigen::Index a = 0; a < n; ++a) {
    const Axis& axis = grid.axes[static_cast<std::size_t>(a)];
    const double last = axis[axis.size() - 1];
    if (!std::isfinite(last))
      fail(ErrorCode::MalformedFile, path,
           "axis {} of {} samples from {} in steps of {} ends at {}; expected a finite coordinate", a, axis.size(),
           axis[0], axis.step(), last);
    farthest(a) = std::max(std::abs(axis[0]), std::abs(last));
  }
  const Eigen::VectorXd reach = grid.linear.cwiseAbs() * farthest + grid.offset.cwiseAbs();
  if (!reach.allFinite())
    fail(ErrorCode::MalformedFile, path,
         "the corners of the image lie up to {} from the origin; expected finite coordinates", reach.maxCoeff());
}

}  // namespace

RawGrid affine_grid(const std::vector<std::size_t>& sizes, const Eigen::MatrixXd& affine, const Eigen::VectorXd& offset,
                    const std::filesystem::path& path) {
  const auto n = static_cast<Eigen::Index>(sizes.size());
  if (!affine.allFinite() || !offset.allFinite())
    fail(ErrorCode::MalformedFile, path, "orientation with an entry that is not finite; expected finite numbers");
  RawGrid grid{{}, Eigen::MatrixXd::Identity(n, n), Eigen::VectorXd::Zero(n), {}};
  for (Eigen::Index a = 0; a < n; ++a) {
    const bool decoupled = is_decoupled(affine, a);
    const double step = decoupled ? affine(a, a) : affine.col(a).norm();
    if (step == 0.0 || !std::isfinite(step))
      fail(ErrorCode::MalformedFile, path, "axis {} has a step of {}; expected a finite step other than 0", a, step);
    grid.axes.push_back(Axis::uniform(sizes[static_cast<std::size_t>(a)], decoupled ? offset(a) : 0.0, step));
    if (decoupled) continue;
    grid.linear.col(a) = affine.col(a) / step;
    grid.offset(a) = offset(a);
  }
  constexpr double kSmallestVolume = 1e-9;  // of the parallelepiped of unit columns; below it axes nearly coincide
  if (!(std::abs(grid.linear.determinant()) > kSmallestVolume))
    fail(ErrorCode::MalformedFile, path, "orientation of determinant {}; expected axes in independent directions",
         grid.linear.determinant());
  require_finite_samples(grid, path);
  return grid;
}

void name_axes(RawGrid& grid) {
  constexpr std::array<const char*, 5> kNames = {"x", "y", "z", "t", "u"};
  for (std::size_t a = 0; a < std::min(grid.axes.size(), kNames.size()); ++a)
    if (grid.axes[a].name.empty()) grid.axes[a].name = kNames[a];
}

Axis axis_of(const std::vector<double>& coordinates) {
  const std::size_t n = coordinates.size();
  const double step = coordinates[1] - coordinates[0];
  bool uniform = true;
  for (std::size_t i = 0; i < n; ++i)
    uniform = uniform && coordinates[i] == coordinates[0] + static_cast<double>(i) * step;
  return uniform ? Axis::uniform(n, coordinates[0], step) : Axis::rectilinear(coordinates);
}

RawGrid with_last_axis(const RawGrid& grid, Axis last) {
  const auto n = static_cast<Eigen::Index>(grid.axes.size());
  RawGrid result{grid.axes, Eigen::MatrixXd::Identity(n + 1, n + 1), Eigen::VectorXd::Zero(n + 1), {}};
  result.axes.push_back(std::move(last));
  result.linear.topLeftCorner(n, n) = grid.linear;
  result.offset.head(n) = grid.offset;
  return result;
}

void drop_trailing_axes(RawGrid& grid, ImageInfo& info) {
  while (grid.axes.size() > 2 && grid.axes.back().size() == 1) {
    const auto left = static_cast<Eigen::Index>(grid.axes.size()) - 1;
    const bool decoupled = grid.linear.col(left).head(left).isZero(0.0) && grid.linear.row(left).head(left).isZero(0.0);
    Axis single = std::move(grid.axes.back());
    grid.axes.pop_back();
    if (decoupled) {
      Axis world = Axis::uniform(1, grid.linear(left, left) * single[0] + grid.offset(left));
      world.name = std::move(single.name);
      world.unit = std::move(single.unit);
      grid.single.push_back({std::move(world)});
      grid.linear = grid.linear.topLeftCorner(left, left).eval();
      grid.offset = grid.offset.head(left).eval();
    } else {
      grid.linear = Eigen::MatrixXd::Identity(left, left);
      grid.offset = Eigen::VectorXd::Zero(left);
      info.world_frame.clear();
    }
  }
}

std::optional<Lattice> lattice_of_text(std::string_view name, const std::filesystem::path& path) {
  if (name.empty() || name == "cubic") return std::nullopt;
  const std::optional<Lattice> lattice = parse_lattice(name);
  if (!lattice)
    fail(ErrorCode::MalformedFile, path, "{} is {}; expected cubic, triangular, fcc, bcc, d4 or fcc_in_time",
         kLatticeKey, shown(name));
  return lattice;
}

void settle_lattice(const RawGrid& grid, ImageInfo& info, const std::filesystem::path& path) {
  if (!info.lattice) return;
  const auto axes = static_cast<int>(grid.axes.size());
  if (info.lattice == Lattice::fcc_in_time && axes == 3) info.lattice = Lattice::fcc;
  if (dimension(*info.lattice) != axes)
    fail(ErrorCode::UnsupportedData, path, "has the lattice {}, and is read as an image of {} axes; expected {}",
         name_of(*info.lattice), axes, dimension(*info.lattice));
}

void fail_axes(const RawGrid& grid, const ImageInfo& info, const std::filesystem::path& path) {
  std::vector<std::size_t> sizes;
  for (const Axis& axis : grid.axes) sizes.push_back(axis.size());
  std::string hint;  // the axes of netCDF have names; the fourth may be fixed
  if (info.format == "netCDF" && sizes.size() > 4)
    hint = fmt::format(", or a fixed index of another dimension, such as {}=0", grid.axes[3].name);
  fail(ErrorCode::UnsupportedData, path,
       "image of {} axes ({}); expected 2, 3 or 4 axes of more than one sample ({}){}", sizes.size(), shape_text(sizes),
       kMoreAxes, hint);
}

AnyImage to_any_image(RawImage&& image, const std::filesystem::path& path) {
  switch (image.grid.axes.size()) {
    case 2:
      return with_dimension<2>(std::move(image));
    case 3:
      return with_dimension<3>(std::move(image));
    case 4:
      return with_dimension<4>(std::move(image));
    default:
      fail_axes(image.grid, image.info, path);
  }
}

AnyImage5d to_image_5d(RawImage&& image) {
  const Grid<5> grid = fixed_grid<5>(image.grid);
  return std::visit(
      [&]<class T>(ValueVector<T>& values) -> AnyImage5d {
        using To = std::conditional_t<std::is_same_v<T, float> || sizeof(T) <= 2, float, double>;
        if constexpr (std::is_same_v<T, To>)
          return OwnedImage<To, 5>{grid, std::move(values)};
        else
          return OwnedImage<To, 5>{grid, converted<To>(values)};
      },
      image.values);
}

const char* type_name(const ValueArray& values) noexcept {
  constexpr std::array<const char*, 10> kNames = {"uint8", "int8",   "uint16", "int16", "int32",
                                                  "float", "double", "uint32", "int64", "uint64"};
  return kNames[values.index()];
}

ValueArray array_of_type(std::string_view name) {
  const auto search = [&]<std::size_t... I>(std::index_sequence<I...>) {
    ValueArray found;
    const auto try_one = [&](ValueArray candidate) {
      const bool matches = type_name(candidate) == name;
      if (matches) found = std::move(candidate);
      return matches;
    };
    if (!(try_one(ValueArray(std::in_place_index<I>)) || ...))
      throw Error(ErrorCode::InvalidArgument, fmt::format("no value type '{}'", name));
    return found;
  };
  return search(std::make_index_sequence<std::variant_size_v<ValueArray>>());
}

ValueArray with_axis_last(const ValueArray& values, std::size_t inner, std::size_t count, std::size_t outer) {
  return std::visit(
      [&]<class T>(const ValueVector<T>& from) -> ValueArray {
        ValueVector<T> to(from.size());
        for (std::size_t o = 0; o < outer; ++o)
          for (std::size_t i = 0; i < count; ++i)
            std::copy_n(from.begin() + static_cast<std::ptrdiff_t>((o * count + i) * inner), inner,
                        to.begin() + static_cast<std::ptrdiff_t>((i * outer + o) * inner));
        return to;
      },
      values);
}

ValueArray with_axes_reversed(const ValueArray& values, const std::vector<std::size_t>& sizes) {
  constexpr std::size_t kBlock = 32;
  const std::size_t n = sizes.size(), first = sizes.front(), last = sizes.back();
  std::size_t inner = first;  // distance of neighbours along the last axis: before, and (outer) along the first: after
  for (std::size_t a = 1; a + 1 < n; ++a) inner *= sizes[a];
  const std::size_t middle = inner / first, outer = middle * last;
  // The index of the middle axes in reverse order.
  const auto reversed = [&](std::size_t index) {
    std::size_t result = 0;
    for (std::size_t a = 1; a + 1 < n; ++a) {
      result = result * sizes[a] + index % sizes[a];
      index /= sizes[a];
    }
    return result;
  };
  return std::visit(
      [&]<class T>(const ValueVector<T>& from) -> ValueArray {
        ValueVector<T> to(from.size());
        for (std::size_t m = 0; m < middle; ++m) {
          const T* const source = from.data() + m * first;
          T* const target = to.data() + reversed(m) * last;
          for (std::size_t z = 0; z < last; z += kBlock)
            for (std::size_t x = 0; x < first; x += kBlock)
              for (std::size_t i = x; i < std::min(first, x + kBlock); ++i)
                for (std::size_t j = z; j < std::min(last, z + kBlock); ++j)
                  target[i * outer + j] = source[j * inner + i];
        }
        return to;
      },
      values);
}

}  // namespace tegl::io_detail
