// SPDX-License-Identifier: BSD-3-Clause
//
// The terms of tetrahedra, with the four axes in one vector. Highway's foreach_target compiles this file once per
// instruction set. All operations and their order are as in `piece_terms_of`, so that the bits are the same.
#include "mesh/piece_terms.hpp"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "mesh/piece_terms.cpp"
#include "base/dispatch.hpp"
// This include must precede Highway's own headers.
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace tegl::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR && HWY_MAX_BYTES >= 32

/// Coordinates of a point.
HWY_INLINE auto load_point(const double* point) { return hn::LoadU(hn::FixedTag<double, 4>(), point); }
HWY_INLINE auto load_point(const float* point) {
  return hn::PromoteTo(hn::FixedTag<double, 4>(), hn::LoadU(hn::FixedTag<float, 4>(), point));
}

template <class Real>
void find_terms_of(const std::array<Real, 4>* points, const std::array<Index, 4>* simplices,
                   std::span<const PointOf<4>> references, const Index* labels, std::span<PieceTerms<4>> terms) {
  const hn::FixedTag<double, 4> d;
  const hn::Half<decltype(d)> d2;
  // by axis, the other three, ascending
  alignas(32) constexpr std::array<std::int64_t, 4> kFirst{1, 0, 0, 0}, kSecond{2, 2, 1, 1}, kThird{3, 3, 3, 2};
  const auto first = hn::SetTableIndices(d, kFirst.data());
  const auto second = hn::SetTableIndices(d, kSecond.data());
  const auto third = hn::SetTableIndices(d, kThird.data());
  alignas(32) constexpr std::array<double, 4> kSigns{-0.0, 0.0, -0.0, 0.0};
  const auto signs = hn::Load(d, kSigns.data());
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const auto& simplex = simplices[i];
    const Index label = labels == nullptr ? 0 : labels[i];
    const auto reference = hn::LoadU(d, references[label < references.size() ? label : 0].data());
    const auto p0 = load_point(points[simplex[0]].data()), p1 = load_point(points[simplex[1]].data()),
               p2 = load_point(points[simplex[2]].data()), p3 = load_point(points[simplex[3]].data());
    // the normal vector, as in normal_vector_of
    const auto e0 = hn::Sub(p1, p0), e1 = hn::Sub(p2, p0), e2 = hn::Sub(p3, p0);
    const auto e0b = hn::TableLookupLanes(e0, second), e0c = hn::TableLookupLanes(e0, third);
    const auto e1b = hn::TableLookupLanes(e1, second), e1c = hn::TableLookupLanes(e1, third);
    const auto e2b = hn::TableLookupLanes(e2, second), e2c = hn::TableLookupLanes(e2, third);
    const auto by_0 = hn::Mul(hn::TableLookupLanes(e0, first), hn::Sub(hn::Mul(e1b, e2c), hn::Mul(e2b, e1c)));
    const auto by_1 = hn::Mul(hn::TableLookupLanes(e1, first), hn::Sub(hn::Mul(e0b, e2c), hn::Mul(e2b, e0c)));
    const auto by_2 = hn::Mul(hn::TableLookupLanes(e2, first), hn::Sub(hn::Mul(e0b, e1c), hn::Mul(e1b, e0c)));
    const auto determinants = hn::Add(hn::Sub(by_0, by_1), by_2);
    const auto normal = hn::Div(hn::Xor(determinants, signs), hn::Set(d, 6.0));
    // the square of its length and the flux, summed in the order of the axes
    const auto squares = hn::Mul(normal, normal);
    const auto near = hn::Sub(p0, reference);
    const auto fluxes = hn::Mul(normal, near);
    const auto even = hn::InterleaveLower(d, squares, fluxes), odd = hn::InterleaveUpper(d, squares, fluxes);
    const auto sums =
        hn::Add(hn::Add(hn::Add(hn::LowerHalf(d2, even), hn::LowerHalf(d2, odd)), hn::UpperHalf(d2, even)),
                hn::UpperHalf(d2, odd));
    const double square = hn::GetLane(sums);
    double size = std::sqrt(square);
    if (!(square > 1e-280 && square < 1e280)) [[unlikely]] {
      PointOf<4> stored;
      hn::StoreU(normal, d, stored.data());
      size = length_of<4>(stored);
    }
    const auto middle =
        hn::Add(hn::Add(hn::Add(near, hn::Sub(p1, reference)), hn::Sub(p2, reference)), hn::Sub(p3, reference));
    PieceTerms<4>& found = terms[i];
    found.size = size;
    found.flux = hn::GetLane(hn::Shuffle01(sums));
    hn::StoreU(hn::Mul(hn::Set(d, size), middle), d, found.moment.data());
  }
}

#else

template <class Real>
void find_terms_of(const std::array<Real, 4>* points, const std::array<Index, 4>* simplices,
                   std::span<const PointOf<4>> references, const Index* labels, std::span<PieceTerms<4>> terms) {
  for (std::size_t i = 0; i < terms.size(); ++i) {
    std::array<PointOf<4>, 4> corners;
    for (int j = 0; j < 4; ++j)
      for (int a = 0; a < 4; ++a) corners[j][a] = static_cast<double>(points[simplices[i][j]][a]);
    const Index label = labels == nullptr ? 0 : labels[i];
    terms[i] =
        piece_terms_of<4>(corners, references[label < references.size() ? label : 0], normal_vector_of<4>(corners));
  }
}

#endif

void find_terms(const SimplexView<4>& contour, std::span<const PointOf<4>> references, std::span<const Index> labels,
                std::size_t from, std::span<PieceTerms<4>> terms) {
  contour.with_points([&](const auto* points) {
    find_terms_of(points, contour.simplices().data() + from, references,
                  labels.empty() ? nullptr : labels.data() + from, terms);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace tegl::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace tegl::detail {

HWY_EXPORT(find_terms);
void find_piece_terms(const SimplexView<4>& contour, std::span<const PointOf<4>> references,
                      std::span<const Index> labels, std::size_t from, std::span<PieceTerms<4>> terms) {
  HWY_DYNAMIC_DISPATCH(find_terms)(contour, references, labels, from, terms);
}

}  // namespace tegl::detail

#endif  // HWY_ONCE
