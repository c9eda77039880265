// SPDX-License-Identifier: BSD-3-Clause
//
// Converts a tile's contour from the builder's form to the form that extractions read (see built_tile.hpp).
#include "tile/built_tile.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace tegl::detail {

using tile::VertexId;
using tile::VertexKind;

namespace {

constexpr std::uint16_t kUnused = BuiltTile::kNone;

bool is_of_contour(VertexKind kind) {
  return kind == VertexKind::edge || kind == VertexKind::barycentre || kind == VertexKind::side;
}

/// Numbers the vertices that are needed: first the contour's own in the builder's order, then those they depend on.
class Numbering {
 public:
  explicit Numbering(const tile::TileFacets& tile) : number_(tile.vertices.size(), kUnused) {
    for (std::size_t v = 0; v < tile.vertices.size(); ++v)
      if (is_of_contour(tile.vertices[v].kind)) add(static_cast<VertexId>(v));
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const tile::Vertex& vertex = tile.vertices[order_[i]];
      if (vertex.copied != tile::kNoVertex) add(vertex.copied);
      for (const tile::Simplex& s : vertex.of)
        for (int j = 0; j < tile::size(s); ++j) add(s[j]);
    }
  }
  [[nodiscard]] const std::vector<VertexId>& order() const { return order_; }
  [[nodiscard]] std::uint16_t operator[](VertexId v) const { return number_[v]; }

 private:
  void add(VertexId v) {
    if (number_[v] != kUnused) return;
    if (order_.size() >= BuiltTile::kIsMiddle)
      throw Error(ErrorCode::TooLarge, fmt::format("a tile with more than {} vertices", BuiltTile::kIsMiddle));
    number_[v] = static_cast<std::uint16_t>(order_.size());
    order_.push_back(v);
  }

  std::vector<std::uint16_t> number_;
  std::vector<VertexId> order_;
};

/// Appends the simplices below a barycentre. Their order, here and in `append_mean`, depends on the face only, so
/// floating-point sums over them do as well.
void append_simplices(const CubeFaces& cube, const tile::TileFacets& tile, const tile::Vertex& vertex,
                      const Numbering& number, std::vector<std::uint16_t>& of) {
  for (const tile::Simplex& simplex : vertex.of) {
    const std::size_t start = of.size();
    for (int j = 0; j < tile::size(simplex); ++j) {
      of.push_back(number[simplex[j]]);
      const tile::Vertex& corner = tile.vertices[simplex[j]];
      const bool is_middle =
          corner.kind == VertexKind::barycentre && cube.cells()[corner.face].dim + 1 == cube.cells()[vertex.face].dim;
      if (!is_middle) continue;
      std::swap(of[start], of.back());
      of[start] |= BuiltTile::kIsMiddle;
    }
  }
}

/// Appends the vertices around a centre.
void append_mean(const tile::Vertex& vertex, const Numbering& number, std::vector<std::uint16_t>& of) {
  std::vector<VertexId> around;
  for (const tile::Simplex& simplex : vertex.of)
    around.insert(around.end(), simplex.begin(), simplex.begin() + tile::size(simplex));
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  for (const VertexId v : around) of.push_back(number[v]);
}

}  // namespace

BuiltTile::BuiltTile(const CubeFaces& cube, const tile::TileFacets& tile) {
  const Numbering number(tile);
  // vertices, by face
  for (const VertexId v : number.order()) {
    const tile::Vertex& vertex = tile.vertices[v];
    const auto n = static_cast<std::uint16_t>(vertices.size());
    const auto face = static_cast<std::uint16_t>(vertex.face);
    if (is_of_contour(vertex.kind)) {
      if (faces.empty() || faces.back().face != face) faces.push_back({face, n, 0, true});
      ++faces.back().count;
      if (vertex.kind == VertexKind::side) faces.back().by_edges = false;
      has_sides = has_sides || vertex.kind == VertexKind::side;
    }
    const auto first = static_cast<std::uint32_t>(of.size());
    if (vertex.kind == VertexKind::barycentre) append_simplices(cube, tile, vertex, number, of);
    if (vertex.kind == VertexKind::centre) append_mean(vertex, number, of);
    const std::uint16_t copied = vertex.copied == tile::kNoVertex ? kUnused : number[vertex.copied];
    vertices.push_back({vertex.kind, face, copied, first, static_cast<std::uint32_t>(of.size()), 0, 0});
  }
  // simplices
  is_settled = tile.facets.size() == 1 && tile.facets[0].filling != tile::Filling::side;
  for (const tile::Facet& facet : tile.facets)
    for (const tile::Simplex& s : facet.simplices)
      for (int j = 0; j < tile::size(s); ++j) simplices.push_back(number[s[j]]);
  // edges of faces with several barycentres
  for (FaceVertices& face : faces) {
    if (face.count == 1 || face.face == cube.tile()) face.by_edges = false;
    for (std::size_t v = face.first; face.by_edges && v < std::size_t{face.first} + face.count; ++v) list_edges(v);
  }
  for (auto* list : {&of, &edges, &simplices}) list->shrink_to_fit();
}

void BuiltTile::list_edges(std::size_t v) {
  std::vector<std::uint16_t> below(of.begin() + vertices[v].first, of.begin() + vertices[v].end);
  for (std::uint16_t& w : below) w &= static_cast<std::uint16_t>(~kIsMiddle);
  std::sort(below.begin(), below.end());
  below.erase(std::unique(below.begin(), below.end()), below.end());
  vertices[v].first_edge = static_cast<std::uint32_t>(edges.size());
  for (const std::uint16_t w : below)
    if (vertices[w].kind == VertexKind::edge) edges.push_back(w);
  vertices[v].end_edge = static_cast<std::uint32_t>(edges.size());
}

std::size_t BuiltTile::bytes() const noexcept {
  return sizeof *this + faces.capacity() * sizeof(FaceVertices) + vertices.capacity() * sizeof(Vertex) +
         (of.capacity() + edges.capacity() + simplices.capacity()) * sizeof(std::uint16_t);
}

}  // namespace tegl::detail
