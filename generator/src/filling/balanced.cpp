// SPDX-License-Identifier: BSD-3-Clause
//
// Fans of polygons, and the tesseracts around them.
#include "filling/balanced.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"
#include "filling/certificate.hpp"
#include "filling/embedding_evidence.hpp"

namespace tegl::gen {

namespace {

/// The low-connected contours of all cubes, in which every polygon of a cube with a single polygon is a balanced fan.
/// Each is proved to be embedded.
std::vector<TileContour> balanced_cubes(const Lattice& lattice) {
  std::vector<TileContour> contours =
      contours_by_dimension(lattice, 3, Alternative::low, Triangulation::compact).back();
  for (TileContour& contour : contours) {
    if (contour.facets.size() != 1 || contour.facets.front().points.size() < 4) continue;
    LocalFacet& facet = contour.facets.front();
    facet.filling = Filling::pulled;
    facet.simplices.clear();
    for (const auto& [a, b, c] : balanced_fan(facet.points)) facet.simplices.push_back({a, b, c});
  }
  // The proof for a tesseract does not compare simplices in one cube.
  const ContourBuilder builder(lattice, 3, Alternative::low, Triangulation::compact);
  const EmbeddingCertifier embedding(builder);
  for (std::size_t s = 0; s < contours.size(); ++s)
    if (!embedding.unproved_pairs(contours[s]).empty())
      throw Error(ErrorCode::CertificateFailed,
                  fmt::format("balanced cube of signature {}: not proved to be embedded", s));
  return contours;
}

}  // namespace

std::vector<std::array<std::uint8_t, 3>> balanced_fan(const std::vector<std::uint8_t>& polygon) {
  return fan_from(*std::max_element(polygon.begin(), polygon.end()), polygon);
}

std::vector<std::array<std::uint8_t, 3>> fan_from(std::uint8_t apex, const std::vector<std::uint8_t>& polygon) {
  const auto count = polygon.size();
  const auto from = static_cast<std::size_t>(std::find(polygon.begin(), polygon.end(), apex) - polygon.begin());
  std::vector<std::array<std::uint8_t, 3>> triangles;
  for (std::size_t k = 1; k + 1 < count; ++k)
    triangles.push_back({polygon[from], polygon[(from + k) % count], polygon[(from + k + 1) % count]});
  return triangles;
}

BalancedTesseracts make_balanced_tesseracts(const Lattice& lattice, const std::vector<bool>& depends_on_data) {
  const ContourBuilder builder(lattice, 4, balanced_cubes(lattice));
  const EmbeddingCertifier embedding(builder);
  TableCertifier certifier(builder);
  BalancedTesseracts result;
  result.contours.resize(depends_on_data.size());
  const auto require = [&](bool holds, Signature s, std::string_view what) {
    if (!holds)
      throw Error(ErrorCode::CertificateFailed, fmt::format("balanced tesseract of signature {}: {}", s, what));
  };
  for (Signature s = 1; s < builder.tile().full(); ++s) {
    const Signature complement = ~s & builder.tile().full();
    if (depends_on_data[s]) continue;
    TileContour& contour = result.contours[s];
    contour = complement < s ? inverted(result.contours[complement]) : builder.build(s);
    const tile::Fault fault = certifier.certify(s, contour);
    require(fault == tile::Fault::none, s, tile::name_of(fault));
    require(embedding.unproved_pairs(contour).empty(), s, "not proved to be embedded");
    ++result.signatures;
    for (const LocalFacet& facet : contour.facets) result.simplices += facet.simplices.size();
  }
  return result;
}

}  // namespace tegl::gen
