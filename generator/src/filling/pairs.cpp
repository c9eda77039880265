// SPDX-License-Identifier: BSD-3-Clause
//
// Chains of signed simplices: the boundary of a contour on each face of its tile, and the sum over two neighbours.
#include "filling/pairs.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/simplex_key.hpp"
#include "symmetry/transversal.hpp"
#include "tegl/table_contract.hpp"

namespace tegl::gen {

namespace {

using Chain = std::vector<SignedFace>;

/// Normalises a chain: sorted, each simplex once, none with sum 0.
void add_up(Chain& chain) {
  std::sort(chain.begin(), chain.end());
  std::size_t kept = 0;
  for (std::size_t i = 0; i < chain.size();) {
    SignedFace sum{chain[i].key, 0};
    for (; i < chain.size() && chain[i].key == sum.key; ++i) sum.sign += chain[i].sign;
    if (sum.sign != 0) chain[kept++] = sum;
  }
  chain.resize(kept);
}

LocalSimplex vertices_of(Key key) {
  return {static_cast<std::uint8_t>(key >> 24), static_cast<std::uint8_t>(key >> 16),
          static_cast<std::uint8_t>(key >> 8), static_cast<std::uint8_t>(key)};
}

/// Boundaries of contours on the faces of their tiles, in the faces' own vertex numbering.
class Traces {
 public:
  explicit Traces(const ContourBuilder& builder) : builder_(builder), local_(builder.tile().faces.size()) {
    for (std::uint32_t f = 0; f < local_.size(); ++f) {
      local_[f].fill(kNone);
      const std::uint32_t edges = static_cast<std::uint32_t>(builder.tile().faces[f].edge.size());
      const std::uint32_t slots = builder.dim() == 4 ? tables::kFaceSlots : 0;
      for (std::uint32_t v = 0; v < edges + slots; ++v)
        local_[f][builder.lift(f, static_cast<std::uint8_t>(v))] = static_cast<std::uint8_t>(v);
    }
  }

  /// The boundary of a contour, one chain per face.
  [[nodiscard]] std::vector<Chain> of(const TileContour& contour) const {
    const int n = builder_.dim();
    Chain boundary;
    for (const LocalFacet& facet : contour.facets)
      for (const LocalSimplex& s : facet.simplices)
        for (int i = 0; i < n; ++i) {
          const LocalSimplex face = without(s, i, n);
          boundary.push_back({key_of(face, n - 1), (i % 2 == 0 ? 1 : -1) * parity(face, n - 1)});
        }
    add_up(boundary);
    std::vector<Chain> result(local_.size());
    for (const SignedFace& face : boundary) put(face, result);
    for (Chain& chain : result) std::sort(chain.begin(), chain.end());
    return result;
  }

 private:
  static constexpr std::uint8_t kNone = 0xff;

  void put(const SignedFace& face, std::vector<Chain>& result) const {
    const int count = builder_.dim() - 1;
    LocalSimplex s = vertices_of(face.key);
    std::uint32_t common = ~0u;
    for (int i = 0; i < count; ++i) common &= builder_.faces_of(s[i]);
    for (std::uint32_t f = 0; f < result.size(); ++f) {
      if (((common >> f) & 1u) == 0) continue;
      for (int i = 0; i < count; ++i) s[i] = local_[f][s[i]];
      result[f].push_back({key_of(s, count), face.sign * parity(s, count)});
      return;  // an (n-2)-simplex of a contour lies in one face only
    }
    throw Error(ErrorCode::Internal,
                fmt::format("a contour ends inside of its {}-tile, at {:08x}", builder_.dim(), face.key));
  }

  const ContourBuilder& builder_;
  std::vector<std::array<std::uint8_t, 256>> local_;
};

/// Numbers chains; equal chains get equal numbers.
class Numbered {
 public:
  std::uint32_t operator()(const Chain& chain) {
    std::vector<std::uint64_t> flat;
    for (const SignedFace& f : chain) flat.push_back(std::uint64_t{f.key} << 8 | static_cast<std::uint8_t>(f.sign));
    return numbers_.emplace(std::move(flat), static_cast<std::uint32_t>(numbers_.size())).first->second;
  }

 private:
  std::map<std::vector<std::uint64_t>, std::uint32_t> numbers_;
};

Chain negated(Chain chain) {
  for (SignedFace& f : chain) f.sign = -f.sign;
  return chain;
}

/// Signatures of the tiles on one side of a face, grouped by the number of their chain on that face.
using Side = std::map<std::uint32_t, std::vector<Signature>>;

/// Compares every tile below the face with every tile above it.
void compare(const Side& below, const Side& above, int axis, PairFigures& figures) {
  const auto count = [](const Side& side) {
    std::uint64_t sum = 0;
    for (const auto& [chain, signatures] : side) sum += signatures.size();
    return sum;
  };
  std::uint64_t matched = 0;
  for (const auto& [chain, signatures] : below)
    if (const auto same = above.find(chain); same != above.end()) matched += signatures.size() * same->second.size();
  const std::uint64_t all = count(below) * count(above);
  figures.pairs += all;
  if (matched == all) return;
  if (figures.unmatched == 0) {
    figures.axis = axis;
    std::pair<Signature, Signature> first{~Signature{0}, ~Signature{0}};
    for (const auto& [chain, signatures] : below)
      for (const auto& [other, others] : above)
        if (chain != other) first = std::min(first, {signatures.front(), others.front()});
    figures.below = first.first;
    figures.above = first.second;
  }
  figures.unmatched += all - matched;
}

}  // namespace

PairFigures certify_pairs(const ContourBuilder& builder, std::span<const TileContour> contours) {
  const Tile& tile = builder.tile();
  const Traces traces(builder);
  Numbered number;
  std::vector<std::vector<Side>> sides(tile.faces.size());  // by face and its signature
  for (std::uint32_t f = 0; f < sides.size(); ++f) sides[f].resize(std::size_t{tile.faces[f].tile->full()} + 1);
  // chains of every signature on every face; lower faces negated so that matching chains are equal
  for (Signature s = 0; s < contours.size(); ++s) {
    const auto chains = traces.of(contours[s]);
    for (std::uint32_t f = 0; f < chains.size(); ++f)
      sides[f][tile.restrict_to(f, s)][number(f % 2 == 1 ? chains[f] : negated(chains[f]))].push_back(s);
  }
  // compare both sides of every face signature, per axis
  PairFigures figures;
  for (std::uint32_t axis = 0; 2 * axis < sides.size(); ++axis)
    for (std::size_t q = 0; q < sides[2 * axis].size(); ++q)
      compare(sides[2 * axis + 1][q], sides[2 * axis][q], static_cast<int>(axis), figures);
  return figures;
}

std::string unmatched_text(int dim, const PairFigures& figures) {
  return fmt::format(
      "{} of {} pairs of neighbouring {}-tiles leave a hole between them: the first is signature {} below {} along "
      "axis "
      "{}; expected none",
      figures.unmatched, figures.pairs, dim, figures.below, figures.above, figures.axis);
}

std::vector<LocalSimplex> open_simplices(const ContourBuilder& builder, const TileContour& below,
                                         const TileContour& above, int axis) {
  const Traces traces(builder);
  const auto face = static_cast<std::uint32_t>(2 * axis + 1);
  Chain both = traces.of(below)[face];
  const Chain other = traces.of(above)[face - 1];
  both.insert(both.end(), other.begin(), other.end());
  add_up(both);
  std::vector<LocalSimplex> result;
  for (const SignedFace& f : both) {
    LocalSimplex s = vertices_of(f.key);
    for (int i = 0; i < builder.dim() - 1; ++i) s[i] = builder.lift(face, s[i]);
    result.push_back(s);
  }
  return result;
}

std::vector<TileContour> contours_by_class(const ContourBuilder& builder, GroupKind kind, bool inversion) {
  const int n = builder.dim();
  if (n != 2 && n != 3)
    throw Error(ErrorCode::InvalidArgument, fmt::format("contours by class in dimension {}: expected 2 or 3", n));
  const Tile& tile = builder.tile();
  const auto elements = group(n, kind, inversion);
  const Transversal classes = transversal(n, elements);
  std::vector<TileContour> result;
  for (Signature s = 0; s <= tile.full(); ++s) {
    const Element& g = elements[classes.element_of[s]];
    const auto moved = edge_permutation(tile, corner_permutation(g, n));
    TileContour contour = builder.build(classes.representatives[classes.class_of[s]]);
    for (LocalFacet& facet : contour.facets) {
      for (std::uint8_t& point : facet.points) point = moved[point];
      for (LocalSimplex& simplex : facet.simplices) {
        for (int i = 0; i < n; ++i)
          if (simplex[i] < moved.size()) simplex[i] = moved[simplex[i]];
        if (g.reverses_orientation()) std::swap(simplex[n - 1], simplex[n - 2]);
      }
    }
    contour.boundary.clear();  // refers to the representative
    contour.boundary_sign.clear();
    result.push_back(std::move(contour));
  }
  return result;
}

}  // namespace tegl::gen
