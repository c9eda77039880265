// SPDX-License-Identifier: BSD-3-Clause
//
// Sums over a whole contour or over groups of simplices, shared by `measure` and `components`.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/exact_sum.hpp"
#include "base/periods.hpp"
#include "base/progress.hpp"
#include "mesh/faces_of_stars.hpp"
#include "mesh/piece_terms.hpp"
#include "mesh/simplex_geometry.hpp"
#include "mesh/validate.hpp"
#include "mesh/vertex_stars.hpp"
#include "tegl/contour.hpp"
#include "tegl/error.hpp"
#include "tegl/work.hpp"

namespace tegl::detail {

/// Items sorted by group: group g has members[first[g] … first[g + 1]), ascending.
struct Groups {
  std::vector<std::size_t> first;
  Buffer<Index> members;

  [[nodiscard]] std::span<const Index> of(std::size_t g) const noexcept {
    return std::span(members).subspan(first[g], first[g + 1] - first[g]);
  }
};

/// Groups the items by their labels 0 … count - 1. Items with other labels are in no group.
inline Groups group_by(std::span<const Index> labels, Index count, const Progress& progress = {}) {
  Groups groups;
  groups.first.assign(std::size_t{count} + 2, 0);  // counts are two places up, so that filling turns them into offsets
  in_parts(labels.size(), part_of(progress, 0.0, 0.4), [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      if (labels[i] < count) ++groups.first[labels[i] + std::size_t{2}];
  });
  for (std::size_t g = 1; g < groups.first.size(); ++g) groups.first[g] += groups.first[g - 1];
  groups.members.resize(groups.first.back());
  in_parts(labels.size(), part_of(progress, 0.4, 1.0), [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      if (labels[i] < count) groups.members[groups.first[labels[i] + std::size_t{1}]++] = static_cast<Index>(i);
  });
  groups.first.pop_back();
  return groups;
}

/// Sums over simplices. Coordinates are relative to a reference point near them, so that the terms are small.
///
/// A wrapped contour that winds round a period has no inside of its own cell: the flux of the position vector depends
/// on where the cell is cut. The flux of the field <e, x> e does not, for a unit vector e across all periods. Its
/// divergence is 1, too.
template <int N>
class PieceSums {
 public:
  /// `across`: e of a contour that winds (`across_periods`); null for others.
  explicit PieceSums(const PointOf<N>& reference, const PointOf<N>* across = nullptr)
      : reference_(reference), across_(across) {}

  void add(const std::array<PointOf<N>, N>& corners) noexcept {
    const PointOf<N> normal = normal_vector_of<N>(corners);
    PieceTerms<N> terms = piece_terms_of<N>(corners, reference_, normal);
    if (across_ != nullptr) terms.flux = add_flux_across(corners, normal);
    add(terms);
  }
  /// Adds a simplex of a contour that is not wrapped.
  void add(const PieceTerms<N>& terms) noexcept {
    few_.add(terms);
    ++count_;
    if (++few_.count == kFew) settle();
  }
  /// The same for several simplices: terms_of(0), …, terms_of(count - 1).
  template <class TermsOf>
  void add_all(std::size_t count, const TermsOf& terms_of) noexcept {
    std::size_t i = 0;
    while (i < count && few_.count > 0) add(terms_of(i++));
    for (; i + kFew <= count; i += kFew) {
      Few few;  // stays in registers
      for (std::size_t j = i; j < i + kFew; ++j) few.add(terms_of(j));
      few_ = few;
      count_ += kFew;
      settle();
    }
    while (i < count) add(terms_of(i++));
  }
  /// Adds sums with the same reference point.
  void add(const PieceSums& other) noexcept {
    settle();
    count_ += other.count_;
    size_.add(other.size());
    content_.add(other.content());
    directed_.add(other.directed());
    for (int a = 0; a < N; ++a) moment_[a].add(other.moment_[a].value() + other.few_.moment[a]);
  }

  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  [[nodiscard]] double size() const noexcept { return size_.value() + few_.size; }
  /// N times the volume of the cone over the simplices with its apex at the reference point.
  [[nodiscard]] double content() const noexcept { return content_.value() + few_.content; }
  /// The sum of the normal vectors' components along `across`: not 0 if a wrapped contour has different sides at the
  /// two ends of space, as a plane has.
  [[nodiscard]] double directed() const noexcept { return directed_.value() + few_.directed; }
  /// The middle of the bounding box if the size is 0.
  [[nodiscard]] PointOf<N> centroid(const PointOf<N>& lowest, const PointOf<N>& highest) const noexcept {
    PointOf<N> middle;
    for (int a = 0; a < N; ++a)
      middle[a] = size() > 0 ? reference_[a] + (moment_[a].value() + few_.moment[a]) / (N * size())
                             : lowest[a] + 0.5 * (highest[a] - lowest[a]);
    return middle;
  }

 private:
  /// So many terms are added plainly: their rounding errors are as large as the rounding errors in the terms.
  static constexpr int kFew = 8;
  struct Few {
    double size = 0.0, content = 0.0, directed = 0.0;
    std::array<double, N> moment{};
    int count = 0;

    void add(const PieceTerms<N>& terms) noexcept {
      size += terms.size;
      for (int a = 0; a < N; ++a) moment[a] += terms.moment[a];
      content += terms.flux;
    }
  };

  /// Returns N times the flux of <e, x> e.
  double add_flux_across(const std::array<PointOf<N>, N>& corners, const PointOf<N>& normal) noexcept {
    double directed = 0.0, height = 0.0;
    for (int a = 0; a < N; ++a) {
      directed += normal[a] * (*across_)[a];
      for (const PointOf<N>& corner : corners) height += (corner[a] - reference_[a]) * (*across_)[a];
    }
    few_.directed += directed;
    return directed * height;
  }

  void settle() noexcept {
    size_.add(few_.size);
    content_.add(few_.content);
    if (across_ != nullptr) directed_.add(few_.directed);
    for (int a = 0; a < N; ++a) moment_[a].add(few_.moment[a]);
    few_ = {};
  }

  PointOf<N> reference_;
  const PointOf<N>* across_;
  std::uint64_t count_ = 0;
  Few few_;
  CompensatedSum size_;
  CompensatedSum content_;
  CompensatedSum directed_;
  std::array<CompensatedSum, N> moment_;
};

/// A unit vector across all periods of a wrapped contour, along an axis if possible; none if there is none.
template <int N>
std::optional<PointOf<N>> across_periods(std::span<const Period<N>> periods);

/// Sums and bounding box of the simplices with one label.
template <int N>
struct PieceMeasures {
  std::uint64_t vertices = 0, simplices = 0;
  double size = 0.0;
  double content = 0.0;  ///< N times the enclosed content, if the simplices enclose any
  PointOf<N> centroid{};
  PointOf<N> lowest{};
  PointOf<N> highest{};
  bool bounds = true;  ///< false: the simplices wind round periods and enclose nothing
};

/// Measures of the simplices with each label 0 … count - 1. Each label must have a simplex. Simplices and vertices with
/// other labels are left out; a simplex has the label of its vertices. `vertex_labels`: #V;
/// `simplex_labels`: #S, or empty for label 0.
/// O(#S).
template <int N>
std::vector<PieceMeasures<N>> measure_pieces(const SimplexView<N>& contour, std::span<const Index> vertex_labels,
                                             std::span<const Index> simplex_labels, Index count, unsigned threads,
                                             const Progress& progress);

/// The enclosed content from the sums of a contour; empty if the contour is open.
template <int N>
std::optional<double> content_of(const PieceMeasures<N>& sums, const FaceCounts& faces, GradientDirection direction) {
  if (faces.open > 0 || !sums.bounds) return std::nullopt;
  const double content = sums.content / N;
  return direction == GradientDirection::descent ? content : -content;
}

}  // namespace tegl::detail
