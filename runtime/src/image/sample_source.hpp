// SPDX-License-Identifier: BSD-3-Clause
//
// The interfaces through which the extraction reads an image, one for each use of the samples. They hide the value type
// and where the samples are, so the kernel is compiled once per dimension. A virtual call reads a row or a cell, except
// where a comment states a single sample.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "image/bitplanes.hpp"
#include "image/cell_heights.hpp"
#include "image/gradient.hpp"

namespace tegl::detail {

/// Indices of a sample, or of the lowest corner of a cell, by axis.
template <int N>
using SampleIndex = std::array<std::size_t, N>;

/// The layers of samples along the last axis, in the order in which an extraction needs them.
class SampleLayers {
 public:
  /// Sets the number of adjacent layers needed at a time. Called once, before prepare.
  virtual void keep(std::size_t /*layers*/) {}
  /// Prepares the samples of layer k. Called for each layer in order, by the thread that started the extraction. May
  /// throw.
  virtual void prepare(std::size_t /*k*/) {}

  /// Whether all layers are available from the start without additional memory.
  [[nodiscard]] bool are_in_memory() const noexcept { return are_in_memory_; }
  [[nodiscard]] std::size_t sample_bytes() const noexcept { return sample_bytes_; }

 protected:
  SampleLayers(bool are_in_memory, std::size_t sample_bytes)
      : are_in_memory_(are_in_memory), sample_bytes_(sample_bytes) {}
  ~SampleLayers() = default;

 private:
  bool are_in_memory_;
  std::size_t sample_bytes_;
};

/// Comparison of samples with the isovalue.
template <int N>
class SampleClassifier {
 public:
  /// Classifies `rows` rows along axis 1, starting with the row of `start` (start[0] = 0); see classify_rows.
  virtual Word classify(const SampleIndex<N>& start, std::size_t rows, BitRows high,
                        BitRows missing) const noexcept = 0;
  /// Whether one sample is high.
  [[nodiscard]] virtual bool is_high(const SampleIndex<N>& index) const noexcept = 0;

 protected:
  ~SampleClassifier() = default;
};

/// Values of samples, for decisions by the values at corners of cells. double represents all value types exactly.
template <int N>
class CornerValues {
 public:
  [[nodiscard]] double isovalue() const noexcept { return isovalue_; }
  /// Number of layer 0 in the whole image.
  [[nodiscard]] std::size_t first_layer() const noexcept { return first_layer_; }
  /// Number of layers that the image has from layer 0 on. There may be more than are extracted.
  [[nodiscard]] std::size_t layers_from_first() const noexcept { return layers_from_first_; }

  /// Value of one sample. Layers before the first, modulo 2^64, are allowed if the image has them.
  [[nodiscard]] virtual double value(const SampleIndex<N>& index) const noexcept = 0;
  /// Values at the corners of the cell along `axes` based at `base`, in the order of the cell's own corners.
  virtual void corner_values(const SampleIndex<N>& base, unsigned axes, double* out) const noexcept = 0;
  /// Reads `count` samples from each of the 2^(N-1) rows around the tiles that start at `base`. Rows are `pitch` apart
  /// in `out`; bit a - 1 of a row's number is its side along axis a.
  virtual void corner_rows(const SampleIndex<N>& base, std::size_t count, double* out,
                           std::size_t pitch) const noexcept = 0;

 protected:
  CornerValues(double isovalue, std::size_t first_layer, std::size_t layers_from_first)
      : isovalue_(isovalue), first_layer_(first_layer), layers_from_first_(layers_from_first) {}
  ~CornerValues() = default;

 private:
  double isovalue_;
  std::size_t first_layer_;
  std::size_t layers_from_first_;
};

/// Edges in rows of one layer: offset of each edge's row from the first row (EdgeCrossings::strides), and position
/// along the row.
struct EdgesInRows {
  const std::ptrdiff_t* rows;
  const std::uint32_t* at;
  std::size_t count;
  /// If the edges are all critical ones of one row, which has many of them: the bits of their first samples, by which
  /// they may be found faster. Otherwise null.
  const Word* critical = nullptr;
};

/// The memory of a layer of samples, or of other values from which the interpolation parameters are computed.
struct LayerInMemory {
  const std::byte* first = nullptr;  ///< the sample of index 0; null: unknown
  std::ptrdiff_t step_bytes = 0;     ///< in which the offsets of rows are counted (EdgeCrossings::strides)
  std::ptrdiff_t sample_bytes = 0;   ///< from a sample to the next one of its row
};

/// Some cells of K axes, and edges of each (bit masks).
template <int N, int K>
struct CellsWithEdges {
  static constexpr std::size_t kMost = CubeRays::kMost;
  /// By local edge and cell.
  using Alphas = std::array<std::array<double, kMost>, std::size_t{K} << (K - 1)>;

  const std::uint8_t* axes;
  const SampleIndex<N>* bases;
  const std::uint32_t* edges;
  std::size_t count;  ///< at most kMost
};

/// Intersections of the contour with edges of the grid, as interpolation parameters: 0 at an edge's first end, 1 at its
/// second, clamped to [epsilon, 1 - epsilon]. Also the data of intersections with rays inside cells.
template <int N>
class EdgeCrossings {
 public:
  using Strides = std::array<std::ptrdiff_t, N>;

  /// Steps between samples within a layer. The entry of the last axis is undefined.
  [[nodiscard]] const Strides& strides() const noexcept { return strides_; }
  /// Where layer k is in memory, to fetch samples before edge_alphas reads them.
  [[nodiscard]] virtual LayerInMemory layer_in_memory(std::size_t /*k*/) const noexcept { return {}; }
  /// Interpolation parameters of critical edges along `axis` that start in layer k.
  virtual void edge_alphas(std::size_t k, int axis, const EdgesInRows& edges, double* out) const noexcept = 0;
  /// Interpolation parameters for the edges in the bit mask `edges` of the cell along `axes` based at `base`: local
  /// edge e to out[e]. `out` has an entry for each edge of the cell; the other entries are undefined.
  virtual void cell_alphas(const SampleIndex<N>& base, unsigned axes, std::uint32_t edges,
                           double* out) const noexcept = 0;
  /// The same for several cells. The other entries of `out` are undefined.
  virtual void cells_alphas(const CellsWithEdges<N, 3>& cubes,
                            typename CellsWithEdges<N, 3>::Alphas& out) const noexcept {
    alphas_one_by_one(cubes, out);
  }
  virtual void cells_alphas(const CellsWithEdges<N, 4>& tesseracts,
                            typename CellsWithEdges<N, 4>::Alphas& out) const noexcept {
    alphas_one_by_one(tesseracts, out);
  }
  /// Heights of the cell along K `axes` based at `base`: 3 (CubeHeights), 4 or 5 (TileHeights).
  template <int K>
  [[nodiscard]] CellHeights<K> heights(const SampleIndex<N>& base, unsigned axes) const noexcept {
    std::array<double, std::size_t{1} << K> at;
    const double epsilon = corner_heights(base, axes, at.data());
    return CellHeights<K>{at, epsilon};
  }

 protected:
  explicit EdgeCrossings(const Strides& strides) : strides_(strides) {}
  ~EdgeCrossings() = default;

 private:
  template <int K>
  void alphas_one_by_one(const CellsWithEdges<N, K>& cells, typename CellsWithEdges<N, K>::Alphas& out) const noexcept {
    std::array<double, std::tuple_size_v<typename CellsWithEdges<N, K>::Alphas>> alphas;
    for (std::size_t i = 0; i < cells.count; ++i) {
      cell_alphas(cells.bases[i], cells.axes[i], cells.edges[i], alphas.data());
      for (std::uint32_t rest = cells.edges[i]; rest != 0; rest &= rest - 1) {
        const auto e = static_cast<unsigned>(std::countr_zero(rest));
        out[e][i] = alphas[e];
      }
    }
  }
  /// Writes the samples at the corners of the cell along `axes` based at `base`, minus the isovalue, in the order of
  /// the cell's own corners. Returns epsilon.
  virtual double corner_heights(const SampleIndex<N>& base, unsigned axes, double* out) const noexcept = 0;

  Strides strides_;
};

template <int N>
class SampleGradients;

/// Reads the values around edges, at most kEdgesAtOnce of them, to kEdgeValues x kEdgesAtOnce entries. Returns as bits
/// the edges that have an end at an end of its row. Calc: type of the arithmetic.
template <int N, class Calc>
using AroundEdges = std::uint64_t (*)(const SampleGradients<N>& samples, const EdgeSurroundings<N>& around,
                                      const EdgesInRows& edges, Calc* out) noexcept;

/// Gradients at samples, and the values around edges from which the gradients at their ends are computed.
template <int N>
class SampleGradients {
 public:
  /// Steps along an axis, on which the extracted samples are `here`. They may extend beyond these.
  [[nodiscard]] virtual AxisSteps steps(int axis, const Axis& here) const {
    return axis + 1 < N ? AxisSteps(here) : AxisSteps(last_axis_, first_layer_);
  }
  /// The function that reads values around edges of these samples.
  [[nodiscard]] virtual AroundEdges<N, double> around_edges() const noexcept = 0;
  /// The function that reads them in float. Null if float does not represent all values exactly.
  [[nodiscard]] virtual AroundEdges<N, float> around_edges_in_float() const noexcept = 0;
  /// Gradient at one sample by differences to its neighbours along the axes.
  [[nodiscard]] virtual std::array<double, N> gradient(const SampleIndex<N>& index,
                                                       const std::array<AxisSteps, N>& steps) const noexcept = 0;
  /// Values of a sample and its neighbours.
  [[nodiscard]] virtual ValuesAround<N> values_around(const SampleIndex<N>& index,
                                                      const std::array<AxisSteps, N>& steps) const noexcept = 0;

 protected:
  SampleGradients(Axis last_axis, std::size_t first_layer)
      : last_axis_(std::move(last_axis)), first_layer_(first_layer) {}
  ~SampleGradients() = default;

 private:
  Axis last_axis_;
  std::size_t first_layer_;
};

/// All uses of an image with an isovalue; rows run along axis 0. Functions take the one of these interfaces that they
/// need.
template <int N>
class SampleSource : public EdgeCrossings<N>,
                     public CornerValues<N>,
                     public SampleClassifier<N>,
                     public SampleGradients<N>,
                     public SampleLayers {
 public:
  SampleSource(const SampleSource&) = delete;
  SampleSource& operator=(const SampleSource&) = delete;
  virtual ~SampleSource() = default;

 protected:
  /// `last_axis`: of the whole image, whose layer `first_layer` is layer 0 here.
  SampleSource(const typename EdgeCrossings<N>::Strides& strides, double isovalue, const Axis& last_axis,
               std::size_t first_layer, bool are_in_memory, std::size_t sample_bytes)
      : EdgeCrossings<N>(strides),
        CornerValues<N>(isovalue, first_layer, last_axis.size() - first_layer),
        SampleGradients<N>(last_axis, first_layer),
        SampleLayers(are_in_memory, sample_bytes) {}
};

}  // namespace tegl::detail
