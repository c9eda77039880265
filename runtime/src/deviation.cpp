// SPDX-License-Identifier: BSD-3-Clause
//
// How far every point of one contour is from another, simplex by simplex: parts are cut off along the faces of what
// they lie over, until nothing is left.
#include "tegl/deviation.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "box_tree.hpp"
#include "require.hpp"
#include "simplex_shapes.hpp"
#include "workers.hpp"

namespace tegl {
namespace detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A part may be farther from what it lies over than its corners and middle are from the nearest simplices, by this
/// factor, or by this share of the longest edge.
constexpr double kSlack = 1.5;
constexpr double kEdgeShare = 0.02;
/// If that is too little, by this factor more.
constexpr double kWider = 3.0;
/// More simplices at hand than these: a part is halved first; in 4D, where halving is of little help, left.
constexpr std::size_t kMostNear = 40;
constexpr int kMostHalvings = 12;
/// How often what nothing covers is halved, to measure it more closely.
template <int N>
constexpr int kUncoveredHalvings = N == 4 ? 2 : 10;
/// How much more than the distance of one of its points the bound of a part may be.
constexpr double kLooseness = 1.25;
/// Simplices that are flatter have no normal to speak of.
constexpr double kFlat = 1e-9;
/// Of the longest edge: at this distance and more, it is bounded well enough without any matching.
template <int N>
constexpr double kFarAway = N == 4 ? 0.25 : 0.7;
/// Of the content of a simplex: less that nothing covers is bounded by its size alone; still less is rounding.
constexpr double kCoverPrecision = 1e-7;
constexpr double kRounding = 1e-12;
/// No use in cutting on when what is left is in so many parts.
constexpr std::size_t kMostParts = 200;
/// Of the longest edge: nearer to a plane is on it. What is nearer than this share of that again is rounding.
constexpr double kOnPlane = 1e-10;
constexpr double kRoundingOfPlanes = 1e-3;
/// The largest bounds are measured again with more parts: those of so many simplices, and of this share of them.
constexpr std::size_t kMostRefined = 64;
constexpr std::size_t kRefinedShare = 400;
constexpr std::size_t kRefinedParts = 512;

void raise(double& value, double candidate) {
  std::atomic_ref<double> shared(value);
  double old = shared.load(std::memory_order_relaxed);
  while (candidate > old && !shared.compare_exchange_weak(old, candidate, std::memory_order_relaxed)) {
  }
}

/// Coordinates along a hyperplane, of D = N - 1 dimensions, and the height above it.
template <int N>
struct Frame {
  static constexpr int D = N - 1;
  std::array<PointN<N>, D> basis;
  PointN<N> normal;
  PointN<N> origin;

  /// `unit_normal` becomes the last of an orthonormal basis by the reflection that carries an axis to it.
  Frame(const PointN<N>& unit_normal, const PointN<N>& at) : normal(unit_normal), origin(at) {
    int longest = 0;
    for (int a = 1; a < N; ++a)
      if (std::abs(normal[a]) > std::abs(normal[longest])) longest = a;
    PointN<N> mirror = normal;
    mirror[longest] += normal[longest] > 0.0 ? 1.0 : -1.0;
    const double square = dot(mirror, mirror);
    for (int a = 0, k = 0; a < N; ++a) {
      if (a == longest) continue;
      for (int b = 0; b < N; ++b) basis[k][b] = (a == b ? 1.0 : 0.0) - 2.0 * mirror[a] * mirror[b] / square;
      ++k;
    }
  }
  [[nodiscard]] PointN<D> along(const PointN<N>& p) const {
    const PointN<N> way = minus(p, origin);
    PointN<D> result;
    for (int k = 0; k < D; ++k) result[k] = dot(way, basis[k]);
    return result;
  }
  [[nodiscard]] PointN<N> in_space(const PointN<D>& x) const {
    PointN<N> result = origin;
    for (int k = 0; k < D; ++k)
      for (int a = 0; a < N; ++a) result[a] += x[k] * basis[k][a];
    return result;
  }
};

/// What lies above and below a simplex, seen in a frame: N half-spaces, and the height over the frame as a linear
/// function.
template <int N>
struct Prism {
  static constexpr int D = N - 1;
  std::array<PointN<D>, N> normals;
  std::array<double, N> offsets;
  PointN<D> slope;
  double height_at_origin = 0;

  [[nodiscard]] double inside(int side, const PointN<D>& x) const { return dot(normals[side], x) - offsets[side]; }
  [[nodiscard]] double height(const PointN<D>& x) const { return height_at_origin + dot(slope, x); }

  /// False if the simplex does not face the same way as the frame.
  bool set(const Frame<N>& frame, const CornersN<N>& corners, const PointN<N>& normal) {
    const double up = dot(normal, frame.normal);
    if (!(up > 1e-9 * norm(normal))) return false;
    std::array<PointN<D>, N> flat;
    for (int i = 0; i < N; ++i) flat[i] = frame.along(corners[i]);
    for (int omitted = 0; omitted < N; ++omitted) {
      std::array<PointN<D>, D> face;
      for (int i = 0, k = 0; i < N; ++i)
        if (i != omitted) face[k++] = flat[i];
      PointN<D> m = normal_of<D>(face);
      double length = norm(m);
      if (!(length > 0.0)) return false;
      if (dot(m, minus(flat[omitted], face[0])) < 0.0) length = -length;
      for (double& x : m) x /= length;
      normals[omitted] = m;
      offsets[omitted] = dot(m, face[0]);
    }
    height_at_origin = dot(normal, minus(corners[0], frame.origin)) / up;
    for (int k = 0; k < D; ++k) slope[k] = -dot(normal, frame.basis[k]) / up;
    return true;
  }
};

/// The simplices of a contour, scaled.
template <int N>
struct Pieces {
  std::span<const std::array<Index, N>> simplices;
  std::vector<PointN<N>> points;
  std::vector<CornersN<N>> corners;
  std::vector<double> edges;  ///< the longest of each
  std::vector<PointN<N>> normals;

  template <class Real>
  Pieces(const Contour<N, Real>& contour, const std::array<double, N>& scale) : simplices(contour.simplices) {
    points.reserve(contour.vertices.size());
    for (const auto& vertex : contour.vertices) {
      PointN<N> point;
      for (int a = 0; a < N; ++a) point[a] = static_cast<double>(vertex[a]) * scale[a];
      points.push_back(point);
    }
    corners.reserve(contour.simplices.size());
    normals.reserve(contour.simplices.size());
    edges.reserve(contour.simplices.size());
    for (std::size_t s = 0; s < contour.simplices.size(); ++s) {
      CornersN<N> at;
      for (int i = 0; i < N; ++i) {
        const Index v = contour.simplices[s][i];
        at[i] = points[v];
      }
      corners.push_back(at);
      normals.push_back(normal_of<N>(at));
      edges.push_back(longest_edge<N>(at));
    }
  }
};

template <int N>
class Matcher {
 public:
  static constexpr int D = N - 1;
  using Part = std::array<PointN<D>, N>;
  /// A simplex that covers some of another, seen in the frame of that one.
  struct Match {
    Index simplex = 0;
    double height = 0.0;  ///< the largest over the part that it covers
    Prism<N> prism;
    Part flat;
    Box<D> box;
  };

  /// `of_vertices`: how far each vertex of `from` is from the nearest of `to`.
  Matcher(const Pieces<N>& from, const Pieces<N>& to, const BoxTree<N>& tree, const std::vector<double>& of_vertices,
          std::vector<double>& of_to)
      : from_(from), to_(to), tree_(tree), of_vertices_(of_vertices), of_to_(of_to) {}

  /// Bounds of simplex s; `least` is raised to a distance that is reached.
  double bound(Index s, double& least) {
    const CornersN<N>& corners = from_.corners[s];
    double nearest = 0.0;
    for (const Index v : from_.simplices[s]) nearest = std::max(nearest, of_vertices_[v]);
    least = std::max(least, nearest);
    bound_ = nearest;
    const double edge = from_.edges[s];
    const double length = norm(from_.normals[s]);
    // What is flat has no normal; what is far away needs none.
    if (shape_of_simplex<N>(corners, length) <= kFlat || nearest > kFarAway<N> * edge) {
      measure_uncovered(corners, 0);
      return bound_;
    }
    PointN<N> unit = from_.normals[s];
    for (double& x : unit) x /= length;
    const Frame<N> frame(unit, corners[0]);
    Part whole;
    for (int i = 0; i < N; ++i) whole[i] = frame.along(corners[i]);
    const double reach = reach_of(corners, edge, nearest);
    for (const double wider : {1.0, kWider})
      if (match_at_once(frame, s, whole, edge, wider * reach)) return bound_;
    match(frame, whole, kOnPlane * edge, 0);
    return bound_;
  }

  /// A bound of simplex s that took more pains: the part with the largest is halved until that is `enough`, or as long
  /// as is worth it.
  double refined_bound(Index s, double enough) const {
    const auto less = [](const Bounded& a, const Bounded& b) { return a.bound < b.bound; };
    std::vector<Bounded> parts{bound_of(from_.corners[s])};
    while (parts.front().bound > enough && parts.size() < kRefinedParts) {
      std::pop_heap(parts.begin(), parts.end(), less);
      const CornersN<N> worst = parts.back().part;
      parts.pop_back();
      for (const CornersN<N>& half : halves(worst)) {
        parts.push_back(bound_of(half));
        std::push_heap(parts.begin(), parts.end(), less);
      }
    }
    return parts.front().bound;
  }

 private:
  static CornersN<N> in_space(const Frame<N>& frame, const Part& part) {
    CornersN<N> result;
    for (int i = 0; i < N; ++i) result[i] = frame.in_space(part[i]);
    return result;
  }

  /// How far from a part its match may be, if its corners are no farther from the nearest than that.
  [[nodiscard]] double reach_of(const CornersN<N>& part, double edge, double nearest) const {
    PointN<N> middle{};
    for (const PointN<N>& corner : part)
      for (int a = 0; a < N; ++a) middle[a] += corner[a] / N;
    return kSlack * std::max(nearest, tree_.nearest(middle).distance) + kEdgeShare * edge;
  }

  /// The two halves of a simplex, across its longest edge.
  template <class Corners>
  static std::array<Corners, 2> halves(const Corners& part) {
    int first = 0, second = 1;
    double longest = -1.0;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < i; ++j) {
        const auto edge = minus(part[i], part[j]);
        if (dot(edge, edge) > longest) {
          longest = dot(edge, edge);
          first = j;
          second = i;
        }
      }
    std::array<Corners, 2> result = {part, part};
    result[0][second] = result[1][first] = between(part[first], part[second], 0.5);
    return result;
  }

  /// The usual case: what simplex s has in common with each near it, no two of which overlap, makes up the whole of it.
  bool match_at_once(const Frame<N>& frame, Index s, const Part& whole, double edge, double reach) {
    const CornersN<N>& corners = from_.corners[s];
    Box<N> box;
    for (const PointN<N>& corner : corners) box.add(corner);
    Prism<N> own;
    if (!own.set(frame, corners, from_.normals[s])) return false;
    double covered = 0.0, farthest = 0.0;
    matches_.clear();
    excess_ = 0.0;
    tree_.visit_near(box, reach, [&](Index t) {
      const double content = match_with(frame, own, whole, t, edge, reach);
      if (content > 0.0) farthest = std::max(farthest, matches_.back().height);
      covered += content;
    });
    const double all = content_of(whole);
    if (!(covered >= (1.0 - kCoverPrecision) * all) || !overlap_nowhere(kOnPlane * edge)) return false;
    // What nothing covers has at most this share of the content. From any point in it, the simplex drawn together
    // towards that point by the root of the share reaches what is covered, and distances grow no faster than the way.
    const double slab = D == 1 ? 1.0 : D == 2 ? 2.0 * edge : 6.0 * edge * edge;
    const double share = std::max(0.0, all - covered + slab * excess_) / all;
    if (!(share <= kCoverPrecision)) return false;
    const double gap = share <= kRounding ? 0.0 : edge * std::pow(share, 1.0 / D);
    bound_ = std::max(bound_, farthest + gap);
    for (const Match& match : matches_) raise(of_to_[match.simplex], match.height + gap);
    return true;
  }

  /// The content of what simplex t covers of the whole, which is noted as a match; 0 for none.
  double match_with(const Frame<N>& frame, const Prism<N>& own, const Part& whole, Index t, double edge, double reach) {
    const double on_plane = kOnPlane * edge;
    Match match;
    match.simplex = t;
    if (!match.prism.set(frame, to_.corners[t], to_.normals[t])) return 0.0;
    inside_.clear();
    outside_.clear();
    for (int i = 0; i < N; ++i) match.flat[i] = frame.along(to_.corners[t][i]);
    if (is_beside(match.prism, whole, on_plane) || is_beside(own, match.flat, on_plane)) return 0.0;
    const double excess = excess_;
    // The smaller of the two is cut by the sides of the larger.
    if (to_.edges[t] < edge)
      split(own, match.flat, 0, on_plane);
    else
      split(match.prism, whole, 0, on_plane);
    double content = 0.0;
    for (const Part& piece : inside_) {
      content += content_of(piece);
      for (const PointN<D>& x : piece) match.height = std::max(match.height, std::abs(match.prism.height(x)));
    }
    if (!(content > 0.0) || match.height > reach) {
      excess_ = excess;
      return 0.0;
    }
    for (const PointN<D>& x : match.flat) match.box.add(x);
    matches_.push_back(match);
    return content;
  }

  /// Whether no two matches have more in common than rounding makes; adds that to the excess.
  bool overlap_nowhere(double on_plane) {
    std::sort(matches_.begin(), matches_.end(), [](const Match& a, const Match& b) {
      return a.box.low[0] != b.box.low[0] ? a.box.low[0] < b.box.low[0] : a.simplex < b.simplex;
    });
    for (std::size_t i = 0; i < matches_.size(); ++i)
      for (std::size_t j = i + 1; j < matches_.size() && matches_[j].box.low[0] < matches_[i].box.high[0]; ++j) {
        const double depth = depth_of_overlap(matches_[i], matches_[j], on_plane);
        if (depth > on_plane) return false;
        if (depth > kRoundingOfPlanes * on_plane) excess_ += depth;
      }
    return true;
  }

  /// How wide the overlap of two matches is in some direction (0 or less: they do not overlap); in the first found in
  /// which it is no wider than `enough`. Two convex bodies without common inside are apart along a side of one or, in
  /// three dimensions, at right angles to an edge of each.
  static double depth_of_overlap(const Match& a, const Match& b, double enough) {
    double least = kInfinity;
    for (int k = 0; k < D; ++k) least = std::min({least, a.box.high[k] - b.box.low[k], b.box.high[k] - a.box.low[k]});
    for (int side = 0; side < N && least > enough; ++side) {
      double in_a = -kInfinity, in_b = -kInfinity;
      for (int i = 0; i < N; ++i) {
        in_a = std::max(in_a, a.prism.inside(side, b.flat[i]));
        in_b = std::max(in_b, b.prism.inside(side, a.flat[i]));
      }
      least = std::min({least, in_a, in_b});
    }
    if constexpr (D == 3)
      for (int i = 1; i < N && least > enough; ++i)
        for (int j = 0; j < i && least > enough; ++j)
          least = std::min(least, depth_across_edge(a, b, minus(a.flat[i], a.flat[j]), enough));
    return least;
  }

  /// The same in the directions at right angles to the given edge of one and to those of the other.
  static double depth_across_edge(const Match& a, const Match& b, const PointN<D>& edge, double enough) {
    double least = kInfinity;
    for (int i = 1; i < N && least > enough; ++i)
      for (int j = 0; j < i && least > enough; ++j) {
        const PointN<D> other = minus(b.flat[i], b.flat[j]);
        PointN<D> axis = {edge[1] * other[2] - edge[2] * other[1], edge[2] * other[0] - edge[0] * other[2],
                          edge[0] * other[1] - edge[1] * other[0]};
        const double length = norm(axis);
        if (!(length > 1e-6 * norm(edge) * norm(other))) continue;
        double low_a = kInfinity, high_a = -kInfinity, low_b = kInfinity, high_b = -kInfinity;
        for (int k = 0; k < N; ++k) {
          // From one origin, so that the place of the contour adds no rounding.
          const double at_a = dot(axis, minus(a.flat[k], a.flat[0])) / length;
          const double at_b = dot(axis, minus(b.flat[k], a.flat[0])) / length;
          low_a = std::min(low_a, at_a);
          high_a = std::max(high_a, at_a);
          low_b = std::min(low_b, at_b);
          high_b = std::max(high_b, at_b);
        }
        least = std::min({least, high_a - low_b, high_b - low_a});
      }
    return least;
  }

  /// Length, area or volume, times (N-1)!.
  static double content_of(const Part& part) {
    if constexpr (D == 1) {
      return std::abs(part[1][0] - part[0][0]);
    } else {
      std::array<PointN<D>, D> face;
      std::copy(part.begin() + 1, part.end(), face.begin());
      return std::abs(dot(normal_of<D>(face), minus(part[0], part[1])));
    }
  }

  void match(const Frame<N>& frame, const Part& part, double on_plane, int depth) {
    const CornersN<N> corners = in_space(frame, part);
    const double edge = longest_edge<N>(corners);
    double nearest = 0.0;
    for (const PointN<N>& corner : corners) nearest = std::max(nearest, tree_.nearest(corner).distance);
    const double reach = reach_of(corners, edge, nearest);
    Box<N> box;
    for (const PointN<N>& corner : corners) box.add(corner);
    std::vector<Index> near;
    tree_.visit_near(box, reach, [&](Index t) { near.push_back(t); });
    if (near.size() > kMostNear) {
      if (N == 4 || edge < 2.0 * reach || depth >= kMostHalvings) return measure_uncovered(corners, 0);
      for (const Part& half : halves(part)) match(frame, half, on_plane, depth + 1);
      return;
    }
    std::vector<Part> left{part};
    for (const Index t : near) {
      cover(frame, t, reach, on_plane, left);
      if (left.empty()) return;
      if (left.size() > kMostParts) break;
    }
    for (const Part& rest : left) measure_uncovered(in_space(frame, rest), 0);
  }

  /// Takes off the parts what lies over simplex t, no farther than `reach`.
  void cover(const Frame<N>& frame, Index t, double reach, double on_plane, std::vector<Part>& left) {
    Prism<N> prism;
    if (!prism.set(frame, to_.corners[t], to_.normals[t])) return;
    std::vector<Part> still;
    double farthest = 0.0;
    bool any = false;
    for (const Part& part : left) {
      inside_.clear();
      outside_.clear();
      split(prism, part, 0, on_plane);
      double height = 0.0;
      for (const Part& piece : inside_)
        for (const PointN<D>& x : piece) height = std::max(height, std::abs(prism.height(x)));
      if (inside_.empty() || height > reach) {
        still.push_back(part);
        continue;
      }
      any = true;
      farthest = std::max(farthest, height);
      still.insert(still.end(), outside_.begin(), outside_.end());
    }
    if (!any) return;
    left.swap(still);
    bound_ = std::max(bound_, farthest);
    raise(of_to_[t], farthest);
  }

  /// Whether all of a part is beyond one side of a prism.
  static bool is_beside(const Prism<N>& prism, const Part& part, double on_plane) {
    for (int side = 0; side < N; ++side)
      if (std::all_of(part.begin(), part.end(), [&](const PointN<D>& x) { return prism.inside(side, x) <= on_plane; }))
        return true;
    return false;
  }

  /// Parts a simplex at the sides of a prism, from the given side on.
  void split(const Prism<N>& prism, const Part& part, int side, double on_plane) {
    for (; side < N; ++side) {
      int highest = 0, lowest = 0;
      std::array<double, N> at;
      for (int i = 0; i < N; ++i) {
        at[i] = prism.inside(side, part[i]);
        if (at[i] > at[highest]) highest = i;
        if (at[i] < at[lowest]) lowest = i;
      }
      if (at[lowest] >= -on_plane) {
        if (-at[lowest] > kRoundingOfPlanes * on_plane) excess_ -= at[lowest];
        continue;
      }
      if (at[highest] <= on_plane) {
        outside_.push_back(part);
        return;
      }
      const PointN<D> crossing = between(part[highest], part[lowest], at[highest] / (at[highest] - at[lowest]));
      for (const int gone : {lowest, highest}) {
        Part half = part;
        half[gone] = crossing;
        split(prism, half, side, on_plane);
      }
      return;
    }
    inside_.push_back(part);
  }

  struct Bounded {
    double bound = 0.0;    ///< no point of the part is farther than this
    double nearest = 0.0;  ///< and some are as far as this
    std::array<Index, N + 1> candidates;
    CornersN<N> part;
  };

  /// The distance from one simplex is convex, so its largest value is at a corner; and no distance grows faster than
  /// the way does. Either bound will do.
  [[nodiscard]] Bounded bound_of(const CornersN<N>& part) const {
    constexpr int kPoints = N + 1;
    Bounded result;
    result.part = part;
    std::array<PointN<N>, kPoints> points;
    points[N] = {};
    for (int i = 0; i < N; ++i) {
      points[i] = part[i];
      for (int a = 0; a < N; ++a) points[N][a] += part[i][a] / N;
    }
    double radius = 0.0, at_middle = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const auto [distance, simplex] = tree_.nearest(points[i]);
      result.candidates[i] = simplex;
      at_middle = distance;  // that of the last one is left
      result.nearest = std::max(result.nearest, distance);
      radius = std::max(radius, norm(minus(points[i], points[N])));
    }
    result.bound = at_middle + radius;
    for (const Index t : result.candidates) {
      double farthest = 0.0;
      for (const PointN<N>& corner : part)
        farthest = std::max(farthest, distance_to_simplex<N>(corner, to_.corners[t], N));
      result.bound = std::min(result.bound, farthest);
    }
    return result;
  }

  /// What is bounded too loosely is halved.
  void measure_uncovered(const CornersN<N>& part, int depth) {
    const Bounded bounded = bound_of(part);
    if (bounded.bound > kLooseness * bounded.nearest && bounded.bound > bound_ && depth < kUncoveredHalvings<N>) {
      for (const CornersN<N>& half : halves(part)) measure_uncovered(half, depth + 1);
      return;
    }
    bound_ = std::max(bound_, bounded.bound);
    for (const Index t : bounded.candidates) raise(of_to_[t], bounded.bound);
  }

  const Pieces<N>& from_;
  const Pieces<N>& to_;
  const BoxTree<N>& tree_;
  const std::vector<double>& of_vertices_;
  std::vector<double>& of_to_;
  double bound_ = 0.0;
  std::vector<Part> inside_, outside_;
  std::vector<Match> matches_;
  double excess_ = 0.0;  ///< how deep what was counted as covered lies beyond the sides of what covers it, in sum
};

template <int N>
void require_scale(const std::array<double, N>& scale) {
  for (const double s : scale)
    if (!(s > 0.0 && std::isfinite(s)))
      throw Error(ErrorCode::InvalidArgument, fmt::format("a scale is {}; expected a positive number", s));
}

/// Measures the simplices with the largest bounds again: few decide on the bound of all.
template <int N>
void refine_largest(const Matcher<N>& matcher, Deviation& result, Workers<int>& workers) {
  std::vector<std::size_t> order(result.of_from.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t most = std::min(order.size() - 1, kMostRefined + order.size() / kRefinedShare);
  const auto larger = [&](std::size_t a, std::size_t b) {
    return result.of_from[a] != result.of_from[b] ? result.of_from[a] > result.of_from[b] : a < b;
  };
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(), larger);
  // No use in a closer bound of some than the others have.
  const double enough = std::max(kLooseness * result.least, order.size() > 1 ? result.of_from[order[most]] : 0.0);
  workers.for_range(std::max<std::size_t>(most, 1), 1, [&](std::size_t first, std::size_t end, int&) {
    for (std::size_t i = first; i < end; ++i) {
      double& bound = result.of_from[order[i]];
      if (bound > enough) bound = std::min(bound, matcher.refined_bound(static_cast<Index>(order[i]), enough));
    }
  });
  result.bound = *std::max_element(result.of_from.begin(), result.of_from.end());
  for (double& bound : result.of_to) bound = std::min(bound, result.bound);
}

}  // namespace
}  // namespace detail

template <int N, class Real>
Deviation deviation(const Contour<N, Real>& from, const Contour<N, Real>& to, const DeviationOptions<N>& options) {
  using namespace detail;
  require_scale<N>(options.scale);
  require_vertices(from);
  require_vertices(to);
  Deviation result;
  result.of_from.assign(from.simplices.size(), 0.0);
  result.of_to.assign(to.simplices.size(), 0.0);
  if (from.simplices.empty()) return result;
  if (to.simplices.empty()) {
    result.bound = result.least = kInfinity;
    result.of_from.assign(from.simplices.size(), kInfinity);
    return result;
  }
  const Pieces<N> from_pieces(from, options.scale), to_pieces(to, options.scale);
  const BoxTree<N> tree(to_pieces.corners);
  constexpr std::size_t kGrain = 256;
  std::atomic<std::size_t> done = 0;
  std::atomic<bool> stopped = false;
  const std::thread::id caller = std::this_thread::get_id();
  Workers<int> workers(options.threads, [] { return 0; });
  std::vector<double> of_vertices(from.vertices.size());
  workers.for_range(of_vertices.size(), kGrain, [&](std::size_t first, std::size_t end, int&) {
    for (std::size_t v = first; v < end; ++v) of_vertices[v] = tree.nearest(from_pieces.points[v]).distance;
  });
  workers.for_range(from.simplices.size(), kGrain, [&](std::size_t first, std::size_t end, int&) {
    Matcher<N> matcher(from_pieces, to_pieces, tree, of_vertices, result.of_to);
    double least = 0.0;
    for (std::size_t s = first; s < end && !stopped.load(std::memory_order_relaxed); ++s) {
      result.of_from[s] = matcher.bound(static_cast<Index>(s), least);
      if (s % kGrain != 0 || !options.progress || std::this_thread::get_id() != caller) continue;
      const std::size_t so_far = done.load(std::memory_order_relaxed) + (s - first);
      if (!options.progress(static_cast<double>(so_far) / static_cast<double>(from.simplices.size())))
        stopped.store(true, std::memory_order_relaxed);
    }
    done.fetch_add(end - first, std::memory_order_relaxed);
    raise(result.least, least);
  });
  if (stopped) throw Error(ErrorCode::Cancelled, "measuring the distance of two contours cancelled");
  refine_largest(Matcher<N>(from_pieces, to_pieces, tree, of_vertices, result.of_to), result, workers);
  return result;
}

template Deviation deviation(const Contour<2, float>&, const Contour<2, float>&, const DeviationOptions<2>&);
template Deviation deviation(const Contour<2, double>&, const Contour<2, double>&, const DeviationOptions<2>&);
template Deviation deviation(const Contour<3, float>&, const Contour<3, float>&, const DeviationOptions<3>&);
template Deviation deviation(const Contour<3, double>&, const Contour<3, double>&, const DeviationOptions<3>&);
template Deviation deviation(const Contour<4, float>&, const Contour<4, float>&, const DeviationOptions<4>&);
template Deviation deviation(const Contour<4, double>&, const Contour<4, double>&, const DeviationOptions<4>&);

}  // namespace tegl
