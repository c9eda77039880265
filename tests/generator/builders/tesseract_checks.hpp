// SPDX-License-Identifier: BSD-3-Clause
//
// Compares an emitted builder of the tesseract, as compiled, with tile::FacetBuilder, with the definition and with the
// certificate. A template, because each builder, and each copy with a fault, is a class of its own.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "../coned_part.hpp"
#include "../definition_oracle.hpp"
#include "builder4.hpp"
#include "embedding/embedding_proof.hpp"
#include "tegl/tile/certificate.hpp"
#include "tegl/tile/corners.hpp"
#include "tegl/tile/facets.hpp"
#include "tesseract_masks.hpp"

namespace tegl::test {

using builders::ResolvedKey;
using tile::Choice;

inline std::string text_of(const ResolvedKey& key) {
  return fmt::format("signature {}, squares {:#x}, low cubes {:#x}, high cubes {:#x}, centre {}: ", key.signature,
                     key.squares, key.low_cubes, key.high_cubes, static_cast<int>(key.tile));
}

/// A facet: the edges on which it has points, and its Euler characteristic.
using FacetFigures = std::multiset<std::pair<std::uint64_t, long>>;

/// Tiles by tile::FacetBuilder and by the definition, and the certificate.
class GeneralTesseract {
 public:
  GeneralTesseract() {
    for (unsigned e = 0; e < 32; ++e) edge_face_[e] = face(corner_bits(e));
  }

  /// Figures of the facets that tile::FacetBuilder makes.
  [[nodiscard]] FacetFigures figures(const ResolvedKey& key) {
    std::vector<Choice> choices(lattice_.faces().size(), Choice::separate);
    for (unsigned q = 0; q < 24; ++q)
      choices[face(corners_of(builders::kTesseractSquares[q].base, builders::kTesseractSquares[q].axes))] =
          (key.squares >> q & 1u) != 0 ? Choice::high : Choice::low;
    for (unsigned f = 0; f < 8; ++f) {
      Choice& choice = choices[face_of_cube(f)];
      if ((key.low_cubes >> f & 1u) != 0)
        choice = Choice::low;
      else if ((key.high_cubes >> f & 1u) != 0)
        choice = Choice::high;
    }
    choices[lattice_.tile()] = key.tile;
    const tile::TileFacets& tile =
        builder_.build(key.signature, {choices, tile::Alternative::low}, tile::Geometry::without);
    FacetFigures result;
    for (const tile::Facet& facet : tile.facets) {
      std::uint64_t edges = 0;
      tile::Simplices sorted = facet.simplices;
      for (tile::Simplex& s : sorted) tile::sort_vertices(s);
      for (const tile::Simplex& s : sorted)
        for (int i = 0; i < 4; ++i)
          if (tile.vertices[s[i]].kind == tile::VertexKind::edge) edges |= edge_bit(tile.vertices[s[i]].face);
      result.emplace(edges, tile::euler_characteristic(sorted));
    }
    return result;
  }

  /// The certificate of a filling. `lists`: of the tile's cubes.
  [[nodiscard]] tile::Fault certify(const ResolvedKey& key, const builders::ResolvedView& view,
                                    Triangulation triangulation) {
    using builders::ResolvedCubes;
    const ResolvedCubes& cubes = ResolvedCubes::instance(triangulation);
    const ResolvedCubes::Lists lists = builders::ResolvedTesseract::lists_of(key);
    tile::TileFacets tile;
    for (unsigned v = 0; v < ResolvedCubes::kVertices + view.own_vertices; ++v) {
      tile::Vertex vertex;
      vertex.kind = v < 32 ? tile::VertexKind::edge : tile::VertexKind::side;
      vertex.face = v < 32                         ? edge_face_[v]
                    : v < ResolvedCubes::kVertices ? face_of_cube((v - 32) / ResolvedCubes::kMostOwn)
                                                   : lattice_.tile();
      vertex.number = v;
      tile.vertices.push_back(vertex);
    }
    const tile::Face& all = lattice_.faces().back();
    tile.in_face.resize(all.faces.size());
    tile.in_face_sign.resize(all.faces.size());
    for (unsigned f = 0; f < 8; ++f) {
      if (lists[f] == ResolvedCubes::kNone) continue;
      const auto g =
          static_cast<std::size_t>(std::find(all.faces.begin(), all.faces.end(), face_of_cube(f)) - all.faces.begin());
      const auto triangles = cubes.triangles_of(lists[f]);
      for (std::size_t t = 0; t < triangles.size(); t += 3) {
        tile::Simplex triangle = tile::kNoSimplex;
        // frames by the table contract, not by the emitted ones
        for (std::size_t i = 0; i < 3; ++i)
          triangle[i] = static_cast<tile::VertexId>(triangles[t + i] < 12 ? detail::lifted_edge(4, f, triangles[t + i])
                                                                          : 32 + 4 * f + triangles[t + i] - 12u);
        const int sign = tile::sort_vertices(triangle);
        tile.in_face[g].push_back(triangle);
        tile.in_face_sign[g].push_back(sign);
        tile.sigma.push_back(triangle);
        tile.sigma_sign.push_back(sign * all.signs[g]);
      }
    }
    tile::Facet& facet = tile.facets.emplace_back();
    for (std::uint32_t s = 0; s < view.simplex_count; ++s) {
      tile::Simplex& simplex = facet.simplices.emplace_back(tile::kNoSimplex);
      for (unsigned i = 0; i < 4; ++i) simplex[i] = view.simplices[4 * s + i];
    }
    return certifier_.certify(lattice_, tile);
  }

  /// By definition, if no centre of a cube joins: if the tile's centre is low, the facets are copies of the components
  /// of the high part of the boundary; if it is high, of the low part.
  [[nodiscard]] static std::multiset<long> eulers(const ResolvedKey& key) {
    const bool high = key.tile == Choice::low;
    const auto is_inside = [&](unsigned base, unsigned axes) {
      for (unsigned q = 0; q < 24; ++q)
        if (builders::kTesseractSquares[q].base == base && builders::kTesseractSquares[q].axes == axes)
          return ((key.squares >> q & 1u) != 0) == high;
      return false;
    };
    std::multiset<long> result;
    if (key.signature == 0 || key.signature == 0xffff) return result;
    const BoundaryPart part(4, high ? key.signature : ~unsigned{key.signature} & 0xffffu, is_inside);
    for (std::size_t c = 0; c < part.components(); ++c) result.insert(part.euler(c));
    return result;
  }

  /// By definition, if each cube and the tile have a centre that is low or high.
  [[nodiscard]] static std::multiset<long> eulers_by_centres(const ResolvedKey& key) {
    return eulers_of_facets(4, key.signature, key.tile == Choice::high, [&](unsigned base, unsigned axes) {
      for (unsigned q = 0; q < 24; ++q)
        if (builders::kTesseractSquares[q].base == base && builders::kTesseractSquares[q].axes == axes)
          return (key.squares >> q & 1u) != 0;
      for (unsigned f = 0; f < 8; ++f)
        if (base == (f % 2) << f / 2 && axes == (15u ^ 1u << f / 2)) return (key.high_cubes >> f & 1u) != 0;
      throw std::logic_error("a face that is no square and no cube");
    });
  }

  /// Edge e of the tile for the face of an edge.
  [[nodiscard]] const tile::FaceLattice& lattice() const { return lattice_; }

 private:
  static tile::Signature corners_of(unsigned base, unsigned axes) {
    tile::Signature corners = 0;
    for (unsigned v = 0; v < 16; ++v)
      if ((v & ~axes) == base) corners |= tile::Signature{1} << v;
    return corners;
  }
  static tile::Signature corner_bits(unsigned e) { return corners_of(detail::edge_base(4, e), 1u << e / 8); }
  [[nodiscard]] std::uint32_t face(tile::Signature corners) const { return lattice_.find(corners).value(); }
  [[nodiscard]] std::uint32_t face_of_cube(unsigned f) const {
    return face(corners_of((f % 2) << (f / 2), 15u ^ 1u << (f / 2)));
  }
  [[nodiscard]] std::uint64_t edge_bit(std::uint32_t number) const {
    const auto at = std::find(edge_face_.begin(), edge_face_.end(), number);
    return std::uint64_t{1} << (at - edge_face_.begin());
  }

  tile::FaceLattice lattice_ = tile::FaceLattice::cube(4);
  std::array<std::uint32_t, 32> edge_face_{};
  tile::FacetBuilder builder_{lattice_};
  tile::Certifier certifier_;
};

/// Figures of the connected parts of a filling.
inline FacetFigures figures_of(const builders::ResolvedView& view) {
  std::vector<VertexSet> simplices(view.simplex_count);
  for (std::uint32_t s = 0; s < view.simplex_count; ++s)
    for (unsigned i = 0; i < 4; ++i) simplices[s][i] = view.simplices[4 * s + i];
  FacetFigures result;
  for (const Piece& piece : pieces_of(simplices, 4)) {
    std::uint64_t edges = 0;
    for (const std::uint8_t v : piece.vertices)
      if (v < 32) edges |= std::uint64_t{1} << v;
    result.emplace(edges, piece.euler);
  }
  return result;
}

inline std::string text_of(const FacetFigures& figures) {
  std::string text;
  for (const auto& [edges, euler] : figures) text += fmt::format(" ({:#x}, {})", edges, euler);
  return text;
}

/// All numbers of a filling: size, simplices and masks. `apart`: what is known of Sigma.
template <class Builder>
std::vector<std::uint64_t> tesseract_numbers(Builder& builder, const ResolvedKey& key,
                                             std::uint32_t apart = builders::ResolvedTesseract::kNotKnown) {
  const auto size = builder.size(key);
  const builders::ResolvedView view = builder.find(key, Builder::lists_of(key), apart);
  std::vector<std::uint64_t> numbers{size.simplices, size.own_vertices};
  numbers.insert(numbers.end(), view.simplices, view.simplices + 4 * std::size_t{view.simplex_count});
  if (view.own_vertices != 0) numbers.insert(numbers.end(), view.masks, view.masks + view.own_vertices);
  return numbers;
}

/// The values that ResolvedTesseract::find accepts for Sigma, by definition: 0 if Sigma is one component. The boundary
/// is a 3-sphere, in which a connected surface separates two regions.
inline std::uint32_t known_of_sigma(const ResolvedKey& key) {
  if (key.signature == 0 || key.signature == 0xffffu) return builders::ResolvedTesseract::kNotKnown;
  for (const bool high : {true, false}) {
    if (regions_of_side(key, !high).size() != 1) continue;
    std::vector<std::uint32_t> regions = regions_of_side(key, high);
    if (regions.size() > 1 && key.tile == (high ? Choice::high : Choice::low)) continue;
    const auto is_corner = [](std::uint32_t region) { return std::has_single_bit(region); };
    const auto rest = std::find_if_not(regions.begin(), regions.end(), is_corner);
    regions.erase(rest == regions.end() ? regions.begin() : rest);
    if (!std::all_of(regions.begin(), regions.end(), is_corner)) continue;
    std::uint32_t apart = 0;
    for (const std::uint32_t region : regions) apart |= region;
    return apart;
  }
  return builders::ResolvedTesseract::kNotKnown;
}

/// What is wrong with the filling of a tile; "" if nothing is. The definition applies if `is_by_squares`: no centre of
/// a cube joins, and the tile's centre is low or high.
template <class Builder>
std::string fault_of_tesseract(Builder& builder, GeneralTesseract& general, const ResolvedKey& key,
                               Triangulation triangulation, bool is_by_squares) {
  const auto size = builder.size(key);
  const builders::ResolvedView view = builder.find(key);
  if (size.simplices != view.simplex_count || size.own_vertices != view.own_vertices)
    return text_of(key) + "another size than was counted";
  if (builders::ResolvedCubes::kVertices + view.own_vertices > 256) return text_of(key) + "too many vertices";
  const tile::Fault fault = general.certify(key, view, triangulation);
  if (fault != tile::Fault::none) return text_of(key) + std::string(tile::name_of(fault));
  const FacetFigures figures = figures_of(view);
  if (const FacetFigures expected = general.figures(key); figures != expected)
    return text_of(key) + "facets" + text_of(figures) + ", of the general builder" + text_of(expected);
  std::multiset<long> eulers;
  for (const auto& [edges, euler] : figures) eulers.insert(euler);
  if (is_by_squares && eulers != GeneralTesseract::eulers(key))
    return text_of(key) + "facets differ from the definition";
  if (const std::string wrong = TesseractMasks(key, view, triangulation).fault(); !wrong.empty())
    return text_of(key) + wrong;
  if (tesseract_numbers(builder, key, known_of_sigma(key)) != tesseract_numbers(builder, key))
    return text_of(key) + "another filling if it is known how Sigma is connected";
  return "";
}

/// Whether a filling's vertices are all on edges of the tile, so that the proof is exact for it.
inline bool is_on_edges(const builders::ResolvedView& view) {
  return std::all_of(view.simplices, view.simplices + 4 * std::size_t{view.simplex_count},
                     [](std::uint8_t v) { return v < 32; });
}

/// What is wrong with a filling on edges: "" if it is embedded for all positions of the points on them.
inline std::string fault_of_embedding(const gen::EmbeddingProof& proof, const ResolvedKey& key,
                                      const builders::ResolvedView& view) {
  std::vector<gen::LocalSimplex> simplices(view.simplex_count);
  for (std::size_t s = 0; s < simplices.size(); ++s) std::copy_n(view.simplices + 4 * s, 4, simplices[s].begin());
  return proof.holds(simplices) ? "" : text_of(key) + "simplices intersect for some positions";
}

/// Random keys. Half have uniform signatures, the others fewer high or fewer low corners.
class RandomKeys {
 public:
  explicit RandomKeys(std::uint64_t seed) : random_(seed) {}
  ResolvedKey operator()() {
    ResolvedKey key;
    key.signature = static_cast<std::uint16_t>(random_());
    if (random_() % 4 == 0) key.signature &= static_cast<std::uint16_t>(random_());
    if (random_() % 4 == 0) key.signature |= static_cast<std::uint16_t>(random_());
    key.squares = static_cast<std::uint32_t>(random_()) & 0xffffffu;
    key.low_cubes = static_cast<std::uint8_t>(random_());
    key.high_cubes = static_cast<std::uint8_t>(random_() & ~unsigned{key.low_cubes});
    key.tile = static_cast<Choice>(random_() % 3);
    return key;
  }

 private:
  std::mt19937_64 random_;
};

/// What is wrong with random tiles of a builder.
template <class Builder>
std::string fault_of_tesseracts(Builder& builder, Triangulation triangulation, int count) {
  GeneralTesseract general;
  RandomKeys keys(4);
  for (int i = 0; i < count; ++i)
    if (std::string fault = fault_of_tesseract(builder, general, keys(), triangulation, false); !fault.empty())
      return fault;
  return "";
}

}  // namespace tegl::test
