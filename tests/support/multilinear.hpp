// SPDX-License-Identifier: BSD-3-Clause
//
// The exact topology of {f = 0} for the piecewise bilinear (2D) or trilinear (3D) interpolant f of samples: an oracle
// for contours. It shares neither code nor method with the library.
//
// A cube is swept along one of its axes. In each plane across that axis f is bilinear. The part of a square where a
// bilinear function is >= 0 consists of contractible components, each of which contains a corner of the square (its
// extremes over a component lie at corners). The signs of the four corners determine the components; if high corners
// lie on a diagonal, the sign of q = f00 f11 - f10 f01 does too. Along the sweep the corners are linear and q is
// quadratic. So the cube is a stack of finitely many levels, at which one of them vanishes, and of slabs between
// levels, in which no sign changes. All signs are computed in integer arithmetic.
//
// Euler characteristics follow from the stack by additivity: a level counts as its slice, an open slab as minus its
// slice. Union-find over (layer, corner) gives the components of the cube. Components in a field meet in samples, as
// each has a corner in every cube that it enters. The result must not depend on the sweep's axis: tests compare all
// three.
//
// Based on: Etiene, Nonato, Scheidegger, Tierny, Peters, Pascucci, Kirby and Silva, Topology verification for
// isosurface extraction, 2012, for the properties to verify; their oracles are digital topology and stratified Morse
// theory.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <ostream>
#include <stdexcept>
#include <utility>
#include <vector>

namespace tegl::test {

/// Euler characteristic and number of components.
struct Topology {
  std::int64_t components = 0;
  std::int64_t euler = 0;
  bool operator==(const Topology&) const = default;
};

inline std::ostream& operator<<(std::ostream& out, const Topology& topology) {
  return out << topology.components << " components, Euler characteristic " << topology.euler;
}

/// Disjoint sets of numbers (union-find).
class Pieces {
 public:
  explicit Pieces(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t find(std::size_t x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  void join(std::size_t x, std::size_t y) { parent_[find(x)] = find(y); }

 private:
  std::vector<std::size_t> parent_;
};

__extension__ using Wide = __int128;

/// Maximum magnitude of a sample: then all signs fit in 128 bits.
inline constexpr std::int64_t kLargestSample = std::int64_t{1} << 29;

inline int sign_of(Wide x) { return (x > 0) - (x < 0); }

/// Signs of the corners of a square, in the order 00, 10, 01, 11, and of q.
struct Slice {
  std::array<int, 4> corners{};
  int q = 0;
};

/// The part of a slice with f >= 0.
struct SlicePart {
  std::array<bool, 4> has{};
  bool joined = false;  ///< if only two corners on a diagonal are in the part: whether they are connected

  explicit SlicePart(const Slice& slice) {
    for (int v = 0; v < 4; ++v) has[v] = slice.corners[v] >= 0;
    // The value at the saddle is q divided by a number that is positive if 00 and 11 are high and the others low,
    // negative in the opposite case.
    if (has[0] && has[3] && !has[1] && !has[2]) joined = slice.q >= 0;
    if (has[1] && has[2] && !has[0] && !has[3]) joined = slice.q <= 0;
  }
  /// Calls join(v, w) for pairs of corners that connect each component.
  template <class Join>
  void for_each_join(const Join& join) const {
    constexpr std::array<std::array<int, 2>, 4> kEdges{{{0, 1}, {2, 3}, {0, 2}, {1, 3}}};
    for (const auto& [v, w] : kEdges)
      if (has[v] && has[w]) join(v, w);
    if (joined) has[0] ? join(0, 3) : join(1, 2);
  }
  [[nodiscard]] int components() const {
    Pieces pieces(4);
    int count = has[0] + has[1] + has[2] + has[3];
    for_each_join([&](int v, int w) {
      count -= pieces.find(static_cast<std::size_t>(v)) != pieces.find(static_cast<std::size_t>(w));
      pieces.join(static_cast<std::size_t>(v), static_cast<std::size_t>(w));
    });
    return count;
  }
};

/// a t^2 + b t + c.
struct Quadratic {
  Wide a = 0, b = 0, c = 0;

  [[nodiscard]] int sign_at(std::int64_t p, std::int64_t q) const { return sign_of((a * p + b * q) * p + c * q * q); }
  [[nodiscard]] int slope_at(std::int64_t p, std::int64_t q) const { return sign_of(2 * a * p + b * q); }
  /// The sign just after p / q (direction 1) or just before it (-1).
  [[nodiscard]] int sign_beside(std::int64_t p, std::int64_t q, int direction) const {
    if (const int here = sign_at(p, q)) return here;
    if (const int slope = slope_at(p, q)) return direction * slope;
    return sign_of(a);
  }
};

/// A cube as a stack of slices along one axis: levels at even positions, slabs between them at odd ones.
class Stack {
 public:
  /// `corners`: corner v of the cube has coordinate v >> a & 1 on axis a. Throws std::invalid_argument for samples
  /// beyond kLargestSample.
  Stack(const std::array<std::int64_t, 8>& corners, int axis) {
    constexpr std::array<std::array<int, 2>, 3> kOthers{{{1, 2}, {0, 2}, {0, 1}}};
    for (int v = 0; v < 4; ++v) {
      place_[v] = (v & 1) << kOthers[axis][0] | (v >> 1) << kOthers[axis][1];
      start_[v] = corners[place_[v]];
      slope_[v] = corners[place_[v] | 1 << axis] - start_[v];
      for (const std::int64_t value : {start_[v], start_[v] + slope_[v]})
        if (value < -kLargestSample || value > kLargestSample)
          throw std::invalid_argument("oracle: a sample too large");
    }
    along_ = 1 << axis;
    const auto product = [&](int v, int w) {
      return Quadratic{Wide{slope_[v]} * slope_[w], Wide{start_[v]} * slope_[w] + Wide{slope_[v]} * start_[w],
                       Wide{start_[v]} * start_[w]};
    };
    const Quadratic even = product(0, 3), odd = product(1, 2);
    q_ = {even.a - odd.a, even.b - odd.b, even.c - odd.c};
    build();
  }

  [[nodiscard]] const std::vector<Slice>& layers() const { return layers_; }
  /// True if no sample is 0 and no critical value of f in the cube or in its squares at the ends is 0.
  [[nodiscard]] bool regular() const { return regular_; }

  /// The part with f >= 0: returns its Euler characteristic; reports corners in one component through join(v, w).
  template <class Join>
  int high_part(const Join& join) const {
    int euler = 0;
    Pieces pieces(4 * layers_.size());
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const SlicePart here(layers_[i]);
      euler += (i % 2 == 0 ? 1 : -1) * here.components();
      here.for_each_join(
          [&](int v, int w) { pieces.join(4 * i + static_cast<std::size_t>(v), 4 * i + static_cast<std::size_t>(w)); });
      if (i == 0) continue;
      const SlicePart before(layers_[i - 1]);
      for (std::size_t v = 0; v < 4; ++v)
        if (here.has[v] && before.has[v]) pieces.join(4 * i + v, 4 * i - 4 + v);
    }
    report(pieces, join);
    return euler;
  }

 private:
  struct Level {
    std::int64_t p = 0, q = 1;
  };

  [[nodiscard]] std::array<int, 4> corners_at(const Level& at) const {
    std::array<int, 4> signs{};
    for (int v = 0; v < 4; ++v) signs[v] = sign_of(Wide{start_[v]} * at.q + Wide{slope_[v]} * at.p);
    return signs;
  }

  /// True if f rises at all corners, or falls at all.
  [[nodiscard]] bool same_slopes() const {
    const auto rising = std::count_if(slope_.begin(), slope_.end(), [](std::int64_t s) { return s > 0; });
    const auto falling = std::count_if(slope_.begin(), slope_.end(), [](std::int64_t s) { return s < 0; });
    return rising == 4 || falling == 4;
  }

  void build() {
    std::vector<Level> levels{{0, 1}, {1, 1}};
    for (int v = 0; v < 4; ++v) {
      const std::int64_t p = slope_[v] > 0 ? -start_[v] : start_[v], q = slope_[v] > 0 ? slope_[v] : -slope_[v];
      if (0 < p && p < q) levels.push_back({p, q});
    }
    const auto before = [](const Level& x, const Level& y) { return Wide{x.p} * y.q < Wide{y.p} * x.q; };
    std::sort(levels.begin(), levels.end(), before);
    for (std::size_t i = 0; i < levels.size(); ++i) {
      if (i > 0) {
        if (!before(levels[i - 1], levels[i])) continue;
        add_between(levels[i - 1], levels[i]);
      }
      add(corners_at(levels[i]), q_.sign_at(levels[i].p, levels[i].q));
      const auto& corners = layers_.back().corners;
      const auto zeros = std::count(corners.begin(), corners.end(), 0);
      if (zeros == 4 && !same_slopes()) regular_ = false;
      if (zeros > 0 && (i == 0 || i + 1 == levels.size())) regular_ = false;
      if (layers_.back().q == 0 && is_diagonal()) regular_ = false;
    }
  }

  /// Adds the layers between two neighbouring roots of corners: the corners' signs are constant, the sign of q changes
  /// up to twice.
  void add_between(const Level& from, const Level& to) {
    const std::array<int, 4> corners = corners_at({from.p + to.p, from.q + to.q});
    const int first = q_.sign_beside(from.p, from.q, 1), last = q_.sign_beside(to.p, to.q, -1);
    add(corners, first);
    if (std::count(corners.begin(), corners.end(), 0) > 0) regular_ = false;
    if (is_diagonal() && first == 0) regular_ = false;
    if (first != last) {  // one root
      add(corners, 0);
      add(corners, last);
    } else if (sign_of(q_.a) != 0 && q_.slope_at(from.p, from.q) * q_.slope_at(to.p, to.q) < 0) {
      // The extreme of q lies between them: 4 a c - b^2 has the sign of a times the extreme value.
      const int extreme = sign_of(q_.a) * sign_of(4 * q_.a * q_.c - q_.b * q_.b);
      if (extreme == first) return;
      if (is_diagonal() && extreme == 0) regular_ = false;  // a critical point of f
      add(corners, 0);
      if (extreme != 0) {
        add(corners, extreme);
        add(corners, 0);
      }
      add(corners, last);
    }
  }

  void add(const std::array<int, 4>& corners, int q) { layers_.push_back({corners, q}); }
  [[nodiscard]] bool is_diagonal() const {
    const auto& c = layers_.back().corners;
    return c[0] * c[3] > 0 && c[1] * c[2] > 0 && c[0] * c[1] < 0;
  }

  /// Reports corners of the cube whose components meet in some layer.
  template <class Join>
  void report(Pieces& pieces, const Join& join) const {
    std::vector<std::pair<std::size_t, int>> found;
    for (const bool end : {false, true}) {
      const std::size_t layer = end ? layers_.size() - 1 : 0;
      const SlicePart here(layers_[layer]);
      for (std::size_t v = 0; v < 4; ++v)
        if (here.has[v]) found.emplace_back(pieces.find(4 * layer + v), place_[v] | (end ? along_ : 0));
    }
    std::sort(found.begin(), found.end());
    for (std::size_t i = 1; i < found.size(); ++i)
      if (found[i].first == found[i - 1].first) join(found[i - 1].second, found[i].second);
  }

  std::array<int, 4> place_{};  ///< corners of the cube in the slice at 0
  int along_ = 0;
  std::array<std::int64_t, 4> start_{}, slope_{};
  Quadratic q_;
  std::vector<Slice> layers_;
  bool regular_ = true;
};

/// Samples minus the isovalue, axis 0 fastest.
template <int N>
struct SampledField {
  std::array<std::size_t, N> sizes{};
  std::vector<std::int64_t> values;
};

/// Topology of a field's interpolant at level 0.
struct InterpolantTopology {
  bool regular = true;  ///< see Stack::regular; the other members are valid only if true
  Topology high;        ///< {f >= 0}
  Topology low;         ///< {f <= 0}
  Topology contour;     ///< {f = 0}: a manifold with boundary at the border of the field
  /// For each sample the representative of its high or low component. A critical edge connects a low to a high
  /// component: two edges meet the same component of the contour if they connect the same pair.
  std::vector<std::size_t> pieces;
};

namespace multilinear {

/// Euler characteristic and joins of the part with f >= 0 of a face with these corners (1, 2, 4 or 8 of them).
template <class Join>
int face_part(const std::vector<std::int64_t>& corners, int axis, bool& regular, const Join& join) {
  const auto in = [&](std::size_t v) { return corners[v] >= 0; };
  if (corners.size() == 1) {
    regular = regular && corners[0] != 0;
    return in(0);
  }
  if (corners.size() == 2) {
    if (in(0) && in(1)) join(0, 1);
    return in(0) || in(1);
  }
  if (corners.size() == 4) {
    Slice slice;
    for (std::size_t v = 0; v < 4; ++v) slice.corners[v] = sign_of(corners[v]);
    slice.q = sign_of(Wide{corners[0]} * corners[3] - Wide{corners[1]} * corners[2]);
    const auto& c = slice.corners;
    regular = regular && !(slice.q == 0 && c[0] * c[3] > 0 && c[0] * c[1] < 0);
    const SlicePart part(slice);
    part.for_each_join(join);
    return part.components();
  }
  const auto high = std::count_if(corners.begin(), corners.end(), [](std::int64_t value) { return value >= 0; });
  if (high == 0) return 0;
  std::array<std::int64_t, 8> cube{};
  std::copy_n(corners.begin(), 8, cube.begin());
  const Stack stack(cube, axis);
  regular = regular && stack.regular();
  return stack.high_part(join);
}

/// {f >= 0} of a field, by inclusion and exclusion over its cells and their common interior faces. Joins the samples of
/// each component.
template <int N>
Topology high_part(const SampledField<N>& field, int axis, Pieces& pieces, bool& regular) {
  Topology result;
  std::array<std::size_t, N> strides{}, at{};
  for (int a = 0; a < N; ++a) strides[a] = a == 0 ? 1 : strides[a - 1] * field.sizes[a - 1];
  std::vector<std::int64_t> corners;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < field.values.size(); ++i) {
    for (unsigned axes = 0; axes < 1u << N; ++axes) {
      bool fits = true, inside = true;
      for (int a = 0; a < N; ++a) {
        const bool free = (axes >> a & 1u) != 0;
        fits = fits && (!free || at[a] + 1 < field.sizes[a]);
        inside = inside && (free || (at[a] > 0 && at[a] + 1 < field.sizes[a]));
      }
      if (!fits) continue;
      places.assign(1, i);
      for (int a = 0; a < N; ++a)
        for (std::size_t k = 0, count = places.size(); (axes >> a & 1u) != 0 && k < count; ++k)
          places.push_back(places[k] + strides[a]);
      corners.clear();
      for (const std::size_t place : places) corners.push_back(field.values[place]);
      const int euler = face_part(corners, axis, regular, [&](int v, int w) {
        pieces.join(places[static_cast<std::size_t>(v)], places[static_cast<std::size_t>(w)]);
      });
      if (inside) result.euler += (N - __builtin_popcount(axes)) % 2 == 0 ? euler : -euler;
    }
    for (int a = 0; a < N && ++at[a] == field.sizes[a]; ++a) at[a] = 0;
  }
  for (std::size_t i = 0; i < field.values.size(); ++i)
    result.components += field.values[i] >= 0 && pieces.find(i) == i;
  return result;
}

}  // namespace multilinear

/// The topology of a field's interpolant at 0, computed by sweeps along `axis` (3D). A box is simply connected, so each
/// component of the contour separates it, and the graph of regions and contour components is a tree: there is one
/// component less than regions. The regions cover the box and intersect in the contour, so the Euler characteristics
/// add up. At least two samples along each axis.
template <int N>
requires(N == 2 || N == 3) InterpolantTopology interpolant_topology(const SampledField<N>& field, int axis = N - 1) {
  InterpolantTopology result;
  Pieces high(field.values.size()), low(field.values.size());
  result.high = multilinear::high_part<N>(field, axis, high, result.regular);
  SampledField<N> inverted = field;
  for (std::int64_t& value : inverted.values) value = -value;
  result.low = multilinear::high_part<N>(inverted, axis, low, result.regular);
  result.contour.components = result.high.components + result.low.components - 1;
  result.contour.euler = result.high.euler + result.low.euler - 1;
  if (result.high.components == 0 || result.low.components == 0) result.contour = {};
  for (std::size_t i = 0; i < field.values.size(); ++i)
    result.pieces.push_back(field.values[i] >= 0 ? high.find(i) : low.find(i));
  return result;
}

}  // namespace tegl::test
