// SPDX-License-Identifier: BSD-3-Clause
//
// The recursion of the certificate over the faces of a tile. Contours are compared by a digest of vertex names. A name
// is made of face, kind and number, which do not depend on the tile.
#include "tegl/tile/tile_certifier.hpp"

#include <bit>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "faces.hpp"

namespace tegl::tile {

namespace {

constexpr int kRememberedDim = 3;

std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

std::uint64_t name(std::uint32_t face, const Vertex& vertex) {
  return mix((std::uint64_t{face} << 40 | std::uint64_t{vertex.number} << 8 | static_cast<unsigned>(vertex.kind)) +
             0x9e3779b97f4a7c15u);
}

/// The lattice of a face, its corners renumbered in ascending order.
FaceLattice lattice_of(const FaceLattice& lattice, const Face& face) {
  const std::vector<int> corners = corner_list(face.corners);
  std::vector<Signature> maximal;
  for (const std::uint32_t g : face.faces) maximal.push_back(compressed(lattice.faces()[g].corners, corners));
  return {face.dim, maximal};
}

}  // namespace

class TileCertifier::Impl {
 public:
  Impl(FaceLattice lattice, Build build) : builder_(std::move(lattice)), build_(std::move(build)) {
    const FaceLattice& own = builder_.lattice();
    for (const std::uint32_t g : own.faces().back().faces) {
      Below below{.corners = corner_list(own.faces()[g].corners), .faces = closure(own, g), .number = {}, .shape = 0};
      below.number.assign(own.faces().size(), 0);
      for (std::uint32_t k = 0; k < below.faces.size(); ++k) below.number[below.faces[k]] = k;
      if (own.dim() > 2) below.shape = shape_of(lattice_of(own, own.faces()[g]));
      below_.push_back(std::move(below));
    }
  }

  [[nodiscard]] const FaceLattice& lattice() const { return builder_.lattice(); }
  [[nodiscard]] const TileFacets& tile() const { return *tile_; }

  Fault certify(Signature signature, const Resolution& resolution) {
    tile_ = build_ ? &build_(signature, resolution) : &builder_.build(signature, resolution, Geometry::without);
    if (const Fault fault = certifier_.certify(lattice(), *tile_); fault != Fault::none) return fault;
    for (std::size_t j = 0; j < below_.size(); ++j)
      if (const Fault fault = certify_face(j, signature, resolution); fault != Fault::none) return fault;
    return Fault::none;
  }

 private:
  struct Below {
    std::vector<int> corners;
    std::vector<std::uint32_t> faces;   ///< its faces, by the tile's numbers
    std::vector<std::uint32_t> number;  ///< by face of the tile: its number in this lattice
    std::size_t shape;
  };

  std::size_t shape_of(FaceLattice lattice) {
    const auto same = [&](const Impl& other) {
      const std::vector<Face>&a = other.lattice().faces(), &b = lattice.faces();
      if (a.size() != b.size()) return false;
      for (std::size_t f = 0; f < a.size(); ++f)
        if (a[f].corners != b[f].corners) return false;
      return true;
    };
    for (std::size_t s = 0; s < shapes_.size(); ++s)
      if (same(*shapes_[s])) return s;
    shapes_.push_back(std::make_unique<Impl>(std::move(lattice), Build{}));
    return shapes_.size() - 1;
  }

  Fault certify_face(std::size_t j, Signature signature, const Resolution& resolution) {
    const Below& below = below_[j];
    const Simplices& contour = tile_->in_face[j];
    const Signature own = compressed(signature, below.corners);
    if (lattice().dim() == 2) {  // an edge has a point if its ends differ: positive if the second end is high
      const bool differ = std::popcount(own) == 1;
      const bool right =
          contour.size() == (differ ? 1u : 0u) && (!differ || tile_->in_face_sign[j][0] == (own == 2 ? 1 : -1));
      return right ? Fault::none : Fault::sigma;
    }
    // choices and digest of the contour in this face
    choices_.clear();
    if (!resolution.choices.empty())
      for (const std::uint32_t g : below.faces) choices_.push_back(resolution.choices[g]);
    std::uint64_t digest = 0;
    for (std::size_t k = 0; k < contour.size(); ++k) {
      const Simplex& s = contour[k];
      std::uint64_t sum = 0;
      for (int i = 0; i < size(s); ++i) sum += name(below.number[tile_->vertices[s[i]].face], tile_->vertices[s[i]]);
      digest += mix(sum + static_cast<unsigned>(tile_->in_face_sign[j][k] + 1));
    }
    const auto [fault, expected] = shapes_[below.shape]->alone(own, {choices_, resolution.alternative});
    return fault != Fault::none ? fault : digest == expected ? Fault::none : Fault::sigma;
  }

  /// Certifies the tile of this lattice on its own. Returns its fault and the digest of its contour.
  std::pair<Fault, std::uint64_t> alone(Signature signature, const Resolution& resolution) {
    if (lattice().dim() > kRememberedDim || lattice().faces().size() > 32) return alone_anew(signature, resolution);
    std::uint64_t key = resolution.alternative == Alternative::high ? 1 : 0;
    for (std::size_t f = 0; f < resolution.choices.size(); ++f)
      if (lattice().faces()[f].dim >= 2) key = key << 2 | static_cast<unsigned>(resolution.choices[f]);
    key = key << 32 | signature;
    const auto at = remembered_.find(key);
    if (at != remembered_.end()) return {Fault::none, at->second};
    const auto result = alone_anew(signature, resolution);
    if (result.first == Fault::none) remembered_.emplace(key, result.second);
    return result;
  }

  std::pair<Fault, std::uint64_t> alone_anew(Signature signature, const Resolution& resolution) {
    if (const Fault fault = certify(signature, resolution); fault != Fault::none) return {fault, 0};
    std::uint64_t digest = 0;
    for (const Facet& facet : tile_->facets)
      for (Simplex s : facet.simplices) {
        const int sign = sort_vertices(s);
        std::uint64_t sum = 0;
        for (int i = 0; i < size(s); ++i) sum += name(tile_->vertices[s[i]].face, tile_->vertices[s[i]]);
        digest += mix(sum + static_cast<unsigned>(sign + 1));
      }
    return {Fault::none, digest};
  }

  FacetBuilder builder_;
  Build build_;  ///< empty: builder_
  Certifier certifier_;
  const TileFacets* tile_ = nullptr;
  std::vector<Below> below_;                   ///< one per face of codimension one
  std::vector<std::unique_ptr<Impl>> shapes_;  ///< their distinct lattices
  std::vector<Choice> choices_;
  std::unordered_map<std::uint64_t, std::uint64_t> remembered_;
};

TileCertifier::TileCertifier(FaceLattice lattice) : TileCertifier(std::move(lattice), Build{}) {}
TileCertifier::TileCertifier(FaceLattice lattice, Build build)
    : impl_(std::make_unique<Impl>(std::move(lattice), std::move(build))) {}
TileCertifier::~TileCertifier() = default;
TileCertifier::TileCertifier(TileCertifier&&) noexcept = default;
TileCertifier& TileCertifier::operator=(TileCertifier&&) noexcept = default;

const FaceLattice& TileCertifier::lattice() const& { return impl_->lattice(); }
FaceLattice TileCertifier::lattice() const&& { return impl_->lattice(); }
Fault TileCertifier::certify(Signature signature, const Resolution& resolution) {
  return impl_->certify(signature, resolution);
}
const TileFacets& TileCertifier::tile() const& { return impl_->tile(); }
TileFacets TileCertifier::tile() const&& { return impl_->tile(); }

}  // namespace tegl::tile
