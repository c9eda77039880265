// SPDX-License-Identifier: BSD-3-Clause
//
// The signatures that an element fixes are unions of its cycles of corners; if it inverts, high and low corners
// alternate along each cycle, so that all cycles must have even length.
#include "symmetry/group_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <map>
#include <numeric>
#include <string_view>
#include <tuple>

#include "base/error.hpp"
#include "symmetry/transversal.hpp"

namespace tegl::gen {
namespace {

/// Lengths of an element's cycles of axes; a cycle that reverses its axes counts as negative.
std::vector<int> cycles_of_axes(const Element& g, int n) {
  std::vector<int> cycles;
  std::uint32_t seen = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
    int length = 0;
    bool reversed = false;
    for (std::size_t j = i; (seen >> j & 1U) == 0; j = g.axis[j], ++length) {
      seen |= 1U << j;
      reversed ^= (g.flip >> j & 1U) != 0;
    }
    if (length > 0) cycles.push_back(reversed ? -length : length);
  }
  std::sort(cycles.begin(), cycles.end(),
            [](int a, int b) { return std::pair(a < 0, -std::abs(a)) < std::pair(b < 0, -std::abs(b)); });
  return cycles;
}

/// A conjugacy class of the symmetries of the square or the cube, without inversion.
struct Kind {
  std::string_view name;
  std::vector<int> cycles;
};

/// The kinds in 3D, the rotations in the order of table 7.5 of the thesis; in 2D. None in 4D.
const std::vector<Kind>& kinds(int n) {
  static const std::vector<Kind> square{{"identity", {1, 1}},
                                        {"quarter turn", {-2}},
                                        {"half turn", {-1, -1}},
                                        {"mirror parallel to sides", {1, -1}},
                                        {"mirror through corners", {2}}};
  static const std::vector<Kind> cube{{"identity", {1, 1, 1}},
                                      {"quarter turn about a face axis", {1, -2}},
                                      {"half turn about a face axis", {1, -1, -1}},
                                      {"half turn about an edge axis", {2, -1}},
                                      {"third of a turn about a corner axis", {3}},
                                      {"mirror in the centre", {-1, -1, -1}},
                                      {"mirror parallel to faces", {1, 1, -1}},
                                      {"mirror through edges", {2, 1}},
                                      {"rotary reflection, quarter turn", {-2, -1}},
                                      {"rotary reflection, sixth of a turn", {-3}}};
  static const std::vector<Kind> none;
  return n == 2 ? square : n == 3 ? cube : none;
}

std::vector<std::vector<std::uint32_t>> cycles_of_corners(const Element& g, int n) {
  std::vector<std::vector<std::uint32_t>> cycles;
  std::vector<bool> seen(std::size_t{1} << n, false);
  for (std::uint32_t v = 0; v < seen.size(); ++v) {
    if (seen[v]) continue;
    cycles.emplace_back();
    for (std::uint32_t w = v; !seen[w]; w = g.corner(w)) {
      seen[w] = true;
      cycles.back().push_back(w);
    }
  }
  return cycles;
}

/// The signatures with g(s) = s, given that there are some: of each cycle one half or the other, or all or nothing.
std::vector<std::uint32_t> signatures_of(const std::vector<std::vector<std::uint32_t>>& cycles, bool inverts) {
  std::vector<std::uint32_t> result{0};
  for (const std::vector<std::uint32_t>& cycle : cycles) {
    std::uint32_t all = 0, every_other = 0;
    for (std::size_t i = 0; i < cycle.size(); ++i) {
      all |= 1U << cycle[i];
      if (i % 2 == 0) every_other |= 1U << cycle[i];
    }
    const std::size_t before = result.size();
    for (std::size_t i = 0; i < before; ++i) {
      result.push_back(result[i] | (inverts ? every_other : all));
      if (inverts) result[i] |= all & ~every_other;
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

ElementRow row_of(const Element& g, Word word, int n) {
  ElementRow row;
  row.element = g;
  row.word = std::move(word);
  row.cycles = cycles_of_axes(g, n);
  for (const Kind& kind : kinds(n))
    if (kind.cycles == row.cycles) row.kind = kind.name;
  if (g.inverts && !row.kind.empty()) row.kind += ", inverted";
  for (Element power = g; !(power == Element{}); power = compose(g, power)) ++row.order;
  const auto cycles = cycles_of_corners(g, n);
  const bool all_even = std::all_of(cycles.begin(), cycles.end(), [](const auto& c) { return c.size() % 2 == 0; });
  if (g.inverts && !all_even) return row;
  row.fixed = std::uint64_t{1} << cycles.size();
  if (n <= 3) row.fixed_signatures = signatures_of(cycles, g.inverts);
  return row;
}

std::vector<ElementRow> element_rows(int n, const std::vector<Element>& elements, const std::vector<Generator>& by) {
  std::vector<Word> words = shortest_words(elements, by);
  std::vector<ElementRow> rows;
  for (std::size_t i = 0; i < elements.size(); ++i) rows.push_back(row_of(elements[i], std::move(words[i]), n));
  const auto rank = [n](const ElementRow& row) {
    if (n != 3) return std::ptrdiff_t{0};
    const std::vector<Kind>& all = kinds(n);
    return std::find_if(all.begin(), all.end(), [&](const Kind& kind) { return kind.cycles == row.cycles; }) -
           all.begin();
  };
  std::sort(rows.begin(), rows.end(), [&](const ElementRow& a, const ElementRow& b) {
    const auto key = [&](const ElementRow& row) {
      return std::tuple(row.element.inverts, -row.element.det, rank(row));
    };
    return key(a) != key(b) ? key(a) < key(b) : precedes(a.word, b.word);
  });
  return rows;
}

/// Products of elements, which are given as indices of rows.
class Products {
 public:
  explicit Products(const std::vector<ElementRow>& rows) : rows_(rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) index_.emplace(key(rows[i].element), i);
  }

  /// The subgroup that some elements generate, as flags of rows.
  [[nodiscard]] std::vector<bool> generated_by(const std::vector<std::size_t>& elements) const {
    std::vector<bool> in(rows_.size(), false);
    std::vector<std::size_t> todo{index_.at(key(Element{}))};
    in[todo.front()] = true;
    for (std::size_t done = 0; done < todo.size(); ++done) {
      for (const std::size_t g : elements) {
        const std::size_t image = index_.at(key(compose(rows_[g].element, rows_[todo[done]].element)));
        if (!in[image]) todo.push_back(image);
        in[image] = true;
      }
    }
    return in;
  }

 private:
  using Key = std::tuple<bool, std::array<std::uint8_t, kMaxDim>, std::uint32_t>;
  static Key key(const Element& g) { return {g.inverts, g.axis, g.flip}; }

  const std::vector<ElementRow>& rows_;
  std::map<Key, std::size_t> index_;
};

/// Generators of a subgroup, none of which can be left out: each element that the earlier ones do not generate, then
/// without those that the others generate.
std::vector<std::size_t> minimal_generators(const Products& products, const std::vector<std::size_t>& subgroup) {
  std::vector<std::size_t> chosen;
  std::vector<bool> generated = products.generated_by({});
  for (const std::size_t g : subgroup) {
    if (generated[g]) continue;
    chosen.push_back(g);
    generated = products.generated_by(chosen);
  }
  for (std::size_t i = 0; i < chosen.size();) {
    std::vector<std::size_t> others = chosen;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    if (products.generated_by(others) == generated)
      chosen = std::move(others);
    else
      ++i;
  }
  return chosen;
}

std::vector<ClassRow> class_rows(int n, const std::vector<ElementRow>& rows, const Transversal& classes) {
  std::vector<std::vector<std::uint32_t>> corners;
  for (const ElementRow& row : rows) corners.push_back(corner_permutation(row.element, n));
  const Products products(rows);
  std::vector<ClassRow> result;
  for (std::size_t c = 0; c < classes.representatives.size(); ++c) {
    ClassRow row;
    row.signature = classes.representatives[c];
    row.high_corners = std::popcount(row.signature);
    row.orbit_length = classes.orbit_length[c];
    for (std::size_t g = 0; g < rows.size(); ++g)
      if (act(rows[g].element, corners[g], row.signature) == row.signature) row.isotropy.push_back(g);
    if (row.isotropy.size() * row.orbit_length != rows.size())
      throw Error(ErrorCode::CountMismatch,
                  fmt::format("signature {}: {} elements fix it and its orbit has {} signatures: expected a product of "
                              "{}",
                              row.signature, row.isotropy.size(), row.orbit_length, rows.size()));
    row.isotropy_by = minimal_generators(products, row.isotropy);
    result.push_back(std::move(row));
  }
  std::sort(result.begin(), result.end(), [](const ClassRow& a, const ClassRow& b) {
    return std::pair(a.high_corners, a.signature) < std::pair(b.high_corners, b.signature);
  });
  return result;
}

}  // namespace

GroupTable group_table(int n, GroupKind kind, bool inversion) {
  GroupTable table;
  table.dim = n;
  table.kind = kind;
  table.inversion = inversion;
  table.generators = named_generators(n, kind, inversion);
  const std::vector<Element> elements = group(n, kind, inversion);
  table.elements = element_rows(n, elements, table.generators);
  for (const ElementRow& row : table.elements) table.fixed_sum += row.fixed;
  table.classes = class_rows(n, table.elements, transversal(n, elements));
  if (table.fixed_sum != table.elements.size() * table.classes.size())
    throw Error(
        ErrorCode::CountMismatch,
        fmt::format("dimension {}: {} fixed points of {} elements, {} classes by enumeration: expected {} fixed "
                    "points by Burnside's lemma",
                    n, table.fixed_sum, table.elements.size(), table.classes.size(),
                    table.elements.size() * table.classes.size()));
  return table;
}

std::string isotropy_name(const GroupTable& table, const ClassRow& row) {
  if (row.isotropy.size() == table.elements.size()) return "G";
  const bool in_full = row.isotropy.size() <= 4;
  std::vector<std::string> names;
  for (const std::size_t g : in_full ? row.isotropy : row.isotropy_by)
    names.push_back(word_text(table.elements[g].word, table.generators));
  return in_full ? fmt::format("{{{}}}", fmt::join(names, ", ")) : fmt::format("<{}>", fmt::join(names, ", "));
}

}  // namespace tegl::gen
