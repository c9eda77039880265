// SPDX-License-Identifier: BSD-3-Clause
//
// The level set of a simplicial complex while the level rises vertex by vertex. It consists of cells, one in each
// simplex that has vertices on both sides of the level (vertices at the level count as below). Two cells touch if their
// simplices share an edge that crosses the level.
//
// Each cell has a label; labels are merged by union-find, and a set of labels is a component. Around a vertex v the
// cells just below it form as many connected groups as the lower link of v has components; the same holds above v and
// its upper link. With one group below and one above there is no event: new cells take the label of the old ones.
// Otherwise the components of the groups below meet in v and become one set. The groups above v may belong to several
// components. To find these, a search over the cells just above v starts from all groups at once, one cell of each in
// turn. It ends when all groups except one are exhausted (connected groups count as one). The cells of exhausted groups
// get new labels; the remaining group keeps the set. So splitting off a component costs the size of the smaller side,
// and two connected groups cost the cells around the place where their searches meet.
//
// The Euler characteristic of the level set changes at v by that of the upper link minus that of the lower link: near v
// the level set is a neighbourhood of the lower link before v and of the upper link after v, and both have the same
// boundary.
//
// Based on: S. Parsa, A deterministic O(m log m) time algorithm for the Reeb graph, 2012 (components of the level set
// under insertion and deletion); H. Doraiswamy and V. Natarajan, Output-sensitive construction of Reeb graphs, 2012
// (only vertices with a disconnected lower or upper link are critical).
#include "track/track_sweep.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "base/periods.hpp"
#include "base/progress.hpp"
#include "base/slice_at.hpp"
#include "track/track_link.hpp"
#include "track/track_measure.hpp"

namespace tegl::detail {
namespace {

/// A component of the level set.
struct Component {
  Index arc = kNone;
  std::uint64_t size = 0;  ///< cells
  std::int64_t euler = 0;
  // State before the vertices of the current time, if the component has met any of them:
  std::uint64_t time = 0;  ///< number of that time
  std::uint64_t size_before = 0;
  std::int64_t euler_before = 0;
};

template <int N>
class Sweeper {
 public:
  Sweeper(const SimplexView<N>& contour, const IncidenceData<N>* incidence, GradientDirection direction,
          const TrackOptions& options)
      : options_(options),
        direction_(direction),
        complex_(contour, incidence, options.work.threads, part_of(options.work.progress, 0.0, kReady)),
        star_(complex_) {
    const std::size_t count = contour.simplices().size();
    labels_.resize(count);
    is_labelled_.assign((count + 63) / 64, 0);
    labels_of_new_.assign(contour.vertex_count(), kNone);
    seen_.resize(count);
    for_each_part(count, options.work.threads, {},
                  [&](std::size_t from, std::size_t to) { std::fill(&seen_[from], &seen_[from] + (to - from), 0u); });
    for (const double time : options.times)
      times_.push_back(contour.is_single() ? static_cast<double>(rounded_at<float>(time)) : rounded_at<double>(time));
    std::tie(result_.first, result_.last) = complex_.times();
    const double epsilon =
        contour.is_single() ? double{std::numeric_limits<float>::epsilon()} : std::numeric_limits<double>::epsilon();
    result_.tolerance = 4 * epsilon * std::max(std::abs(result_.first), std::abs(result_.last));
    if (options.label_simplices) result_.simplex_arcs.assign(count, kNone);
    if (times_.empty() || count == 0) return;
    first_ = complex_.time(0);
    plan_samples();
  }

  SweepResult run() {
    const std::size_t count = complex_.vertex_count();
    for (Index v = 0; v < count; ++v) {
      const double time = complex_.time(v);
      while (!starts_.empty() && next_time_ < times_.size() && is_due(times_[next_time_], time)) take_sample();
      if (v == 0 || time != complex_.time(v - 1)) settle_starts();
      fraction_ = static_cast<double>(v) / static_cast<double>(count);
      visit(v);
    }
    settle_starts();
    fraction_ = 1.0;
    tell_all(kTellEvery);
    return std::move(result_);
  }

 private:
  /// Whether a sample is due before the first vertex at `time` is visited. At the first time of the contour a sample is
  /// the limit from above, as in `slice`: all vertices at that time are visited before it.
  [[nodiscard]] bool is_due(double sample, double time) const {
    return sample < time || (sample == time && time != first_);
  }

  /// Counts visited simplices and reports progress from time to time. Progress is measured by simplices, not by
  /// vertices: the search at a single vertex may take long.
  void tell_all(std::size_t seen) {
    seen_since_ += seen;
    if (seen_since_ < kTellEvery) return;
    seen_since_ = 0;
    detail::tell(options_.work.progress, kReady + (kSwept - kReady) * fraction_, "tracking was cancelled");
  }

  /// The time that is reported for an event at a vertex: of those that differ from its own by rounding only, the one of
  /// most vertices. Points between two layers of an image lie off both by the smallest step (Placement::inside_slab),
  /// so an event at a layer may be at such a point.
  [[nodiscard]] double reported_time(Index v) const {
    const std::span<const double> times = complex_.all_times();
    // half of the tolerance, so that two vertices with one reported time count as equal
    const double from = times[v] - result_.tolerance / 2, to = times[v] + result_.tolerance / 2;
    double best = times[v];
    std::ptrdiff_t most = 1;
    for (auto at = std::lower_bound(times.begin(), times.end(), from); at != times.end() && *at <= to;) {
      const auto end = std::upper_bound(at, times.end(), *at);
      if (end - at > most) best = *at, most = end - at;
      at = end;
    }
    return best;
  }

  // ---- the sweep ----

  void visit(Index v) {
    if (const auto& passage = complex_.passage(v); passage.below != kNone) {
      tell_all(kPassing);
      return pass_by(v, passage);
    }
    const std::span<const Index> cells = complex_.star(v);
    tell_all(1 + cells.size());
    if (cells.empty()) return;
    growth_ = 0;
    for (const Index s : cells) {
      const auto& simplex = complex_.simplex(s);
      growth_ += (simplex.front() == v ? 1 : 0) - (simplex.back() == v ? 1 : 0);
    }
    star_.load(v);
    if (star_.parts_below() == 1 && star_.parts_above() == 1 && !(N >= 4 && star_.at_border()))
      pass(v, find_incoming(v).front(), 0);
    else
      visit_special(v);
  }

  /// Visits a vertex at which no component begins, ends, merges or splits.
  void pass_by(Index v, const typename SweptComplex<N>::Passage& passage) {
    growth_ = passage.growth;
    const Index set = sets_.find(is_labelled(passage.below) ? labels_[passage.below] : labels_of_new_[passage.front]);
    pass(v, set, passage.euler);
    if (passage.euler != 0)
      result_.handles.push_back({complex_.vertex(v), complex_.time(v), reported_time(v), components_[set].arc, true,
                                 std::int64_t{passage.euler}});
  }

  /// A member of the set that a cell which exists belongs to.
  [[nodiscard]] Index label_of(Index s) const {
    return is_labelled(s) ? labels_[s] : labels_of_new_[complex_.simplex(s).front()];
  }
  [[nodiscard]] bool is_labelled(Index s) const { return (is_labelled_[s / 64] >> s % 64 & 1u) != 0; }
  void set_label(Index s, Index label) {
    labels_[s] = label;
    is_labelled_[s / 64] |= std::uint64_t{1} << s % 64;
  }

  /// The sets of the cells below the vertex, without duplicates, sorted by arc.
  const std::vector<Index>& find_incoming(Index v) {
    incoming_.clear();
    const bool one = star_.parts_below() == 1;
    for (const Index s : star_.cells()) {
      if (complex_.simplex(s).front() == v) continue;  // above
      const Index set = sets_.find(label_of(s));
      if (std::find(incoming_.begin(), incoming_.end(), set) == incoming_.end()) incoming_.push_back(set);
      if (one) break;
    }
    std::sort(incoming_.begin(), incoming_.end(),
              [&](Index a, Index b) { return components_[a].arc < components_[b].arc; });
    return incoming_;
  }

  /// Adds the new cells above the vertex to the set.
  void pass(Index v, Index set, std::int64_t euler_change) {
    Component& component = components_[set];
    if (component.time != time_) {
      component.time = time_;
      component.size_before = component.size;
      component.euler_before = component.euler;
    }
    component.size += static_cast<std::uint64_t>(growth_);  // modulo 2^64, as it may be negative
    component.euler += euler_change;
    labels_of_new_[v] = set;
    if (!options_.label_simplices) return;
    for (const Index s : complex_.star(v))
      if (complex_.simplex(s).front() == v) result_.simplex_arcs[s] = component.arc;
  }

  void visit_special(Index v) {
    const std::int64_t euler_change = star_.euler(true) - star_.euler(false);
    const std::vector<Index>& incoming = find_incoming(v);
    std::vector<Component> before;
    for (const Index set : incoming) before.push_back(components_[set]);
    const Index set = join(incoming);
    pass(v, set, euler_change);
    const std::vector<Index> outgoing = star_.parts_above() == 0 ? std::vector<Index>{} : separate(v, set);
    if (before.size() == 1 && outgoing.size() == 1) {
      if (euler_change != 0)
        result_.handles.push_back(
            {complex_.vertex(v), complex_.time(v), reported_time(v), before[0].arc, star_.at_border(), euler_change});
      return;
    }
    const auto node = static_cast<Index>(result_.nodes.size());
    result_.nodes.push_back(
        {complex_.vertex(v), complex_.time(v), reported_time(v), euler_change, star_.at_border(), star_.flatness()});
    for (const Component& component : before) {
      SweepArc& arc = result_.arcs[component.arc];
      arc.to = node;
      const bool met = component.time == time_;
      arc.size_at_end = met ? component.size_before : component.size;
      arc.euler_at_end = met ? component.euler_before : component.euler;
    }
    for (const Index part : outgoing) start_arc(node, part);
    relabel_new_cells(v);
  }

  /// Merges the sets, or creates a set if there are none.
  Index join(const std::vector<Index>& sets) {
    if (sets.empty()) return new_set({});
    if (sets.size() == 1) return sets.front();
    Component sum;
    Index joined = sets.front();
    for (const Index set : sets) {
      sum.arc = components_[set].arc;
      sum.size += components_[set].size;
      sum.euler += components_[set].euler;
      sets_.join(joined, set);
    }
    joined = sets_.find(joined);
    components_[joined] = sum;
    return joined;
  }

  Index new_set(const Component& component) {
    components_.push_back(component);
    return sets_.add();
  }

  void start_arc(Index node, Index set) {
    Component& component = components_[set];
    component.arc = static_cast<Index>(result_.arcs.size());
    result_.arcs.push_back({node, kNone, 0, 0, 0, 0});
    started_.push_back(set);
  }

  /// Stores the start values of new arcs after all vertices of a time have been visited.
  void settle_starts() {
    for (const Index set : started_) {
      const Component& component = components_[sets_.find(set)];
      SweepArc& arc = result_.arcs[component.arc];
      arc.size_at_start = component.size;
      arc.euler_at_start = component.euler;
    }
    started_.clear();
    ++time_;
  }

  /// Assigns the cells that begin at a node to the arcs that begin there.
  void relabel_new_cells(Index v) {
    if (!options_.label_simplices) return;
    for (const Index s : star_.cells())
      if (star_.part(s, true) != kNone && complex_.simplex(s).front() == v)
        result_.simplex_arcs[s] = components_[sets_.find(label_of(s))].arc;
  }

  // ---- separation of the cells above a vertex ----

  /// Cells reached from one group, in breadth-first order.
  struct Front {
    std::vector<Index> cells;
    std::size_t next = 0;         ///< not yet searched over edges
    std::size_t next_across = 0;  ///< N = 4: not yet searched across facets; next at least
    /// N = 4: number of the edges of searched cells, minus that of their triangles, which cross the level. Each is
    /// counted at one cell.
    std::int64_t euler = 0;
    bool is_counted = true;  ///< N = 4: whether no triangle is in more than two tetrahedra; else `euler` is not known
    [[nodiscard]] bool is_done() const { return next == cells.size(); }
  };

  /// The components of the level set just above v within `set`: the set itself, and new sets for exhausted groups, in
  /// the order of their lowest group.
  std::vector<Index> separate(Index v, Index set) {
    std::vector<Index> parts{set};
    if (star_.parts_above() <= 1) return parts;
    // search from all groups in turn until at most one is open
    const std::size_t count = start_fronts();
    const Index level = v;
    for (std::size_t open = count; open > 1;) {
      bool changed = false;
      for (std::size_t f = 0; f < count; ++f) {
        Front& front = fronts_[f];
        if (front.is_done()) continue;
        changed = expand(front, f, level) || changed;
        changed = front.is_done() || changed;
      }
      if (changed) open = open_groups(count);
    }
    // exhausted groups become new sets
    const Index rest = find_rest(count);
    for (Index group = 0; group < count; ++group)
      if (groups_.find(group) == group && group != rest) parts.push_back(part_off(group, count, set, level));
    first_seen_ += static_cast<std::uint32_t>(count);
    return parts;
  }

  /// Creates one front per component of the upper link and marks its cells. Returns the number of fronts.
  std::size_t start_fronts() {
    const auto count = std::size_t{star_.parts_above()};
    if (fronts_.size() < count) fronts_.resize(count);
    if (std::numeric_limits<std::uint32_t>::max() - first_seen_ < count) {
      std::fill(seen_.begin(), seen_.end(), 0u);
      first_seen_ = 1;
    }
    for (std::size_t f = 0; f < count; ++f) {
      fronts_[f].cells.clear();
      fronts_[f].next = fronts_[f].next_across = 0;
      fronts_[f].euler = 0;
      fronts_[f].is_counted = true;
    }
    front_of_part_.assign(star_.link_size(), kNone);
    Index used = 0;
    for (const Index s : star_.cells()) {
      const Index part = star_.part(s, true);
      if (part == kNone) continue;
      if (front_of_part_[part] == kNone) front_of_part_[part] = used++;
      fronts_[front_of_part_[part]].cells.push_back(s);
      seen_[s] = first_seen_ + front_of_part_[part];
    }
    groups_.reset(count);
    return count;
  }

  /// Adds unmarked cells that touch the next cell of a front. Returns true if groups were merged. Tetrahedra are
  /// searched across their triangles first, then over their edges, which takes longer and rarely finds more: most
  /// searches end when they meet.
  bool expand(Front& front, std::size_t number, Index level) {
    if constexpr (N == 4)
      if (front.next_across < front.cells.size()) {
        prefetch_across(front);
        return expand_across(front.cells[front.next_across++], number, level);
      }
    return expand_over(front.cells[front.next++], number, level);
  }

  /// Fetches rows that the next searches across triangles read; most are not in a cache.
  [[gnu::always_inline]] void prefetch_across(const Front& front) const {
    constexpr std::size_t kRows = 8, kNeighbours = 3;
    const std::size_t next = front.next_across;
    if (next + kRows < front.cells.size()) complex_.prefetch(front.cells[next + kRows]);
    if (next + kNeighbours < front.cells.size())
      for (const Index t : complex_.across(front.cells[next + kNeighbours]))
        if (t < kSeveralSimplices) __builtin_prefetch(&seen_[t]);
  }

  bool expand_across(Index s, std::size_t front, Index level) {
    bool joined = false;
    const auto& simplex = complex_.simplex(s);
    int below = 0;
    for (const Index u : simplex) below += u <= level ? 1 : 0;
    tell_all(N);
    for (int i = 0; i < N; ++i) {
      const bool crosses = below - (i < below ? 1 : 0) > 0 && N - below - (i < below ? 0 : 1) > 0;
      if (!crosses) continue;
      const Index t = complex_.across(s)[i];
      if (t < kSeveralSimplices) joined = meet(t, front) || joined;
      fronts_[front].euler -= s < t ? 1 : 0;  // also if there is no other tetrahedron
      if (t == kSeveralSimplices) fronts_[front].is_counted = false;
    }
    return joined;
  }

  /// Searches over the edges of a cell that cross the level: for each vertex below, for each vertex above.
  bool expand_over(Index s, std::size_t front, Index level) {
    const auto& simplex = complex_.simplex(s);
    const std::size_t below =
        static_cast<std::size_t>(std::count_if(simplex.begin(), simplex.end(), [&](Index u) { return u <= level; }));
    const std::span<const Index> lower = std::span(simplex).first(below);
    const std::span<const Index> upper = std::span(simplex).subspan(below);
    if (upper.size() == 1) return expand_around(s, upper[0], lower, front);
    bool joined = false;
    for (const Index a : lower) joined = expand_around(s, a, upper, front) || joined;
    return joined;
  }

  /// Searches over the edges from a vertex of the cell s to others, in their order. One pass over the star finds the
  /// cells around all of these edges.
  bool expand_around(Index s, Index centre, std::span<const Index> others, std::size_t front) {
    const std::span<const Index> star = complex_.star(centre);
    tell_all(star.size());
    around_.clear();
    for (const Index t : star) {
      unsigned met = 0;  // found without branches
      for (const Index u : complex_.simplex(t))
        for (std::size_t i = 0; i < others.size(); ++i) met |= u == others[i] ? 1u << i : 0u;
      if (met != 0) around_.emplace_back(t, met);
    }
    const auto own = first_seen_ + static_cast<std::uint32_t>(front);
    bool joined = false;
    for (unsigned i = 0; i < others.size(); ++i) {
      bool is_first = true;
      for (const auto& [t, met] : around_) {
        if ((met >> i & 1u) == 0) continue;
        fronts_[front].euler += is_first && t == s ? 1 : 0;  // the star is ascending
        is_first = false;
        if (seen_[t] != own) joined = meet(t, front) || joined;
      }
    }
    return joined;
  }

  /// Adds a cell that touches a cell of the front, if it is unmarked. Else returns whether groups were merged.
  bool meet(Index t, std::size_t front) {
    if (seen_[t] < first_seen_) {
      seen_[t] = first_seen_ + static_cast<std::uint32_t>(front);
      fronts_[front].cells.push_back(t);
      return false;
    }
    const Index here = groups_.find(static_cast<Index>(front));
    const Index there = groups_.find(seen_[t] - first_seen_);
    if (here == there) return false;
    groups_.join(here, there);
    return true;
  }

  [[nodiscard]] bool is_done(Index group, std::size_t count) {
    for (Index f = 0; f < count; ++f)
      if (groups_.find(f) == group && !fronts_[f].is_done()) return false;
    return true;
  }
  /// The group that is not exhausted; the last one if all are.
  [[nodiscard]] Index find_rest(std::size_t count) {
    Index rest = 0;
    for (Index f = 0; f < count; ++f) {
      if (groups_.find(f) != f) continue;
      rest = f;
      if (!is_done(f, count)) break;
    }
    return rest;
  }
  [[nodiscard]] std::size_t open_groups(std::size_t count) {
    std::size_t open = 0;
    for (Index f = 0; f < count; ++f) open += groups_.find(f) == f && !is_done(f, count) ? 1 : 0;
    return open;
  }

  /// Moves the cells of an exhausted group from the old set to a new one.
  Index part_off(Index group, std::size_t count, Index old_set, Index level) {
    Component part;
    const Index set = new_set({});
    bool is_counted = N == 4;
    for (Index f = 0; f < count; ++f) {
      if (groups_.find(f) != group) continue;
      for (const Index s : fronts_[f].cells) {
        tell_all(1);
        set_label(s, set);
      }
      part.size += fronts_[f].cells.size();
      part.euler += fronts_[f].euler;
      is_counted = is_counted && fronts_[f].is_counted;
    }
    // a k-face of the complex is a (k-1)-face of the level set
    if (is_counted)
      part.euler += static_cast<std::int64_t>(part.size);
    else
      part.euler = -euler_of_group(group, count, level);
    components_[old_set].size -= part.size;
    components_[old_set].euler -= part.euler;
    components_[set] = part;
    return set;
  }

  /// Alternating number of the faces of a group's cells that cross the level.
  std::int64_t euler_of_group(Index group, std::size_t count, Index level) {
    faces_.clear();
    for (Index f = 0; f < count; ++f)
      if (groups_.find(f) == group)
        for (const Index s : fronts_[f].cells) add_cell_faces(s, level);
    return faces_.euler();
  }

  void add_cell_faces(Index s, Index level) {
    const auto& simplex = complex_.simplex(s);
    unsigned above = 0;
    for (int i = 0; i < N; ++i) above |= simplex[i] > level ? 1u << i : 0u;
    faces_.add(simplex, N, [above](unsigned mask) { return (mask & above) != 0 && (mask & ~above) != 0; });
  }

  // ---- samples ----

  /// Sorts the simplices that are cut at some sample time by the first such time.
  void plan_samples() {
    const auto& contour = complex_.contour();
    const auto first_cut = [&](Index s) {
      const auto [low, high] = span(s);
      const auto at = low == first_ ? std::lower_bound(times_.begin(), times_.end(), low)
                                    : std::upper_bound(times_.begin(), times_.end(), low);
      const bool is_cut =
          low < high && at != times_.end() && *at <= high && !is_collapsed<N>(complex_.simplex(s).data());
      return is_cut ? static_cast<std::size_t>(at - times_.begin()) : times_.size();
    };
    starts_.assign(times_.size() + 3, 0);
    for (Index s = 0; s < contour.simplices().size(); ++s) {
      tell_all(1);
      ++starts_[first_cut(s) + 2];
    }
    for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
    starting_.resize(contour.simplices().size());
    for (Index s = 0; s < contour.simplices().size(); ++s) {
      tell_all(1);
      starting_[starts_[first_cut(s) + 1]++] = s;
    }
    for (int a = 0; a < N - 1; ++a) origin_[a] = contour.coordinate(0, a);
    find_across();
  }

  /// Sets `across_` of a wrapped contour.
  void find_across() {
    std::vector<Period<N - 1>> spatial;
    for (const Period<N>& period : complex_.contour().periods())
      std::copy_n(period.vector.begin(), N - 1, spatial.emplace_back().vector.begin());
    if constexpr (N > 2)
      if (!spatial.empty()) across_ = across_periods<N - 1>(std::span<const Period<N - 1>>(spatial));
  }

  [[nodiscard]] std::pair<double, double> span(Index s) const {
    const auto& simplex = complex_.simplex(s);
    return {complex_.time(simplex.front()), complex_.time(simplex.back())};
  }

  /// Takes a sample. All vertices before its time have been visited. A vertex at the time counts as above, as in
  /// `slice`; at the first time it counts as below.
  void take_sample() {
    const double time = times_[next_time_];
    const double asked_for = options_.times[next_time_];
    // update the list of simplices that are cut
    std::erase_if(cut_, [&](Index s) { return span(s).second < time; });
    cut_.insert(cut_.end(), starting_.begin() + static_cast<std::ptrdiff_t>(starts_[next_time_]),
                starting_.begin() + static_cast<std::ptrdiff_t>(starts_[next_time_ + 1]));
    ++next_time_;
    // add up by arc
    sums_.clear();
    for (const Index s : cut_) {
      tell_all(1);
      const Index arc = components_[sets_.find(label_of(s))].arc;
      if (slots_.size() <= arc) slots_.resize(result_.arcs.size(), kNone);
      if (slots_[arc] == kNone) {
        slots_[arc] = static_cast<Index>(sums_.size());
        sums_.push_back({arc, {}});
      }
      add_cut(s, time, sums_[slots_[arc]].second);
    }
    for (const auto& [arc, sums] : sums_) slots_[arc] = kNone;
    std::sort(sums_.begin(), sums_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [arc, sums] : sums_) result_.samples.push_back({arc, sums.to_sample(asked_for, N - 1, origin_)});
  }

  void add_cut(Index s, double time, PartSums& sums) const {
    std::array<PointOf<N>, N> corners = complex_.contour().corners(s);
    if (const auto periods = complex_.contour().periods(); !periods.empty()) {
      if (!across_) sums.open = true;
      if (!sums.has_near) std::copy(corners[0].begin(), corners[0].end(), sums.near.begin());
      sums.has_near = true;
      PointOf<N> near;
      std::copy_n(sums.near.begin(), N, near.begin());
      for (auto& corner : corners) {
        move_near(periods, near, corner);
        near = corners[0];
      }
    }
    for (auto& corner : corners)
      for (int a = 0; a < N - 1; ++a) corner[a] -= origin_[a];
    PointOf<N> normal = normal_vector_of<N>(corners);
    if (direction_ == GradientDirection::ascent)
      for (double& x : normal) x = -x;
    if constexpr (N == 2) sums.open = true;  // a point encloses nothing
    unsigned below = 0;
    const auto is_below = [&](const PointOf<N>& corner) {
      return corner[N - 1] < time || (time == first_ && corner[N - 1] == time);
    };
    for (int i = 0; i < N; ++i) below |= is_below(corners[i]) ? 1u << i : 0u;
    const unsigned border = complex_.border_of_contour(s);
    for (int i = 0; i < N; ++i)
      if (((border >> i) & 1u) != 0 && (below & ~(1u << i)) != 0 && (~below & kAll & ~(1u << i)) != 0) sums.open = true;
    std::stable_partition(corners.begin(), corners.end(), is_below);
    CutCell<N>(corners, std::popcount(below), time).add_to(sums, normal, across_ ? &*across_ : nullptr);
  }

  static constexpr unsigned kAll = (1u << N) - 1;
  static constexpr std::size_t kPassing = 8;  ///< the work of passing a vertex, in simplices
  static constexpr std::size_t kTellEvery = std::size_t{1} << 16;
  static constexpr double kReady = 0.2;  ///< progress at the start of the sweep

  const TrackOptions& options_;
  const GradientDirection direction_;
  double fraction_ = 0.0;       ///< of the sweep
  std::size_t seen_since_ = 0;  ///< simplices visited since the last progress report
  SweptComplex<N> complex_;
  VertexStar<N> star_;
  SweepResult result_;
  DisjointSets sets_;
  std::vector<Component> components_;  ///< by set, valid at its root
  /// #S: a member of the set that the simplex's cell belongs to, if it is labelled. Else it belongs to the set of its
  /// lowest vertex. Few cells are labelled: only their labels take memory.
  Buffer<Index> labels_;
  std::vector<std::uint64_t> is_labelled_;  ///< by simplex, one bit
  std::vector<Index> labels_of_new_;        ///< by vertex: a member of the set that the cells above it began in
  std::vector<Index> incoming_;
  std::vector<Index> started_;  ///< sets whose arcs started at the current time
  std::uint64_t time_ = 0;      ///< number of distinct times so far
  std::int64_t growth_ = 0;     ///< cells that begin at the current vertex minus those that end

  std::vector<Front> fronts_;
  DisjointSets groups_;         ///< of fronts
  Buffer<std::uint32_t> seen_;  ///< #S: first_seen_ + the front that has the cell
  std::uint32_t first_seen_ = 1;
  std::vector<Index> front_of_part_;
  std::vector<std::pair<Index, unsigned>> around_;  ///< cells of a star, and the edges that they are around
  Faces<N> faces_;

  double first_ = 0.0;         ///< minimum time of a vertex, if there are samples
  std::vector<double> times_;  ///< sample times rounded to the precision of the vertices, as in `slice`
  std::size_t next_time_ = 0;
  std::vector<std::size_t> starts_;  ///< by time: first of its simplices in `starting_`
  std::vector<Index> starting_;
  std::vector<Index> cut_;  ///< simplices cut at the previous sample time
  std::array<double, 4> origin_{};
  std::optional<PointOf<N - 1>> across_;  ///< of a wrapped contour: as in PieceSums
  std::vector<Index> slots_;              ///< by arc: its position in `sums_`
  std::vector<std::pair<Index, PartSums>> sums_;
};

}  // namespace

template <int N, class Real>
SweepResult sweep(const Contour<N, Real>& contour, const IncidenceData<N>* incidence, const TrackOptions& options) {
  return Sweeper<N>(SimplexView<N>(contour), incidence, contour.direction, options).run();
}

#define TEGL_INSTANTIATE_CONTOURS_TO_5(N, Real) \
  template SweepResult sweep(const Contour<N, Real>&, const IncidenceData<N>*, const TrackOptions&);
#include "base/instantiate.hpp"

}  // namespace tegl::detail
