// SPDX-License-Identifier: BSD-3-Clause
//
// The conditions of a tile's certificate, one function per condition.
#include "tegl/tile/certificate.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <stdexcept>
#include <string>

#include "shelling.hpp"

namespace tegl::tile {

/// Reuses its memory from tile to tile.
class Certifier::Impl {
 public:
  Fault certify(const FaceLattice& lattice, const TileFacets& tile) {
    check_form(lattice, tile);
    simplices_.clear(), signs_.clear();
    for (const Facet& facet : tile.facets)
      for (Simplex s : facet.simplices) {
        signs_.push_back(sort_vertices(s));
        simplices_.push_back(s);
      }
    Fault fault = check_simplices();
    if (fault == Fault::none) fault = collect_sigma(lattice, tile);
    if (fault == Fault::none) fault = check_ridges();
    if (fault == Fault::none) fault = check_components();
    if (fault == Fault::none) fault = check_links(tile);
    if (fault == Fault::none) fault = check_tile_boundary(lattice, tile);
    return fault;
  }

 private:
  /// Preconditions of the other checks: sizes of simplices and ranges of indices.
  static void check_form(const FaceLattice& lattice, const TileFacets& tile) {
    const int n = lattice.dim();
    const auto check = [&](const Simplices& simplices, int vertices) {
      for (const Simplex& s : simplices) {
        if (size(s) != vertices)
          throw std::invalid_argument("simplex of " + std::to_string(size(s)) + " vertices, expected " +
                                      std::to_string(vertices));
        for (int i = 0; i < vertices; ++i)
          if (s[i] >= tile.vertices.size())
            throw std::invalid_argument("vertex " + std::to_string(s[i]) + " of " +
                                        std::to_string(tile.vertices.size()));
      }
    };
    for (const Facet& facet : tile.facets) check(facet.simplices, n);
    for (const Simplices& in_face : tile.in_face) check(in_face, n - 1);
    check(tile.sigma, n - 1);
    for (const Vertex& v : tile.vertices)
      if (v.face > lattice.tile())
        throw std::invalid_argument("vertex in face " + std::to_string(v.face) + " of " +
                                    std::to_string(lattice.faces().size()));
    if (lattice.faces().back().faces.size() > 64)
      throw std::invalid_argument(std::to_string(lattice.faces().back().faces.size()) +
                                  " faces of codimension one, expected at most 64");
  }

  Fault check_simplices() {
    map_.clear(simplices_.size());
    for (std::uint32_t j = 0; j < simplices_.size(); ++j) {
      const Simplex& s = simplices_[j];
      if (std::adjacent_find(s.begin(), s.begin() + size(s)) != s.begin() + size(s)) return Fault::repeated_vertex;
      SimplexMap::Slot& slot = map_.at(vertex_hash(s), [&](std::uint32_t other) { return simplices_[other] == s; });
      if (slot.value != SimplexMap::kNone) return Fault::repeated_vertex;
      slot.value = j;
    }
    return Fault::none;
  }

  /// Sign of the orientation that simplex j induces on its face without vertex i.
  [[nodiscard]] int induced(std::size_t j, std::size_t i) const { return i % 2 == 0 ? signs_[j] : -signs_[j]; }

  [[nodiscard]] int induced(std::size_t j, const Simplex& face) const {
    std::size_t i = 0;
    while (simplices_[j][i] == face[i]) ++i;
    return induced(j, i);
  }

  /// Collects Sigma from the contours in the faces and compares it with the builder's Sigma.
  Fault collect_sigma(const FaceLattice& lattice, const TileFacets& tile) {
    const Face& whole = lattice.faces()[lattice.tile()];
    sigma_.clear(), sigma_sign_.clear();
    if (tile.in_face.size() != whole.faces.size() || tile.in_face_sign.size() != whole.faces.size())
      return Fault::sigma;
    std::size_t total = 0;
    for (const Simplices& in_face : tile.in_face) total += in_face.size();
    map_.clear(total);
    for (std::size_t g = 0; g < whole.faces.size(); ++g) {
      if (tile.in_face_sign[g].size() != tile.in_face[g].size()) return Fault::sigma;
      for (std::size_t j = 0; j < tile.in_face[g].size(); ++j) {
        std::uint32_t& at = sigma_slot(tile.in_face[g][j]);
        if (at != SimplexMap::kNone) return Fault::sigma;  // in two faces
        at = static_cast<std::uint32_t>(sigma_.size());
        sigma_.push_back(tile.in_face[g][j]);
        sigma_sign_.push_back(tile.in_face_sign[g][j] * whole.signs[g]);
      }
    }
    if (tile.sigma.size() != sigma_.size() || tile.sigma_sign.size() != sigma_.size()) return Fault::sigma;
    for (std::size_t j = 0; j < tile.sigma.size(); ++j) {
      const std::uint32_t at = find_in_sigma(tile.sigma[j]);
      if (at == SimplexMap::kNone || sigma_sign_[at] != tile.sigma_sign[j]) return Fault::sigma;
    }
    return Fault::none;
  }

  std::uint32_t& sigma_slot(const Simplex& s) {
    return map_.at(vertex_hash(s), [&](std::uint32_t k) { return sigma_[k] == s; }).value;
  }

  [[nodiscard]] std::uint32_t find_in_sigma(const Simplex& s) const {
    return map_.find(vertex_hash(s), [&](std::uint32_t k) { return sigma_[k] == s; });
  }

  /// Checks (1), (3) and branching on the faces of codimension one.
  Fault check_ridges() {
    if (!adjacency_.build(simplices_)) return Fault::branching;
    std::size_t boundary = 0;
    Fault fault = Fault::none;
    reached_.assign(simplices_.size(), false);
    queue_.clear();
    for (std::uint32_t j = 0; j < simplices_.size(); ++j)
      for (std::size_t i = 0; i < adjacency_.vertices_per_simplex(); ++i) {
        const Simplex face = without(simplices_[j], static_cast<int>(i));
        if (const std::uint32_t n = adjacency_.neighbour(j, i); n != Adjacency::kNone) {
          if (induced(j, i) == induced(n, face)) return Fault::orientation;
          continue;
        }
        ++boundary;
        if (!reached_[j]) reached_[j] = true, queue_.push_back(j);
        const std::uint32_t at = find_in_sigma(face);
        if (at == SimplexMap::kNone || sigma_sign_[at] != induced(j, i)) fault = Fault::boundary;
      }
    return boundary == sigma_.size() ? fault : Fault::boundary;
  }

  /// Every simplex must be reachable from the boundary.
  Fault check_components() {
    for (std::size_t k = 0; k < queue_.size(); ++k)
      for (std::size_t i = 0; i < adjacency_.vertices_per_simplex(); ++i)
        if (const std::uint32_t n = adjacency_.neighbour(queue_[k], i); n != Adjacency::kNone && !reached_[n])
          reached_[n] = true, queue_.push_back(n);
    return queue_.size() == simplices_.size() ? Fault::none : Fault::bubble;
  }

  /// Checks (2) for every vertex.
  Fault check_links(const TileFacets& tile) {
    const std::size_t width = adjacency_.vertices_per_simplex();
    // stars: count per vertex, prefix sum, write
    start_.assign(tile.vertices.size() + 1, 0);
    for (const Simplex& s : simplices_)
      for (std::size_t i = 0; i < width; ++i) ++start_[s[i] + std::size_t{1}];
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    star_.resize(simplices_.size() * width);
    next_.assign(start_.begin(), start_.end());
    for (std::uint32_t j = 0; j < simplices_.size(); ++j)
      for (std::size_t i = 0; i < width; ++i) star_[next_[simplices_[j][i]]++] = j;
    // vertices on Sigma
    on_sigma_.assign(tile.vertices.size(), false);
    for (const Simplex& s : sigma_)
      for (int i = 0; i < size(s); ++i) on_sigma_[s[i]] = true;
    // link of each vertex: by a shelling, else by collapses
    for (std::size_t v = 0; v < tile.vertices.size(); ++v) {
      const auto star = std::span(star_).subspan(start_[v], start_[v + 1] - start_[v]);
      if (star.empty()) continue;
      const Shape right = on_sigma_[v] ? Shape::ball : Shape::sphere;
      const auto vertex = static_cast<VertexId>(v);
      if (shelling_.shape(simplices_, adjacency_, star, vertex) == right) continue;
      // A sphere of dimension 3 or more need not have a shelling that a few tries find.
      if (width <= 4 || shape_of(link(star, vertex)) != right) return Fault::link;
    }
    return Fault::none;
  }

  [[nodiscard]] Simplices link(std::span<const std::uint32_t> star, VertexId vertex) const {
    Simplices result;
    for (const std::uint32_t j : star) {
      const Simplex& s = simplices_[j];
      result.push_back(without(s, static_cast<int>(std::find(s.begin(), s.end(), vertex) - s.begin())));
    }
    return result;
  }

  /// Checks (4): the part of every simplex in each maximal face of the tile. Its subsets belong as well, as `own_` is
  /// closed under subsets.
  Fault check_tile_boundary(const FaceLattice& lattice, const TileFacets& tile) {
    const std::vector<std::uint32_t>& maximal = lattice.faces()[lattice.tile()].faces;
    collect_own(tile);
    inside_.clear();
    // per face of the lattice: the maximal faces that contain it, as bits
    for (const Face& f : lattice.faces()) {
      std::uint64_t in = 0;
      for (std::size_t g = 0; g < maximal.size(); ++g)
        if ((f.corners & ~lattice.faces()[maximal[g]].corners) == 0) in |= std::uint64_t{1} << g;
      inside_.push_back(in);
    }
    // per simplex and maximal face: the vertices in that face
    for (const Simplex& s : simplices_) {
      std::uint64_t in[kMaxVertices] = {}, any = 0;
      const int width = size(s);
      for (int i = 0; i < width; ++i) any |= in[i] = inside_[tile.vertices[s[i]].face];
      for (; any != 0; any &= any - 1) {
        const auto g = static_cast<std::uint32_t>(std::countr_zero(any));
        Simplex part = kNoSimplex;
        int count = 0;
        for (int i = 0; i < width; ++i)
          if (((in[i] >> g) & 1u) != 0) part[count++] = s[i];
        if (!is_own(g, part)) return Fault::in_tile_boundary;
      }
    }
    return Fault::none;
  }

  struct Own {
    std::uint32_t face;
    Simplex simplex;
    friend bool operator==(const Own&, const Own&) = default;
  };

  static std::uint64_t hash(const Own& own) { return vertex_hash(own.simplex) + own.face * 0x9e3779b97f4a7c15u; }

  /// Collects all simplices of every dimension of the contours in the maximal faces.
  void collect_own(const TileFacets& tile) {
    std::size_t total = 0;
    for (const Simplices& in_face : tile.in_face)
      if (!in_face.empty()) total += in_face.size() << size(in_face[0]);
    own_.clear();
    map_.clear(total);
    for (std::uint32_t g = 0; g < tile.in_face.size(); ++g)
      for (const Simplex& s : tile.in_face[g])
        for (unsigned subset = 1; subset < 1u << size(s); ++subset) {
          Own own{g, kNoSimplex};
          int count = 0;
          for (int i = 0; i < size(s); ++i)
            if (((subset >> i) & 1u) != 0) own.simplex[count++] = s[i];
          SimplexMap::Slot& slot = map_.at(hash(own), [&](std::uint32_t k) { return own_[k] == own; });
          if (slot.value != SimplexMap::kNone) continue;
          slot.value = static_cast<std::uint32_t>(own_.size());
          own_.push_back(own);
        }
  }

  [[nodiscard]] bool is_own(std::uint32_t face, const Simplex& simplex) const {
    const Own own{face, simplex};
    return map_.find(hash(own), [&](std::uint32_t k) { return own_[k] == own; }) != SimplexMap::kNone;
  }

  Simplices simplices_, sigma_;
  std::vector<int> signs_, sigma_sign_;
  std::vector<bool> reached_;
  std::vector<std::uint32_t> queue_;
  Adjacency adjacency_;
  Shelling shelling_;
  SimplexMap map_;
  std::vector<std::uint32_t> start_, next_, star_;
  std::vector<bool> on_sigma_;
  std::vector<Own> own_;
  std::vector<std::uint64_t> inside_;  ///< by face: the maximal faces that contain it
};

Certifier::Certifier() : impl_(std::make_unique<Impl>()) {}
Certifier::~Certifier() = default;
Certifier::Certifier(Certifier&&) noexcept = default;
Certifier& Certifier::operator=(Certifier&&) noexcept = default;

Fault Certifier::certify(const FaceLattice& lattice, const TileFacets& tile) { return impl_->certify(lattice, tile); }

Fault certify(const FaceLattice& lattice, const TileFacets& tile) { return Certifier().certify(lattice, tile); }

std::string_view name_of(Fault fault) noexcept {
  switch (fault) {
    case Fault::none:
      return "none";
    case Fault::repeated_vertex:
      return "repeated vertex";
    case Fault::branching:
      return "branching";
    case Fault::orientation:
      return "orientation";
    case Fault::sigma:
      return "Sigma is not what the faces' contours make";
    case Fault::boundary:
      return "boundary is not Sigma";
    case Fault::bubble:
      return "a component without boundary";
    case Fault::link:
      return "bad link";
    case Fault::in_tile_boundary:
      return "simplex in the tile's boundary that is not Sigma's";
  }
  return "unknown";
}

}  // namespace tegl::tile
