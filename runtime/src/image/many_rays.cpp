// SPDX-License-Identifier: BSD-3-Clause
//
// Roots of the multilinear interpolant on the rays of a tesseract (see many_rays.hpp), and on rays of many cubes
// (cube_levels in cube_heights.hpp). Highway's foreach_target compiles this file once per instruction set. The
// operations are those of tile_heights.cpp, cube_heights.cpp and ray_level.hpp, in the same order, so that the levels
// are equal bit by bit.
#include "image/many_rays.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <type_traits>
#include <utility>

#include "image/cube_heights.hpp"
#include "image/ray_level.hpp"
#include "image/rays_of_tiles.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "image/many_rays.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using RayTag = hn::CappedTag<double, 8>;
using RayLanes = hn::Vec<RayTag>;
using RayMask = hn::Mask<RayTag>;

/// A polynomial in each lane, the constant coefficient first.
template <std::size_t Count>
struct RayPolynomials {
  std::array<RayLanes, Count> of;

  template <std::size_t K = 0>
  HWY_INLINE RayLanes value(RayLanes x) const {
    if constexpr (K + 1 == Count)
      return of[K];
    else
      return hn::Add(of[K], hn::Mul(x, value<K + 1>(x)));
  }
  template <std::size_t K = 1>
  HWY_INLINE RayLanes slope(RayLanes x) const {
    const auto term = hn::Mul(hn::Set(RayTag(), static_cast<double>(K)), of[K]);
    if constexpr (K + 1 == Count)
      return term;
    else
      return hn::Add(term, hn::Mul(x, slope<K + 1>(x)));
  }
};

/// The interpolant on rays of a tesseract. `u`: by axis 2 x - 1 of their ends.
HWY_INLINE RayPolynomials<5> tesseract_polynomials(const std::array<double, 16>& products, const RayLanes (&u)[4]) {
  // Unrolled, so that the coefficients stay in registers. The weight of a set of axes is the product of u over them.
  return [&]<std::size_t... Set>(std::index_sequence<Set...>) HWY_ATTR {
    const RayTag d;
    RayLanes weights[16], sums[5];
    for (auto& sum : sums) sum = hn::Zero(d);
    const auto add = [&]<std::size_t S>(std::integral_constant<std::size_t, S>) HWY_ATTR {
      if constexpr (S == 0) {
        weights[0] = hn::Set(d, 1.0);
      } else {
        constexpr std::size_t kLast = std::bit_width(S) - 1;
        weights[S] = hn::Mul(weights[S ^ std::size_t{1} << kLast], u[kLast]);
      }
      constexpr int kDegree = std::popcount(S);
      sums[kDegree] = hn::Add(sums[kDegree], hn::Mul(hn::Set(d, products[S]), weights[S]));
    };
    (add(std::integral_constant<std::size_t, Set>{}), ...);
    return RayPolynomials<5>{{sums[0], sums[1], sums[2], sums[3], sums[4]}};
  }
  (std::make_index_sequence<16>());
}

/// Searches last_root in the lanes `wanted`.
template <std::size_t Count>
class RootSearch {
 public:
  HWY_INLINE RootSearch(const RayPolynomials<Count>& polynomials, RayMask wanted) : polynomials_(polynomials) {
    const RayTag d;
    above_ = hn::Set(d, 1.0);
    auto at_above = polynomials.value(above_);
    is_high_ = hn::Ge(at_above, hn::Zero(d));
    // the last fourth at whose ends the signs differ
    auto at_below = at_above, last = above_, at_last = at_above;
    below_ = above_;
    found_ = hn::And(is_high_, hn::Not(is_high_));
    for (double start = 0.75; start >= 0.0; start -= 0.25) {
      const auto x = hn::Set(d, start), at = polynomials.value(x);
      const auto here = hn::AndNot(found_, is_beyond(at));
      below_ = hn::IfThenElse(here, x, below_), at_below = hn::IfThenElse(here, at, at_below);
      above_ = hn::IfThenElse(here, last, above_), at_above = hn::IfThenElse(here, at_last, at_above);
      found_ = hn::Or(found_, here);
      last = x, at_last = at;
    }
    x_ = hn::Add(below_, hn::Mul(hn::Sub(above_, below_), hn::Div(at_below, hn::Sub(at_below, at_above))));
    active_ = hn::And(found_, wanted);
  }

  HWY_INLINE bool has_ended() const { return hn::AllFalse(RayTag(), active_); }
  /// One step of Newton's method in the lanes that have not ended.
  HWY_INLINE void step() {
    const RayTag d;
    const auto at = polynomials_.value(x_);
    const auto beyond = is_beyond(at);
    above_ = hn::IfThenElse(beyond, above_, x_);
    below_ = hn::IfThenElse(beyond, x_, below_);
    auto next = hn::Sub(x_, hn::Div(at, polynomials_.slope(x_)));
    const auto is_between = hn::And(hn::Ge(next, below_), hn::Le(next, above_));
    next = hn::IfThenElse(is_between, next, hn::Mul(hn::Set(d, 0.5), hn::Add(below_, above_)));
    const auto moved = hn::Abs(hn::Sub(next, x_));
    x_ = hn::IfThenElse(active_, next, x_);
    active_ = hn::AndNot(hn::Lt(moved, hn::Set(d, kEnoughOfRay<Count>)), active_);
  }
  HWY_INLINE RayLanes root() const { return hn::IfThenElse(found_, x_, hn::Set(RayTag(), -1.0)); }

 private:
  HWY_INLINE RayMask is_beyond(RayLanes at) const { return hn::Xor(hn::Ge(at, hn::Zero(RayTag())), is_high_); }

  const RayPolynomials<Count>& polynomials_;
  RayLanes x_, above_, below_;
  RayMask is_high_, found_, active_;
};

constexpr int kMostSteps = 8;

/// last_root in the lanes `wanted`.
template <std::size_t Count>
HWY_INLINE RayLanes last_roots(const RayPolynomials<Count>& polynomials, RayMask wanted) {
  RootSearch<Count> search(polynomials, wanted);
  for (int step = 0; step < kMostSteps && !search.has_ended(); ++step) search.step();
  return search.root();
}

/// last_root of two registers of polynomials. Each step of a search waits for the one before, so the searches take
/// turns.
template <std::size_t Count>
HWY_INLINE std::array<RayLanes, 2> last_roots(const std::array<RayPolynomials<Count>, 2>& polynomials,
                                              const std::array<RayMask, 2>& wanted) {
  RootSearch<Count> first(polynomials[0], wanted[0]), second(polynomials[1], wanted[1]);
  for (int step = 0; step < kMostSteps && !(first.has_ended() && second.has_ended()); ++step) {
    first.step();
    second.step();
  }
  return {first.root(), second.root()};
}

/// level_inside for some levels.
struct LevelsInside {
  RayLanes least, most;

  HWY_INLINE explicit LevelsInside(double epsilon) {
    const double least_level = std::max(kLeastRayLevel, epsilon);
    least = hn::Set(RayTag(), least_level);
    most = hn::Set(RayTag(), 1.0 - least_level);
  }
  HWY_INLINE RayLanes operator()(RayLanes level) const {
    const auto step = hn::Set(RayTag(), kRayLevelStep);
    level = hn::IfThenElse(hn::Lt(level, least), least, hn::IfThenElse(hn::Lt(most, level), most, level));
    return hn::Sub(hn::Add(level, step), step);
  }
};

/// The level of a ray on which the interpolant has the root `level`, or -1 if it has none.
HWY_INLINE RayLanes level_of_root(const RayPolynomials<5>& polynomials, RayLanes level, const LevelsInside& inside) {
  const RayTag d;
  const auto one = hn::Set(d, 1.0);
  const auto is_nearer = hn::Lt(hn::Abs(polynomials.value(one)), hn::Abs(polynomials.of[0]));
  return inside(hn::IfThenElse(hn::Lt(level, hn::Zero(d)), hn::IfThenElseZero(is_nearer, one), level));
}

void levels_of_tesseract(const std::array<double, 16>& products, double epsilon, TesseractRays& rays) {
  const RayTag d;
  const std::size_t lanes = hn::Lanes(d);
  const auto one = hn::Set(d, 1.0), two = hn::Set(d, 2.0);
  const LevelsInside inside(epsilon);
  const std::size_t end = (rays.count + lanes - 1) / lanes * lanes;
  const std::size_t last = end - lanes;  // the register that may not be full; there is at least one ray
  for (auto& ends : rays.ends)
    hn::Store(hn::IfThenElseZero(hn::FirstN(d, rays.count - last), hn::Load(d, ends.data() + last)), d,
              ends.data() + last);
  const auto polynomials_at = [&](std::size_t i) HWY_ATTR {
    RayLanes u[4];
    for (std::size_t a = 0; a < 4; ++a) u[a] = hn::Sub(hn::Mul(two, hn::Load(d, rays.ends[a].data() + i)), one);
    return tesseract_polynomials(products, u);
  };
  const auto wanted_at = [&](std::size_t i) HWY_ATTR { return hn::FirstN(d, rays.count - i); };
  const auto store = [&](std::size_t i, const RayPolynomials<5>& polynomials, RayLanes root)
                         HWY_ATTR { hn::Store(level_of_root(polynomials, root, inside), d, rays.levels.data() + i); };
  std::size_t i = 0;
  for (; i + lanes < end; i += 2 * lanes) {
    const std::array<RayPolynomials<5>, 2> polynomials = {polynomials_at(i), polynomials_at(i + lanes)};
    const auto levels = last_roots<5>(polynomials, {wanted_at(i), wanted_at(i + lanes)});
    store(i, polynomials[0], levels[0]);
    store(i + lanes, polynomials[1], levels[1]);
  }
  if (i == end) return;
  const RayPolynomials<5> polynomials = polynomials_at(i);
  store(i, polynomials, last_roots(polynomials, wanted_at(i)));
}

static_assert(TesseractRays::kMost <= RaysOfTiles::kMost);

/// A register of rays of one tile.
struct RayRegister {
  const RaysOfTiles::Tile* tile;
  std::size_t at;      ///< place of the first ray
  std::size_t wanted;  ///< lanes with a ray
};

HWY_INLINE RayPolynomials<5> polynomials_on(const RaysOfTiles& rays, const RayRegister& of) {
  const RayTag d;
  RayLanes u[4];
  for (std::size_t a = 0; a < 4; ++a)
    u[a] = hn::Sub(hn::Mul(hn::Set(d, 2.0), hn::Load(d, rays.ends[a].data() + of.at)), hn::Set(d, 1.0));
  return tesseract_polynomials(of.tile->products, u);
}

/// The coordinate along one axis of points at `level` on rays to `end`, in a box.
HWY_INLINE RayLanes coordinate_on(RayLanes end, RayLanes level, double box_from, double box_to) {
  const RayTag d;
  const auto half = hn::Set(d, 0.5), from = hn::Set(d, box_from), to = hn::Set(d, box_to), step = hn::Sub(to, from);
  const auto least = hn::Set(d, std::min(box_from, box_to)), most = hn::Set(d, std::max(box_from, box_to));
  const auto x = hn::Add(half, hn::Mul(level, hn::Sub(end, half)));
  auto point = hn::Add(from, hn::Mul(x, step));
  point = hn::IfThenElse(hn::Gt(least, point), least, point);
  point = hn::IfThenElse(hn::Gt(point, most), most, point);
  return hn::IfThenElse(hn::Ge(x, hn::Set(d, 1.0)), to, point);
}

HWY_INLINE void store_points(RaysOfTiles& rays, const RayRegister& of, RayLanes level) {
  const RayTag d;
  if (!is_finite_enough(of.tile->products[0])) level = hn::Set(d, 0.5);
  for (std::size_t a = 0; a < 4; ++a) {
    double* const end = rays.ends[a].data() + of.at;
    hn::Store(coordinate_on(hn::Load(d, end), level, of.tile->box.from[a], of.tile->box.to[a]), d, end);
  }
}

template <std::size_t... I>
HWY_INLINE void place_registers(RaysOfTiles& rays, const RayRegister* of, const LevelsInside& inside,
                                std::index_sequence<I...>) {
  const RayPolynomials<5> polynomials[] = {polynomials_on(rays, of[I])...};
  RootSearch<5> searches[] = {RootSearch<5>(polynomials[I], hn::FirstN(RayTag(), of[I].wanted))...};
  for (int step = 0; step < kMostSteps && !(searches[I].has_ended() && ...); ++step) (searches[I].step(), ...);
  (store_points(rays, of[I], level_of_root(polynomials[I], searches[I].root(), inside)), ...);
}

void points_on_rays_of_tiles(double epsilon, RaysOfTiles& rays) {
  constexpr std::size_t kLanes = hn::MaxLanes(RayTag());
  constexpr std::size_t kTogether = kLanes == 8 ? 4 : 2;  // more do not fit into the registers that there are
  std::array<RayRegister, RaysOfTiles::kMost / kLanes> registers;
  std::size_t count = 0;
  for (std::size_t g = 0; g < rays.groups; ++g)
    for (std::size_t i = 0; i < rays.rays_in[g]; i += kLanes)
      registers[count++] = {&rays.of_tiles[rays.tile_of[g]], RaysOfTiles::kGroup * g + i, rays.rays_in[g] - i};
  const LevelsInside inside(epsilon);
  std::size_t i = 0;
  for (; i + kTogether <= count; i += kTogether)
    place_registers(rays, registers.data() + i, inside, std::make_index_sequence<kTogether>());
  for (; i < count; ++i) place_registers(rays, registers.data() + i, inside, std::make_index_sequence<1>());
}

/// Levels of rays to squares, on which the interpolant is linear. `a`: sum of all heights.
HWY_INLINE RayLanes linear_levels(RayLanes a, const RayLanes (&sums)[4]) {
  const auto level = hn::Div(a, hn::Sub(sums[1], sums[0]));
  return hn::IfThenElseZero(hn::Ge(level, hn::Zero(RayTag())), level);
}

/// Levels of rays to edges: quadratic_level in cube_heights.cpp.
HWY_INLINE RayLanes quadratic_levels(RayLanes a, const RayLanes (&sums)[4]) {
  const RayTag d;
  const auto zero = hn::Zero(d), one = hn::Set(d, 1.0);
  const auto b = hn::Mul(hn::Set(d, 2.0), hn::Sub(sums[0], sums[2]));
  const auto c = hn::Add(hn::Sub(sums[0], sums[1]), sums[2]);
  const auto discriminant = hn::Sub(hn::Mul(b, b), hn::Mul(hn::Mul(hn::Set(d, 4.0), a), c));
  const auto w = hn::Mul(hn::Set(d, -0.5), hn::Add(b, hn::CopySign(hn::Sqrt(discriminant), b)));
  auto level = zero;
  for (const auto root : {hn::Div(w, c), hn::Div(a, w)})
    level = hn::IfThenElse(hn::And(hn::Gt(root, level), hn::Lt(root, one)), root, level);
  return hn::IfThenElseZero(hn::Ge(discriminant, zero), level);
}

/// The interpolant on rays to corners.
HWY_INLINE RayPolynomials<4> cube_polynomials(RayLanes a, const RayLanes (&sums)[4]) {
  const RayTag d;
  const auto three = hn::Set(d, 3.0);
  const auto& [s0, s1, s2, s3] = sums;
  return {{a, hn::Sub(hn::Add(hn::Mul(three, hn::Sub(s0, s3)), s1), s2),
           hn::Sub(hn::Sub(hn::Mul(three, hn::Add(s0, s3)), s1), s2), hn::Sub(hn::Add(hn::Sub(s0, s1), s2), s3)}};
}

/// Sums of the heights of a register of rays: at each distance from the end, and of all.
struct HeightSums {
  RayLanes at_distance[4];
  RayLanes all;

  HWY_INLINE HeightSums(const CubeRays& rays, unsigned degree, std::size_t i) {
    // By degree: the number of corners at each distance from the end.
    static constexpr std::uint8_t kCorners[4][4] = {{8, 0, 0, 0}, {4, 4, 0, 0}, {2, 4, 2, 0}, {1, 3, 3, 1}};
    const RayTag d;
    for (std::size_t distance = 0, corner = 0; distance < 4; ++distance) {
      at_distance[distance] = hn::Zero(d);
      for (unsigned count = kCorners[degree][distance]; count != 0; --count, ++corner)
        at_distance[distance] = hn::Add(at_distance[distance], hn::Load(d, rays.heights[corner].data() + i));
    }
    all = hn::Add(hn::Add(hn::Add(at_distance[0], at_distance[1]), at_distance[2]), at_distance[3]);
  }
};

/// Stores CubeHeights::level of a register of rays.
HWY_INLINE void store_levels(RayLanes level, RayLanes sum, const LevelsInside& inside, double* out) {
  const RayTag d;
  const auto most = hn::Set(d, std::numeric_limits<double>::max() / 64);
  const auto is_finite = hn::Le(hn::Abs(sum), most);
  hn::StoreU(hn::IfThenElse(is_finite, inside(level), hn::Set(d, 0.5)), d, out);
}

/// Levels of rays to corners, of two registers.
HWY_INLINE void cubic_levels(const CubeRays& rays, std::size_t i, const LevelsInside& inside, double* out) {
  const RayTag d;
  const std::size_t next = i + hn::Lanes(d);
  const HeightSums sums(rays, 3, i), of_next(rays, 3, next);
  const std::array<RayPolynomials<4>, 2> polynomials = {cube_polynomials(sums.all, sums.at_distance),
                                                        cube_polynomials(of_next.all, of_next.at_distance)};
  const auto levels = last_roots<4>(polynomials, {hn::FirstN(d, rays.count - i), hn::FirstN(d, rays.count - next)});
  store_levels(levels[0], sums.all, inside, out + i);
  store_levels(levels[1], of_next.all, inside, out + next);
}

/// CubeHeights::level of `rays`.
void levels_of_cubes(CubeRays& rays, unsigned degree, double epsilon, double* out) {
  const RayTag d;
  const std::size_t lanes = hn::Lanes(d);
  const LevelsInside inside(epsilon);
  const std::size_t end = (rays.count + lanes - 1) / lanes * lanes;
  for (auto& heights : rays.heights) std::fill(heights.begin() + rays.count, heights.begin() + end, 0.0);
  std::size_t i = 0;
  if (degree == 3)
    for (; i + lanes < end; i += 2 * lanes) cubic_levels(rays, i, inside, out);
  for (; i < end; i += lanes) {
    const HeightSums sums(rays, degree, i);
    const auto wanted = hn::FirstN(d, rays.count - i);
    const auto level = degree == 3   ? last_roots(cube_polynomials(sums.all, sums.at_distance), wanted)
                       : degree == 2 ? quadratic_levels(sums.all, sums.at_distance)
                                     : linear_levels(sums.all, sums.at_distance);
    store_levels(level, sums.all, inside, out + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(levels_of_tesseract);
HWY_EXPORT(levels_of_cubes);
HWY_EXPORT(points_on_rays_of_tiles);

void find_levels(const std::array<double, 16>& products, double epsilon, TesseractRays& rays) noexcept {
  if (is_finite_enough(products[0]))
    HWY_DYNAMIC_DISPATCH(levels_of_tesseract)(products, epsilon, rays);
  else
    std::fill_n(rays.levels.begin(), rays.count, 0.5);
}

void place_on_rays(double epsilon, RaysOfTiles& rays) noexcept {
  if (rays.groups != 0) HWY_DYNAMIC_DISPATCH(points_on_rays_of_tiles)(epsilon, rays);
}

void cube_levels(CubeRays& rays, unsigned degree, double epsilon, std::array<double, CubeRays::kMost>& out) noexcept {
  HWY_DYNAMIC_DISPATCH(levels_of_cubes)(rays, degree, epsilon, out.data());
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
