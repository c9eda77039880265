// SPDX-License-Identifier: BSD-3-Clause
#include "facet_tables.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "disjoint_sets.hpp"

namespace tegl::detail {
namespace {

constexpr Index kNoPart = ~Index{0};

/// What a facet of dimension d - 3 in a d-cube is called: its face, by the axes and sides that it is cut off by, and
/// its number there. `face` is 2 a + side, `in_face` the same in that face's own axes.
unsigned name_of(unsigned face, const FacetEntry& in_face) noexcept {
  unsigned a = face / 2, b = in_face.face / 2u;
  if (b >= a) ++b;
  unsigned side_a = face % 2, side_b = in_face.face % 2u;
  if (a > b) {
    std::swap(a, b);
    std::swap(side_a, side_b);
  }
  return ((a * FacetTables::kMaxDim + b) * 4 + side_a * 2 + side_b) * 8 + in_face.number;
}
constexpr std::size_t kNames = FacetTables::kMaxDim * FacetTables::kMaxDim * 4 * 8;

}  // namespace

FacetTables::FacetTables(Ambiguity ambiguity) : ambiguity_(ambiguity) {
  for (Lists& lists : lists_) lists.first_facet = lists.first_entry = {0};
  for (unsigned dim = 1; dim < kMaxDim; ++dim)
    for (unsigned signature = 0; signature < 1u << (1u << dim); ++signature) add_signature(dim, signature);
}

void FacetTables::add_tesseracts(std::span<const std::uint16_t> signatures) {
  std::vector<std::uint16_t> sorted(signatures.begin(), signatures.end());
  std::sort(sorted.begin(), sorted.end());
  Lists& lists = lists_[kMaxDim];
  lists = {{0}, {0}, {}};
  auto next = sorted.begin();
  for (unsigned signature = 0; signature < 1u << (1u << kMaxDim); ++signature) {
    if (next == sorted.end() || *next != signature) {
      lists.first_facet.push_back(lists.first_facet.back());
      continue;
    }
    add_signature(kMaxDim, signature);
    next = std::find_if(next, sorted.end(), [&](std::uint16_t s) { return s != signature; });
  }
}

void FacetTables::add_signature(unsigned dim, unsigned signature) {
  Lists& lists = lists_[dim];
  if (dim == 1) {
    if (std::popcount(signature) == 1) lists.first_entry.push_back(lists.first_entry.back());
  } else if (dim == 2) {
    add_square(signature);
  } else {
    std::vector<Part> all = parts(dim, signature);
    join_parts(dim, signature, all);
    for (std::size_t first = 0; first < all.size(); ++first) {
      if (all[first].component != first) continue;
      if (dim == 3) {  // head to tail
        std::size_t at = first;
        do {
          lists.entries.push_back(all[at].entry);
          at = static_cast<std::size_t>(
              std::find_if(all.begin(), all.end(), [&](const Part& part) { return part.ends[0] == all[at].ends[1]; }) -
              all.begin());
        } while (at != first);
      } else {
        for (const Part& part : all)
          if (part.component == first) lists.entries.push_back(part.entry);
      }
      lists.first_entry.push_back(static_cast<std::uint32_t>(lists.entries.size()));
    }
  }
  lists.first_facet.push_back(static_cast<std::uint32_t>(lists.first_entry.size() - 1));
}

void FacetTables::add_square(unsigned signature) {
  std::array<FacetEntry, 4> points{};
  unsigned count = 0;
  for (unsigned face = 0; face < 4; ++face) {
    const unsigned ends = face_signature(2, signature, face / 2, face % 2);
    if (std::popcount(ends) != 1) continue;
    const int rising = ends == 2 ? 1 : -1;
    points[count++] = {static_cast<std::uint8_t>(face), 0,
                       static_cast<std::int8_t>(rising * face_sign(face / 2, face % 2))};
  }
  Lists& lists = lists_[2];
  const auto add = [&](const FacetEntry& a, const FacetEntry& b) {
    lists.entries.push_back(a.sign < 0 ? a : b);
    lists.entries.push_back(a.sign < 0 ? b : a);
    lists.first_entry.push_back(static_cast<std::uint32_t>(lists.entries.size()));
  };
  if (count == 2) add(points[0], points[1]);
  if (count != 4) return;
  // Faces 0 and 1 are at x = 0 and 1, faces 2 and 3 at y = 0 and 1. What is cut off are corners 0 and 3, or 1 and 2.
  const bool diagonal_is_high = signature == 0b1001;
  if (diagonal_is_high == (ambiguity_ == Ambiguity::low)) {
    add(points[0], points[2]);
    add(points[1], points[3]);
  } else {
    add(points[0], points[3]);
    add(points[1], points[2]);
  }
}

std::vector<FacetTables::Part> FacetTables::parts(unsigned dim, unsigned signature) const {
  std::vector<Part> result;
  for (unsigned face = 0; face < 2 * dim; ++face) {
    const unsigned sub = face_signature(dim, signature, face / 2, face % 2);
    for (unsigned number = 0; number < count(dim - 1, sub); ++number)
      result.push_back({{static_cast<std::uint8_t>(face), static_cast<std::uint8_t>(number),
                         static_cast<std::int8_t>(face_sign(face / 2, face % 2))},
                        result.size()});
  }
  return result;
}

/// Parts that share a facet of the next lower dimension hang together.
void FacetTables::join_parts(unsigned dim, unsigned signature, std::vector<Part>& parts) const {
  std::vector<Index> first_with(kNames, kNoPart);
  DisjointSets components;
  components.reset(parts.size());
  for (Index i = 0; i < parts.size(); ++i) {
    const FacetEntry& part = parts[i].entry;
    const unsigned sub = face_signature(dim, signature, part.face / 2u, part.face % 2u);
    for (const FacetEntry& shared : entries(dim - 1, sub, part.number)) {
      const unsigned name = name_of(part.face, shared);
      if (dim == 3) parts[i].ends[shared.sign * part.sign > 0 ? 1 : 0] = name;
      if (first_with[name] == kNoPart) first_with[name] = i;
      components.join(first_with[name], i);
    }
  }
  for (Index i = 0; i < parts.size(); ++i) parts[i].component = components.find(i);
}

}  // namespace tegl::detail
