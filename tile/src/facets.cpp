// SPDX-License-Identifier: BSD-3-Clause
//
// Assembles tiles from the pieces of their faces. Faces of equal shape, signature and choices share one cached piece.
#include "tegl/tile/facets.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <utility>

#include "faces.hpp"
#include "pieces.hpp"

namespace tegl::tile {

namespace {

/// Number of key bits for a face's resolution: an ambiguous square has two resolutions, other faces up to four.
int choice_bits(int dim) { return dim < 2 ? 0 : dim == 2 ? 1 : 2; }

}  // namespace

/// Faces share a cache if an order-preserving renumbering of corners maps one to the other.
class FacetBuilder::Impl {
 public:
  Impl(FaceLattice lattice, std::size_t max_kept_bytes)
      : lattice_(std::move(lattice)), max_large_bytes_(max_kept_bytes) {
    const std::size_t count = lattice_.faces().size();
    pieces_.resize(count), transient_.resize(count), codes_.resize(count);
    std::vector<std::vector<Signature>> shapes;
    for (std::uint32_t f = 0; f < count; ++f) {
      closures_.push_back(closure(lattice_, f));
      corners_.push_back(corner_list(lattice_.faces()[f].corners));
      std::vector<Signature> shape;
      int bits = static_cast<int>(corners_[f].size());
      for (const std::uint32_t g : closures_[f]) {
        shape.push_back(compressed(lattice_.faces()[g].corners, corners_[f]));
        bits += choice_bits(lattice_.faces()[g].dim);
      }
      const auto at = std::find(shapes.begin(), shapes.end(), shape);
      shape_.push_back(static_cast<std::uint32_t>(at - shapes.begin()));
      if (at == shapes.end()) {
        shapes.push_back(shape);
        caches_.emplace_back().bits = bits;
        if (bits <= kDirectBits) caches_.back().direct.resize(std::size_t{1} << bits);
      }
    }
    builder_ = std::make_unique<PieceBuilder>(lattice_, closures_);
  }

  [[nodiscard]] const FaceLattice& lattice() const { return lattice_; }
  [[nodiscard]] std::size_t kept_bytes() const { return large_bytes_; }

  const TileFacets& build(Signature signature, const Resolution& resolution, Geometry geometry) {
    // pieces of all proper faces, by ascending dimension
    for (std::uint32_t f = 0; f < lattice_.tile(); ++f) pieces_[f] = piece_of(f, signature, resolution);
    const std::uint32_t tile = lattice_.tile();
    Piece& piece = transient_[tile];
    builder_->build(tile, pieces_, choice_of(tile, resolution), resolution.alternative, false, piece);
    pieces_[tile] = &piece;
    write(piece, geometry);
    if (large_bytes_ > max_large_bytes_) forget_large();
    return result_;
  }

 private:
  static constexpr int kDirectBits = 16;
  static constexpr int kSmallDim = 3;  ///< largest dimension with few resolutions per face

  struct Cache {
    int bits = 0;
    std::vector<std::unique_ptr<Piece>> direct{};
    std::unordered_map<std::uint64_t, std::unique_ptr<Piece>> hashed{};
  };

  static Choice choice_of(std::uint32_t face, const Resolution& resolution) {
    return resolution.choices.empty() ? Choice::separate : resolution.choices[face];
  }

  /// Pieces of large faces are cached only without choices: they repay their memory only if few resolutions occur.
  [[nodiscard]] bool is_kept(const Cache& cache, int dim, const Resolution& resolution) const {
    return cache.bits <= 64 && (dim <= kSmallDim || resolution.choices.empty());
  }

  std::unique_ptr<Piece>& slot(Cache& cache, std::uint64_t key) const {
    return cache.direct.empty() ? cache.hashed[key] : cache.direct[key];
  }

  const Piece* piece_of(std::uint32_t f, Signature signature, const Resolution& resolution) {
    const Face& face = lattice_.faces()[f];
    const Choice choice = choice_of(f, resolution);
    Cache& cache = caches_[shape_[f]];
    if (!is_kept(cache, face.dim, resolution)) {
      build_piece(f, signature, choice, resolution.alternative, transient_[f]);
      return &transient_[f];
    }
    const Piece* piece = kept_piece(cache, f, signature, choice, resolution.alternative);
    // If the face offers no choice, all choices share the piece of the default choice.
    if (codes_[f] != 0 && face.dim <= kSmallDim && nothing_to_choose(face.dim, *piece))
      piece = kept_piece(cache, f, signature, face.dim == 2 ? Choice::low : Choice::separate, Alternative::low);
    return piece;
  }

  static unsigned code_of(int dim, Choice choice, Alternative alternative) {
    const bool high = choice == Choice::separate ? alternative == Alternative::high : choice == Choice::high;
    if (dim < 2) return 0;
    if (dim == 2) return high ? 1 : 0;
    return dim > kSmallDim && choice == Choice::separate && high ? 3u : static_cast<unsigned>(choice);
  }

  static bool nothing_to_choose(int dim, const Piece& piece) {
    if (dim == 2) return piece.facets.size() < 2;
    return std::none_of(piece.facets.begin(), piece.facets.end(), [](auto& f) { return f.filling == Filling::side; });
  }

  const Piece* kept_piece(Cache& cache, std::uint32_t f, Signature signature, Choice choice, Alternative alternative) {
    const int dim = lattice_.faces()[f].dim;
    codes_[f] = code_of(dim, choice, alternative);
    // key: signature, then the choice codes of all faces of f
    std::uint64_t key = compressed(signature, corners_[f]);
    int shift = static_cast<int>(corners_[f].size());
    for (const std::uint32_t g : closures_[f]) {
      const int bits = choice_bits(lattice_.faces()[g].dim);
      if (bits > 0) key |= std::uint64_t{codes_[g]} << shift;
      shift += bits;
    }
    std::unique_ptr<Piece>& piece = slot(cache, key);
    if (piece == nullptr) {
      auto made = std::make_unique<Piece>();
      build_piece(f, signature, choice, alternative, *made);
      if (dim > kSmallDim) large_bytes_ += made->bytes();
      piece = std::move(made);
    }
    return piece.get();
  }

  void build_piece(std::uint32_t f, Signature signature, Choice choice, Alternative alternative, Piece& piece) {
    if (lattice_.faces()[f].dim > 0) {
      builder_->build(f, pieces_, choice, alternative, true, piece);
      return;
    }
    piece.clear();
    piece.own = {OwnVertex{}};
    Simplex corner = kNoSimplex;
    corner[0] = 0;
    ((signature & lattice_.faces()[f].corners) != 0 ? piece.high : piece.low) = {corner};
  }

  void forget_large() {
    for (std::uint32_t f = 0; f < lattice_.faces().size(); ++f)
      if (lattice_.faces()[f].dim > kSmallDim) {
        Cache& cache = caches_[shape_[f]];
        cache.hashed.clear();
        for (std::unique_ptr<Piece>& piece : cache.direct) piece.reset();
      }
    large_bytes_ = 0;
  }

  void write(const Piece& tile, Geometry geometry) {
    // vertices, and their origin if geometry is requested
    result_.vertices.clear();
    for (std::uint32_t f = 0; f < pieces_.size(); ++f) {
      const Piece& piece = *pieces_[f];
      const bool mapped = geometry == Geometry::with && std::any_of(piece.own.begin(), piece.own.end(), [](auto& v) {
                            return v.copied != kNoVertex || v.of_end > v.of_begin;
                          });
      if (mapped) builder_->number(f, map_);
      for (const OwnVertex& own : piece.own) {
        result_.vertices.push_back({own.kind, f, own.number, kNoVertex, {}});
        if (!mapped) continue;
        Vertex& vertex = result_.vertices.back();
        if (own.copied != kNoVertex) vertex.copied = map_[own.copied];
        for (std::uint32_t i = own.of_begin; i < own.of_end; ++i) vertex.of.push_back(carried(piece.of[i]));
      }
    }
    // facets; a negative sign exchanges the first two vertices
    result_.facets.resize(tile.facets.size());
    for (std::size_t i = 0; i < tile.facets.size(); ++i) {
      const PieceFacet& from = tile.facets[i];
      Facet& to = result_.facets[i];
      to.filling = from.filling, to.boundary_euler = from.boundary_euler;
      to.simplices.assign(tile.contour.begin() + from.begin, tile.contour.begin() + from.end);
      for (std::size_t j = 0; j < to.simplices.size(); ++j)
        if (tile.sign[from.begin + j] < 0) std::swap(to.simplices[j][0], to.simplices[j][1]);
    }
    // Sigma
    result_.sigma = builder_->sigma();
    builder_->euler_characteristics(result_.sigma_euler);
    result_.sigma_sign.assign(builder_->sigma_sign().begin(), builder_->sigma_sign().end());
    // contours in the faces of codimension one
    const std::vector<std::uint32_t>& faces = lattice_.faces().back().faces;
    result_.in_face.resize(faces.size()), result_.in_face_sign.resize(faces.size());
    for (std::size_t j = 0; j < faces.size(); ++j) {
      builder_->number(faces[j], map_);
      result_.in_face[j].clear();
      const Piece& piece = *pieces_[faces[j]];
      for (const Simplex& s : piece.contour) result_.in_face[j].push_back(carried(s));
      result_.in_face_sign[j].assign(piece.sign.begin(), piece.sign.end());
    }
  }

  [[nodiscard]] Simplex carried(const Simplex& simplex) const {
    Simplex result = kNoSimplex;
    for (int i = 0; i < kMaxVertices && simplex[i] != kNoVertex; ++i) result[i] = map_[simplex[i]];
    return result;
  }

  FaceLattice lattice_;
  PieceBuilder::Closures closures_;
  std::vector<std::vector<int>> corners_;  ///< by face
  std::vector<std::uint32_t> shape_;       ///< by face: index into caches_
  std::vector<Cache> caches_;
  std::size_t max_large_bytes_;
  std::size_t large_bytes_ = 0;
  std::unique_ptr<PieceBuilder> builder_;
  // State of the current tile.
  std::vector<const Piece*> pieces_;
  std::vector<Piece> transient_;
  std::vector<unsigned> codes_;
  std::vector<VertexId> map_;
  TileFacets result_;
};

FacetBuilder::FacetBuilder(FaceLattice lattice, std::size_t max_kept_bytes) {
  if (lattice.dim() < 2)
    throw std::invalid_argument("tile of dimension " + std::to_string(lattice.dim()) + ", expected 2 or more");
  impl_ = std::make_unique<Impl>(std::move(lattice), max_kept_bytes);
}

FacetBuilder::~FacetBuilder() = default;
FacetBuilder::FacetBuilder(FacetBuilder&&) noexcept = default;
FacetBuilder& FacetBuilder::operator=(FacetBuilder&&) noexcept = default;

const FaceLattice& FacetBuilder::lattice() const& { return impl_->lattice(); }
FaceLattice FacetBuilder::lattice() const&& { return impl_->lattice(); }
std::size_t FacetBuilder::kept_bytes() const { return impl_->kept_bytes(); }

const TileFacets& FacetBuilder::build(Signature signature, const Resolution& resolution, Geometry geometry) & {
  const FaceLattice& lattice = impl_->lattice();
  if (const Signature corners = lattice.faces().back().corners; (signature & ~corners) != 0)
    throw std::invalid_argument("signature " + std::to_string(signature) + " has corners beyond those of the tile, " +
                                std::to_string(corners));
  if (!resolution.choices.empty() && resolution.choices.size() != lattice.faces().size())
    throw std::invalid_argument(std::to_string(resolution.choices.size()) + " choices, expected one for each of " +
                                std::to_string(lattice.faces().size()) + " faces");
  return impl_->build(signature, resolution, geometry);
}

TileFacets FacetBuilder::build(Signature signature, const Resolution& resolution, Geometry geometry) && {
  return build(signature, resolution, geometry);
}

TileFacets build_facets(const FaceLattice& lattice, Signature signature, const Resolution& resolution) {
  return FacetBuilder(lattice).build(signature, resolution);
}

}  // namespace tegl::tile
