// SPDX-License-Identifier: BSD-3-Clause
//
// The net of a contour: its points on the critical edges of the grid, each joined with the points in the squares around
// its edge. In each plane of squares, the net is a set of curves.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/function_ref.hpp"
#include "position/critical_edges.hpp"
#include "tegl/contour.hpp"

namespace tegl::detail {

/// Whether the high corners of the ambiguous square along `axes` based at `base` are joined.
template <int N>
using JoinsHigh = FunctionRef<bool(const SampleIndex<N>& base, unsigned axes)>;

/// The neighbours of each point. Memory: 8 (N - 1) bytes per point.
template <int N>
class ContourNet {
 public:
  using Number = typename CriticalEdges<N>::Number;
  /// Curves through a point: one in each plane that its edge spans with another axis.
  static constexpr int kCurves = N - 1;

  /// The neighbour of a point in a square: on the edge across the square, or on the edge at the lower or the upper end
  /// of the point's own edge. `none` at the image border and at missing samples.
  enum class Side : std::uint8_t { across, lower, upper, none };
  struct Link {
    std::uint32_t bits = ~std::uint32_t{0};
    [[nodiscard]] Side side() const noexcept { return static_cast<Side>(bits >> 30); }
    [[nodiscard]] Number point() const noexcept { return bits & (CriticalEdges<N>::kMost - 1); }
  };
  static_assert(sizeof(Link) == sizeof(std::uint32_t));

  /// `signs` and `edges` must be of the same samples; only `edges` must outlive this object.
  ContourNet(const SampleSigns<N>& signs, const CriticalEdges<N>& edges, JoinsHigh<N> joins_high, unsigned threads);

  [[nodiscard]] const CriticalEdges<N>& edges() const noexcept { return edges_; }
  [[nodiscard]] Number size() const noexcept { return edges_.count(); }
  /// The neighbour of a point in curve c, on the side of decreasing (0) or increasing (1) coordinates of the other
  /// axis.
  [[nodiscard]] Link link(Number point, int c, int side) const noexcept {
    return link(place(point, c), static_cast<unsigned>(side));
  }
  /// The place of a point's curve among all, by curve and then by point.
  [[nodiscard]] std::size_t place(Number point, int c) const noexcept {
    return static_cast<std::size_t>(c) * size() + point;
  }
  [[nodiscard]] Link link(std::size_t place, unsigned side) const noexcept { return links_[place * 2 + side]; }
  /// The bits of all links, by place and side.
  [[nodiscard]] const std::uint32_t* link_bits() const noexcept { return &links_.data()->bits; }
  /// The other axis of curve c of a point on an edge along `axis`, and the inverse.
  static constexpr int other_axis(int axis, int c) noexcept { return c < axis ? c : c + 1; }
  static constexpr int curve_of(int axis, int other) noexcept { return other < axis ? other : other - 1; }

 private:
  const CriticalEdges<N>& edges_;
  Buffer<Link> links_;
};

/// What the links of a net are made from, and where they go.
template <int N>
struct NetRows {
  const SampleSigns<N>& signs;
  const CriticalEdges<N>& edges;
  JoinsHigh<N> joins_high;
  typename ContourNet<N>::Link* links;
};

/// Writes the links of all points on edges along `axis` in some rows (net_rows.cpp).
template <int N>
void link_rows(const NetRows<N>& net, int axis, std::size_t from, std::size_t end) noexcept;
template <>
void link_rows<2>(const NetRows<2>& net, int axis, std::size_t from, std::size_t end) noexcept;
template <>
void link_rows<3>(const NetRows<3>& net, int axis, std::size_t from, std::size_t end) noexcept;
template <>
void link_rows<4>(const NetRows<4>& net, int axis, std::size_t from, std::size_t end) noexcept;
template <>
void link_rows<5>(const NetRows<5>& net, int axis, std::size_t from, std::size_t end) noexcept;

}  // namespace tegl::detail
