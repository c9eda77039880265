// SPDX-License-Identifier: BSD-3-Clause
//
// Faces of closed stars. A triangle at the centre v of a star is an edge of v's link, directed as its tetrahedron
// orients it. Each is compared with the reverses of all others of the star, several at a time, which is faster than a
// table for the few that there are. Highway's foreach_target compiles this file once per instruction set.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "mesh/closed_stars.hpp"
#include "tegl/incidence.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mesh/closed_stars.cpp"
// This include must precede Highway's own headers.
#include "base/dispatch.hpp"
#include "base/star_neighbours.hpp"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__

static_assert(kReadable <= Stars::kPadding);

/// The edges of v's link between vertices above v, in one tetrahedron with v. A tetrahedron with one vertex above has
/// an edge from there to v, so that all vertices above are starts of edges.
struct Arrows {
  /// By edge, the place of its start in the tetrahedron, then that of its end; for registers of four 16-bit or of eight
  /// 32-bit numbers of vertices.
  alignas(32) std::array<std::uint32_t, 8> places{};
  alignas(16) std::array<std::uint8_t, 16> bytes{};
  /// Sums of three kinds in one number: edges, and from bits 16 and 32 on those that end at v, and tetrahedra above v.
  std::uint64_t counts = 0;
  std::array<std::uint8_t, 4> omitted{};  ///< by edge: the place of the vertex that is neither v nor one of its ends
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
      const bool is_single = above != 0 && (above & (above - 1)) == 0;
      unsigned count = 0;
      for (unsigned i = 0; i < 3; ++i) {
        const std::uint32_t from = others[i], to = is_single ? at : others[(i + 1) % 3];
        if ((above >> from & 1u) == 0 || (!is_single && (above >> to & 1u) == 0)) continue;
        arrows.places[2 * count] = from;
        arrows.places[2 * count + 1] = to;
        arrows.omitted[count] = static_cast<std::uint8_t>(is_single ? at : 6 - at - from - to);
        ++count;
      }
      for (unsigned i = 0; i < 16; ++i) arrows.bytes[i] = static_cast<std::uint8_t>(4 * arrows.places[i / 2] + i % 2);
      arrows.counts = count | std::uint64_t{is_single} << 16 | std::uint64_t{count == 3} << 32;
    }
  return all;
}
constexpr std::array<Arrows, 256> kArrows = make_arrows();

constexpr std::size_t kMostArrows = 3 * kMostInStar;

/// The directed edges of one link at a time. Key: std::uint32_t for vertices whose numbers exceed that of the centre by
/// less than 2^16, as nearly all do unless the contour is large, or std::uint64_t for any vertices.
template <class Key>
class LinkEdges {
 public:
  /// `star`: of Stars. False if a vertex number is too large.
  HWY_INLINE bool load(const Index* rows, Index v, std::span<const Index> star, bool with_across) {
    const hn::FixedTag<std::uint32_t, 4> d;
    const auto centre = hn::Set(d, v);
    auto farthest = hn::Zero(d);
    std::uint64_t counts = 0;
    // Without a branch that depends on the tetrahedra: which vertices are above v varies irregularly.
    for (const Index& member : star) {
      const Index s = member;
      __builtin_prefetch(rows + std::size_t{(&member)[kAhead]} * 4);  // most are in the third level of cache
      const Index* const row = rows + std::size_t{s} * 4;
      const auto vertices = hn::LoadU(d, row);
      const auto is_above = hn::Gt(vertices, centre);
      const auto beyond = hn::Sub(vertices, centre);
      const Arrows& arrows = kArrows[word_of(d, is_above) | word_of(d, hn::Eq(vertices, centre)) << 4];
      const std::size_t first = counts & 0xffff;
      store(row, hn::BitCast(hn::Repartition<std::uint8_t, decltype(d)>(), beyond), arrows, keys_.data() + first);
      farthest = hn::Or(farthest, hn::IfThenElseZero(is_above, beyond));
      if (with_across) {
        hn::StoreU(hn::Set(d, s), d, tetrahedra_of_.data() + first);
        std::memcpy(omitted_.data() + first, arrows.omitted.data(), 4);
      }
      counts += arrows.counts;
    }
    size_ = counts & 0xffff;
    singles_ = counts >> 16 & 0xffff;
    tetrahedra_ = counts >> 32;
    return kIsWide || hn::AllTrue(d, hn::Lt(farthest, hn::Set(d, 1u << 16)));
  }

  /// Counts what was loaded.
  HWY_INLINE ClosedStar count(Index v, bool with_edges, ClosedStars* more) {
    ClosedStar found;
    const std::size_t paired = find_reverses();
    if (is_repeated_) return found;
    open_ = 0;
    if (paired != size_ - singles_ && (more == nullptr || !list_open(v))) return found;
    if (more != nullptr) write_across(more->across);
    found.is_settled = true;
    found.triangles = static_cast<std::uint16_t>(paired / 2 + open_);
    found.boundary = static_cast<std::uint16_t>(open_);
    found.tetrahedra = static_cast<std::uint16_t>(tetrahedra_);
    if (!with_edges) return found;
    // the ends of edges without a reverse may be no starts
    for (std::size_t k = 0; k < open_; ++k) keys_[size_ + k] = reverse_of(keys_[open_edges_[k]]);
    size_ += open_;
    found.edges = static_cast<std::uint16_t>(count_starts(v, more));
    return found;
  }

 private:
  static constexpr bool kIsWide = sizeof(Key) == 8;
  using Vertex = std::conditional_t<kIsWide, std::uint32_t, std::uint16_t>;  ///< without the centre's number if narrow
  using Keys = hn::ScalableTag<Key>;
  using Vertices = hn::ScalableTag<Vertex>;
  static constexpr std::size_t kKeys = hn::MaxLanes(Keys());
  static constexpr std::size_t kVertices = hn::MaxLanes(Vertices());
  static constexpr std::size_t kAtOnce = 4 * kKeys;  ///< two registers of vertices
  static constexpr Key kOnce = 256;                  ///< more than any place

  static Key reverse_of(Key key) noexcept { return std::rotl(key, 4 * sizeof(Key)); }

  /// Stores up to four edges.
  static HWY_INLINE void store(const Index* row, hn::Vec<hn::FixedTag<std::uint8_t, 16>> beyond, const Arrows& arrows,
                               Key* to) {
    const hn::FixedTag<std::uint8_t, 16> d8;
    const hn::CappedTag<std::uint32_t, 8> d;
    auto* const out = reinterpret_cast<std::uint8_t*>(to);
    if constexpr (!kIsWide) return hn::StoreU(hn::TableLookupBytes(beyond, hn::Load(d8, arrows.bytes.data())), d8, out);
    const auto repeated = hn::LoadDup128(d, row);
    const hn::Repartition<std::uint8_t, decltype(d)> d_bytes;
    for (std::size_t k = 0; k < 8; k += hn::Lanes(d)) {
      const auto ends = hn::TableLookupLanes(repeated, hn::SetTableIndices(d, arrows.places.data() + k));
      hn::StoreU(hn::BitCast(d_bytes, ends), d_bytes, out + 4 * k);
    }
  }

  /// Sets the places of the reverses of the edges, plus kOnce; 0 for those without one. Returns the number of edges
  /// with a reverse, and sets `is_repeated_` if an edge has several.
  HWY_INLINE std::size_t find_reverses() {
    is_repeated_ = false;
    std::size_t paired = 0, j = 0;
    for (; size_ > j + 3 * kKeys; j += 4 * kKeys) paired += find_reverses_of<4>(j);
    if (size_ > j + 2 * kKeys)
      paired += find_reverses_of<3>(j);
    else if (size_ > j + kKeys)
      paired += find_reverses_of<2>(j);
    else if (size_ > j)
      paired += find_reverses_of<1>(j);
    return paired;
  }
  /// For the edges in kVectors vectors, from number j.
  template <std::size_t kVectors>
  HWY_INLINE std::size_t find_reverses_of(std::size_t j) {
    const Keys d;
    hn::Vec<Keys> keys[kVectors], places[kVectors];
    for (std::size_t k = 0; k < kVectors; ++k) {
      keys[k] = hn::LoadU(d, keys_.data() + j + k * kKeys);
      places[k] = hn::Zero(d);
    }
    auto place = hn::Set(d, kOnce);
    const auto one = hn::Set(d, Key{1});
    for (std::size_t i = 0; i < size_; ++i) {
      const auto reverse = hn::Set(d, reverse_of(keys_[i]));
      for (std::size_t k = 0; k < kVectors; ++k) places[k] = add_where(d, hn::Eq(keys[k], reverse), places[k], place);
      place = hn::Add(place, one);
    }
    std::size_t paired = 0;
    auto repeated = hn::MaskFromVec(hn::Zero(d));
    for (std::size_t k = 0; k < kVectors; ++k) {
      const std::size_t first = j + k * kKeys;
      const auto is_used = hn::FirstN(d, size_ > first ? size_ - first : 0);
      hn::StoreU(places[k], d, places_.data() + first);
      paired += hn::CountTrue(d, hn::And(is_used, hn::Ne(places[k], hn::Zero(d))));
      repeated = hn::Or(repeated, hn::And(is_used, hn::Gt(places[k], hn::Set(d, 2 * kOnce - 1))));
    }
    is_repeated_ = is_repeated_ || !hn::AllFalse(d, repeated);
    return paired;
  }

  [[nodiscard]] bool ends_at(std::size_t i, Index v) const { return reverse_start(i) == (kIsWide ? v : 0); }
  [[nodiscard]] Index reverse_start(std::size_t i) const { return static_cast<Vertex>(reverse_of(keys_[i])); }

  /// Lists the edges without a reverse, except those to v. False if one of them occurs twice.
  bool list_open(Index v) {
    open_ = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      if (places_[i] != 0 || ends_at(i, v)) continue;
      for (std::size_t k = 0; k < open_; ++k)
        if (keys_[open_edges_[k]] == keys_[i]) return false;
      open_edges_[open_++] = static_cast<std::uint8_t>(i);
    }
    return true;
  }

  /// Without a branch that depends on the edges.
  HWY_INLINE void write_across(Index* across) const {
    Index nowhere = 0;  // in place of the entry of an edge to v
    const auto entry_of = [&](std::size_t i) { return across + (std::size_t{tetrahedra_of_[i]} * 4 + omitted_[i]); };
    for (std::size_t i = 0; i < size_; ++i) {
      Index* const entry = places_[i] != 0 ? entry_of(i) : &nowhere;
      *entry = tetrahedra_of_[places_[i] % kOnce];
    }
    for (std::size_t k = 0; k < open_; ++k) *entry_of(open_edges_[k]) = kNoSimplex;
  }

  /// The number of different starts, which are added to `more`.
  HWY_INLINE std::size_t count_starts(Index v, ClosedStars* more) {
    std::size_t count = 0;
    for (std::size_t j = 0; j < size_; j += kAtOnce) {
      std::uint64_t first = size_ > j + kVertices ? first_starts<2>(j) : first_starts<1>(j);
      count += static_cast<std::size_t>(std::popcount(first));
      if (more == nullptr) continue;
      if (more->edges.size() < more->edge_count + 64) more->edges.resize(2 * more->edges.size() + 1024);
      Index* to = more->edges.data() + more->edge_count;
      for (; first != 0; first &= first - 1)
        *to++ = static_cast<Vertex>(keys_[j + static_cast<std::size_t>(std::countr_zero(first))]) + (kIsWide ? 0 : v);
      more->edge_count = static_cast<std::size_t>(to - more->edges.data());
    }
    return count;
  }
  /// The starts in kVectors vectors, from number j, that do not occur before.
  template <std::size_t kVectors>
  HWY_INLINE std::uint64_t first_starts(std::size_t j) const {
    const Keys d_keys;
    const Vertices d;
    const hn::Half<Vertices> d_half;
    hn::Vec<Vertices> starts[kVectors];
    for (std::size_t k = 0; k < kVectors; ++k) {
      const Key* const from = keys_.data() + j + k * kVertices;
      starts[k] = hn::Combine(d, hn::TruncateTo(d_half, hn::LoadU(d_keys, from + kKeys)),
                              hn::TruncateTo(d_half, hn::LoadU(d_keys, from)));
    }
    const auto equal_to = [&](std::size_t i) {
      std::uint64_t word = 0;
      const auto start = hn::Set(d, static_cast<Vertex>(keys_[i]));
      for (std::size_t k = 0; k < kVectors; ++k) word |= word_of(d, hn::Eq(starts[k], start)) << (k * kVertices);
      return word;
    };
    std::uint64_t before = 0, first = 0;
    for (std::size_t i = 0; i < j; ++i) before |= equal_to(i);
    for (std::size_t i = j; i < size_; ++i) {
      const std::uint64_t equal = equal_to(i);
      first |= equal & (~equal + 1);
    }
    const std::size_t used = std::min(size_ - j, kVectors * kVertices);
    return first & ~before & (~std::uint64_t{0} >> (64 - used));
  }

  std::size_t size_ = 0, singles_ = 0, tetrahedra_ = 0, open_ = 0;
  bool is_repeated_ = false;
  // By edge, with room for whole registers:
  alignas(64) std::array<Key, 2 * kMostArrows + kAtOnce> keys_{};
  alignas(64) std::array<Key, kMostArrows + kAtOnce> places_{};  ///< of its reverse
  std::array<Index, kMostArrows + 4> tetrahedra_of_{};
  std::array<std::uint8_t, kMostArrows + 4> omitted_{};
  std::array<std::uint8_t, kMostArrows> open_edges_{};
};

void count_stars(const Index* rows, const Stars& stars, std::size_t from, bool with_edges, std::span<ClosedStar> found,
                 ClosedStars* more) {
  LinkEdges<std::uint32_t> narrow;
  LinkEdges<std::uint64_t> wide;
  bool is_wide = false;
  for (std::size_t i = 0; i < found.size(); ++i) {
    found[i] = {};
    const auto v = static_cast<Index>(from + i);
    const std::span<const Index> star = stars.of(v);
    if (star.size() > kMostInStar) continue;
    is_wide = is_wide || !narrow.load(rows, v, star, more != nullptr);
    if (is_wide) wide.load(rows, v, star, more != nullptr);
    found[i] = is_wide ? wide.count(v, with_edges, more) : narrow.count(v, with_edges, more);
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
