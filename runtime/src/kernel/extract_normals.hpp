// SPDX-License-Identifier: BSD-3-Clause
//
// Vertex normals: the image's gradient at the vertex, in world coordinates, with length 1.
// Based on: M. Liversage, thesis, 1994, section 8.2. Vertices that are not on grid edges (barycentres, cap corners)
// have the multilinear interpolation of the gradients at the corners of their cell. On edges the two definitions agree.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <variant>

#include <Eigen/LU>

#include "image/context_gradient.hpp"
#include "image/edge_normals.hpp"
#include "image/line_kernel.hpp"
#include "image/sample_source.hpp"
#include "tegl/eigen.hpp"
#include "tegl/extract.hpp"

namespace tegl::detail {

/// Values around edges. Vector code reads whole registers; entries past the last are zero or left over.
template <class Calc>
struct EdgeValues {
  alignas(64) std::array<Calc, kEdgeValues<4> * kEdgesAtOnce> values{};
  std::array<Calc, 4 * kEdgesAtOnce> row_weights{};
};

/// Working storage of one thread. An extraction calculates in only one of the two types.
class NormalScratch {
 public:
  template <class Calc>
  [[nodiscard]] EdgeValues<Calc>& of() noexcept {
    if (auto* const there = std::get_if<EdgeValues<Calc>>(&values_)) return *there;
    return values_.emplace<EdgeValues<Calc>>();
  }

 private:
  std::variant<EdgeValues<double>, EdgeValues<float>> values_;
};

template <int N, class Real>
class NormalWriter {
 public:
  using Index = std::array<std::size_t, N>;
  using Vertex = std::array<Real, N>;

  /// `source` must outlive the writer. Throws InvalidArgument for a wrong kernel.
  NormalWriter(const SampleGradients<N>& source, const Grid<N>& grid, GradientDirection direction, Normals kind,
               const GradientKernel& kernel)
      : source_(source),
        kind_(kind),
        kernel_(line_kernel_of<N>(kind, kernel)),
        steps_(steps_of(source, grid)),
        sizes_(grid.sizes()),
        mapped_(grid.has_world_map()),
        sign_(direction == GradientDirection::descent ? -1.0 : 1.0),
        // A world map may amplify small differences, for which float is not precise enough.
        around_edges_in_float_(std::is_same_v<Real, float> && !mapped_ ? source.around_edges_in_float() : nullptr),
        around_edges_(source.around_edges()) {
    // Gradients are covectors, so the inverse transpose transforms them.
    const Eigen::Matrix<double, N, N> linear = as_eigen(grid.linear);
    if (mapped_) to_world_ = sign_ * linear.inverse().transpose();
  }

  /// Whether a row can be processed together with other rows, because its differences have the same weights.
  [[nodiscard]] bool is_inside(const Index& index) const noexcept {
    for (int a = 1; a + 1 < N; ++a)
      if (!steps_[a].is_uniform() || index[a] == 0 || index[a] + 2 >= sizes_[a]) return false;
    return true;
  }

  /// Whether normals are made of differences in float, with the same weights at all samples of a row but the first and
  /// the last.
  [[nodiscard]] bool is_by_equal_weights() const noexcept { return reads_ends_in_float() && steps_[0].is_uniform(); }
  [[nodiscard]] const AxisSteps& steps(int axis) const noexcept { return steps_[axis]; }
  /// Whether samples at the ends of a row have no neighbours beyond.
  [[nodiscard]] bool ends_with_row() const noexcept {
    return !steps_[0].has_backward(0) && !steps_[0].has_forward(sizes_[0] - 1);
  }
  /// By which gradients are multiplied, so that they point to the side that the contour faces.
  [[nodiscard]] double sign() const noexcept { return sign_; }

  /// Whether normals are made of differences in float, so that `edges` reads the samples at the ends of each edge.
  [[nodiscard]] bool reads_ends_in_float() const noexcept {
    return kind_ == Normals::differences && around_edges_in_float_ != nullptr;
  }

  struct NoAlphas {
    template <class Calc>
    void operator()(const Calc* /*first*/, const Calc* /*second*/, std::size_t /*i*/, std::size_t /*count*/) const {}
  };
  /// Writes the normals on edges along `axis`. They start in the row of `start`, or in several rows that are inside,
  /// one of which is the row of `start` (start[0] is ignored). `start_of(i)`: index of edge i's first sample. Up to 15
  /// entries past the end of `alphas` are read. With reads_ends_in_float, `alphas` need not be known before:
  /// write_alphas(first, second, i, count) may set them for `count` edges from edge i on, from the samples at their
  /// ends.
  template <class StartOf, class WriteAlphas = NoAlphas>
  void edges(const Index& start, int axis, const EdgesInRows& edges, const double* alphas, NormalScratch& scratch,
             Vertex* out, const StartOf& start_of, const WriteAlphas& write_alphas = {}) const noexcept {
    if (kind_ != Normals::differences) {
      for (std::size_t i = 0; i < edges.count; ++i) out[i] = on_edge(start_of(i), axis, alphas[i]);
      return;
    }
    if constexpr (std::is_same_v<Real, float>)
      if (around_edges_in_float_ != nullptr)
        return edges_by(around_edges_in_float_, start, axis, edges, alphas, scratch.of<float>(), out, start_of,
                        write_alphas);
    edges_by(around_edges_, start, axis, edges, alphas, scratch.of<double>(), out, start_of, NoAlphas{});
  }

  /// Normal on the edge along `axis` from the sample `index`, at the share `alpha` of it, for any values.
  [[nodiscard]] Vertex on_edge(Index index, int axis, double alpha) const noexcept {
    std::array<double, N> gradient = gradient_at(index, {axis, 1});
    ++index[axis];
    const std::array<double, N> there = gradient_at(index, {axis, -1});
    // Not a + alpha * (b - a), as the difference may overflow.
    for (int a = 0; a < N; ++a) gradient[a] = (1.0 - alpha) * gradient[a] + alpha * there[a];
    return normal(gradient);
  }

  /// As on_edge for differences, from the values around the edge: value(place), places as for kEdgeValues. Along the
  /// row, there must be no neighbours beyond its ends.
  template <class ValueAt>
  [[nodiscard]] Vertex on_edge_among(const Index& index, int axis, double alpha, const ValueAt& value) const noexcept {
    const auto own = 4 * static_cast<unsigned>(axis);
    const double first = value(own + 2), second = value(own + 1);
    const auto along = [&](unsigned a) {
      const double here = derivative(value(4 * a), first, value(4 * a + 1), steps_[a].at(index[a]));
      const std::size_t next = index[a] + (static_cast<int>(a) == axis ? 1 : 0);
      const double there = derivative(value(4 * a + 2), second, value(4 * a + 3), steps_[a].at(next));
      return (1.0 - alpha) * here + alpha * there;
    };
    // Through parameters, because an array that is written entry by entry cannot be read as a vector soon after.
    const auto normal_of = [&](auto... derivatives) { return normal({derivatives...}); };
    return [&]<unsigned... A>(std::integer_sequence<unsigned, A...>) { return normal_of(along(A)...); }
    (std::make_integer_sequence<unsigned, N>());
  }

  /// A normal with its uncertainty.
  struct ContextNormal {
    Vertex vector;
    double uncertainty;
  };
  /// As on_edge, for normals by context.
  [[nodiscard]] ContextNormal on_edge_by_context(Index index, int axis, double alpha) const noexcept {
    ContextGradient<N> here = context_at(index, {axis, 1});
    ++index[axis];
    const ContextGradient<N> there = context_at(index, {axis, -1});
    for (int a = 0; a < N; ++a) here.gradient[a] = (1.0 - alpha) * here.gradient[a] + alpha * there.gradient[a];
    return {normal(here.gradient), (1.0 - alpha) * here.uncertainty + alpha * there.uncertainty};
  }

  /// Uncertainty of the context's gradient at one end of an edge, or at a sample.
  [[nodiscard]] double uncertainty_at(const Index& index, EdgeFrom edge) const noexcept {
    return context_at(index, edge).uncertainty;
  }

  /// The gradient at a sample, in the world and on the side of the direction.
  [[nodiscard]] std::array<double, N> in_world_at(const Index& index) const noexcept {
    return in_world(gradient_at(index));
  }

  /// Normal at a position in a cell; parameters as in Placement::in_cell.
  template <class Frame>
  [[nodiscard]] Vertex in_cell(const Index& base, const std::array<double, Frame::kDim>& place) const noexcept {
    std::array<double, N> sum{};
    for (unsigned corner = 0; corner < 1u << Frame::kDim; ++corner) {
      double weight = 1.0;
      for (int j = 0; j < Frame::kDim; ++j) weight *= (corner >> j & 1u) != 0 ? place[j] : 1.0 - place[j];
      if (weight == 0.0) continue;
      Index index = base;
      for (int a = 0; a < N; ++a) index[a] += Frame::spread(corner) >> a & 1u;
      const auto gradient = gradient_at(index);
      for (int a = 0; a < N; ++a) sum[a] += weight * gradient[a];
    }
    return normal(sum);
  }

 private:
  static std::array<AxisSteps, N> steps_of(const SampleGradients<N>& source, const Grid<N>& grid) {
    return [&]<std::size_t... A>(std::index_sequence<A...>) {
      return std::array<AxisSteps, N>{source.steps(int{A}, grid.axes[A])...};
    }
    (std::make_index_sequence<N>());
  }

  template <class Calc, class StartOf, class WriteAlphas>
  void edges_by(AroundEdges<N, Calc> around_edges, const Index& start, int axis, const EdgesInRows& edges,
                const double* alphas, EdgeValues<Calc>& scratch, Vertex* out, const StartOf& start_of,
                const WriteAlphas& write_alphas) const noexcept {
    EdgeSurroundings<N> around{start[N - 1], axis, {}};
    NormalRow<N, Real, Calc> row{scratch.values.data(),    alphas, 0, axis, {}, nullptr, nullptr,
                                 static_cast<Calc>(sign_), out};
    describe(start, around, row);
    if constexpr (std::is_same_v<Calc, double>)
      if (mapped_) row.to_world = to_world_.data();
    const bool all_read = ends_with_row();
    for (std::size_t i = 0; i < edges.count; i += kEdgesAtOnce, row.out += kEdgesAtOnce) {
      // values and weights
      row.count = std::min(kEdgesAtOnce, edges.count - i);
      const Word at_ends =
          around_edges(source_, around, {edges.rows + i, edges.at + i, row.count}, scratch.values.data());
      const auto end = [&](std::size_t place) -> const Calc* {
        return scratch.values.data() + (4 * static_cast<std::size_t>(axis) + place) * kEdgesAtOnce;
      };
      write_alphas(end(2), end(1), i, row.count);
      row.alphas = alphas + i;
      row.row_weights = write_row_weights(axis, edges.at + i, row.count, all_read ? at_ends : 0, scratch.row_weights);
      // normals
      Word left = write_normals(row);
      if (!all_read) left |= at_ends;  // there are neighbours beyond the row
      for (; left != 0; left &= left - 1) {
        const auto j = static_cast<std::size_t>(std::countr_zero(left));
        const auto value = [&](unsigned place) {
          return static_cast<double>(scratch.values[place * kEdgesAtOnce + j]);
        };
        row.out[j] = all_read ? on_edge_among(start_of(i + j), axis, alphas[i + j], value)
                              : on_edge(start_of(i + j), axis, alphas[i + j]);
      }
    }
  }

  /// Sets what all edges have in common: weights, and which neighbours exist.
  template <class Calc>
  void describe(const Index& start, EdgeSurroundings<N>& around, NormalRow<N, Real, Calc>& row) const noexcept {
    const auto set = [&](int a, const StepWeights& first, const StepWeights& second) {
      row.weights[a] = {static_cast<Calc>(first.backward), static_cast<Calc>(first.forward),
                        static_cast<Calc>(second.backward), static_cast<Calc>(second.forward)};
    };
    set(0, steps_[0].inside(), steps_[0].inside());
    for (int a = 1; a < N; ++a) {
      const std::size_t first = start[a];
      const std::size_t second = first + (a == around.axis ? 1 : 0);
      around.exists[a] = {steps_[a].has_backward(first), steps_[a].has_forward(first), steps_[a].has_backward(second),
                          steps_[a].has_forward(second)};
      set(a, steps_[a].at(first), steps_[a].at(second));
    }
  }

  /// Writes the weights along the row by edge, if they differ. Returns them, or null. `at_ends`: edges with an end that
  /// is the first or the last sample of its row.
  template <class Calc, std::size_t kCount>
  const Calc* write_row_weights(int axis, const std::uint32_t* at, std::size_t count, Word at_ends,
                                std::array<Calc, kCount>& out) const noexcept {
    const auto set = [&](std::size_t i) {
      const StepWeights first = steps_[0].at(at[i]);
      const StepWeights second = axis == 0 ? steps_[0].at(at[i] + std::size_t{1}) : first;
      const std::array<double, 4> weights = {first.backward, first.forward, second.backward, second.forward};
      for (std::size_t j = 0; j < 4; ++j) out[j * kEdgesAtOnce + i] = static_cast<Calc>(weights[j]);
    };
    if (!steps_[0].is_uniform()) {
      for (std::size_t i = 0; i < count; ++i) set(i);
      return out.data();
    }
    if (at_ends == 0) return nullptr;
    out.fill(static_cast<Calc>(steps_[0].inside().forward));
    for (; at_ends != 0; at_ends &= at_ends - 1) set(static_cast<std::size_t>(std::countr_zero(at_ends)));
    return out.data();
  }

  [[nodiscard]] std::array<StepWeights, N> steps_at(const Index& index) const noexcept {
    std::array<StepWeights, N> result;
    for (int a = 0; a < N; ++a) result[a] = steps_[a].at(index[a]);
    return result;
  }
  [[nodiscard]] ContextGradient<N> context_at(const Index& index, EdgeFrom edge) const noexcept {
    return ContextFit<N>(source_.values_around(index, steps_), steps_at(index)).fit(edge);
  }
  [[nodiscard]] std::array<double, N> gradient_at(const Index& index, EdgeFrom edge = {}) const noexcept {
    if (kind_ == Normals::differences) return source_.gradient(index, steps_);
    if (kind_ == Normals::context) return context_at(index, edge).gradient;
    return kernel_gradient<N>(kernel_, source_.values_around(index, steps_), steps_at(index));
  }

  /// Unit normal of a gradient; 0 if the gradient is zero.
  [[nodiscard]] Vertex normal(const std::array<double, N>& gradient) const noexcept {
    std::array<double, N> v = in_world(gradient);
    double square = square_of(v);
    if (!(square > 1e-280 && square < 1e280)) {
      std::array<double, N> scaled = gradient;
      scale(scaled);
      v = in_world(scaled);
      scale(v);
      square = square_of(v);
    }
    const double inverse = square > 0.0 ? 1.0 / std::sqrt(square) : 0.0;
    Vertex result;
    for (int a = 0; a < N; ++a) result[a] = static_cast<Real>(v[a] * inverse);
    return result;
  }

  [[nodiscard]] std::array<double, N> in_world(const std::array<double, N>& gradient) const noexcept {
    std::array<double, N> v{};
    for (int a = 0; a < N; ++a) {
      if (!mapped_) v[a] = sign_ * gradient[a];
      for (int b = 0; b < N && mapped_; ++b) v[a] += to_world_(a, b) * gradient[b];
    }
    return v;
  }

  static double square_of(const std::array<double, N>& v) noexcept {
    double square = 0.0;
    for (const double x : v) square += x * x;
    return square;
  }

  /// Scales the largest component to magnitude 1, unless all are 0. If components are infinite, these become 1 or -1
  /// and the others 0.
  static void scale(std::array<double, N>& v) noexcept {
    double largest = 0.0;
    for (const double x : v) largest = std::max(largest, std::abs(x));
    for (double& x : v) {
      if (std::isinf(largest))
        x = std::isinf(x) ? std::copysign(1.0, x) : 0.0;
      else
        x = largest > 0.0 ? x / largest : 0.0;
    }
  }

  const SampleGradients<N>& source_;
  Normals kind_;
  LineKernel<N> kernel_;  ///< of kinds with a kernel
  std::array<AxisSteps, N> steps_;
  Index sizes_;
  bool mapped_;
  double sign_;
  AroundEdges<N, float> around_edges_in_float_;  ///< null: the arithmetic is in double
  AroundEdges<N, double> around_edges_;
  Eigen::Matrix<double, N, N, Eigen::RowMajor> to_world_ = Eigen::Matrix<double, N, N>::Identity();
};

}  // namespace tegl::detail
