// SPDX-License-Identifier: BSD-3-Clause
//
// Tests of the simplices that a contraction replaces: first their star as a whole, then each against those near it.
#include "intersect/moving_simplices.hpp"

#include <algorithm>
#include <utility>

namespace tegl::detail {

namespace {
/// Marks of simplices: replaced by the contraction; near one that is.
constexpr std::uint8_t kReplaced = 1, kNear = 2;
}  // namespace

template <int N>
MovingSimplices<N>::MovingSimplices(std::vector<PointN<N>> points, std::span<const Simplex> simplices,
                                    const Progress& progress)
    : points_(std::move(points)),
      rows_(simplices.begin(), simplices.end()),
      simplices_(points_, rows_, 1, part_of(progress, 0.0, 0.5)),
      boxes_(simplices_, 1, part_of(progress, 0.5, 1.0)),
      place_(rows_.size()),
      pairs_(simplices_),
      stars_(simplices_),
      marked_(rows_.size()),
      embedded_(points_.size()) {
  for (std::size_t i = 0; i < boxes_.order().size(); ++i) place_[boxes_.order()[i]] = static_cast<Index>(i);
}

/// Moves the point, and replaces v by u. The boxes stay.
template <int N>
void MovingSimplices<N>::move(const Contraction& contraction) {
  points_[contraction.u] = contraction.at;
  for (const Index s : contraction.only_v) std::replace(rows_[s].begin(), rows_[s].end(), contraction.v, contraction.u);
  for (const auto& part : {contraction.only_u, contraction.only_v})
    for (const Index s : part) simplices_.update(s);
}

/// Undoes `move`.
template <int N>
void MovingSimplices<N>::restore(const Contraction& contraction, const PointN<N>& from) {
  points_[contraction.u] = from;
  for (const Index s : contraction.only_v) std::replace(rows_[s].begin(), rows_[s].end(), contraction.u, contraction.v);
  for (const auto& part : {contraction.only_u, contraction.only_v})
    for (const Index s : part) simplices_.update(s);
}

template <int N>
bool MovingSimplices<N>::stay_apart(const Contraction& contraction) {
  const PointN<N> from = points_[contraction.u];
  move(contraction);
  for (const auto& part : {contraction.only_u, contraction.only_v, contraction.both})
    for (const Index s : part) marked_[s] = kReplaced;
  const bool result = are_apart(contraction);
  for (const auto& part : {contraction.only_u, contraction.only_v, contraction.both})
    for (const Index s : part) marked_[s] = 0;
  restore(contraction, from);
  return result;
}

template <int N>
bool MovingSimplices<N>::are_apart(const Contraction& contraction) {
  changed_.clear();
  for (const auto& part : {contraction.only_u, contraction.only_v})
    for (const Index s : part)
      if (!simplices_.is_flat(s)) changed_.push_back(s);
  if (!star_is_apart(contraction.u)) return false;
  find_candidates();
  test_link(contraction.u);
  const bool result = candidates_are_apart();
  for (const Index w : link_) embedded_[w] = 0;
  return result;
}

/// Whether the changed simplices, all at u, do not intersect each other.
template <int N>
bool MovingSimplices<N>::star_is_apart(Index u) {
  if (stars_.is_embedded(u, changed_)) return true;
  PointN<N> place;
  for (std::size_t i = 0; i < changed_.size(); ++i) {
    pairs_.load(changed_[i]);
    for (std::size_t j = i + 1; j < changed_.size(); ++j)
      if (pairs_.meets(changed_[j], place)) return false;
  }
  return true;
}

template <int N>
void MovingSimplices<N>::find_candidates() {
  candidates_.clear();
  near_.clear();
  for (const Index s : changed_)
    boxes_.visit_near(simplices_.corners(s), [&](Index t) {
      if (marked_[t] == kReplaced) return;
      candidates_.push_back({s, t});
      if (marked_[t] == kNear) return;
      marked_[t] = kNear;
      near_.push_back(t);
    });
  for (const Index t : near_) marked_[t] = 0;
}

/// Tests the stars of the other vertices of changed simplices. Their boxes meet, so near_ contains all of them.
template <int N>
void MovingSimplices<N>::test_link(Index u) {
  link_.clear();
  const auto add = [&](Index s, bool adds_vertices) {
    for (const Index w : rows_[s]) {
      const auto at = static_cast<std::size_t>(std::find(link_.begin(), link_.end(), w) - link_.begin());
      if (w == u || (at == link_.size() && !adds_vertices)) continue;
      if (at == link_.size()) {
        link_.push_back(w);
        if (around_.size() < link_.size()) around_.emplace_back();
        around_[at].clear();
      }
      around_[at].push_back(s);
    }
  };
  for (const Index s : changed_) add(s, true);
  for (const Index s : near_) add(s, false);
  for (std::size_t i = 0; i < link_.size(); ++i) embedded_[link_[i]] = stars_.is_embedded(link_[i], around_[i]) ? 1 : 0;
}

template <int N>
bool MovingSimplices<N>::share_embedded_vertex(Index s, Index t) const {
  bool result = false;
  for (const Index v : rows_[s])
    for (const Index w : rows_[t]) result |= v == w && embedded_[v] != 0;
  return result;
}

/// Whether no changed simplex intersects one that stays.
template <int N>
bool MovingSimplices<N>::candidates_are_apart() {
  PointN<N> place;
  Index loaded = 0;
  bool is_loaded = false;
  for (const Candidate& candidate : candidates_) {
    if (share_embedded_vertex(candidate.changed, candidate.other)) continue;
    if (!is_loaded || loaded != candidate.changed) pairs_.load(candidate.changed);
    is_loaded = true;
    loaded = candidate.changed;
    if (pairs_.meets(candidate.other, place)) return false;
  }
  return true;
}

template <int N>
void MovingSimplices<N>::contract(const Contraction& contraction) {
  move(contraction);
  for (const Index s : contraction.both) boxes_.replace(place_[s], nullptr);
  for (const auto& part : {contraction.only_u, contraction.only_v})
    for (const Index s : part) {
      const CornersN<N> corners = simplices_.corners(s);
      boxes_.replace(place_[s], simplices_.is_flat(s) ? nullptr : &corners);
    }
}

template class MovingSimplices<2>;
template class MovingSimplices<3>;
template class MovingSimplices<4>;

}  // namespace tegl::detail
