// SPDX-License-Identifier: BSD-3-Clause
//
// Converts the contours of the tables to the form that tile::Certifier takes, for tiles of any dimension.
#include "filling/certificate.hpp"

#include <map>

#include "filling/resolutions.hpp"

namespace tegl::gen {

namespace {

tile::Simplex simplex_of(const LocalSimplex& s, int count) {
  tile::Simplex result = tile::kNoSimplex;
  for (int i = 0; i < count; ++i) result[i] = s[i];
  return result;
}

}  // namespace

TableCertifier::TableCertifier(const ContourBuilder& builder)
    : builder_(builder), lattice_(face_lattice(builder.tile().kind, builder.dim())) {
  const Tile& tile = builder.tile();
  const std::vector<tile::Face>& faces = lattice_.faces();
  const std::vector<std::uint32_t>& maximal = faces[lattice_.tile()].faces;
  // the tile's number of each maximal face
  for (const std::uint32_t g : maximal)
    for (std::uint32_t f = 0; f < tile.faces.size(); ++f)
      if (tile.faces[f].corners() == faces[g].corners) face_.push_back(f);
  // A local vertex lies in the smallest face common to all maximal faces that contain it.
  std::map<std::uint32_t, std::uint32_t> by_maximal;
  for (std::uint32_t g = 0; g < faces.size(); ++g) {
    std::uint32_t set = 0;
    for (std::size_t j = 0; j < maximal.size(); ++j)
      if ((faces[g].corners & ~faces[maximal[j]].corners) == 0) set |= 1u << face_[j];
    by_maximal.emplace(set, g);
  }
  tile_.vertices.resize(256);
  for (std::uint32_t v = 0; v < 256; ++v)
    tile_.vertices[v].face = by_maximal.at(builder.faces_of(static_cast<std::uint8_t>(v)));
  tile_.in_face.resize(maximal.size()), tile_.in_face_sign.resize(maximal.size());
}

tile::Fault TableCertifier::certify(Signature signature, const TileContour& contour) {
  const int n = builder_.dim();
  // the contour
  tile_.facets.assign(1, {});
  for (const LocalFacet& facet : contour.facets)
    for (const LocalSimplex& s : facet.simplices) tile_.facets[0].simplices.push_back(simplex_of(s, n));
  // Sigma and the contours in the faces, from the builder
  tile_.sigma.clear(), tile_.sigma_sign.clear();
  const tile::Face& whole = lattice_.faces()[lattice_.tile()];
  for (std::size_t j = 0; j < face_.size(); ++j) {
    const std::uint32_t f = face_[j];
    tile_.in_face[j].clear(), tile_.in_face_sign[j].clear();
    for (const LocalFacet& facet : builder_.face_contour(f, signature).facets)
      for (LocalSimplex s : facet.simplices) {
        for (int i = 0; i < n - 1; ++i) s[i] = builder_.lift(f, s[i]);
        tile::Simplex simplex = simplex_of(s, n - 1);
        const int sign =
            builder_.tile().faces[f].sign * builder_.orientation() * facet.sign * tile::sort_vertices(simplex);
        tile_.sigma.push_back(simplex);
        tile_.sigma_sign.push_back(sign);
        tile_.in_face[j].push_back(simplex);
        tile_.in_face_sign[j].push_back(sign * whole.signs[j]);
      }
  }
  return certifier_.certify(lattice_, tile_);
}

tile::Fault certify(const ContourBuilder& builder, Signature signature, const TileContour& contour) {
  return TableCertifier(builder).certify(signature, contour);
}

}  // namespace tegl::gen
