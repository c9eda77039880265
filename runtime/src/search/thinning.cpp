// SPDX-License-Identifier: BSD-3-Clause
//
// Volume thinning in any dimension. Tiles are removed from outside, layer by layer, if the remaining tiles are a
// deformation retract of the tiles before. Tiles around an extremum always stay. The result is a seed set: a component
// of the contour that met no remaining tile would separate the image into two sides, each with an extremum, but the
// remaining tiles connect all extrema.
#include <algorithm>
#include <array>
#include <bitset>
#include <optional>
#include <span>
#include <unordered_map>

#include "base/disjoint_sets.hpp"
#include "search/seed_methods.hpp"
#include "search/tile_ranges.hpp"

namespace tegl::detail {

namespace {

/// Proper faces of an N-cube as base-3 numbers, one digit per axis: 0 or 1 if the face lies at that end of the axis, 2
/// if it extends along the axis. The neighbour in direction d shares the face with digits 0, 2, 1 for d = -1, 0, 1.
template <int N>
class CubeBoundary {
 public:
  static constexpr std::size_t kFaces = N == 2 ? 9 : N == 3 ? 27 : N == 4 ? 81 : 243;
  using Set = std::bitset<kFaces>;

  CubeBoundary() {
    for (std::size_t f = 0; f < kFaces; ++f)
      for (std::size_t g = 0; g + 1 < kFaces; ++g) {  // the last one is the cube itself
        if (f + 1 == kFaces || !is_part(f, g)) continue;
        closure_[g].set(f);
        if (dim(g) == dim(f) + 1) above_[f].set(g);
      }
  }

  [[nodiscard]] const Set& closure(std::size_t face) const noexcept { return closure_[face]; }

  /// Whether a set of faces, closed under taking subfaces, collapses to a point. Each elementary collapse removes a
  /// free face and the only face of the set that contains it.
  [[nodiscard]] bool collapses(Set set) const {
    if (set.none()) return false;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t f = 0; f + 1 < kFaces; ++f) {
        if (!set[f]) continue;
        const Set above = set & above_[f];
        if (above.count() != 1) continue;
        const std::size_t g = above._Find_first();
        if ((set & above_[g]).any()) continue;
        set.reset(f);
        set.reset(g);
        changed = true;
      }
    }
    return set.count() == 1;
  }

 private:
  static std::size_t digit(std::size_t face, int axis) noexcept {
    for (int a = 0; a < axis; ++a) face /= 3;
    return face % 3;
  }
  static int dim(std::size_t face) noexcept {
    int free = 0;
    for (int a = 0; a < N; ++a) free += digit(face, a) == 2 ? 1 : 0;
    return free;
  }
  static bool is_part(std::size_t face, std::size_t of) noexcept {
    for (int a = 0; a < N; ++a)
      if (digit(of, a) != 2 && digit(of, a) != digit(face, a)) return false;
    return true;
  }

  std::array<Set, kFaces> closure_, above_;
};

/// Calls visit(linear number, index) for all samples, axis 0 fastest.
template <int N, class Visit>
void for_each_sample(const std::array<std::size_t, N>& sizes, const Visit& visit) {
  std::array<std::size_t, N> index{};
  std::size_t count = 1;
  for (const std::size_t size : sizes) count *= size;
  for (std::size_t i = 0; i < count; ++i) {
    visit(i, index);
    for (int a = 0; a < N && ++index[a] == sizes[a]; ++a) index[a] = 0;
  }
}

/// Comparison of samples, by their offsets in the image in elements.
class SampleOrder {
 public:
  SampleOrder() = default;
  SampleOrder(const SampleOrder&) = delete;
  SampleOrder& operator=(const SampleOrder&) = delete;
  virtual ~SampleOrder() = default;
  [[nodiscard]] virtual bool may_miss() const noexcept = 0;  ///< whether the type has missing values
  [[nodiscard]] virtual bool missing(std::ptrdiff_t at) const noexcept = 0;
  /// Negative, 0 or positive: value a is below, equal to or above value b.
  [[nodiscard]] virtual int compare(std::ptrdiff_t a, std::ptrdiff_t b) const noexcept = 0;
};

template <Value T>
class OrderOf final : public SampleOrder {
 public:
  explicit OrderOf(const T* data) : data_(data) {}
  [[nodiscard]] bool may_miss() const noexcept override { return std::is_floating_point_v<T>; }
  [[nodiscard]] bool missing(std::ptrdiff_t at) const noexcept override { return data_[at] != data_[at]; }
  [[nodiscard]] int compare(std::ptrdiff_t a, std::ptrdiff_t b) const noexcept override {
    return static_cast<int>(data_[b] < data_[a]) - static_cast<int>(data_[a] < data_[b]);
  }

 private:
  const T* data_;
};

/// Sizes and strides of an image, in elements.
template <int N>
struct SampleGrid {
  std::array<std::size_t, N> sizes;
  std::array<std::ptrdiff_t, N> strides;

  [[nodiscard]] std::ptrdiff_t offset(const std::array<std::size_t, N>& index) const noexcept {
    std::ptrdiff_t at = 0;
    for (int a = 0; a < N; ++a) at += static_cast<std::ptrdiff_t>(index[a]) * strides[a];
    return at;
  }
};

template <int N>
class Thinning {
 public:
  Thinning(const SampleGrid<N>& grid, const SampleOrder& values, const PaddedTiles& tiles)
      : grid_(grid), values_(values), tiles_(tiles), state_(tiles.room()) {
    std::size_t faces = 1;
    for (int a = 0; a < N; ++a) faces *= 3;
    for (std::size_t face = 0; face + 1 < faces; ++face) {
      std::ptrdiff_t distance = 0;
      std::size_t rest = face;
      for (int a = 0; a < N; ++a, rest /= 3) distance += (rest % 3 == 0 ? -1 : rest % 3 == 1 ? 1 : 0) * tiles.step(a);
      neighbours_.emplace_back(distance, face);
    }
  }

  std::vector<Place> run(const Progress& progress) {
    find_tiles();
    report_progress(progress, 0.1);
    keep_extrema();
    report_progress(progress, 0.3);
    take_away(progress);
    std::vector<Place> left;
    for (Place place = 0; place < state_.size(); ++place)
      if (state_[place] != kNone) left.push_back(place);
    return left;
  }

 private:
  enum State : std::uint8_t { kNone = 0, kTile, kKept };

  void find_tiles() {
    tiles_.scan(default_order(N), [&](Place place) { state_[place] = kTile; });
    if (values_.may_miss())
      for_each_sample<N>(grid_.sizes, [&](std::size_t, const auto& index) {
        if (values_.missing(grid_.offset(index))) for_tiles_around(index, [&](Place place) { state_[place] = kNone; });
      });
  }

  /// The tile whose given corner is the sample; none if that tile lies outside the image.
  [[nodiscard]] std::optional<Place> tile_with_corner(const std::array<std::size_t, N>& index, unsigned corner) const {
    auto at = static_cast<std::ptrdiff_t>(tiles_.row_place(0));
    for (int a = 0; a < N; ++a) {
      const std::size_t back = corner >> a & 1u;
      if (index[a] < back || index[a] - back >= tiles_.size(a)) return std::nullopt;
      at += static_cast<std::ptrdiff_t>(index[a] - back) * tiles_.step(a);
    }
    return static_cast<Place>(at);
  }

  /// Calls visit(place) for all tiles of the image with a corner at the sample, whatever their state.
  template <class Visit>
  void for_tiles_around(const std::array<std::size_t, N>& index, const Visit& visit) const {
    for (unsigned corner = 0; corner < 1u << N; ++corner)
      if (const auto place = tile_with_corner(index, corner)) visit(*place);
  }

  /// Whether any remaining tile contains the edge from a sample to the next one along an axis.
  [[nodiscard]] bool has_tile(const std::array<std::size_t, N>& index, int axis) const {
    for (unsigned corner = 0; corner < 1u << N; ++corner) {
      if ((corner >> axis & 1u) != 0) continue;
      const auto place = tile_with_corner(index, corner);
      if (place && state_[*place] != kNone) return true;
    }
    return false;
  }

  /// Keeps the tiles around one sample of every extremal plateau (a connected set of equal samples with no higher, or
  /// no lower, neighbour along the axes).
  void keep_extrema() {
    const auto& sizes = grid_.sizes;
    std::size_t count = 1;
    for (const std::size_t size : sizes) count *= size;
    DisjointSets plateaus(count);
    std::vector<bool> has_higher(count), has_lower(count), has_tiles(count);
    const auto for_edges = [&](const auto& visit) {
      for_each_sample<N>(sizes, [&](std::size_t i, const std::array<std::size_t, N>& index) {
        std::size_t step = 1;
        for (int a = 0; a < N; step *= sizes[a++]) {
          if (index[a] + 1 >= sizes[a] || !has_tile(index, a)) continue;
          const std::ptrdiff_t at = grid_.offset(index);
          visit(i, i + step, values_.compare(at, at + grid_.strides[a]));
        }
      });
    };
    // merge equal neighbours into plateaus
    for_edges([&](std::size_t i, std::size_t j, int order) {
      has_tiles[i] = has_tiles[j] = true;
      if (order != 0) return;
      const auto a = plateaus.find(static_cast<std::uint32_t>(i));
      const auto b = plateaus.find(static_cast<std::uint32_t>(j));
      if (a != b) plateaus.join_under(std::max(a, b), std::min(a, b));
    });
    // mark plateaus that have higher or lower neighbours
    for_edges([&](std::size_t i, std::size_t j, int order) {
      if (order == 0) return;
      const auto lower = static_cast<std::uint32_t>(order < 0 ? i : j);
      const auto higher = static_cast<std::uint32_t>(order < 0 ? j : i);
      has_higher[plateaus.find(lower)] = true;
      has_lower[plateaus.find(higher)] = true;
    });
    // keep the tiles around the roots of extremal plateaus
    for_each_sample<N>(sizes, [&](std::size_t i, const std::array<std::size_t, N>& index) {
      if (!has_tiles[i] || plateaus.find(static_cast<std::uint32_t>(i)) != i || (has_higher[i] && has_lower[i])) return;
      for_tiles_around(index, [&](Place place) {
        if (state_[place] == kTile) state_[place] = kKept;
      });
    });
  }

  void take_away(const Progress& progress) {
    // the outer tiles are the first layer
    std::vector<Place> layer, next;
    std::vector<bool> waits(state_.size());
    tiles_.scan(default_order(N), [&](Place place) {
      if (state_[place] == kTile && is_outside(place)) layer.push_back(place);
    });
    std::size_t gone = 0;
    for (; !layer.empty(); layer.swap(next), next.clear()) {
      for (const Place place : layer) waits[place] = false;
      for (const Place place : layer) {
        if (state_[place] != kTile || !may_go(place)) continue;
        state_[place] = kNone;
        if (++gone % (1u << 16) == 0)
          report_progress(progress, 0.3 + 0.7 * static_cast<double>(gone) / static_cast<double>(state_.size()));
        for (const auto& [distance, face] : neighbours_) {
          const auto other = static_cast<Place>(place + distance);
          if (state_[other] != kTile || waits[other]) continue;
          waits[other] = true;
          next.push_back(other);
        }
      }
      std::sort(next.begin(), next.end());
    }
  }
  [[nodiscard]] bool is_outside(Place place) const {
    return std::any_of(neighbours_.begin(), neighbours_.end(), [&](const auto& neighbour) {
      return state_[static_cast<Place>(place + neighbour.first)] == kNone;
    });
  }

  [[nodiscard]] bool may_go(Place place) {
    typename CubeBoundary<N>::Set shared;
    for (const auto& [distance, face] : neighbours_)
      if (state_[static_cast<Place>(place + distance)] != kNone) shared.set(face);
    if (shared.count() == neighbours_.size()) return false;
    const auto known = may_go_.find(shared);
    if (known != may_go_.end()) return known->second;
    typename CubeBoundary<N>::Set closed;
    for (std::size_t face = 0; face < CubeBoundary<N>::kFaces; ++face)
      if (shared[face]) closed |= boundary_.closure(face);
    const bool result = boundary_.collapses(closed);
    constexpr std::size_t kMostKnown = std::size_t{1} << 20;
    if (may_go_.size() < kMostKnown) may_go_.emplace(shared, result);
    return result;
  }

  const SampleGrid<N>& grid_;
  const SampleOrder& values_;
  const PaddedTiles& tiles_;
  std::vector<std::uint8_t> state_;
  std::vector<std::pair<std::ptrdiff_t, std::size_t>> neighbours_;  ///< distance, face shared
  CubeBoundary<N> boundary_;
  std::unordered_map<typename CubeBoundary<N>::Set, bool> may_go_;  ///< lookup by key only: the order does not matter
};

template <int N>
std::vector<Place> thin(std::span<const std::size_t> sizes, std::span<const std::ptrdiff_t> strides,
                        const SampleOrder& values, const PaddedTiles& tiles, const Progress& progress) {
  SampleGrid<N> grid;
  std::copy_n(sizes.begin(), N, grid.sizes.begin());
  std::copy_n(strides.begin(), N, grid.strides.begin());
  return Thinning<N>(grid, values, tiles).run(progress);
}

}  // namespace

template <Value T>
std::vector<Place> thin_tiles(const SampleView<T>& samples, const PaddedTiles& tiles, const Progress& progress) {
  if (tiles.rows() == 0) return {};
  constexpr std::array kThin = {thin<2>, thin<3>, thin<4>, thin<5>};
  return kThin[static_cast<std::size_t>(samples.dim - 2)](samples.axes(), samples.strides, OrderOf<T>(samples.data),
                                                          tiles, progress);
}

#define TEGL_INSTANTIATE(T) \
  template std::vector<Place> thin_tiles<T>(const SampleView<T>&, const PaddedTiles&, const Progress&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
