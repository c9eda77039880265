// SPDX-License-Identifier: BSD-3-Clause
//
// Separation of facets next to missing values. Tiles without missing corners may share only an edge or a square of the
// grid there, and so may the contours in these tiles (split_nonmanifold.hpp does the same for simplices).
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "base/disjoint_sets.hpp"
#include "tegl/facet_hierarchy.hpp"

namespace tegl::detail {

template <int N, class Real>
class FacetSeparation {
 public:
  explicit FacetSeparation(FacetHierarchy<N, Real>& facets) : facets_(facets) {}

  /// Separates the facets of dimension k. Higher dimensions must be done before.
  template <class MayNeedIt>
  void run(int k, const MayNeedIt& may_need_it) {
    facets_.connect_up();
    const std::size_t count = facets_.count(k);
    for (std::size_t f = 0; f < count; ++f)
      if (may_need_it(facets_.levels[k].places[f])) separate(k, f);
  }

 private:
  /// The facets of dimension `to` around facet f of dimension k, ascending.
  std::vector<Index> around(int k, Index f, int to) const {
    std::vector<Index> result{f};
    for (; k < to; ++k) {
      std::vector<Index> next;
      for (const Index g : result) {
        const auto up = facets_.up(k, g);
        next.insert(next.end(), up.begin(), up.end());
      }
      std::sort(next.begin(), next.end());
      next.erase(std::unique(next.begin(), next.end()), next.end());
      result.swap(next);
    }
    return result;
  }

  void separate(int k, std::size_t f) {
    const std::vector<Index> tops = around(k, static_cast<Index>(f), N - 1);
    fans_.reset(tops.size());
    const auto place_of = [&](Index top) {
      return static_cast<Index>(std::lower_bound(tops.begin(), tops.end(), top) - tops.begin());
    };
    for (const Index ridge : around(k, static_cast<Index>(f), N - 2)) {
      const auto up = facets_.up(N - 2, ridge);
      for (const Index top : up) fans_.join(place_of(up[0]), place_of(top));
    }
    std::vector<Index> copies(tops.size(), static_cast<Index>(f));  // by fan
    for (Index fan = 1; fan < tops.size(); ++fan)
      if (fans_.find(fan) == fan) copies[fan] = copy(k, f);
    auto& above = facets_.levels[k + 1];
    for (const Index g : facets_.up(k, f)) {
      const Index mine = copies[fans_.find(place_of(around(k + 1, g, N - 1).front()))];
      std::replace(above.down.data() + above.down_first[g], above.down.data() + above.down_first[g + 1],
                   static_cast<Index>(f), mine);
    }
  }

  Index copy(int k, std::size_t f) {
    auto& level = facets_.levels[k];
    const std::size_t number = level.places.size();
    const std::size_t end = k > 0 ? level.down.size() + facets_.down(k, f).size() : 0;
    if (std::max(number, end) >= std::numeric_limits<Index>::max())
      throw Error(ErrorCode::TooLarge, fmt::format("{} facets or incidences of dimension {}; expected at most {}",
                                                   std::max(number, end), k, std::numeric_limits<Index>::max()));
    level.places.push_back(FacetPlace(level.places[f]));
    if (k == 0) {
      facets_.vertices.push_back(std::array<Real, N>(facets_.vertices[f]));
      if (!facets_.normals.empty()) facets_.normals.push_back(std::array<Real, N>(facets_.normals[f]));
      return static_cast<Index>(number);
    }
    for (Index e = level.down_first[f]; e < level.down_first[f + 1]; ++e) {
      level.down.push_back(Index(level.down[e]));
      level.down_signs.push_back(std::int8_t(level.down_signs[e]));
    }
    level.down_first.push_back(static_cast<Index>(level.down.size()));
    return static_cast<Index>(number);
  }

  FacetHierarchy<N, Real>& facets_;
  DisjointSets fans_;
};

/// Doubles facets whose incident (N-1)-facets are not connected through (N-2)-facets around them. `may_need_it(place)`
/// is false for facets that need no test. New facets are appended, in an order that depends only on the facets.
template <int N, class Real, class MayNeedIt>
void separate_facets(FacetHierarchy<N, Real>& facets, const MayNeedIt& may_need_it) {
  for (int k = N - 3; k >= 0; --k) FacetSeparation<N, Real>(facets).run(k, may_need_it);
  if (N == 2) return;
  for (auto& level : facets.levels) {  // `up` is computed on demand
    level.up_first = {};
    level.up = {};
    level.up_signs = {};
  }
}

}  // namespace tegl::detail
