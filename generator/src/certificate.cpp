// SPDX-License-Identifier: BSD-3-Clause
#include "tegl/gen/certificate.hpp"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "simplex_key.hpp"

namespace tegl::gen {

namespace {

std::string text(const Simplex& s, int count) {
  return fmt::format("({})", fmt::join(s.begin(), s.begin() + count, " "));
}

/// Is a 1-complex (edges by vertex pairs) a single path or cycle?
enum class Shape { none, ball, sphere };

Shape shape_of_points(std::size_t count) { return count == 1 ? Shape::ball : count == 2 ? Shape::sphere : Shape::none; }

class Sets {
 public:
  explicit Sets(std::size_t n) : parent_(n), count_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t find(std::size_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a), b = find(b);
    if (a != b) parent_[a] = b, --count_;
  }
  [[nodiscard]] std::size_t count() const { return count_; }

 private:
  std::vector<std::size_t> parent_;
  std::size_t count_;
};

/// Edges as pairs: one path or one cycle?
Shape shape_of_edges(const std::vector<Simplex>& edges) {
  std::array<std::uint8_t, 256> degree{};
  for (const Simplex& e : edges) ++degree[e[0]], ++degree[e[1]];
  Sets sets(edges.size());
  std::array<int, 256> last;
  last.fill(-1);
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (int k = 0; k < 2; ++k) {
      int& at = last[edges[i][k]];
      if (at >= 0) sets.join(i, static_cast<std::size_t>(at));
      at = static_cast<int>(i);
    }
  if (sets.count() != 1) return Shape::none;
  std::size_t ends = 0;
  for (const std::uint8_t d : degree) {
    if (d > 2) return Shape::none;
    if (d == 1) ++ends;
  }
  return ends == 0 ? Shape::sphere : ends == 2 ? Shape::ball : Shape::none;
}

/// Triangles: a sphere or a disc? Every edge in at most two triangles, one umbrella at every vertex, connected,
/// and Euler characteristic 2 without, 1 with boundary.
Shape shape_of_triangles(const std::vector<Simplex>& triangles) {
  const std::size_t count = triangles.size();
  std::vector<std::array<std::uint32_t, 3>> edges;  // key, triangle, corner opposite to the edge
  edges.reserve(3 * count);
  std::array<bool, 256> seen{};
  for (std::uint32_t t = 0; t < count; ++t)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const std::uint8_t a = triangles[t][(i + 1) % 3], b = triangles[t][(i + 2) % 3];
      edges.push_back({std::uint32_t{std::min(a, b)} << 8 | std::max(a, b), t, i});
      seen[triangles[t][i]] = true;
    }
  std::sort(edges.begin(), edges.end());
  Sets connected(count), umbrellas(3 * count);
  std::size_t distinct = 0, open = 0;
  const auto corner = [&](std::uint32_t t, std::uint8_t v) {
    return 3 * std::size_t{t} + static_cast<std::size_t>(std::find(triangles[t].begin(), triangles[t].begin() + 3, v) -
                                                         triangles[t].begin());
  };
  for (std::size_t i = 0; i < edges.size();) {
    std::size_t j = i + 1;
    while (j < edges.size() && edges[j][0] == edges[i][0]) ++j;
    ++distinct;
    if (j - i > 2) return Shape::none;
    if (j - i == 1) ++open;
    if (j - i == 2) {
      const std::uint32_t t = edges[i][1], u = edges[i + 1][1];
      connected.join(t, u);
      for (const auto v : {static_cast<std::uint8_t>(edges[i][0] >> 8), static_cast<std::uint8_t>(edges[i][0] & 0xff)})
        umbrellas.join(corner(t, v), corner(u, v));
    }
    i = j;
  }
  const auto vertices = static_cast<std::size_t>(std::count(seen.begin(), seen.end(), true));
  if (connected.count() != 1 || umbrellas.count() != vertices) return Shape::none;
  const auto euler = static_cast<std::ptrdiff_t>(vertices + count) - static_cast<std::ptrdiff_t>(distinct);
  if (open == 0) return euler == 2 ? Shape::sphere : Shape::none;
  return euler == 1 ? Shape::ball : Shape::none;
}

/// One run of the certificate over one contour.
class Certifier {
 public:
  Certifier(const ContourBuilder& builder, Signature signature, const TileContour& contour)
      : builder_(builder), n_(builder.dim()) {
    for (const Facet& facet : contour.facets)
      simplices_.insert(simplices_.end(), facet.simplices.begin(), facet.simplices.end());
    collect_sigma(signature);
  }

  Certificate run() {
    for (const auto check : {&Certifier::check_simplices, &Certifier::check_faces, &Certifier::check_links,
                             &Certifier::check_tile_boundary})
      if (Certificate result = (this->*check)(); !result.passed()) return result;
    return {};
  }

 private:
  /// Sigma with signs, and all simplices of every dimension of its triangulation, face by face.
  void collect_sigma(Signature signature) {
    const Tile& tile = builder_.tile();
    in_face_.resize(tile.faces.size());
    for (std::uint32_t f = 0; f < tile.faces.size(); ++f) {
      for (const Facet& facet : builder_.face_contour(f, signature).facets)
        for (Simplex s : facet.simplices) {
          for (int i = 0; i < n_ - 1; ++i) s[i] = builder_.lift(f, s[i]);
          const int sign = tile.faces[f].sign * builder_.orientation() * facet.sign;
          sigma_.push_back({key_of(s, n_ - 1), sign * parity(s, n_ - 1)});
          for (std::uint32_t subset = 1; subset < 1u << (n_ - 1); ++subset)
            in_face_[f].push_back(subset_key(s, subset));
          for (int i = 0; i < n_ - 1; ++i) on_sigma_[s[i]] = true;
        }
      std::sort(in_face_[f].begin(), in_face_[f].end());
    }
    std::sort(sigma_.begin(), sigma_.end());
  }

  static Key subset_key(const Simplex& s, std::uint32_t subset) {
    Simplex part{};
    int count = 0;
    for (int i = 0; i < 4; ++i)
      if (((subset >> i) & 1u) != 0) part[count++] = s[i];
    return key_of(part, count);
  }

  Certificate check_simplices() {
    std::vector<Key> keys;
    for (const Simplex& s : simplices_) {
      for (int i = 0; i < n_; ++i)
        for (int j = 0; j < i; ++j)
          if (s[i] == s[j]) return {Fault::RepeatedVertex, text(s, n_)};
      keys.push_back(key_of(s, n_));
    }
    std::sort(keys.begin(), keys.end());
    const auto twice = std::adjacent_find(keys.begin(), keys.end());
    if (twice != keys.end()) return {Fault::RepeatedVertex, fmt::format("simplex {:08x} twice", *twice)};
    return {};
  }

  /// (1), (3) and branching, from the signed (n-2)-faces.
  Certificate check_faces() {
    std::vector<SignedFace> faces;
    for (const Simplex& s : simplices_)
      for (int i = 0; i < n_; ++i) {
        const Simplex face = without(s, i, n_);
        faces.push_back({key_of(face, n_ - 1), (i % 2 == 0 ? 1 : -1) * parity(face, n_ - 1)});
      }
    std::sort(faces.begin(), faces.end());
    std::vector<SignedFace> boundary;
    for (std::size_t i = 0; i < faces.size();) {
      std::size_t j = i + 1;
      while (j < faces.size() && faces[j].key == faces[i].key) ++j;
      if (j - i > 2) return {Fault::Branching, fmt::format("face {:08x} in {} simplices", faces[i].key, j - i)};
      if (j - i == 1) boundary.push_back(faces[i]);
      if (j - i == 2 && faces[i].sign == faces[i + 1].sign)
        return {Fault::Orientation, fmt::format("face {:08x}", faces[i].key)};
      i = j;
    }
    if (boundary.size() != sigma_.size())
      return {Fault::Boundary, fmt::format("{} boundary simplices, Sigma has {}", boundary.size(), sigma_.size())};
    for (std::size_t i = 0; i < boundary.size(); ++i)
      if (boundary[i].key != sigma_[i].key || boundary[i].sign != sigma_[i].sign)
        return {Fault::Boundary, fmt::format("face {:08x}, Sigma has {:08x}", boundary[i].key, sigma_[i].key)};
    return {};
  }

  /// (2)
  Certificate check_links() {
    std::array<std::vector<Simplex>, 256> links;
    for (const Simplex& s : simplices_)
      for (int i = 0; i < n_; ++i) links[s[i]].push_back(without(s, i, n_));
    for (int v = 0; v < 256; ++v) {
      if (links[v].empty()) {
        if (on_sigma_[v]) return {Fault::Boundary, fmt::format("vertex {} of Sigma in no simplex", v)};
        continue;
      }
      const Shape shape = n_ == 2   ? shape_of_points(links[v].size())
                          : n_ == 3 ? shape_of_edges(links[v])
                                    : shape_of_triangles(links[v]);
      if (shape != (on_sigma_[v] ? Shape::ball : Shape::sphere))
        return {Fault::Link, fmt::format("vertex {}, {} on Sigma", v, on_sigma_[v] ? "one" : "not")};
    }
    return {};
  }

  /// (4)
  Certificate check_tile_boundary() {
    for (const Simplex& s : simplices_)
      for (std::uint32_t subset = 1; subset < 1u << n_; ++subset) {
        std::uint32_t common = ~0u;
        for (int i = 0; i < n_; ++i)
          if (((subset >> i) & 1u) != 0) common &= builder_.faces_of(s[i]);
        for (std::uint32_t f = 0; common != 0; ++f, common >>= 1)
          if ((common & 1u) != 0 && !std::binary_search(in_face_[f].begin(), in_face_[f].end(), subset_key(s, subset)))
            return {Fault::InTileBoundary, fmt::format("{} of simplex {} in face {}", subset, text(s, n_), f)};
      }
    return {};
  }

  const ContourBuilder& builder_;
  int n_;
  std::vector<Simplex> simplices_;
  std::vector<SignedFace> sigma_;
  std::vector<std::vector<Key>> in_face_;
  std::array<bool, 256> on_sigma_{};
};

}  // namespace

const char* fault_name(Fault fault) noexcept {
  switch (fault) {
    case Fault::None:
      return "none";
    case Fault::RepeatedVertex:
      return "repeated vertex";
    case Fault::Boundary:
      return "boundary is not Sigma";
    case Fault::Branching:
      return "branching";
    case Fault::Link:
      return "bad link";
    case Fault::Orientation:
      return "orientation";
    case Fault::InTileBoundary:
      return "simplex in the tile's boundary that is not Sigma's";
  }
  return "unknown";
}

Certificate certify(const ContourBuilder& builder, Signature signature, const TileContour& contour) {
  return Certifier(builder, signature, contour).run();
}

}  // namespace tegl::gen
