// SPDX-License-Identifier: BSD-3-Clause
//
// tile_intersections: the number of tiles whose contour intersects itself, in 3D and 4D, and the total content that the
// contours of noise and of its negative enclose. Writes CSV. Simplices of different tiles never intersect, as each
// simplex lies in its tile.
//
//     tile_intersections [TILES]
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "tegl/extract.hpp"
#include "tegl/measure.hpp"
#include "usage.hpp"

namespace {

using namespace tegl;

/// The common points of two simplices of N points in N dimensions, as weights of the points such that both weighted
/// sums are equal: N + 2 linear equations in 2 N non-negative weights. The simplices intersect outside their common
/// face if and only if a vertex of the solution polytope has weight outside that face.
template <int N>
class CommonPoints {
 public:
  static constexpr std::size_t kWeights = 2 * N;
  using Weights = std::array<double, kWeights>;

  CommonPoints(const std::array<std::array<double, N>, N>& a, const std::array<std::array<double, N>, N>& b) {
    for (std::size_t i = 0; i < N; ++i)
      for (std::size_t k = 0; k < N; ++k) {
        rows_[k][i] = a[i][k];
        rows_[k][N + i] = -b[i][k];
      }
    for (std::size_t i = 0; i < N; ++i) rows_[N][i] = rows_[N + 1][N + i] = 1.0;
    rows_[N][kWeights] = rows_[N + 1][kWeights] = 1.0;
    eliminate();
  }

  /// Calls visit(weights) for the vertices of the polytope until it returns true; returns whether it did.
  template <class Visit>
  [[nodiscard]] bool any_vertex(const Visit& visit) const {
    for (std::size_t i = rank_; i < kRows; ++i)
      if (std::abs(rows_[i][kWeights]) > kTiny) return false;
    for (unsigned basis = 0; basis < 1u << kWeights; ++basis) {
      if (static_cast<std::size_t>(std::popcount(basis)) != rank_) continue;
      const std::optional<Weights> weights = solve(basis);
      if (weights && visit(*weights)) return true;
    }
    return false;
  }

 private:
  static constexpr std::size_t kRows = N + 2;
  static constexpr double kTiny = 1e-9;
  using Row = std::array<double, kWeights + 1>;

  static void subtract(Row& row, const Row& pivot, std::size_t column) {
    const double factor = row[column] / pivot[column];
    if (factor == 0.0) return;
    for (std::size_t j = 0; j <= kWeights; ++j) row[j] -= factor * pivot[j];
    row[column] = 0.0;
  }

  /// Gauss-Jordan elimination with full pivoting; afterwards the first rank_ rows are independent.
  void eliminate() {
    std::array<bool, kWeights> used{};
    for (; rank_ < kRows; ++rank_) {
      double largest = kTiny;
      std::size_t row = kRows, column = 0;
      for (std::size_t i = rank_; i < kRows; ++i)
        for (std::size_t j = 0; j < kWeights; ++j)
          if (!used[j] && std::abs(rows_[i][j]) > largest) {
            largest = std::abs(rows_[i][j]);
            row = i;
            column = j;
          }
      if (row == kRows) return;
      std::swap(rows_[rank_], rows_[row]);
      used[column] = true;
      for (std::size_t i = 0; i < kRows; ++i)
        if (i != rank_) subtract(rows_[i], rows_[rank_], column);
    }
  }

  /// The solution with all weights 0 except those of the basis, unless it does not exist or has a negative weight.
  [[nodiscard]] std::optional<Weights> solve(unsigned basis) const {
    std::array<Row, kRows> rows = rows_;
    Weights weights{};
    std::size_t k = 0;
    for (std::size_t column = 0; column < kWeights; ++column) {
      if ((basis >> column & 1u) == 0) continue;
      std::size_t pivot = k;
      for (std::size_t i = k + 1; i < rank_; ++i)
        if (std::abs(rows[i][column]) > std::abs(rows[pivot][column])) pivot = i;
      if (std::abs(rows[pivot][column]) < kTiny) return std::nullopt;
      std::swap(rows[k], rows[pivot]);
      for (std::size_t i = 0; i < rank_; ++i)
        if (i != k) subtract(rows[i], rows[k], column);
      ++k;
    }
    k = 0;
    for (std::size_t column = 0; column < kWeights; ++column) {
      if ((basis >> column & 1u) == 0) continue;
      weights[column] = rows[k][kWeights] / rows[k][column];
      if (weights[column] < -kTiny) return std::nullopt;
      ++k;
    }
    return weights;
  }

  std::array<Row, kRows> rows_{};
  std::size_t rank_ = 0;
};

/// Minimum and maximum of coordinate k over N points.
template <int N>
std::pair<double, double> span(const std::array<std::array<double, N>, N>& points, std::size_t k) {
  const auto [low, high] =
      std::minmax_element(points.begin(), points.end(), [k](const auto& p, const auto& q) { return p[k] < q[k]; });
  return {(*low)[k], (*high)[k]};
}

/// True if two simplices with at most N - 2 common points intersect elsewhere.
template <int N>
bool intersect(const Contour<N, double>& contour, std::size_t s, std::size_t t) {
  std::array<std::array<double, N>, N> a, b;
  std::array<bool, 2 * N> shared{};
  int common = 0;
  for (std::size_t i = 0; i < N; ++i) {
    a[i] = contour.vertices[contour.simplices[s][i]];
    b[i] = contour.vertices[contour.simplices[t][i]];
    for (std::size_t j = 0; j < N; ++j)
      if (contour.simplices[s][i] == contour.simplices[t][j]) {
        shared[i] = shared[N + j] = true;
        ++common;
      }
  }
  if (common > N - 2) return false;
  for (std::size_t k = 0; k < N; ++k)
    if (span<N>(a, k).second < span<N>(b, k).first || span<N>(b, k).second < span<N>(a, k).first) return false;
  return CommonPoints<N>(a, b).any_vertex([&](const typename CommonPoints<N>::Weights& weights) {
    double outside = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (!shared[i]) outside += weights[i];
    return outside > 1e-6;
  });
}

template <int N>
bool intersects_itself(const Contour<N, double>& contour) {
  for (std::size_t s = 1; s < contour.simplices.size(); ++s)
    for (std::size_t t = 0; t < s; ++t)
      if (intersect<N>(contour, s, t)) return true;
  return false;
}

/// True if each component of the contour of a tile has the Euler characteristic of a disc or a ball.
template <int N>
bool only_balls(const Contour<N, double>& contour) {
  std::vector<Index> component(contour.vertices.size());
  for (std::size_t v = 0; v < component.size(); ++v) component[v] = static_cast<Index>(v);
  const auto root = [&](Index v) {
    while (component[v] != v) v = component[v];
    return v;
  };
  std::set<std::vector<Index>> faces;
  for (const auto& simplex : contour.simplices) {
    for (const Index v : simplex) component[root(v)] = root(simplex[0]);
    for (unsigned subset = 1; subset < 1u << N; ++subset) {
      std::vector<Index> face;
      for (std::size_t i = 0; i < N; ++i)
        if ((subset >> i & 1u) != 0) face.push_back(simplex[i]);
      std::sort(face.begin(), face.end());
      faces.insert(std::move(face));
    }
  }
  std::map<Index, int> euler;
  for (const auto& face : faces) euler[root(face[0])] += face.size() % 2 == 1 ? 1 : -1;
  return std::all_of(euler.begin(), euler.end(), [](const auto& entry) { return entry.second == 1; });
}

/// A combination of options, with its names in the output.
struct Way {
  const char* ambiguity_name;
  Ambiguity ambiguity;
  Triangulation triangulation;

  [[nodiscard]] const char* triangulation_name() const {
    return triangulation == Triangulation::compact ? "compact" : "barycentric";
  }
  [[nodiscard]] ExtractOptions options() const {
    ExtractOptions options;
    options.ambiguity = ambiguity;
    options.triangulation = triangulation;
    options.work.threads = 1;
    return options;
  }
};

/// Distances of the corners' values from the isovalue: all equal (points at the middle of their edges), uniform in [0,
/// 1), or with uniform logarithm between 1e-3 and 1.
enum class Distances { alike, uniform, log_uniform };

double distance(Distances kind, std::mt19937_64& bits) {
  const double share = static_cast<double>(bits() >> 11) * 0x1p-53;
  if (kind == Distances::alike) return 1.0;
  return kind == Distances::uniform ? share + 0x1p-60 : std::pow(1e-3, share);
}

template <int N>
Grid<N> unit_grid(std::size_t samples) {
  std::array<std::size_t, N> sizes;
  sizes.fill(samples);
  return Grid<N>::unit(sizes);
}

/// Tests `tiles` random tiles; with equal distances, every signature once.
template <int N>
void count_tiles(const Way& way, Distances kind, std::size_t tiles) {
  constexpr std::size_t kCorners = std::size_t{1} << N;
  constexpr std::uint64_t kActive = (std::uint64_t{1} << kCorners) - 2;
  std::mt19937_64 bits(1994);
  std::array<std::size_t, 2> of{}, hit{};  // tiles with balls only; others
  if (kind == Distances::alike) tiles = kActive;
  for (std::size_t t = 0; t < tiles; ++t) {
    const std::uint64_t signature = 1 + (kind == Distances::alike ? t : bits() % kActive);
    std::array<double, kCorners> values;
    for (std::size_t v = 0; v < kCorners; ++v)
      values[v] = (signature >> v & 1u) != 0 ? distance(kind, bits) : -distance(kind, bits);
    const auto contour = extract<double>(Image<double, N>(values.data(), unit_grid<N>(2)), 0.0, way.options());
    const std::size_t row = only_balls<N>(contour) ? 0 : 1;
    ++of[row];
    hit[row] += intersects_itself<N>(contour) ? 1u : 0u;
  }
  constexpr std::array<const char*, 3> kNames = {"alike", "uniform", "log-uniform"};
  std::printf("%dD,%s,%s,%s,%zu,%zu,%zu,%zu\n", N, way.ambiguity_name, way.triangulation_name(),
              kNames[static_cast<std::size_t>(kind)], of[0], hit[0], of[1], hit[1]);
  std::fflush(stdout);
}

/// The shares of the box that noise and its negative enclose, closed at the border.
template <int N>
void enclosed(const Way& way, std::size_t samples) {
  std::mt19937_64 bits(2005);
  const double box = std::pow(static_cast<double>(samples - 1), N);
  std::vector<double> values(static_cast<std::size_t>(std::pow(static_cast<double>(samples), N) + 0.5));
  for (double& value : values) value = static_cast<double>(bits() >> 11) * 0x1p-52 - 1.0;
  ExtractOptions options = way.options();
  options.close = true;
  const auto share = [&] {
    const Image<double, N> image(values.data(), unit_grid<N>(samples));
    return measure(extract<double>(image, 0.0, options)).content.value_or(0.0) / box;
  };
  const double high = share();
  for (double& value : values) value = -value;
  const double low = share();
  std::printf("%dD,%s,%s,%zu,%.4f,%.4f,%.4f\n", N, way.ambiguity_name, way.triangulation_name(), samples, high, low,
              high + low);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  if (tegl::bench::tells_usage(argc, argv,
                               "tile_intersections [TILES]: tiles whose contour intersects itself, and what contours "
                               "of noise enclose, as CSV"))
    return 0;
  const std::size_t tiles = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 100'000;
  constexpr auto compact = Triangulation::compact;
  constexpr auto barycentric = Triangulation::barycentric;
  constexpr Way kLow{"low", Ambiguity::low, compact}, kHigh{"high", Ambiguity::high, compact};
  constexpr Way kMean{"mean", Ambiguity::mean, compact}, kSaddle{"saddle", Ambiguity::saddle, compact};
  constexpr Way kSquares{"squares", Ambiguity::squares, compact}, kDecider{"decider", Ambiguity::decider, compact};
  constexpr Way kLowEven{"low", Ambiguity::low, barycentric}, kMeanEven{"mean", Ambiguity::mean, barycentric};
  constexpr Way kSaddleEven{"saddle", Ambiguity::saddle, barycentric};
  std::printf("dimension,ambiguity,triangulation,samples along an axis,share of noise,share of its negative,sum\n");
  for (const Way& way : {kLow, kLowEven, kMean, kMeanEven, kSaddle, kSaddleEven, kSquares, kDecider}) {
    enclosed<3>(way, 48);
    enclosed<4>(way, 12);
  }
  std::printf("dimension,ambiguity,triangulation,distances,tiles of balls,hit,other tiles,hit\n");
  for (const Distances kind : {Distances::uniform, Distances::log_uniform}) {
    for (const Way& way : {kLow, kMean, kSaddle, kSquares, kDecider, kMeanEven}) count_tiles<3>(way, kind, tiles);
    count_tiles<4>(kLow, kind, tiles);
    for (const Way& way : {kMean, kSaddle, kSquares, kDecider}) count_tiles<4>(way, kind, tiles / 20);
    count_tiles<4>(kLowEven, kind, tiles / 20);
  }
  for (const Way& way : {kLow, kHigh, kLowEven}) count_tiles<4>(way, Distances::alike, 0);
}
