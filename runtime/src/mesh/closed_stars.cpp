// SPDX-License-Identifier: BSD-3-Clause
//
// Faces of closed stars. A triangle at the centre v of a star is an edge of v's link, directed as its tetrahedron
// orients it: one word of 64 bits. Each word is compared with the reverses of all others of the star, several at a
// time, which is faster than a table for the few that there are. Highway's foreach_target compiles this file once per
// instruction set.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "mesh/closed_stars.hpp"
#include "tegl/incidence.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mesh/closed_stars.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

/// The edges of v's link between vertices above v, in one tetrahedron with v.
struct Arrows {
  /// Places in the tetrahedron: the start and the end of each edge. Tetrahedra with one vertex above: its place first.
  alignas(32) std::array<std::uint32_t, 8> places{};
  std::array<std::uint8_t, 4> omitted{};  ///< by edge: the place of the vertex that is neither v nor one of its ends
  std::uint8_t count = 0;                 ///< edges
  std::uint8_t single = 0;                ///< 1 if there is one vertex above
};

/// By the set of places of vertices above v, plus 16 times the set that contains the place of v.
constexpr std::array<Arrows, 256> make_arrows() {
  std::array<Arrows, 256> all{};
  for (unsigned at = 0; at < 4; ++at)
    for (unsigned above = 0; above < 16; ++above) {
      if ((above >> at & 1u) != 0) continue;
      Arrows& arrows = all[16u << at | above];
      std::array<std::uint32_t, 3> others{};  // so that v followed by them has the tetrahedron's orientation
      for (unsigned i = 0, k = 0; i < 4; ++i)
        if (i != at) others[k++] = i;
      if (at % 2 == 1) others = {others[0], others[2], others[1]};
      unsigned above_count = 0;
      for (unsigned i = 0; i < 3; ++i) {
        const std::uint32_t from = others[i], to = others[(i + 1) % 3];
        if ((above >> from & 1u) == 0) continue;
        if (++above_count == 1 && arrows.count == 0) arrows.places[0] = from;
        if ((above >> to & 1u) == 0) continue;
        arrows.places[2 * arrows.count] = from;
        arrows.places[2 * arrows.count + 1] = to;
        arrows.omitted[arrows.count] = static_cast<std::uint8_t>(6 - at - from - to);
        ++arrows.count;
      }
      arrows.single = above_count == 1 ? 1 : 0;
    }
  return all;
}
constexpr std::array<Arrows, 256> kArrows = make_arrows();

/// Counts one star at a time.
class Counter {
 public:
  HWY_INLINE ClosedStar count(const Index* rows, Index v, std::span<const Index> star, bool with_edges,
                              ClosedStars* more) {
    ClosedStar found;
    if (star.size() > kMostTetrahedra) return found;
    load(rows, v, star, more != nullptr);
    const std::size_t paired = find_reverses();
    if (paired != arrows_ && (more == nullptr || repeats_one())) return found;
    if (more != nullptr) write_across(more->across);
    found.is_settled = true;
    found.triangles = static_cast<std::uint16_t>(arrows_ - paired / 2);
    found.boundary = static_cast<std::uint16_t>(arrows_ - paired);
    found.tetrahedra = static_cast<std::uint16_t>(tetrahedra_);
    if (with_edges) found.edges = static_cast<std::uint16_t>(count_edges(paired != arrows_, more));
    return found;
  }

 private:
  static constexpr std::size_t kMostTetrahedra = 64;
  static constexpr std::size_t kMostLanes = 16;  ///< of 32-bit words
  static constexpr std::size_t kMostArrows = 3 * kMostTetrahedra;
  static constexpr std::size_t kPadding = 32;  ///< at least the lanes of four vectors of 64-bit words

  /// Without a branch that depends on the tetrahedra: which vertices are above v varies irregularly.
  HWY_INLINE void load(const Index* rows, Index v, std::span<const Index> star, bool with_tetrahedra) {
    const hn::CappedTag<std::uint32_t, 8> d;
    const hn::FixedTag<std::uint32_t, 4> d4;
    const auto centre = hn::Set(d4, v);
    std::size_t singles = 0, tetrahedra = 0, arrow = 0;
    for (const Index s : star) {
      const Index* const row = rows + std::size_t{s} * 4;
      const auto vertices = hn::LoadU(d4, row);
      std::uint8_t bits[16] = {};
      hn::StoreMaskBits(d4, hn::Gt(vertices, centre), bits);
      hn::StoreMaskBits(d4, hn::Eq(vertices, centre), bits + 8);
      const Arrows& arrows = kArrows[static_cast<unsigned>(bits[0]) | static_cast<unsigned>(bits[8]) << 4];
      const auto repeated = hn::LoadDup128(d, row);
      for (std::size_t k = 0; k < 8; k += hn::Lanes(d)) {
        const auto ends = hn::TableLookupLanes(repeated, hn::SetTableIndices(d, arrows.places.data() + k));
        if (k == 0) singles_[singles] = hn::GetLane(ends);
        hn::StoreU(ends, d, ends_.data() + 2 * arrow + k);
      }
      if (with_tetrahedra) {
        hn::StoreU(hn::Set(d4, s), d4, tetrahedra_of_.data() + arrow);
        std::memcpy(omitted_.data() + arrow, arrows.omitted.data(), 4);
      }
      singles += arrows.single;
      tetrahedra += arrows.count == 3 ? 1 : 0;
      arrow += arrows.count;
    }
    arrows_ = arrow;
    single_count_ = singles;
    tetrahedra_ = tetrahedra;
  }

  /// Sets the places of the reverses of the directed edges; kMostArrows for those without one. Returns the number of
  /// edges that occur once and whose reverse occurs once.
  HWY_INLINE std::size_t find_reverses() {
    const std::size_t lanes = hn::Lanes(hn::ScalableTag<std::uint64_t>());
    std::size_t j = 0;
    for (; arrows_ > j + 3 * lanes; j += 4 * lanes) find_reverses_of<4>(j);
    if (arrows_ > j + 2 * lanes)
      find_reverses_of<3>(j);
    else if (arrows_ > j + lanes)
      find_reverses_of<2>(j);
    else if (arrows_ > j)
      find_reverses_of<1>(j);
    // An edge that occurs twice is not the reverse of its reverse at one of the two places.
    places_[kMostArrows] = kMostArrows;
    std::size_t paired = 0;
    for (std::size_t i = 0; i < arrows_; ++i) paired += places_[places_[i]] == i ? 1 : 0;
    return paired;
  }
  /// For the directed edges in kVectors vectors, from number j.
  template <int kVectors>
  HWY_INLINE void find_reverses_of(std::size_t j) {
    const hn::ScalableTag<std::uint64_t> d;
    const hn::Repartition<std::uint32_t, decltype(d)> d_ends;
    const std::size_t lanes = hn::Lanes(d);
    const auto one = hn::Set(d, std::uint64_t{1});
    hn::Vec<decltype(d)> reverse[kVectors], places[kVectors];
    for (int k = 0; k < kVectors; ++k) {
      const std::uint32_t* const ends = ends_.data() + 2 * (j + static_cast<std::size_t>(k) * lanes);
      reverse[k] = hn::BitCast(d, hn::Shuffle2301(hn::LoadU(d_ends, ends)));
      places[k] = hn::Set(d, std::uint64_t{kMostArrows});
    }
    auto place = hn::Zero(d);
    for (std::size_t i = 0; i < arrows_; ++i) {
      std::uint64_t arrow;
      std::memcpy(&arrow, ends_.data() + 2 * i, sizeof arrow);
      const auto here = hn::Set(d, arrow);
      for (int k = 0; k < kVectors; ++k) places[k] = hn::IfThenElse(hn::Eq(reverse[k], here), place, places[k]);
      place = hn::Add(place, one);
    }
    for (int k = 0; k < kVectors; ++k)
      hn::StoreU(places[k], d, places_.data() + j + static_cast<std::size_t>(k) * lanes);
  }

  /// Whether a directed edge occurs twice.
  [[nodiscard]] bool repeats_one() const {
    for (std::size_t i = 0; i < arrows_; ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (ends_[2 * i] == ends_[2 * j] && ends_[2 * i + 1] == ends_[2 * j + 1]) return true;
    return false;
  }

  HWY_INLINE void write_across(Index* across) const {
    for (std::size_t i = 0; i < arrows_; ++i)
      across[std::size_t{tetrahedra_of_[i]} * 4 + omitted_[i]] =
          places_[i] == kMostArrows ? kNoSimplex : tetrahedra_of_[places_[i]];
  }

  /// The number of different vertices of the link above v: the starts of edges, the ends of edges without a reverse
  /// (with `boundary`), and the vertices without such an edge.
  HWY_INLINE std::size_t count_edges(bool boundary, ClosedStars* more) {
    const hn::ScalableTag<std::uint32_t> d;
    const std::size_t lanes = hn::Lanes(d);
    std::size_t count = arrows_ + single_count_;
    for (std::size_t i = 0; i < arrows_; ++i) starts_[i] = ends_[2 * i];
    for (std::size_t i = 0; i < single_count_; ++i) starts_[arrows_ + i] = singles_[i];
    for (std::size_t i = 0; boundary && i < arrows_; ++i)
      if (places_[i] == kMostArrows) starts_[count++] = ends_[2 * i + 1];
    std::size_t repeats = 0;
    for (std::size_t j = 0; j < count; j += lanes) {
      const auto here = hn::LoadU(d, starts_.data() + j);
      const auto number = hn::Iota(d, static_cast<std::uint32_t>(j));
      // repeats of those before this vector, then of those within it
      auto is_repeat = hn::MaskFromVec(hn::Zero(d));
      for (std::size_t i = 0; i < j; ++i) is_repeat = hn::Or(is_repeat, hn::Eq(here, hn::Set(d, starts_[i])));
      for (std::size_t i = j; i < j + lanes && i < count; ++i)
        is_repeat = hn::Or(is_repeat, hn::And(hn::Eq(here, hn::Set(d, starts_[i])),
                                              hn::Gt(number, hn::Set(d, static_cast<std::uint32_t>(i)))));
      const auto is_new = hn::AndNot(is_repeat, hn::FirstN(d, count - j));
      repeats += std::min(lanes, count - j) - hn::CountTrue(d, is_new);
      if (more != nullptr) {
        std::array<std::uint32_t, kMostLanes> kept;
        const std::size_t size = hn::CompressBlendedStore(here, is_new, d, kept.data());
        more->edges.insert(more->edges.end(), kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(size));
      }
    }
    return count - repeats;
  }

  std::size_t arrows_ = 0, single_count_ = 0, tetrahedra_ = 0;
  alignas(64) std::array<std::uint32_t, 2 * (kMostArrows + kPadding)> ends_{};  ///< start and end of each edge
  std::array<Index, kMostArrows + kPadding> tetrahedra_of_{};                   ///< by edge
  std::array<std::uint8_t, kMostArrows + kPadding> omitted_{};
  alignas(64) std::array<std::uint64_t, kMostArrows + kPadding> places_{};  ///< by edge: the place of its reverse
  std::array<std::uint32_t, kMostTetrahedra + 1> singles_{};                ///< vertices without an edge
  alignas(64) std::array<std::uint32_t, 2 * kMostArrows + kMostTetrahedra + kPadding> starts_{};
};

constexpr std::size_t kAhead = 2;  ///< stars

void count_stars(const Index* rows, const Stars& stars, std::size_t from, bool with_edges, std::span<ClosedStar> found,
                 ClosedStars* more) {
  Counter counter;
  for (std::size_t i = 0; i < found.size(); ++i) {
    // rows that are needed soon; most are in the third level of cache
    if (i + kAhead < found.size())
      for (const Index s : stars.of(from + i + kAhead)) __builtin_prefetch(rows + std::size_t{s} * 4);
    found[i] = counter.count(rows, static_cast<Index>(from + i), stars.of(from + i), with_edges, more);
  }
}

#else

void count_stars(const Index*, const Stars&, std::size_t, bool, std::span<ClosedStar> found, ClosedStars*) {
  for (ClosedStar& star : found) star = {};  // left to the caller
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(count_stars);
void count_closed_stars(const Index* rows, const Stars& stars, std::size_t from, bool with_edges,
                        std::span<ClosedStar> found, ClosedStars* more) {
  HWY_DYNAMIC_DISPATCH(count_stars)(rows, stars, from, with_edges, found, more);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
