// SPDX-License-Identifier: BSD-3-Clause
//
// Linear programming that decides whether two simplices meet outside of their common face.
//
// Let C be the common vertices, A and B the other vertices of the two simplices. They meet outside of conv(C) if and
// only if there are weights x >= 0 of A, y >= 0 of B, not all zero, and z of C, of any sign, with
//     sum x a - sum y b + sum z c = 0  and  sum x - sum y + sum z = 0.
// (If there are, adding a multiple of each c on both sides makes all weights non-negative.) If there are none, then
// there is a hyperplane through C that separates A from B strictly.
//
// The tableau has these N + 1 rows and a last one, sum x + sum y = 1. Columns of C are pivoted into the basis first and
// stay there. Then the simplex method, with Bland's rule, minimises the sum of one artificial variable for each of the
// other rows. The weights exist if and only if the minimum is 0.
//
// Based on: J. Edmonds, J.-F. Maurras, Note sur les Q-matrices d'Edmonds, 1997: pivots of integer tableaus, whose
// entries are minors of the input and whose divisions are exact; R. Bland, New finite pivoting rules, 1977.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <type_traits>

namespace tegl::detail {

inline constexpr std::size_t kMeetingColumns = 8;  ///< all vertices of two tetrahedra

/// `Number`: an integer type that can hold twice the bits of the minors, or double. `kWithDual`: keeps what `separator`
/// needs. `kMost`: the largest dimension.
template <class Number, bool kWithDual, std::size_t kMost = 4>
class MeetingTableau {
 public:
  /// `dimension`: N, at most kMost. `common`: number of vertices in C. Columns are C, then A, then B.
  MeetingTableau(std::size_t dimension, std::size_t common, std::size_t columns)
      : rows_(dimension + 2), common_(common), columns_(columns), result_(columns + (kWithDual ? rows_ : 0)) {}

  /// Sets the coefficients of a column: the coordinates of a vertex relative to any point, and whether it is in B.
  void set_column(std::size_t column, const std::array<Number, kMost>& point, bool in_b) {
    const std::size_t dimension = rows_ - 2;
    for (std::size_t i = 0; i < dimension; ++i) at(i, column) = in_b ? Number(-point[i]) : point[i];
    at(dimension, column) = Number(in_b ? -1 : 1);
    at(dimension + 1, column) = Number(column < common_ ? 0 : 1);
  }

  /// Whether the weights exist; empty if not decided after `most_pivots`. Values up to `tiny` count as 0.
  [[nodiscard]] std::optional<bool> solve(const Number& tiny, std::size_t most_pivots) {
    for (std::size_t i = 0; i < rows_; ++i) {
      at(i, result_) = Number(i + 1 == rows_ ? 1 : 0);
      basis_[i] = columns_ + i;
      if constexpr (kWithDual) at(i, columns_ + i) = Number(1);
    }
    for (std::size_t c = 0; c < common_; ++c)
      if (!pivot_common(c, tiny)) return std::nullopt;
    for (std::size_t pivots = 0; pivots < most_pivots; ++pivots) {
      const std::size_t column = entering(tiny);
      if (column == columns_) return artificial_sum(result_) <= tiny;
      const std::size_t row = leaving(column, tiny);
      if (row == rows_) return std::nullopt;  // only by rounding: the sum is bounded
      pivot(row, column);
    }
    return std::nullopt;
  }

  /// After solve: calls visit(column, numerator, denominator) for the weights in the basis; all others are 0.
  template <class Visit>
  void visit_weights(const Visit& visit) const {
    for (std::size_t i = 0; i < rows_; ++i)
      if (basis_[i] < columns_) visit(basis_[i], table_[i][result_], denominator_);
  }

  /// After solve has returned false: the coefficients of the coordinates in a linear function that is smaller on A than
  /// on B, and constant on C.
  [[nodiscard]] std::array<Number, kMost> separator() requires kWithDual {
    std::array<Number, kMost> result{};
    for (std::size_t i = 0; i + 2 < rows_; ++i) result[i] = artificial_sum(columns_ + i);
    return result;
  }

 private:
  [[nodiscard]] Number& at(std::size_t row, std::size_t column) { return table_[row][column]; }
  [[nodiscard]] bool is_free(std::size_t row) const { return basis_[row] < common_; }
  [[nodiscard]] bool is_artificial(std::size_t row) const { return basis_[row] >= columns_; }

  /// Pivots a column of C into the basis, in the row with the largest entry. False if there is none.
  bool pivot_common(std::size_t column, const Number& tiny) {
    std::size_t best = rows_;
    Number largest = tiny;
    for (std::size_t i = 0; i < rows_; ++i) {
      if (!is_artificial(i)) continue;
      const Number size = at(i, column) < 0 ? Number(-at(i, column)) : at(i, column);
      if (size > largest) {
        largest = size;
        best = i;
      }
    }
    if (best == rows_) return false;
    if (at(best, column) < 0)
      for (std::size_t j = 0; j <= result_; ++j) at(best, j) = -at(best, j);
    pivot(best, column);
    return true;
  }

  [[nodiscard]] Number artificial_sum(std::size_t column) {
    Number sum(0);
    for (std::size_t i = 0; i < rows_; ++i)
      if (is_artificial(i)) sum += at(i, column);
    return sum;
  }

  /// The first column whose entry reduces the sum of the artificial variables; columns_ if there is none.
  [[nodiscard]] std::size_t entering(const Number& tiny) {
    std::size_t column = common_;
    while (column < columns_ && !(artificial_sum(column) > tiny)) ++column;
    return column;
  }

  /// The row whose variable becomes 0 first; of several rows, the one with the lowest number.
  [[nodiscard]] std::size_t leaving(std::size_t column, const Number& tiny) {
    std::size_t best = rows_;
    for (std::size_t i = 0; i < rows_; ++i) {
      if (is_free(i) || !(at(i, column) > tiny)) continue;
      if (best == rows_) {
        best = i;
        continue;
      }
      const Number here(at(i, result_) * at(best, column)), there(at(best, result_) * at(i, column));
      if (here < there || (here == there && basis_[i] < basis_[best])) best = i;
    }
    return best;
  }

  void pivot(std::size_t row, std::size_t column) {
    const Number pivot = at(row, column);
    if constexpr (std::is_floating_point_v<Number>)
      for (std::size_t j = 0; j <= result_; ++j) at(row, j) /= pivot;
    for (std::size_t i = 0; i < rows_; ++i) {
      if (i == row) continue;
      const Number factor = at(i, column);
      for (std::size_t j = 0; j <= result_; ++j) {
        if constexpr (std::is_floating_point_v<Number>)
          at(i, j) -= factor * at(row, j);
        else
          at(i, j) = Number(Number(at(i, j) * pivot) - Number(factor * at(row, j))) / denominator_;
      }
    }
    if constexpr (!std::is_floating_point_v<Number>) denominator_ = pivot;
    basis_[row] = column;
  }

  static constexpr std::size_t kMostRows = kMost + 2;
  static constexpr std::size_t kMostColumns = 2 * kMost + (kWithDual ? kMostRows : 0) + 1;
  std::size_t rows_, common_, columns_;
  std::size_t result_;  ///< the column of the right-hand side
  std::array<std::array<Number, kMostColumns>, kMostRows> table_{};
  std::array<std::size_t, kMostRows> basis_{};  ///< columns_ + row: artificial
  Number denominator_ = Number(1);              ///< of all entries
};

}  // namespace tegl::detail
