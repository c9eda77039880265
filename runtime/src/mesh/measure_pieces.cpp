// SPDX-License-Identifier: BSD-3-Clause
//
// Parallel counts of faces and sums over simplices and vertices, compiled once for both types of coordinates.
#include "mesh/measure_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/orthonormal.hpp"
#include "base/workers.hpp"
#include "mesh/closed_stars.hpp"
#include "mesh/lifts.hpp"

namespace tegl::detail {

namespace {

/// The results of one block by label, in the order in which the block meets the labels. Use one per thread.
template <class Found>
class FoundByLabel {
 public:
  using Part = std::vector<std::pair<Index, Found>>;

  explicit FoundByLabel(Index count) : places_(count, kNowhere) {}

  /// The entry of a label in the part of a block; a new one is made by `make(label)`.
  template <class Make>
  Found& at(Part& part, Index label, const Make& make) {
    if (!part.empty() && part[last_].first == label) return part[last_].second;
    std::size_t& place = places_[label];
    if (place == kNowhere) {
      place = part.size();
      part.emplace_back(label, make(label));
    }
    last_ = place;
    return part[place].second;
  }
  /// Ends a block.
  void finish(const Part& part) {
    for (const auto& [label, found] : part) places_[label] = kNowhere;
    last_ = 0;
  }

 private:
  static constexpr std::size_t kNowhere = ~std::size_t{0};
  std::vector<std::size_t> places_;  ///< by label: in the current part
  std::size_t last_ = 0;
};

template <int N>
struct Extent {
  std::uint64_t vertices = 0;
  PointOf<N> lowest, highest;

  explicit Extent(const PointOf<N>& at) : lowest(at), highest(at) {}
  void add(const PointOf<N>& low, const PointOf<N>& high, std::uint64_t count) {
    vertices += count;
    for (int a = 0; a < N; ++a) {
      lowest[a] = std::min(lowest[a], low[a]);
      highest[a] = std::max(highest[a], high[a]);
    }
  }
};

/// The labels of items; without an array, all have the label 0.
struct Labels {
  std::span<const Index> of;
  std::size_t items;

  [[nodiscard]] std::size_t size() const noexcept { return items; }
  [[nodiscard]] Index operator[](std::size_t i) const noexcept { return of.empty() ? 0 : of[i]; }
};

/// The first item with each label.
std::vector<Index> first_items(const Labels& labels, Index count) {
  std::vector<Index> first(count, 0);
  std::vector<bool> is_known(count, false);
  for (std::size_t i = 0, missing = count; missing > 0 && i < labels.size(); ++i) {
    if (labels[i] >= count || is_known[labels[i]]) continue;
    is_known[labels[i]] = true;
    first[labels[i]] = static_cast<Index>(i);
    --missing;
  }
  return first;
}

constexpr std::size_t kFewItems = 64;

/// Calls add(found, first, end) for all items with a label below `count`, in parallel by block: for consecutive items
/// with one label. `add` is made by make_add(from, to) for at most kFewItems items at a time. Then calls merge(found of
/// a block, label) in order.
template <class Found, class Make, class MakeAdd, class Merge>
void for_labelled(const Labels& labels, Index count, unsigned threads, const Progress& progress, const Make& make,
                  const MakeAdd& make_add, const Merge& merge) {
  std::vector<typename FoundByLabel<Found>::Part> parts(block_count(labels.size(), kBlock));
  for_each_block(
      labels.size(), kBlock, threads, progress, [&] { return FoundByLabel<Found>(count); },
      [&](std::size_t block, std::size_t from, std::size_t to, FoundByLabel<Found>& found) {
        for (std::size_t few = from; few < to; few += kFewItems) {
          const std::size_t end = std::min(to, few + kFewItems);
          const auto add = make_add(few, end);
          for (std::size_t i = few, next = few; i < end; i = next) {
            const Index label = labels[i];
            while (next < end && labels[next] == label) ++next;
            if (label < count) add(found.at(parts[block], label, make), i, next);
          }
        }
        found.finish(parts[block]);
      });
  for (const auto& part : parts)
    for (const auto& [label, found] : part) merge(found, label);
}

/// Simplices of a contour with labels, and the reference point of each label.
template <int N>
struct LabelledPieces {
  const SimplexView<N>& contour;
  Labels labels;
  std::span<const PointOf<N>> references;
  const Lifts<N>& lifts;  ///< of a wrapped contour
};

/// Adds a few simplices to their sums.
template <int N>
class AddPieces {
 public:
  AddPieces(const LabelledPieces<N>& pieces, std::size_t from, std::size_t to) : pieces_(pieces), from_(from) {
    if constexpr (kHasTerms)
      if (pieces.contour.periods().empty())
        find_piece_terms(pieces.contour, pieces.references, pieces.labels.of, from, std::span(terms_).first(to - from));
  }
  /// Adds the simplices first … end - 1, which have one label.
  void operator()(PieceSums<N>& sum, std::size_t first, std::size_t end) const {
    const PointOf<N>& reference = pieces_.references[pieces_.labels[first]];
    const std::span<const Period<N>> periods = pieces_.contour.periods();
    if (periods.empty()) {
      if constexpr (kHasTerms)
        return sum.add_all(end - first, [&](std::size_t i) { return terms_[first + i - from_]; });
      return pieces_.contour.with_points([&](const auto* points) {
        const std::array<Index, N>* const simplices = pieces_.contour.simplices().data() + first;
        sum.add_all(end - first, [&](std::size_t i) {
          std::array<PointOf<N>, N> corners;
          for (int j = 0; j < N; ++j)
            for (int a = 0; a < N; ++a) corners[j][a] = static_cast<double>(points[simplices[i][j]][a]);
          return piece_terms_of<N>(corners, reference, normal_vector_of<N>(corners));
        });
      });
    }
    for (std::size_t s = first; s < end; ++s) {
      std::array<PointOf<N>, N> corners = pieces_.contour.corners(s);
      if (pieces_.lifts.winds[pieces_.labels[s]])
        move_near(periods, reference, corners[0]);
      else
        corners[0] = pieces_.lifts.point(pieces_.contour, pieces_.contour.simplices()[s][0]);
      for (int j = 1; j < N; ++j) move_near(periods, corners[0], corners[j]);
      sum.add(corners);
    }
  }

 private:
  static constexpr bool kHasTerms = N == 4;

  const LabelledPieces<N>& pieces_;
  std::size_t from_;
  std::array<PieceTerms<N>, kHasTerms ? kFewItems : 0> terms_;  ///< not set if the contour is wrapped
};

}  // namespace

template <int N>
std::optional<PointOf<N>> across_periods(std::span<const Period<N>> periods) {
  // the axis with the longest rest beside the periods
  OrthonormalVectors<N> basis;
  for (const Period<N>& period : periods) basis.add(period.vector);
  if (basis.size() >= N) return std::nullopt;
  PointOf<N> best{};
  for (int a = 0; a < N; ++a)
    if (const PointOf<N> rest = basis.rest_of(unit_vector<N>(a)); length_of<N>(rest) > length_of<N>(best) + 1e-9)
      best = rest;
  const double length = length_of<N>(best);
  for (double& component : best) component /= length;
  return best;
}

template <int N>
std::vector<PieceMeasures<N>> measure_pieces(const SimplexView<N>& contour, std::span<const Index> vertex_labels,
                                             std::span<const Index> simplex_labels, Index count, unsigned threads,
                                             const Progress& progress) {
  const Labels labels{simplex_labels, contour.simplices().size()};
  // by label, a corner of its first simplex
  std::vector<PointOf<N>> reference;
  for (const Index s : first_items(labels, count)) reference.push_back(contour.point(contour.simplices()[s][0]));
  const auto reference_of = [&](Index label) { return reference[label]; };
  // sums over simplices
  const std::span<const Period<N>> periods = contour.periods();
  std::optional<PointOf<N>> across;
  if (!periods.empty()) across = across_periods(periods);
  const Lifts<N> lifts = find_lifts<N>(contour, simplex_labels, reference);
  const auto empty_sum = [&](Index label) {
    return PieceSums<N>(reference[label], across && lifts.winds[label] ? &*across : nullptr);
  };
  std::vector<PieceSums<N>> sums;
  for (Index label = 0; label < count; ++label) sums.push_back(empty_sum(label));
  const LabelledPieces<N> pieces{contour, labels, reference, lifts};
  for_labelled<PieceSums<N>>(
      labels, count, threads, part_of(progress, 0.0, 0.9), empty_sum,
      [&](std::size_t from, std::size_t to) { return AddPieces<N>(pieces, from, to); },
      [&](const PieceSums<N>& sum, Index label) { sums[label].add(sum); });
  // boxes of vertices
  std::vector<Extent<N>> extents(reference.begin(), reference.end());
  for_labelled<Extent<N>>(
      Labels{vertex_labels, vertex_labels.size()}, count, threads, part_of(progress, 0.9, 1.0), reference_of,
      [&](std::size_t, std::size_t) {
        return [&](Extent<N>& extent, std::size_t first, std::size_t end) {
          Extent<N> found = extent;
          for (std::size_t v = first; v < end; ++v) {
            const auto vertex = static_cast<Index>(v);
            const bool is_lifted = !periods.empty() && !lifts.winds[vertex_labels[v]];
            PointOf<N> point = is_lifted ? lifts.point(contour, vertex) : contour.point(vertex);
            if (!periods.empty() && !is_lifted) move_near(periods, reference[vertex_labels[v]], point);
            found.add(point, point, 1);
          }
          extent = found;
        };
      },
      [&](const Extent<N>& extent, Index label) {
        extents[label].add(extent.lowest, extent.highest, extent.vertices);
      });
  std::vector<PieceMeasures<N>> result(count);
  for (Index label = 0; label < count; ++label) {
    const auto& [vertices, lowest, highest] = extents[label];
    result[label] = {vertices,
                     sums[label].count(),
                     sums[label].size(),
                     sums[label].content(),
                     sums[label].centroid(lowest, highest),
                     lowest,
                     highest,
                     !lifts.winds[label] || (across && std::abs(sums[label].directed()) <= 1e-6 * sums[label].size())};
  }
  return result;
}

template <int N>
std::vector<FaceCounts> count_faces(
    std::span<const Index> rows, const Stars& stars, std::span<const Index> labels, std::size_t label_count,
    bool with_euler, unsigned threads, const Progress& progress,
    FunctionRef<void(std::size_t block, const typename FacesOfStars<N>::Ridge& ridge)> on_open) {
  const std::size_t vertices = stars.first.size() - 1;
  std::vector<std::vector<std::pair<Index, FaceCounts>>> parts(block_count(vertices, kBlock));
  for_each_block(
      vertices, kBlock, threads, progress, [&] { return FacesOfStars<N>(rows.data(), vertices, with_euler); },
      [&](std::size_t block, std::size_t from, std::size_t to, FacesOfStars<N>& faces) {
        auto& part = parts[block];
        std::vector<ClosedStar> closed;
        if constexpr (N == 4) {
          closed.resize(to - from);
          count_closed_stars(rows.data(), stars, from, with_euler, closed);
        }
        for (std::size_t v = from; v < to; ++v) {
          const std::span<const Index> star = stars.of(v);
          if (star.empty()) continue;
          const Index label = labels.empty() ? 0 : labels[v];
          if (part.empty() || part.back().first != label) part.emplace_back(label, FaceCounts{});
          FaceCounts& counts = part.back().second;
          if (N == 4 && closed[v - from].is_settled)
            counts.euler += closed[v - from].euler_above();
          else
            counts += faces.visit(static_cast<Index>(v), star, [&](const auto& ridge) { on_open(block, ridge); });
        }
      });
  std::vector<FaceCounts> result(label_count);
  for (const auto& part : parts)
    for (const auto& [label, counts] : part) result[label] += counts;
  return result;
}

template std::vector<FaceCounts> count_faces<2>(std::span<const Index>, const Stars&, std::span<const Index>,
                                                std::size_t, bool, unsigned, const Progress&,
                                                FunctionRef<void(std::size_t, const FacesOfStars<2>::Ridge&)>);
template std::vector<FaceCounts> count_faces<3>(std::span<const Index>, const Stars&, std::span<const Index>,
                                                std::size_t, bool, unsigned, const Progress&,
                                                FunctionRef<void(std::size_t, const FacesOfStars<3>::Ridge&)>);
template std::vector<FaceCounts> count_faces<4>(std::span<const Index>, const Stars&, std::span<const Index>,
                                                std::size_t, bool, unsigned, const Progress&,
                                                FunctionRef<void(std::size_t, const FacesOfStars<4>::Ridge&)>);
template std::vector<FaceCounts> count_faces<5>(std::span<const Index>, const Stars&, std::span<const Index>,
                                                std::size_t, bool, unsigned, const Progress&,
                                                FunctionRef<void(std::size_t, const FacesOfStars<5>::Ridge&)>);
template std::optional<PointOf<2>> across_periods<2>(std::span<const Period<2>>);
template std::optional<PointOf<3>> across_periods<3>(std::span<const Period<3>>);
template std::optional<PointOf<4>> across_periods<4>(std::span<const Period<4>>);
template std::vector<PieceMeasures<2>> measure_pieces<2>(const SimplexView<2>&, std::span<const Index>,
                                                         std::span<const Index>, Index, unsigned, const Progress&);
template std::vector<PieceMeasures<3>> measure_pieces<3>(const SimplexView<3>&, std::span<const Index>,
                                                         std::span<const Index>, Index, unsigned, const Progress&);
template std::vector<PieceMeasures<4>> measure_pieces<4>(const SimplexView<4>&, std::span<const Index>,
                                                         std::span<const Index>, Index, unsigned, const Progress&);
template std::vector<PieceMeasures<5>> measure_pieces<5>(const SimplexView<5>&, std::span<const Index>,
                                                         std::span<const Index>, Index, unsigned, const Progress&);

}  // namespace tegl::detail
