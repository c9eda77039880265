// SPDX-License-Identifier: BSD-3-Clause
#include "cut/periodic_cut.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/workers.hpp"
#include "tegl/slice.hpp"

namespace tegl {

double place_in_period(double place, double first, double period) {
  if (!std::isfinite(place) || !(period > 0.0) || !std::isfinite(period)) return place;
  const double moved = place - std::floor((place - first) / period) * period;
  return moved >= first + period ? first : std::max(moved, first);
}

template <int N>
requires DimensionBetween<N, 3, 5>
bool cuts_wrapped(std::type_identity_t<std::span<const Period<N>>> periods, const Hyperplane<N>& hyperplane) {
  const detail::CrossedPeriods crossed =
      detail::crossed_periods<N>(detail::HyperplaneFamily<N>(hyperplane.normal), periods);
  return crossed.count == 0 || crossed.is_modulo;
}

template <int N>
requires DimensionBetween<N, 2, 5> std::optional<std::size_t> period_along(
    std::type_identity_t<std::span<const Vector<N>>> vectors, int axis) {
  constexpr double kRounding = 1e-9;  // of squares
  const auto inner = [](const Vector<N>& v, const Vector<N>& w) {
    double sum = 0.0;
    for (int a = 0; a < N; ++a) sum += v[a] * w[a];
    return sum;
  };
  std::optional<std::size_t> found;
  std::vector<Vector<N>> others;  // orthogonal, of length 1
  const auto take_out_others = [&](Vector<N>& v) {
    for (const Vector<N>& other : others) {
      const double share = inner(v, other);
      for (int a = 0; a < N; ++a) v[a] -= share * other[a];
    }
  };
  for (std::size_t p = 0; p < vectors.size(); ++p) {
    Vector<N> v = vectors[p];
    const double length = inner(v, v);
    if (v[axis] * v[axis] > kRounding * length) {
      if (found) return std::nullopt;
      found = p;
      continue;
    }
    take_out_others(v);
    const double left = inner(v, v);
    if (!(left > kRounding * length)) continue;
    for (int a = 0; a < N; ++a) v[a] /= std::sqrt(left);
    others.push_back(v);
  }
  if (!found) return std::nullopt;
  Vector<N> rest = vectors[*found];
  const double length = inner(rest, rest);
  rest[axis] = 0.0;
  take_out_others(rest);
  return inner(rest, rest) <= kRounding * length ? found : std::nullopt;
}

template std::optional<std::size_t> period_along<2>(std::span<const Vector<2>>, int);
template std::optional<std::size_t> period_along<3>(std::span<const Vector<3>>, int);
template std::optional<std::size_t> period_along<4>(std::span<const Vector<4>>, int);
template std::optional<std::size_t> period_along<5>(std::span<const Vector<5>>, int);

template bool cuts_wrapped<3>(std::span<const Period<3>>, const Hyperplane<3>&);
template bool cuts_wrapped<4>(std::span<const Period<4>>, const Hyperplane<4>&);
template bool cuts_wrapped<5>(std::span<const Period<5>>, const Hyperplane<5>&);

namespace detail {

template <int N>
double place_modulo(const HyperplaneFamily<N>& family, const Period<N>& period, double offset) {
  const double along = period.vector[family.dropped_axis()];
  const double start =
      period.start * along;  // <dual, x> = start here, if the dual vector has the direction of the axis
  return place_in_period(family.sign() * family.template level<double>(offset), std::min(start, start + along),
                         std::abs(along));
}

template double place_modulo(const HyperplaneFamily<3>&, const Period<3>&, double);
template double place_modulo(const HyperplaneFamily<4>&, const Period<4>&, double);
template double place_modulo(const HyperplaneFamily<5>&, const Period<5>&, double);

namespace {

template <int N, class Real>
class Mover {
 public:
  Mover(const Contour<N, Real>& contour, std::size_t period, int axis, std::span<const double> places,
        const WorkOptions& work)
      : contour_(contour),
        period_(contour.periods[period]),
        axis_(axis),
        places_(places),
        work_(work),
        shares_(contour.vertices.size()) {}

  Contour<N, Real> run(std::size_t period) {
    find_shares();
    find_simplices();
    number_vertices();
    Contour<N, Real> result = moved();
    result.periods = contour_.periods;
    result.periods.erase(result.periods.begin() + static_cast<std::ptrdiff_t>(period));
    return result;
  }

 private:
  using Vertex = typename Contour<N, Real>::Vertex;
  using Key = std::uint64_t;  ///< a vertex and how many periods it moves, in this order
  struct Found {
    Index simplex;
    std::array<Key, N> corners;
  };

  static constexpr std::int64_t kZero = std::int64_t{1} << 31;  ///< the lower half of the key of a vertex that stays
  static constexpr std::int64_t kFarthest = kZero / 4;  ///< of a vertex from the first period, so that keys have room
  static constexpr std::size_t kBlock = std::size_t{1} << 14;  ///< simplices of a part of the work

  static Key key_of(Index vertex, std::int64_t times) { return Key{vertex} << 32 | static_cast<Key>(times + kZero); }
  static Index vertex_of(Key key) { return static_cast<Index>(key >> 32); }
  static double times_of(Key key) { return static_cast<double>(static_cast<std::int64_t>(key & 0xffffffffu) - kZero); }
  static std::int64_t whole(double times) { return static_cast<std::int64_t>(times); }

  /// The coordinate along `axis` of a vertex that is moved.
  [[nodiscard]] Real coordinate(Index v, double times, int axis) const {
    const Real x = contour_.vertices[v][axis];
    return times == 0.0 ? x : static_cast<Real>(static_cast<double>(x) + times * period_.vector[axis]);
  }

  /// By the axis, along which the period is: so corners that are moved next to each other are within a period, whatever
  /// the period's dual vector is.
  void find_shares() {
    const double along = period_.vector[axis_];
    for_each_item(shares_.size(), work_.threads, {},
                  [&](std::size_t v) { shares_[v] = static_cast<double>(contour_.vertices[v][axis_]) / along; });
    const auto far = std::find_if_not(shares_.begin(), shares_.end(), [&](double share) {
      return std::abs(share - period_.start) <= static_cast<double>(kFarthest);
    });
    if (far == shares_.end()) return;
    const auto v = static_cast<std::size_t>(far - shares_.begin());
    throw Error(
        ErrorCode::InvalidArgument,
        fmt::format("vertex {} has the coordinate {} along axis {}, with the period {} from {}; expected at most "
                    "{} periods from there",
                    v, contour_.vertices[v][axis_], axis_, std::abs(along), period_.start * along, kFarthest));
  }

  void find_simplices() {
    const std::size_t count = contour_.simplices.size();
    std::vector<std::vector<Found>> parts(block_count(count, kBlock));
    for_each_block(count, kBlock, work_.threads, work_.progress,
                   [&](std::size_t block, std::size_t from, std::size_t to) {
                     for (std::size_t s = from; s < to; ++s) find_moves(s, parts[block]);
                   });
    for (const std::vector<Found>& part : parts) found_.insert(found_.end(), part.begin(), part.end());
  }

  /// Appends the simplex once for each multiple of the period by which it touches a place.
  void find_moves(std::size_t s, std::vector<Found>& found) const {
    const auto& simplex = contour_.simplices[s];
    std::array<std::int64_t, N> apart;  // by corner: the periods to the place next to corner 0
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int j = 0; j < N; ++j) {
      apart[j] = whole(std::round(shares_[simplex[0]] - shares_[simplex[j]]));
      const auto x = static_cast<double>(coordinate(simplex[j], static_cast<double>(apart[j]), axis_));
      low = std::min(low, x);
      high = std::max(high, x);
    }
    // one more at both ends, as coordinates are rounded
    const double along = period_.vector[axis_];
    const auto [from, to] = std::minmax({(places_.front() - high) / along, (places_.front() - low) / along,
                                         (places_.back() - high) / along, (places_.back() - low) / along});
    const std::int64_t last = whole(std::floor(to)) + 1;
    for (std::int64_t times = whole(std::ceil(from)) - 1; times <= last; ++times) {
      low = std::numeric_limits<double>::infinity();
      high = -low;
      for (int j = 0; j < N; ++j) {
        const auto x = static_cast<double>(coordinate(simplex[j], static_cast<double>(times + apart[j]), axis_));
        low = std::min(low, x);
        high = std::max(high, x);
      }
      const auto place = std::lower_bound(places_.begin(), places_.end(), low);
      if (place == places_.end() || *place > high) continue;
      Found& one = found.emplace_back(Found{static_cast<Index>(s), {}});
      for (int j = 0; j < N; ++j) one.corners[j] = key_of(simplex[j], times + apart[j]);
    }
  }

  void number_vertices() {
    keys_.reserve(found_.size() * N);
    for (const Found& one : found_) keys_.insert(keys_.end(), one.corners.begin(), one.corners.end());
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    constexpr std::size_t kMost = std::numeric_limits<Index>::max();
    if (keys_.size() > kMost || found_.size() > kMost)
      throw Error(ErrorCode::TooLarge,
                  fmt::format("{} simplices beside cuts across a period; expected at most {}", found_.size(), kMost));
  }

  [[nodiscard]] Contour<N, Real> moved() const {
    Contour<N, Real> result;
    result.axis_names = contour_.axis_names;
    result.axis_units = contour_.axis_units;
    result.direction = contour_.direction;
    result.vertices.resize(keys_.size());
    result.simplices.resize(found_.size());
    for_each_item(keys_.size(), work_.threads, {}, [&](std::size_t i) {
      for (int a = 0; a < N; ++a) result.vertices[i][a] = coordinate(vertex_of(keys_[i]), times_of(keys_[i]), a);
    });
    for_each_item(found_.size(), work_.threads, {}, [&](std::size_t i) {
      for (int j = 0; j < N; ++j)
        result.simplices[i][j] =
            static_cast<Index>(std::lower_bound(keys_.begin(), keys_.end(), found_[i].corners[j]) - keys_.begin());
    });
    if (!contour_.normals.empty())
      for (const Key key : keys_) result.normals.push_back(contour_.normals[vertex_of(key)]);
    const auto rows = [](const std::vector<Attribute>& attributes, const auto& items, const auto& row_of) {
      std::vector<Attribute> copies;
      for (const Attribute& attribute : attributes) {
        Attribute& copy = copies.emplace_back(Attribute{attribute.name, attribute.unit, attribute.width, {}});
        const auto width = static_cast<std::size_t>(attribute.width);
        for (const auto& item : items) {
          const double* const row = attribute.values.data() + row_of(item) * width;
          copy.values.insert(copy.values.end(), row, row + width);
        }
      }
      return copies;
    };
    result.vertex_attributes = rows(contour_.vertex_attributes, keys_, [](Key key) { return vertex_of(key); });
    result.simplex_attributes =
        rows(contour_.simplex_attributes, found_, [](const Found& one) { return std::size_t{one.simplex}; });
    return result;
  }

  const Contour<N, Real>& contour_;
  const Period<N>& period_;
  const int axis_;
  const std::span<const double> places_;
  const WorkOptions& work_;
  Buffer<double> shares_;
  std::vector<Found> found_;
  std::vector<Key> keys_;  ///< of the vertices of the result, ascending
};

}  // namespace

template <int N, class Real>
Contour<N, Real> moved_to_places(const Contour<N, Real>& contour, std::size_t period, int axis,
                                 std::span<const double> places, const WorkOptions& work) {
  return Mover<N, Real>(contour, period, axis, places, work).run(period);
}

#define TEGL_INSTANTIATE_MOVED(N, Real)                                                                         \
  template Contour<N, Real> moved_to_places(const Contour<N, Real>&, std::size_t, int, std::span<const double>, \
                                            const WorkOptions&);
TEGL_INSTANTIATE_MOVED(3, float)
TEGL_INSTANTIATE_MOVED(3, double)
TEGL_INSTANTIATE_MOVED(4, float)
TEGL_INSTANTIATE_MOVED(4, double)
TEGL_INSTANTIATE_MOVED(5, float)
TEGL_INSTANTIATE_MOVED(5, double)
#undef TEGL_INSTANTIATE_MOVED

}  // namespace detail
}  // namespace tegl
