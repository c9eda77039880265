// SPDX-License-Identifier: BSD-3-Clause
//
// Facets of images with periodic axes: those in a last layer, which repeats the first one, are merged with those of the
// same faces of the grid in the first layer.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "tegl/facet_hierarchy.hpp"

namespace tegl::detail {

/// Merges the facets of the image that is longer by one layer along each axis in `seam_axes`.
template <int N, class Real>
class SeamMerging {
 public:
  SeamMerging(FacetHierarchy<N, Real>& facets, unsigned seam_axes)
      : facets_(facets), longer_(facets.sizes), seam_axes_(seam_axes) {}

  void run() {
    for (int a = 0; a < N; ++a) facets_.sizes[a] -= is_periodic(a) ? 1 : 0;
    std::vector<Index> below;  // new numbers of the facets of the next lower dimension
    for (int k = 0; k < N; ++k) {
      auto& level = facets_.levels[k];
      const std::vector<Index> kept = find_kept(level.places);
      std::vector<Index> numbers(kept.size());
      Index next = 0;
      for (std::size_t f = 0; f < kept.size(); ++f) numbers[f] = kept[f] == f ? next++ : numbers[kept[f]];
      if (k == 0)
        move_points(kept, next);
      else
        move_lists(level, kept, below);
      for (std::size_t f = 0; f < kept.size(); ++f)
        if (kept[f] == f) level.places[numbers[f]] = in_image(level.places[f]);
      level.places.resize(next);
      below = std::move(numbers);
    }
  }

 private:
  using Level = typename FacetHierarchy<N, Real>::Level;
  using Sample = std::array<std::size_t, N>;

  [[nodiscard]] bool is_periodic(int axis) const noexcept { return (seam_axes_ >> axis & 1u) != 0; }
  [[nodiscard]] Sample sample_of(const FacetPlace& place) const noexcept {
    Sample sample;
    std::uint64_t rest = place.base;
    for (int a = 0; a < N; ++a) {
      sample[a] = static_cast<std::size_t>(rest % longer_[a]);
      rest /= longer_[a];
    }
    return sample;
  }
  /// The place in the image that is not longer.
  [[nodiscard]] FacetPlace in_image(FacetPlace place) const noexcept {
    const Sample sample = sample_of(place);
    place.base = 0;
    for (int a = N - 1; a >= 0; --a) place.base = place.base * facets_.sizes[a] + sample[a] % facets_.sizes[a];
    return place;
  }
  /// Whether the facet's face lies in the first or last layer across a periodic axis.
  [[nodiscard]] bool is_on_seam(const FacetPlace& place) const noexcept {
    const Sample sample = sample_of(place);
    for (int a = 0; a < N; ++a)
      if (is_periodic(a) && (place.axes >> a & 1u) == 0 && (sample[a] == 0 || sample[a] + 1 == longer_[a])) return true;
    return false;
  }
  /// By facet: the smallest number of the facets at the same place.
  [[nodiscard]] std::vector<Index> find_kept(const Buffer<FacetPlace>& places) const {
    using Key = std::tuple<std::uint64_t, unsigned, unsigned, bool, Index>;
    std::vector<Key> keys;
    std::vector<Index> kept(places.size());
    for (std::size_t f = 0; f < places.size(); ++f) {
      kept[f] = static_cast<Index>(f);
      if (!is_on_seam(places[f])) continue;
      const FacetPlace place = in_image(places[f]);
      keys.emplace_back(place.base, place.axes, place.number, place.is_cap, kept[f]);
    }
    std::sort(keys.begin(), keys.end());
    const auto place_of = [](const Key& key) {
      return std::tuple(std::get<0>(key), std::get<1>(key), std::get<2>(key), std::get<3>(key));
    };
    for (std::size_t i = 1; i < keys.size(); ++i)
      if (place_of(keys[i]) == place_of(keys[i - 1])) kept[std::get<4>(keys[i])] = kept[std::get<4>(keys[i - 1])];
    return kept;
  }
  void move_points(const std::vector<Index>& kept, std::size_t count) {
    for (auto* const rows : {&facets_.vertices, &facets_.normals}) {
      if (rows->empty()) continue;
      std::size_t next = 0;
      for (std::size_t f = 0; f < kept.size(); ++f)
        if (kept[f] == f) (*rows)[next++] = (*rows)[f];
      rows->resize(count);
    }
  }
  /// Removes the boundaries of merged facets. `below`: new numbers of their facets.
  static void move_lists(Level& level, const std::vector<Index>& kept, const std::vector<Index>& below) {
    std::size_t facets = 0, end = 0, from = 0;
    for (std::size_t f = 0; f < kept.size(); ++f) {
      const std::size_t to = level.down_first[f + 1];
      if (kept[f] == f) {
        for (std::size_t e = from; e < to; ++e, ++end) {
          level.down[end] = below[level.down[e]];
          level.down_signs[end] = level.down_signs[e];
        }
        level.down_first[++facets] = static_cast<Index>(end);
      }
      from = to;
    }
    level.down_first.resize(facets + 1);
    level.down.resize(end);
    level.down_signs.resize(end);
  }

  FacetHierarchy<N, Real>& facets_;
  Sample longer_;
  unsigned seam_axes_;
};

}  // namespace tegl::detail
