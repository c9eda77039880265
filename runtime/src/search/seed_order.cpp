// SPDX-License-Identifier: BSD-3-Clause
//
// Seeds by traversing tiles in an order: a tile that earlier tiles cover is no seed. No tile depends on a later one, so
// propagation from the seeds reaches every covered tile.
#include <algorithm>
#include <queue>

#include "search/seed_methods.hpp"

namespace tegl::detail {

namespace {

/// Whether the ranges of the neighbours in `done` cover the range of a tile.
template <class Key>
bool is_covered(const RangeMap<Key>& map, const std::vector<std::ptrdiff_t>& neighbours, const std::vector<bool>& done,
                Place tile) {
  Key level = map.least[tile];
  while (level < map.greatest[tile]) {
    Key farthest = level;
    for (const std::ptrdiff_t distance : neighbours) {
      const auto other = static_cast<Place>(tile + distance);
      if (done[other] && map.least[other] <= level) farthest = std::max(farthest, map.greatest[other]);
    }
    if (farthest == level) return false;
    level = farthest;
  }
  return true;
}

template <class Key>
class Climb {
 public:
  Climb(const RangeMap<Key>& map, const std::vector<std::ptrdiff_t>& neighbours)
      : map_(map), neighbours_(neighbours), done_(map.tiles.room()), waits_(map.tiles.room()) {}

  void start(Place tile) {
    if (done_[tile] || map_.constant(tile)) return;
    take_seed(tile);
    while (!beside_.empty() || !wide_.empty()) {
      while (!beside_.empty()) {
        const Place next = beside_.back();
        beside_.pop_back();
        waits_[next] = false;
        if (done_[next]) continue;
        if (is_covered(map_, neighbours_, done_, next))
          finish(next);
        else
          wide_.push({map_.width(next), next});
      }
      if (wide_.empty()) return;
      const Place next = wide_.top().place;
      wide_.pop();
      if (done_[next]) continue;
      if (is_covered(map_, neighbours_, done_, next))
        finish(next);
      else
        take_seed(next);
    }
  }
  std::vector<Place> take() { return std::move(seeds_); }

 private:
  struct Wide {
    Key width;
    Place place;
    bool operator<(const Wide& other) const noexcept {
      return width != other.width ? width < other.width : place > other.place;
    }
  };

  void take_seed(Place tile) {
    seeds_.push_back(tile);
    finish(tile);
  }
  void finish(Place tile) {
    done_[tile] = true;
    for (const std::ptrdiff_t distance : neighbours_) {
      const auto other = static_cast<Place>(tile + distance);
      if (done_[other] || waits_[other] || map_.constant(other) || !map_.overlap(tile, other)) continue;
      waits_[other] = true;
      beside_.push_back(other);
    }
  }

  const RangeMap<Key>& map_;
  const std::vector<std::ptrdiff_t>& neighbours_;
  std::vector<bool> done_, waits_;
  std::vector<Place> beside_;
  std::priority_queue<Wide> wide_;
  std::vector<Place> seeds_;
};

/// Calls visit(place) for all tiles and reports progress.
template <class Visit>
void scan_with_progress(const PaddedTiles& tiles, const std::vector<int>& order, const Progress& progress,
                        const Visit& visit) {
  std::size_t met = 0;
  tiles.scan(order, [&](Place tile) {
    if (met++ % (std::size_t{1} << 18) == 0)
      report_progress(progress, static_cast<double>(met) / static_cast<double>(tiles.room()));
    visit(tile);
  });
  report_progress(progress, 1.0);
}

}  // namespace

template <class Key>
std::vector<Place> sweep_tiles(const RangeMap<Key>& map, const std::vector<std::ptrdiff_t>& neighbours,
                               const std::vector<int>& order, const Progress& progress) {
  std::vector<bool> done(map.tiles.room());
  std::vector<Place> seeds;
  scan_with_progress(map.tiles, order, progress, [&](Place tile) {
    if (map.constant(tile)) return;
    if (!is_covered(map, neighbours, done, tile)) seeds.push_back(tile);
    done[tile] = true;
  });
  return seeds;
}

template <class Key>
std::vector<Place> climb_tiles(const RangeMap<Key>& map, const std::vector<std::ptrdiff_t>& neighbours,
                               const std::vector<int>& order, const Progress& progress) {
  Climb<Key> climb(map, neighbours);
  scan_with_progress(map.tiles, order, progress, [&](Place tile) { climb.start(tile); });
  return climb.take();
}

#define TEGL_INSTANTIATE(Key)                                                                       \
  template std::vector<Place> sweep_tiles(const RangeMap<Key>&, const std::vector<std::ptrdiff_t>&, \
                                          const std::vector<int>&, const Progress&);                \
  template std::vector<Place> climb_tiles(const RangeMap<Key>&, const std::vector<std::ptrdiff_t>&, \
                                          const std::vector<int>&, const Progress&);
TEGL_INSTANTIATE(std::uint8_t)
TEGL_INSTANTIATE(std::uint16_t)
TEGL_INSTANTIATE(std::uint32_t)
TEGL_INSTANTIATE(std::uint64_t)
#undef TEGL_INSTANTIATE

}  // namespace tegl::detail
