// SPDX-License-Identifier: BSD-3-Clause
//
// The part of a cell's boundary that a region belongs to if spheres beside it are passed.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "regions/sigma_pieces.hpp"

namespace tegl::detail {

/// The tetrahedra in one of the regions that `sets` connects.
template <class Local>
std::vector<std::array<Local, 4>> tetrahedra_in(Index region, DisjointSets& sets,
                                                const std::vector<std::array<Local, 4>>& of_all) {
  std::vector<std::array<Local, 4>> result;
  std::copy_if(of_all.begin(), of_all.end(), std::back_inserter(result),
               [&](const auto& t) { return sets.find(t[0]) == region; });
  return result;
}

/// Number of components with pieces in a facet.
template <class Local>
std::ptrdiff_t components_in(std::size_t facet, const std::map<Index, std::vector<SigmaPiece<Local>>>& components) {
  return std::count_if(components.begin(), components.end(), [&](const auto& each) {
    return std::any_of(each.second.begin(), each.second.end(), [&](const auto& piece) { return piece.facet == facet; });
  });
}

/// Removes the components for which `is_copied(component)`, and returns their pieces.
template <class Local, class IsCopied>
std::vector<SigmaPiece<Local>> take_components(std::map<Index, std::vector<SigmaPiece<Local>>>& components,
                                               const IsCopied& is_copied) {
  std::vector<SigmaPiece<Local>> taken;
  std::erase_if(components, [&](const auto& each) {
    if (!is_copied(each.second)) return false;
    taken.insert(taken.end(), each.second.begin(), each.second.end());
    return true;
  });
  return taken;
}

/// Regions of both sides, joined across the components of Sigma between them, except the spheres beside one region.
/// Each component divides the boundary of the cell, so what is behind these spheres is apart from the region.
class RegionParts {
 public:
  /// `near`, `far`: vertices that are connected on each side. `count`: of vertices. `region`: of `near`.
  RegionParts(DisjointSets& near, DisjointSets& far, Index count, Index region)
      : near_(near), far_(far), count_(count), region_(region), parts_(2 * std::size_t{count}) {}

  /// Joins the regions. Returns what is left of Sigma without the spheres and everything behind them, and of this what
  /// is beside the region.
  template <class Local>
  std::pair<std::vector<SigmaPiece<Local>>, std::vector<SigmaPiece<Local>>> pass_spheres(
      const std::map<Index, std::vector<SigmaPiece<Local>>>& components) {
    std::vector<const std::vector<SigmaPiece<Local>>*> others;
    for (const auto& [root, component] : components)
      if (near_.find(first_of(component)) != region_ || !is_sphere(component)) others.push_back(&component);
    for (const auto* of : others) parts_.join(near_.find(first_of(*of)), count_ + far_.find(first_of(*of)));
    std::pair<std::vector<SigmaPiece<Local>>, std::vector<SigmaPiece<Local>>> left;
    for (const auto* of : others) {
      const Index beside = near_.find(first_of(*of));
      if (parts_.find(beside) == parts_.find(region_)) left.first.insert(left.first.end(), of->begin(), of->end());
      if (beside == region_) left.second.insert(left.second.end(), of->begin(), of->end());
    }
    return left;
  }
  /// Whether a vertex of the far side is behind the spheres.
  [[nodiscard]] bool is_passed(Index vertex) { return parts_.find(count_ + far_.find(vertex)) != parts_.find(region_); }

 private:
  DisjointSets &near_, &far_;
  Index count_, region_;
  DisjointSets parts_;
};

}  // namespace tegl::detail
