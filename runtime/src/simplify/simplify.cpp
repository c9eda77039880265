// SPDX-License-Identifier: BSD-3-Clause
//
// Simplification from the options to the result: constraints by hyperplanes, rounds until the error bound holds, and
// attributes of vertices and simplices.
#include "tegl/simplify.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "base/kept_pages.hpp"
#include "base/periods.hpp"
#include "base/progress.hpp"
#include "mesh/validate.hpp"
#include "simplify/collapsible_complex.hpp"
#include "simplify/contour_coordinates.hpp"
#include "simplify/edge_collapse.hpp"
#include "simplify/error_attribute.hpp"
#include "simplify/measured_contour.hpp"
#include "simplify/simplify_fast.hpp"
#include "simplify/simplify_options.hpp"
#include "simplify/simplify_orders.hpp"
#include "tegl/check.hpp"

namespace tegl {
namespace detail {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
/// Rounds that reduce the tolerance of parts with too large an error; later rounds set it to 0.
constexpr unsigned kScalingRounds = 6;
constexpr unsigned kMostRounds = 12;
/// Maximum number of further rounds that stop at a count.
constexpr unsigned kMostRoundsOfStop = 4;
/// Search for the smallest error that reaches a count: number of trials, first error in least tolerances, step factor,
/// and the factor up to which the result is determined.
constexpr unsigned kMostTries = 10;
constexpr double kErrorOfTolerance = 3.0;
constexpr std::size_t kKeptBytes = 128;        ///< by simplex: memory of one step that is kept for the next one
constexpr std::size_t kMostSearched = 50'000;  ///< simplices: larger contours take one round with quadrics
constexpr double kNextError = 1.5;
constexpr double kPrecision = 1.25;
/// Number of steps down by a factor of 4 before a tolerance of almost 0 is tried.
constexpr unsigned kMostSteps = 2;
/// Progress of one round after its preparation and after its contractions.
constexpr double kReady = 0.2;
constexpr double kCollapsed = 0.97;
constexpr double kCounted = 0.35;  ///< after the contractions if no other round follows
/// Relative to the size of the contour: bound of the rounding errors of an error.
constexpr double kRounding = 1e-12;
/// Relative to the size of the contour: an error that counts as 0. Sums of squared distances are accurate only to its
/// square.
constexpr double kZeroError = 1e-8;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Remaining simplices, before they become a contour.
template <int N>
struct RemainingSimplices {
  std::vector<std::array<Index, N>> simplices;  ///< vertex numbers of the original
  std::vector<std::size_t> sources;             ///< #S: simplex of the original; empty if unknown
};

/// Works in double precision. The result has the precision of the contour's coordinates.
template <int N>
class Simplifier {
 public:
  /// `is_single`: whether the coordinates are rounded to single precision.
  Simplifier(const Contour<N, double>& contour, bool is_single, const SimplifyOptions<N>& options)
      : contour_(contour), is_single_(is_single), options_(options) {
    require_options(options);
    require_sound(contour);
    for (int a = 0; a < N; ++a) {
      double low = kUnlimited, high = -kUnlimited;
      for (const auto& vertex : contour.vertices) {
        low = std::min(low, vertex[a]);
        high = std::max(high, vertex[a]);
      }
      box_[a] = {low, high};
      if (low <= high) size_ = std::max({size_, (high - low) * options.scale[a], kEpsilon * std::abs(high)});
    }
    const auto before = static_cast<double>(contour.simplices.size());
    if (options.ratio) count_ = static_cast<std::size_t>(std::llround(*options.ratio * before));
    if (options.count) count_ = std::max<std::size_t>(count_, *options.count);
    earlier_error_ = earlier_error<N>(contour, options.scale);
    gather_vertex_data();
  }

  Simplification<N, double> run() {
    const KeptPages pages(kKeptBytes * contour_.simplices.size());  // of the round, for the measurement
    stats_.simplices_before = contour_.simplices.size();
    stats_.vertices_before = contour_.vertices.size();
    Contour<N, double> result = contour_.simplices.empty() ? contour_ : run_rounds();
    stats_.simplices_after = result.simplices.size();
    stats_.vertices_after = result.vertices.size();
    tell(options_.work.progress, 1.0, "simplification cancelled at its end");
    return {std::move(result), stats_};
  }

 private:
  static constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

  /// Collects normals and attributes by vertex. The error attribute of an earlier simplification is not carried along:
  /// it is added to the new error.
  void gather_vertex_data() {
    if (!contour_.normals.empty()) carried_width_ = N;
    for (const Attribute& attribute : contour_.vertex_attributes) {
      if (attribute.name == kErrorName) continue;
      carried_attributes_.push_back(&attribute);
      carried_width_ += static_cast<std::size_t>(attribute.width);
    }
    carried_.reserve(contour_.vertices.size() * carried_width_);
    for (std::size_t v = 0; v < contour_.vertices.size(); ++v) {
      if (!contour_.normals.empty())
        carried_.insert(carried_.end(), contour_.normals[v].begin(), contour_.normals[v].end());
      for (const Attribute* attribute : carried_attributes_) {
        const auto width = static_cast<std::size_t>(attribute->width);
        carried_.insert(carried_.end(), attribute->values.begin() + static_cast<std::ptrdiff_t>(v * width),
                        attribute->values.begin() + static_cast<std::ptrdiff_t>((v + 1) * width));
      }
    }
  }

  /// The result of a round, and its errors.
  struct Round {
    Contour<N, double> result = {};
    std::vector<double> errors = {};  ///< #S; empty if not measured
    std::optional<double> error_of_original = {};
    std::optional<double> error_of_result = {};
    SimplifyEnd end = SimplifyEnd::count;
    bool is_limited = false;            ///< only the maximum error or curvature prevented more contractions
    std::vector<Index> survivors = {};  ///< #V: the vertex that each vertex was merged into; empty if unknown
    std::vector<Index> kept = {};       ///< the original numbers of the result's vertices
  };

  Contour<N, double> run_rounds() {
    if (options_.max_error && earlier_error_ > *options_.max_error + kRounding * size_)
      throw Error(
          ErrorCode::InvalidArgument,
          fmt::format(
              "the largest error is {}, but the contour's error from before (its attribute {}, by this scale) is {}; "
              "expected at least that, or a contour without one",
              *options_.max_error, kErrorName, earlier_error_));
    // Rounding alone moves points, so only the unchanged contour has an error of 0.
    if (options_.max_error && (*options_.max_error == 0.0 || earlier_error_ > *options_.max_error))
      return finish(unchanged(is_reducible() ? SimplifyEnd::error : end_without_limits(contour_)));
    if (options_.max_error) return finish(run_within_max_error());
    if (!options_.measure) return finish(one_round(uniform_tolerance(kUnlimited), 1.0, count_));
    return finish(minimize_error(kUnlimited));
  }

  [[nodiscard]] std::vector<double> uniform_tolerance(double error) const {
    return std::vector<double>(contour_.vertices.size(), error);
  }
  /// Whether a count is reached in one round. A search would take many minutes for large contours.
  [[nodiscard]] bool takes_one_round() const {
    return options_.method == SimplifyMethod::fast ||
           (options_.method == SimplifyMethod::quadric && contour_.simplices.size() > kMostSearched);
  }
  [[nodiscard]] bool by_count() const { return options_.count || options_.ratio; }

  /// Simplifies within the maximum error less the earlier one. With a count, the result for the count is taken if it is
  /// within the error. If no round keeps the error, the result is the contour itself.
  Round run_within_max_error() {
    const double allowed = *options_.max_error - earlier_error_ + kRounding * size_;
    if (by_count() && count_ > 0) {
      Round by_count = minimize_error(allowed);
      if (by_count.end == SimplifyEnd::count && own_error(by_count) <= allowed) return by_count;
    }
    Round best;
    if (!reach_within_error(allowed, best, false)) return unchanged(SimplifyEnd::rounds);
    if (own_error(best) <= 0.5 * allowed) measure_exactly(best);
    return best;
  }

  /// Whether some round keeps this error (and reaches the count if `to_count`). `best` becomes that round; or, with
  /// `to_count`, a round that reaches the count with a smaller error than `best`.
  bool reach_within_error(double allowed, Round& best, bool to_count) {
    std::vector<double> tolerance = uniform_tolerance(allowed);
    std::optional<Round> all = reduce_within_error(allowed, tolerance, to_count);
    if (!all) return false;
    if (all->result.simplices.size() >= count_ || !by_count()) {
      best = std::move(*all);
      return true;
    }
    for (unsigned tried = 1; tried <= kMostRoundsOfStop; ++tried) {
      Round round = one_round(tolerance, progress_after(0.25), count_);
      if (round.end != SimplifyEnd::count) break;
      measure(round, progress_after(1.0 / 3.0), 0.5 * allowed);
      const bool near = own_error(round) <= allowed;
      if (!near) tighten(tolerance, round, allowed, tried);
      if (near || (to_count && error(round) < error(best))) best = std::move(round);
      if (near) return true;
    }
    if (!to_count) best = std::move(*all);
    return !to_count;
  }

  /// Simplifies as far as this error allows, without a count. Parts with too large an error are simplified again with
  /// less tolerance. (With a count, other parts would be contracted in their place, and exceed the error in turn.)
  /// Empty if `to_count` and the count is not reached or the search was long enough, or after kMostRounds rounds.
  std::optional<Round> reduce_within_error(double allowed, std::vector<double>& tolerance, bool to_count) {
    for (unsigned tried = 1; tried <= kMostRounds; ++tried) {
      Round round = one_round(tolerance, progress_after(0.25), 0);
      if (to_count && (round.end != SimplifyEnd::count || measured_.took_long())) break;
      // Bounds below half of the allowed error need no refinement.
      measure(round, progress_after(1.0 / 3.0), 0.5 * allowed);
      if (own_error(round) <= allowed) return round;
      tighten(tolerance, round, allowed, tried);
    }
    return std::nullopt;
  }

  /// Reaches a count with a small error, up to `most`. Most of the error comes from a few contractions in thin parts.
  /// So this searches for the smallest maximum error with which the count is still reached, unless `takes_one_round`.
  Round minimize_error(double most) {
    const bool once = takes_one_round();
    const bool last = once && most == kUnlimited;
    Round best = one_round(uniform_tolerance(once ? most : kUnlimited), last ? kCounted : progress_after(0.25), count_,
                           {.by_mean = once});
    measure(best, last ? 1.0 : progress_after(1.0 / 3.0));
    if (best.end != SimplifyEnd::count || once) return best;
    double low = smallest_tolerance(best);
    double factor = kErrorOfTolerance;
    bool found = false, failed = false;
    const auto is_open = [&] { return low < most && own_error(best) > kPrecision * low && !measured_.took_long(); };
    for (unsigned tried = 0; tried < kMostTries && is_open(); ++tried) {
      const double middle = std::sqrt(low * own_error(best));
      double allowed = middle;
      if (!found) allowed = std::min(factor * low, middle);
      if (found && !failed) allowed = own_error(best) / kPrecision;
      allowed = std::min(allowed, most);
      if (reach_within_error(allowed, best, true)) {
        found = true;
        continue;
      }
      low = allowed;
      // Small steps first: usually the smallest error is near.
      factor = failed ? factor * factor : kNextError;
      failed = true;
    }
    return best;
  }

  /// The smallest uniform tolerance that reaches the count, or a slightly smaller one, below the error of `best`. It is
  /// positive, because flat regions alone may reach the count with almost none. `best` becomes the result for it if its
  /// error is smaller.
  double smallest_tolerance(Round& best) {
    const double least = kZeroError * size_;
    double low = 0.0, high = own_error(best);
    std::optional<Round> reached;
    for (unsigned tried = 0; tried < kMostTries && high > kNextError * std::max(low, least); ++tried) {
      double middle = low > 0.0 ? std::sqrt(low * high) : 0.25 * high;
      if (low == 0.0 && (tried >= kMostSteps || middle < least)) middle = least;
      Round round = one_round(uniform_tolerance(middle), progress_after(0.05), count_);
      const bool is_enough = round.end == SimplifyEnd::count;
      (is_enough ? high : low) = middle;
      if (is_enough) reached = std::move(round);
    }
    if (reached) {
      measure(*reached, progress_after(0.05));
      if (error(*reached) < error(best)) best = std::move(*reached);
    }
    return std::max(low, least);
  }

  static double error(const Round& round) { return std::max(*round.error_of_original, *round.error_of_result); }
  /// The error without the earlier one.
  [[nodiscard]] double own_error(const Round& round) const { return error(round) - earlier_error_; }

  /// Progress after this fraction of the remaining range: the number of rounds is unknown.
  [[nodiscard]] double progress_after(double share) const { return progress_ + share * (1.0 - progress_); }

  /// Simplifies once until at most `stop` simplices are left, and advances the progress to `to`; without measurement.
  struct RoundKind {
    bool is_trial = false;  ///< the result is discarded, so it may be non-manifold
    bool by_mean = false;   ///< CollapseGoal::by_mean
  };
  Round one_round(const std::vector<double>& tolerance, double to, std::size_t stop, RoundKind kind = {}) {
    ++stats_.rounds;
    const Progress progress = detail::part_of(options_.work.progress, progress_, to);
    progress_ = to;
    const bool is_fast = options_.method == SimplifyMethod::fast;
    Round round = is_fast ? run_meshoptimizer(tolerance, stop, kind.is_trial, progress)
                          : collapse_edges(tolerance, stop, kind, progress);
    round.end = end_without_limits(round.result);
    if (round.end == SimplifyEnd::shape && round.is_limited) round.end = SimplifyEnd::error;
    if (round.result.simplices.size() != contour_.simplices.size()) return round;
    Round same = unchanged(round.end);
    same.is_limited = round.is_limited;
    return same;
  }

  /// Reason of the end if no maximum error or curvature was the limit.
  [[nodiscard]] SimplifyEnd end_without_limits(const Contour<N, double>& result) const {
    return by_count() && result.simplices.size() <= count_ ? SimplifyEnd::count : SimplifyEnd::shape;
  }

  /// Whether the contour has more simplices than requested and any could be removed without an error limit. Errors:
  /// also those for a contour that is no manifold.
  bool is_reducible() {
    const std::size_t before = contour_.simplices.size();
    const Round round = one_round(uniform_tolerance(kUnlimited), progress_after(0.5), before - 1, {.is_trial = true});
    stats_.rounds = 0;
    if (end_without_limits(contour_) == SimplifyEnd::count) return false;
    return round.is_limited || round.result.simplices.size() < before;
  }

  /// The unchanged contour as a round.
  Round unchanged(SimplifyEnd end) const {
    Round round;
    round.result = contour_;
    std::erase_if(round.result.vertex_attributes, [](const Attribute& other) { return other.name == kErrorName; });
    round.errors.assign(contour_.simplices.size(), 0.0);
    round.error_of_original = round.error_of_result = earlier_error_;
    round.end = end;
    return round;
  }

  Contour<N, double> finish(Round round) {
    if (round.result.simplices.empty())
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("meshoptimizer left none of {} triangles; expected some: a larger count, or another "
                              "method",
                              contour_.simplices.size()));
    stats_.end = round.end;
    if (!options_.measure && !options_.max_error) return std::move(round.result);
    stats_.error_of_original = round.error_of_original;
    stats_.error_of_result = round.error_of_result;
    add_errors(round.result, round.errors);
    return std::move(round.result);
  }

  /// One round of a method that contracts edges.
  Round collapse_edges(const std::vector<double>& tolerance, std::size_t stop, RoundKind kind,
                       const Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    EdgeCollapse<N> collapse = prepared_collapse(tolerance, detail::part_of(progress, 0.0, kReady));
    keep_neighbours(collapse.complex().take_neighbours());
    // contract
    CollapseGoal goal{stop, options_.max_curvature, kind.by_mean, &progress, kReady, kCollapsed, options_.work.threads};
    if (!kind.is_trial && (options_.measure || options_.max_error)) goal.ready = [this] { measured_.begin(); };
    if (options_.method == SimplifyMethod::quadric) collapse_by_quadrics(collapse, goal);
    if (options_.method == SimplifyMethod::facets) collapse_by_curvature(collapse, goal);
    if (options_.method == SimplifyMethod::vertices) collapse_by_distance(collapse, goal);
    // collect the remaining simplices
    Round round;
    round.is_limited = collapse.is_limited();
    round.survivors.resize(contour_.vertices.size());
    for (Index v = 0; v < round.survivors.size(); ++v) round.survivors[v] = collapse.survivor(v);
    RemainingSimplices<N> remains;
    for (Index s = 0; s < collapse.complex().simplex_count(); ++s) {
      if (!collapse.complex().is_alive(s)) continue;
      remains.simplices.push_back(collapse.complex().simplex(s));
      remains.sources.push_back(s);
    }
    set_result(round, remains, &collapse);
    stats_.simplify_seconds += seconds_since(start);
    detail::tell(progress, 1.0);
    return round;
  }

  /// Keeps the neighbours of the original for its measurement, and for further rounds.
  void keep_neighbours(std::shared_ptr<const FacetNeighbours<N>> neighbours) {
    if (stats_.rounds > 1 || !(options_.measure || options_.max_error)) return;
    measured_.set_neighbours(neighbours);
    if (!takes_one_round() || options_.max_error) neighbours_ = std::move(neighbours);
  }

  /// The contour before its first contraction, bound to its hyperplanes.
  EdgeCollapse<N> prepared_collapse(const std::vector<double>& tolerance, const Progress& progress) const {
    CollapseInput<N> input;
    input.simplices = contour_.simplices;
    input.points.reserve(contour_.vertices.size());
    for (const auto& vertex : contour_.vertices) {
      PointN<N> point;
      for (int a = 0; a < N; ++a) point[a] = vertex[a];
      input.points.push_back(point);
    }
    input.tolerance = tolerance;
    input.scale = options_.scale;
    input.carried_width = carried_width_;
    input.carried = carried_;
    input.border_fixed = options_.border == SimplifyBorder::fixed;
    input.single_precision = is_single_;
    input.keep_embedded = options_.keep_embedded;
    input.neighbours = neighbours_;
    input.threads = options_.work.threads;
    input.progress = progress;
    EdgeCollapse<N> collapse(std::move(input));
    bind_to_planes(collapse);
    return collapse;
  }

  /// One round of the method `fast`.
  Round run_meshoptimizer(const std::vector<double>& tolerance, std::size_t stop, bool is_trial,
                          const Progress& progress) {
    Round round;
    RemainingSimplices<N> remains;
    if constexpr (N == 3) {
      const auto start = std::chrono::steady_clock::now();
      if (progress && !progress(0.0)) throw Error(ErrorCode::Cancelled, "simplification cancelled before it began");
      // scale
      std::vector<PointN<3>> points;
      points.reserve(contour_.vertices.size());
      for (const auto& vertex : contour_.vertices) {
        PointN<3> point;
        for (int a = 0; a < 3; ++a) point[a] = vertex[a] * options_.scale[a];
        points.push_back(point);
      }
      const auto within = [&](double error) {
        return simplify_fast(contour_.simplices, points, stop, error, options_.border == SimplifyBorder::fixed);
      };
      if (!options_.allow_nonmanifold) {
        const CollapsibleComplex<3> complex(contour_.simplices, points.size());  // for the same errors as other methods
        require_manifold(contour_, "the contour");
      }
      // simplify with the smallest tolerance; test whether it is the limit
      const double tightest = *std::min_element(tolerance.begin(), tolerance.end());
      remains.simplices = within(tightest);
      round.is_limited = remains.simplices.size() > count_ && tightest < kUnlimited &&
                         within(kUnlimited).size() < remains.simplices.size();
      stats_.simplify_seconds += seconds_since(start);
    }
    set_result(round, remains, nullptr);
    if (!options_.allow_nonmanifold && !is_trial) require_manifold(round.result, "meshoptimizer's result");
    return round;
  }

  static void require_manifold(const Contour<N, double>& contour, const char* what) {
    const MeshReport report = check(contour);
    auto sorted = contour.simplices;  // `check` takes two triangles with the same corners for a sphere
    for (auto& simplex : sorted) std::sort(simplex.begin(), simplex.end());
    std::sort(sorted.begin(), sorted.end());
    const bool twice = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
    if (report.nonmanifold_simplices + report.bad_links + report.orientation_conflicts == 0 && !twice) return;
    throw Error(
        ErrorCode::UnsupportedData,
        fmt::format("{} is not an oriented manifold ({} faces in more than two triangles, {} bad links, {} orientation "
                    "conflicts{}); expected one: allow nonmanifold results, or use another method",
                    what, report.nonmanifold_simplices, report.bad_links, report.orientation_conflicts,
                    twice ? ", triangles with the same corners" : ""));
  }

  // ---- hyperplanes ----

  void bind_to_planes(EdgeCollapse<N>& collapse) const {
    unsigned number = 0;
    for (int a = 0; a < N; ++a)
      for (const double side : {box_[a].first, box_[a].second}) {
        if (has_part_in_side(collapse, a, side))
          for (Index v = 0; v < collapse.points().size(); ++v)
            if (collapse.points()[v][a] == side) collapse.bind(v, number);
        ++number;
      }
    const double precision = is_single_ ? 1e-6 : 1e-12;
    for (const Hyperplane<N>& plane : options_.planes) {
      for (Index v = 0; v < collapse.points().size(); ++v) {
        double sum = -plane.offset, size = std::abs(plane.offset);
        for (int a = 0; a < N; ++a) {
          sum += plane.normal[a] * collapse.points()[v][a];
          size += std::abs(plane.normal[a] * collapse.points()[v][a]);
        }
        if (std::abs(sum) <= precision * size) collapse.bind(v, number);
      }
      ++number;
    }
  }

  /// Whether a whole simplex or a whole border face lies in a side of the bounding box.
  static bool has_part_in_side(EdgeCollapse<N>& collapse, int axis, double side) {
    for (Index s = 0; s < collapse.complex().simplex_count(); ++s) {
      int outside = 0, last_outside = 0;
      for (int i = 0; i < N; ++i)
        if (collapse.points()[collapse.complex().simplex(s)[i]][axis] != side) {
          ++outside;
          last_outside = i;
        }
      if (outside == 0) return true;
      if (outside == 1 && (collapse.complex().border_faces(s) >> last_outside & 1u) != 0) return true;
    }
    return false;
  }

  // ---- errors ----

  /// Computes error bounds in both directions, and by simplex of the result.
  void measure(Round& round, double to, double enough = 0.0) {
    if (round.error_of_original) return;  // the contour itself
    const double from = std::exchange(progress_, to);
    const auto start = std::chrono::steady_clock::now();
    if (round.result.simplices.empty()) {  // infinitely far away
      round.error_of_original = kUnlimited;
      round.error_of_result = earlier_error_;
      return;
    }
    auto [of_original, of_result] = measured_.measure(
        round.result, enough, {options_.work.threads, detail::part_of(options_.work.progress, from, to)});
    round.errors = std::move(of_original.of_to);
    for (std::size_t s = 0; s < round.errors.size(); ++s)
      round.errors[s] = std::max(round.errors[s], of_result.of_from[s]);
    round.error_of_original = of_original.bound + earlier_error_;
    round.error_of_result = of_result.bound + earlier_error_;
    stats_.measure_seconds += seconds_since(start);
  }

  /// Measures without a threshold a result whose bounds were accepted early.
  void measure_exactly(Round& round) {
    if (round.survivors.empty()) return;  // the contour itself
    const Round before{
        .errors = round.errors, .error_of_original = round.error_of_original, .error_of_result = round.error_of_result};
    round.error_of_original.reset();
    measure(round, progress_after(0.5));
    if (error(round) <= error(before)) return;
    round.errors = before.errors;  // both sets of bounds hold; keep the smaller maximum
    round.error_of_original = before.error_of_original;
    round.error_of_result = before.error_of_result;
  }

  /// Reduces the tolerance of all vertices that were merged into a simplex with too large an error.
  void tighten(std::vector<double>& tolerance, const Round& round, double allowed, unsigned tried) const {
    const bool gently = tried <= kScalingRounds;
    const auto factor_for = [&](double error) { return std::clamp(0.8 * allowed / error, 0.1, 0.8); };
    if (round.survivors.empty()) {
      const double factor = factor_for(own_error(round));
      for (double& t : tolerance) t = tried + 2 < kMostRounds ? factor * t : 0.0;
      return;
    }
    std::vector<double> factors(contour_.vertices.size(), 1.0);
    for (std::size_t s = 0; s < round.errors.size(); ++s) {
      const double error = round.errors[s];
      if (error <= allowed) continue;
      const double factor = gently ? factor_for(error) : 0.0;
      for (const Index v : round.result.simplices[s]) factors[round.kept[v]] = std::min(factors[round.kept[v]], factor);
    }
    // The cause may lie around it: unchanged surroundings would give the same result again.
    if (!gently) spread(factors, round, std::size_t{1} << (tried - kScalingRounds - 1));
    for (std::size_t v = 0; v < tolerance.size(); ++v) tolerance[v] *= factors[round.survivors[v]];
  }

  /// Spreads the minimum factors by `rings` rings of simplices.
  void spread(std::vector<double>& factors, const Round& round, std::size_t rings) const {
    for (std::size_t ring = 0; ring < rings; ++ring) {
      const std::vector<double> before = factors;
      for (const auto& simplex : round.result.simplices) {
        double least = 1.0;
        for (const Index v : simplex) least = std::min(least, before[round.kept[v]]);
        for (const Index v : simplex) factors[round.kept[v]] = std::min(factors[round.kept[v]], least);
      }
    }
  }

  /// Adds the error attribute: by vertex the maximum bound of its simplices.
  void add_errors(Contour<N, double>& result, const std::vector<double>& errors) const {
    Attribute attribute;
    attribute.name = kErrorName;
    attribute.unit = error_unit<N>(contour_, options_.scale);
    attribute.values.assign(result.vertices.size(), earlier_error_);
    for (std::size_t s = 0; s < errors.size(); ++s)
      for (const Index v : result.simplices[s])
        attribute.values[v] = std::max(attribute.values[v], errors[s] + earlier_error_);
    result.vertex_attributes.push_back(std::move(attribute));
  }

  // ---- the result ----

  /// Sets the round's contour: the used vertices, in their order, with attributes. `collapse`: gives the new places of
  /// vertices; null: the places are unchanged.
  void set_result(Round& round, const RemainingSimplices<N>& remains, const EdgeCollapse<N>* collapse) const {
    Contour<N, double>& result = round.result;
    result.axis_names = contour_.axis_names;
    result.axis_units = contour_.axis_units;
    result.direction = contour_.direction;
    std::vector<Index> number(contour_.vertices.size(), 0);
    for (const auto& simplex : remains.simplices)
      for (const Index v : simplex) number[v] = 1;
    // number the used vertices
    for (std::size_t v = 0; v < number.size(); ++v) {
      if (number[v] == 0) continue;
      number[v] = static_cast<Index>(round.kept.size());
      round.kept.push_back(static_cast<Index>(v));
    }
    // simplices and vertices
    result.simplices.reserve(remains.simplices.size());
    for (auto simplex : remains.simplices) {
      for (Index& v : simplex) v = number[v];
      result.simplices.push_back(simplex);
    }
    result.vertices.reserve(round.kept.size());
    for (const Index v : round.kept) {
      auto vertex = contour_.vertices[v];
      if (collapse != nullptr)
        for (int a = 0; a < N; ++a) vertex[a] = rounded(collapse->points()[v][a]);
      result.vertices.push_back(vertex);
    }
    append_vertex_data(result, round.kept, collapse);
    if (!remains.sources.empty()) append_simplex_attributes(result, remains.sources);
  }

  /// Appends normals and attributes of the vertices with these original numbers.
  void append_vertex_data(Contour<N, double>& result, const std::vector<Index>& kept,
                          const EdgeCollapse<N>* collapse) const {
    for (const Attribute* attribute : carried_attributes_) {
      result.vertex_attributes.push_back({attribute->name, attribute->unit, attribute->width, {}});
      result.vertex_attributes.back().values.reserve(kept.size() * static_cast<std::size_t>(attribute->width));
    }
    for (const Index v : kept) {
      std::span<const double> values =
          collapse != nullptr ? collapse->carried(v) : std::span(carried_).subspan(v * carried_width_, carried_width_);
      if (!contour_.normals.empty()) {
        const bool same = collapse == nullptr || collapse->version(v) == 0;
        result.normals.push_back(same ? contour_.normals[v] : unit_normal(values.first(N)));
        values = values.subspan(N);
      }
      for (std::size_t i = 0; i < carried_attributes_.size(); ++i) {
        const auto width = static_cast<std::size_t>(carried_attributes_[i]->width);
        auto& target = result.vertex_attributes[i].values;
        target.insert(target.end(), values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width));
        values = values.subspan(width);
      }
    }
  }

  /// A coordinate as the contour's number type stores it.
  [[nodiscard]] double rounded(double x) const { return is_single_ ? static_cast<double>(static_cast<float>(x)) : x; }

  [[nodiscard]] std::array<double, N> unit_normal(std::span<const double> sum) const {
    PointN<N> normal;
    std::copy(sum.begin(), sum.end(), normal.begin());
    const double length = norm(normal);
    std::array<double, N> result{};
    if (length > 0.0)
      for (int a = 0; a < N; ++a) result[a] = rounded(normal[a] / length);
    return result;
  }

  void append_simplex_attributes(Contour<N, double>& result, const std::vector<std::size_t>& sources) const {
    for (const Attribute& attribute : contour_.simplex_attributes) {
      Attribute& left = result.simplex_attributes.emplace_back();
      left.name = attribute.name;
      left.unit = attribute.unit;
      left.width = attribute.width;
      const auto width = static_cast<std::ptrdiff_t>(attribute.width);
      left.values.reserve(sources.size() * static_cast<std::size_t>(attribute.width));
      for (const std::size_t s : sources) {
        const auto first = attribute.values.begin() + static_cast<std::ptrdiff_t>(s) * width;
        left.values.insert(left.values.end(), first, first + width);
      }
    }
  }

  const Contour<N, double>& contour_;
  const bool is_single_;
  const SimplifyOptions<N>& options_;
  std::array<std::pair<double, double>, N> box_;
  double size_ = 0.0;
  std::size_t count_ = 0;
  std::size_t carried_width_ = 0;
  std::vector<double> carried_;
  std::vector<const Attribute*> carried_attributes_;
  double earlier_error_ = 0.0;
  double progress_ = 0.0;  ///< reported so far
  SimplifyStats stats_;
  std::shared_ptr<const FacetNeighbours<N>> neighbours_;  ///< of the original, once they are found, for further rounds
  MeasuredContour<N> measured_{contour_, options_.scale, options_.work.threads};
};

}  // namespace
}  // namespace detail

template <int N, Coordinate Real>
requires DimensionBetween<N, 2, 4> Simplification<N, Real> simplify(const Contour<N, Real>& contour,
                                                                    const SimplifyOptions<N>& options) {
  detail::require_unwrapped(contour, "simplify");
  if constexpr (std::is_same_v<Real, double>) {
    return detail::Simplifier<N>(contour, false, options).run();
  } else {
    const Contour<N, double> in_doubles = detail::with_coordinates<double, N>(contour);
    auto [result, stats] = detail::Simplifier<N>(in_doubles, true, options).run();
    return {detail::with_coordinates<Real, N>(std::move(result)), stats};
  }
}

#define TEGL_INSTANTIATE_CONTOURS(N, Real) \
  template Simplification<N, Real> simplify(const Contour<N, Real>&, const SimplifyOptions<N>&);
#include "base/instantiate.hpp"

}  // namespace tegl
