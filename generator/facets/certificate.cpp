// SPDX-License-Identifier: BSD-3-Clause
//
// The conditions of the certificate, one function each.
#include "tegl/facets/certificate.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace tegl::facets {

namespace {

using Signed = std::pair<Simplex, int>;

/// The non-empty subsets of a simplex's vertices.
template <class Visit>
void for_each_subset(const Simplex& s, const Visit& visit) {
  for (unsigned subset = 1; subset < 1u << size(s); ++subset) {
    Simplex part = kNoSimplex;
    int count = 0;
    for (int i = 0; i < size(s); ++i)
      if (((subset >> i) & 1u) != 0) part[count++] = s[i];
    visit(part);
  }
}

Fault check_simplices(Simplices sorted) {
  for (const Simplex& s : sorted)
    if (std::adjacent_find(s.begin(), s.begin() + size(s)) != s.begin() + size(s)) return Fault::repeated_vertex;
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end() ? Fault::none : Fault::repeated_vertex;
}

/// (1), (3) and branching, from the signed faces of codimension one.
Fault check_faces(const Simplices& simplices, const std::vector<int>& signs, const TileFacets& tile) {
  std::vector<Signed> faces, boundary, sigma;
  for (std::size_t j = 0; j < simplices.size(); ++j)
    for (int i = 0; i < size(simplices[j]); ++i)
      faces.emplace_back(without(simplices[j], i), (i % 2 == 0 ? 1 : -1) * signs[j]);
  std::sort(faces.begin(), faces.end());
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t j = i + 1;
    while (j < faces.size() && faces[j].first == faces[i].first) ++j;
    if (j - i > 2) return Fault::branching;
    if (j - i == 2 && faces[i].second == faces[i + 1].second) return Fault::orientation;
    if (j - i == 1) boundary.push_back(faces[i]);
    i = j;
  }
  for (std::size_t i = 0; i < tile.sigma.size(); ++i) sigma.emplace_back(tile.sigma[i], tile.sigma_sign[i]);
  std::sort(sigma.begin(), sigma.end());
  return boundary == sigma ? Fault::none : Fault::boundary;
}

/// (2)
Fault check_links(const Simplices& simplices, const TileFacets& tile) {
  std::map<VertexId, Simplices> links;
  for (const Simplex& s : simplices)
    for (int i = 0; i < size(s); ++i) links[s[i]].push_back(without(s, i));
  std::vector<bool> on_sigma(tile.vertices.size());
  for (const Simplex& s : tile.sigma)
    for (int i = 0; i < size(s); ++i) on_sigma[s[i]] = true;
  for (const auto& [vertex, link] : links)
    if (shape_of(link) != (on_sigma[vertex] ? Shape::ball : Shape::sphere)) return Fault::link;
  return Fault::none;
}

/// (4)
Fault check_tile_boundary(const FaceLattice& lattice, const Simplices& simplices, const TileFacets& tile) {
  const std::vector<std::uint32_t>& faces = lattice.faces()[lattice.tile()].faces;
  std::vector<Simplices> own(faces.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    for (const Simplex& s : tile.in_face[f]) for_each_subset(s, [&](const Simplex& part) { own[f].push_back(part); });
    std::sort(own[f].begin(), own[f].end());
  }
  Fault fault = Fault::none;
  for (const Simplex& s : simplices)
    for_each_subset(s, [&](const Simplex& part) {
      Signature corners = 0;
      for (int i = 0; i < size(part); ++i) corners |= lattice.faces()[tile.vertices[part[i]].face].corners;
      for (std::size_t f = 0; f < faces.size(); ++f)
        if ((corners & ~lattice.faces()[faces[f]].corners) == 0 &&
            !std::binary_search(own[f].begin(), own[f].end(), part))
          fault = Fault::in_tile_boundary;
    });
  return fault;
}

}  // namespace

const char* fault_name(Fault fault) noexcept {
  switch (fault) {
    case Fault::none:
      return "none";
    case Fault::repeated_vertex:
      return "repeated vertex";
    case Fault::branching:
      return "branching";
    case Fault::orientation:
      return "orientation";
    case Fault::boundary:
      return "boundary is not Sigma";
    case Fault::link:
      return "bad link";
    case Fault::in_tile_boundary:
      return "simplex in the tile's boundary that is not Sigma's";
  }
  return "unknown";
}

Fault certify(const FaceLattice& lattice, const TileFacets& tile) {
  Simplices simplices;
  std::vector<int> signs;
  for (const Facet& facet : tile.facets)
    for (Simplex s : facet.simplices) {
      signs.push_back(sort_vertices(s));
      simplices.push_back(s);
    }
  Fault fault = check_simplices(simplices);
  if (fault == Fault::none) fault = check_faces(simplices, signs, tile);
  if (fault == Fault::none) fault = check_links(simplices, tile);
  if (fault == Fault::none) fault = check_tile_boundary(lattice, simplices, tile);
  return fault;
}

}  // namespace tegl::facets
