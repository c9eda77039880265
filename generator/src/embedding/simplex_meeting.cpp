// SPDX-License-Identifier: BSD-3-Clause
//
// Affine dependences from minors, in integers of 128 bits.
#include "embedding/simplex_meeting.hpp"

#include <algorithm>
#include <bit>

#include "base/determinant.hpp"

namespace tegl::gen {

namespace {

__extension__ using Wide = __int128;

/// The differences of up to 6 points from the first one: by coordinate, then by point. Below 2^(kGridBits + 1).
template <class T>
using DifferencesOf = std::array<std::array<T, 5>, 4>;
using Differences = DifferencesOf<std::int64_t>;
static_assert(2 * (kGridBits + 1) + 1 < 63, "2 x 2 minors of differences fit into 64 bits");

/// The cross product of all four rows, by Laplace's expansion along pairs of rows: 30 products with 128 bits, where
/// cofactors take 200.
std::array<Wide, 5> cross_product_of_all(const Differences& rows) {
  using Minors = std::array<std::array<std::int64_t, 5>, 5>;  // by columns i < j
  const auto minors_of = [&](std::size_t row) {
    Minors result{};
    for (std::size_t i = 0; i < 5; ++i)
      for (std::size_t j = i + 1; j < 5; ++j)
        result[i][j] = rows[row][i] * rows[row + 1][j] - rows[row][j] * rows[row + 1][i];
    return result;
  };
  const Minors a = minors_of(0), b = minors_of(2);
  const auto product = [](std::int64_t x, std::int64_t y) { return static_cast<Wide>(x) * y; };
  std::array<Wide, 5> result{};
  for (std::size_t c = 0; c < 5; ++c) {
    const std::size_t p = c == 0 ? 1 : 0, q = c <= 1 ? 2 : 1, r = c <= 2 ? 3 : 2, s = c <= 3 ? 4 : 3;  // all but c
    const Wide minor = product(a[p][q], b[r][s]) - product(a[p][r], b[q][s]) + product(a[p][s], b[q][r]) +
                       product(a[q][r], b[p][s]) - product(a[q][s], b[p][r]) + product(a[r][s], b[p][q]);
    result[c] = c % 2 == 0 ? minor : -minor;
  }
  return result;
}

/// A solution of sum(weight[i] * difference i) = 0 for `count` points, up to a factor, by the coordinates in `axes`,
/// which are count - 2. All zero if they do not determine it. The last weight belongs to the first point.
std::array<Wide, 6> dependence(const Differences& differences, unsigned axes, std::size_t count) {
  std::array<Wide, 5> weights;
  if (count == 6) {
    weights = cross_product_of_all(differences);
  } else {
    DifferencesOf<Wide> rows{};
    std::size_t next = 0;
    for (unsigned a = 0; a < 4; ++a)
      if ((axes >> a & 1u) != 0) std::copy(differences[a].begin(), differences[a].end(), rows[next++].begin());
    weights = cross_product(rows, count - 1);
  }
  std::array<Wide, 6> result{};
  for (std::size_t i = 0; i + 1 < count; ++i) result[i] = weights[i], result[5] -= weights[i];
  return result;
}

/// The absolute weights with one sign on P and the other one on Q, and all absolute weights.
struct Shares {
  Wide right = 0, all = 0;
};

Shares shares_of(const std::array<Wide, 6>& weights, std::size_t in_p, std::size_t count) {
  Shares shares;
  for (std::size_t i = 0; i < count; ++i) {
    const Wide weight = i == 0 ? weights[5] : weights[i - 1];
    shares.all += weight < 0 ? -weight : weight;
    if ((weight > 0) == (i < in_p)) shares.right += weight < 0 ? -weight : weight;
  }
  return shares;
}

}  // namespace

SimplexMeeting::SimplexMeeting(int n, const LocalSimplex& a, const LocalSimplex& b) : dim_(n), simplices_{a, b} {
  const auto whole = static_cast<int>(n) + 2;
  for (unsigned p = 1; p < 1u << n; ++p)
    for (unsigned q = 1; q < 1u << n; ++q) {
      if (std::popcount(p) + std::popcount(q) > whole) continue;
      Faces faces{};
      for (int i = 0; i < n; ++i)
        if ((p >> i & 1u) != 0) faces.points[faces.count++] = a[i];
      faces.in_p = faces.count;
      bool disjoint = true;
      for (int i = 0; i < n; ++i) {
        if ((q >> i & 1u) == 0) continue;
        disjoint = disjoint && std::find(faces.points.begin(), faces.points.begin() + faces.in_p, b[i]) ==
                                   faces.points.begin() + faces.in_p;
        faces.points[faces.count++] = b[i];
      }
      if (disjoint) (faces.count == whole ? whole_ : smaller_).push_back(faces);
    }
  vertices_.assign(a.begin(), a.begin() + n);
  vertices_.insert(vertices_.end(), b.begin(), b.begin() + n);
  std::sort(vertices_.begin(), vertices_.end());
  vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
}

double SimplexMeeting::miss(std::span<const GridPoint> places) const {
  double smallest = 1;
  bool is_degenerate = whole_.empty();
  for (const Faces& faces : whole_) {
    Differences differences{};
    for (std::size_t i = 1; i < faces.count; ++i)
      for (int k = 0; k < dim_; ++k) differences[k][i - 1] = places[faces.points[i]][k] - places[faces.points[0]][k];
    const Shares shares = shares_of(dependence(differences, (1u << dim_) - 1, faces.count), faces.in_p, faces.count);
    if (shares.all == 0) {
      is_degenerate = true;
      continue;
    }
    const Wide wrong = std::min(shares.right, shares.all - shares.right);
    if (wrong == 0) return 0;
    smallest = std::min(smallest, static_cast<double>(wrong) / static_cast<double>(shares.all));
  }
  return is_degenerate && meet_in_smaller_faces(places) ? 0 : smallest;
}

/// The perceptron algorithm: the normal moves towards the difference of the two vertices that violate it most.
bool SimplexMeeting::are_clearly_apart(std::span<const GridPoint> places) const {
  constexpr int kMostMoves = 24;
  const auto height = [&](const GridPoint& normal, std::uint8_t v) {
    Wide sum = 0;
    for (int k = 0; k < dim_; ++k) sum += static_cast<Wide>(normal[k]) * places[v][k];
    return sum;
  };
  GridPoint normal{};
  for (int i = 0; i < dim_; ++i)
    for (int k = 0; k < dim_; ++k) normal[k] += places[simplices_[0][i]][k] - places[simplices_[1][i]][k];
  for (int move = 0; move < kMostMoves; ++move) {
    std::uint8_t lowest = simplices_[0][0], highest = simplices_[1][0];
    Wide low = height(normal, lowest), high = height(normal, highest);
    for (int i = 1; i < dim_; ++i) {
      if (const Wide h = height(normal, simplices_[0][i]); h < low) low = h, lowest = simplices_[0][i];
      if (const Wide h = height(normal, simplices_[1][i]); h > high) high = h, highest = simplices_[1][i];
    }
    if (low > high) return true;
    for (int k = 0; k < dim_; ++k) normal[k] += 4 * (places[lowest][k] - places[highest][k]);
  }
  return false;
}

/// Sets of fewer points, in the affine space that they span.
bool SimplexMeeting::meet_in_smaller_faces(std::span<const GridPoint> places) const {
  return std::any_of(smaller_.begin(), smaller_.end(), [&](const Faces& faces) {
    Differences differences{};
    for (std::size_t i = 1; i < faces.count; ++i)
      for (int k = 0; k < dim_; ++k) differences[k][i - 1] = places[faces.points[i]][k] - places[faces.points[0]][k];
    for (unsigned axes = 0; axes < 1u << dim_; ++axes) {
      if (std::popcount(axes) != faces.count - 2) continue;
      const std::array<Wide, 6> weights = dependence(differences, axes, faces.count);
      const Shares shares = shares_of(weights, faces.in_p, faces.count);
      if (shares.all == 0 || (shares.right != 0 && shares.right != shares.all)) continue;
      const bool holds_along_all_axes = std::all_of(differences.begin(), differences.end(), [&](const auto& row) {
        Wide sum = 0;
        for (std::size_t i = 0; i + 1 < faces.count; ++i) sum += weights[i] * row[i];
        return sum == 0;
      });
      if (holds_along_all_axes) return true;
    }
    return false;
  });
}

}  // namespace tegl::gen
