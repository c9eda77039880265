// SPDX-License-Identifier: BSD-3-Clause
#include "contraction.hpp"

#include <algorithm>
#include <set>

namespace tegl::gen {

namespace {

using Edge = std::array<std::uint8_t, 2>;
using Vertices = std::bitset<256>;

std::array<std::uint8_t, 3> sorted(std::uint8_t a, std::uint8_t b, std::uint8_t c) {
  std::array<std::uint8_t, 3> t{a, b, c};
  std::sort(t.begin(), t.end());
  return t;
}

bool contains(const Simplex& t, std::uint8_t v) { return std::find(t.begin(), t.end(), v) != t.end(); }

/// The link of a vertex: its vertices, edges and triangles.
struct Link {
  Vertices vertices;
  std::vector<Edge> edges;  // ascending, sorted, once each
  std::vector<std::array<std::uint8_t, 3>> triangles;
};

Link link_of(const std::vector<Simplex>& tetrahedra, std::uint8_t v) {
  Link link;
  for (const Simplex& t : tetrahedra) {
    if (!contains(t, v)) continue;
    std::array<std::uint8_t, 3> rest{};
    std::copy_if(t.begin(), t.end(), rest.begin(), [v](std::uint8_t w) { return w != v; });
    std::sort(rest.begin(), rest.end());
    for (const std::uint8_t w : rest) link.vertices.set(w);
    link.edges.push_back({rest[0], rest[1]});
    link.edges.push_back({rest[0], rest[2]});
    link.edges.push_back({rest[1], rest[2]});
    link.triangles.push_back(rest);
  }
  std::sort(link.edges.begin(), link.edges.end());
  link.edges.erase(std::unique(link.edges.begin(), link.edges.end()), link.edges.end());
  std::sort(link.triangles.begin(), link.triangles.end());
  return link;
}

/// Link(u) and Link(v) meet exactly in Link(uv).
bool link_condition(const std::vector<Simplex>& tetrahedra, const Link& of_u, const Link& of_v, std::uint8_t u,
                    std::uint8_t v) {
  Vertices vertices;
  std::set<Edge> edges;
  for (const Simplex& t : tetrahedra) {
    if (!contains(t, u) || !contains(t, v)) continue;
    Edge rest{};
    std::copy_if(t.begin(), t.end(), rest.begin(), [&](std::uint8_t w) { return w != u && w != v; });
    std::sort(rest.begin(), rest.end());
    vertices.set(rest[0]).set(rest[1]);
    edges.insert(rest);
  }
  if ((of_u.vertices & of_v.vertices) != vertices) return false;
  std::vector<Edge> common;
  std::set_intersection(of_u.edges.begin(), of_u.edges.end(), of_v.edges.begin(), of_v.edges.end(),
                        std::back_inserter(common));
  if (!std::equal(common.begin(), common.end(), edges.begin(), edges.end())) return false;
  return std::none_of(of_v.triangles.begin(), of_v.triangles.end(), [&](const auto& t) {
    return std::binary_search(of_u.triangles.begin(), of_u.triangles.end(), t);
  });
}

/// The complex with v moved onto its neighbour u, if that is sound; else empty.
std::vector<Simplex> contracted(const std::vector<Simplex>& tetrahedra, std::uint8_t u, std::uint8_t v,
                                const SigmaComplex& sigma) {
  std::vector<Simplex> result;
  for (Simplex t : tetrahedra) {
    if (contains(t, v)) {
      if (contains(t, u)) continue;
      std::replace(t.begin(), t.end(), v, u);
      if (!sigma.allows(t)) return {};
    }
    result.push_back(t);
  }
  return result;
}

}  // namespace

SigmaComplex::SigmaComplex(const ContourBuilder& builder, const std::vector<Simplex>& component) : builder_(builder) {
  for (const Simplex& s : component) {
    triangles_.push_back(sorted(s[0], s[1], s[2]));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (i != j) adjacent_[s[i]].set(s[j]);
  }
  std::sort(triangles_.begin(), triangles_.end());
}

bool SigmaComplex::allows_triangle(std::uint8_t a, std::uint8_t b, std::uint8_t c) const {
  if ((builder_.faces_of(a) & builder_.faces_of(b) & builder_.faces_of(c)) == 0) return true;
  return std::binary_search(triangles_.begin(), triangles_.end(), sorted(a, b, c));
}

bool SigmaComplex::allows(const Simplex& t) const {
  std::uint32_t common = ~0u;
  for (int i = 0; i < 4; ++i) {
    common &= builder_.faces_of(t[i]);
    for (int j = 0; j < i; ++j)
      if ((builder_.faces_of(t[i]) & builder_.faces_of(t[j])) != 0 && !adjacent_[t[i]].test(t[j])) return false;
  }
  return common == 0 && allows_triangle(t[0], t[1], t[2]) && allows_triangle(t[0], t[1], t[3]) &&
         allows_triangle(t[0], t[2], t[3]) && allows_triangle(t[1], t[2], t[3]);
}

void contract(std::vector<Simplex>& tetrahedra, std::uint8_t first_own, const SigmaComplex& sigma) {
  for (bool changed = true; changed;) {
    changed = false;
    std::set<std::uint8_t> own;
    for (const Simplex& t : tetrahedra)
      std::copy_if(t.begin(), t.end(), std::inserter(own, own.end()), [&](std::uint8_t v) { return v >= first_own; });
    for (const std::uint8_t v : own) {
      const Link of_v = link_of(tetrahedra, v);
      std::vector<Simplex> best;
      for (int u = 0; u < 256; ++u) {
        if (!of_v.vertices.test(static_cast<std::size_t>(u))) continue;
        const auto to = static_cast<std::uint8_t>(u);
        auto result = contracted(tetrahedra, to, v, sigma);
        if (result.empty() || (!best.empty() && result.size() >= best.size())) continue;
        if (link_condition(tetrahedra, link_of(tetrahedra, to), of_v, to, v)) best = std::move(result);
      }
      if (best.empty()) continue;
      tetrahedra = std::move(best);
      changed = true;
    }
  }
}

}  // namespace tegl::gen
