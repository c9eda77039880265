// SPDX-License-Identifier: BSD-3-Clause
//
// `gen --symmetries`: a group's elements as words with their fixed points, and the isotropy group of each class.
//
// Based on: M. Liversage, thesis, 1994, tables 6.8, 6.9 and 7.5.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "program/commands.hpp"
#include "symmetry/group_table.hpp"

namespace tegl::gen {

namespace {

const char* group_name(const GroupTable& table) { return table.kind == GroupKind::Full ? "full" : "rotations"; }

std::string word_of(const GroupTable& table, std::size_t element) {
  return word_text(table.elements[element].word, table.generators);
}

std::vector<std::string> words_of(const GroupTable& table, const std::vector<std::size_t>& elements) {
  std::vector<std::string> words;
  for (const std::size_t g : elements) words.push_back(word_of(table, g));
  return words;
}

/// "+2 -1 -1": lengths of cycles of axes with their signs.
std::string cycles_text(const std::vector<int>& cycles) {
  std::vector<std::string> parts;
  for (const int length : cycles) parts.push_back(fmt::format("{:+}", length));
  return fmt::format("{}", fmt::join(parts, " "));
}

/// "{0, 6, 9, 15}"; of more than 16 signatures, or of more than 4 that follow each other, not all.
std::string set_text(const std::vector<std::uint32_t>& set) {
  if (set.size() > 4 && set.back() - set.front() + 1 == set.size())
    return fmt::format("{{{}, {}, ..., {}}}", set[0], set[1], set.back());
  if (set.size() > 16) return fmt::format("{{{}, {}, {}, ..., {}}}", set[0], set[1], set[2], set.back());
  return fmt::format("{{{}}}", fmt::join(set, ", "));
}

void print_heading(const GroupTable& table) {
  fmt::print("dimension   {}\ngroup       {}{}, order {}\n", table.dim, group_name(table),
             table.inversion ? " with inversion" : "", table.elements.size());
  const char* title = "generators  ";
  for (const Generator& generator : table.generators) {
    fmt::print("{}{:<7} {}\n", title, generator.name, generator.meaning);
    title = "            ";
  }
}

void print_fixed_sum(const GroupTable& table) {
  fmt::print("\n{} fixed points in all = {} elements x {} classes (Burnside's lemma)\n\n", table.fixed_sum,
             table.elements.size(), table.classes.size());
}

/// One line for each element: its word, its kind and the signatures that it fixes.
void print_elements(const GroupTable& table) {
  std::size_t words = 7, kinds = 4;
  for (std::size_t g = 0; g < table.elements.size(); ++g) {
    words = std::max(words, word_of(table, g).size());
    kinds = std::max(kinds, table.elements[g].kind.size());
  }
  fmt::print("\n{:<{}}  {:<{}}  fixed  signatures\n", "element", words, "kind", kinds);
  for (std::size_t g = 0; g < table.elements.size(); ++g) {
    const ElementRow& row = table.elements[g];
    fmt::print("{:<{}}  {:<{}}  {:>5}  {}\n", word_of(table, g), words, row.kind, kinds, row.fixed,
               set_text(row.fixed_signatures));
  }
}

/// One line for all elements with the same cycles of axes.
void print_cycle_types(const GroupTable& table) {
  using Key = std::tuple<bool, int, std::vector<int>>;  // inverts, -det, cycles
  std::vector<std::pair<Key, std::vector<std::size_t>>> types;
  for (std::size_t g = 0; g < table.elements.size(); ++g) {
    const ElementRow& row = table.elements[g];
    const Key key{row.element.inverts, -row.element.det, row.cycles};
    const auto found = std::find_if(types.begin(), types.end(), [&](const auto& type) { return type.first == key; });
    if (found == types.end())
      types.push_back({key, {g}});
    else
      found->second.push_back(g);
  }
  fmt::print("\n{:<12} {:>3} {:>6} {:>9} {:>11}  example\n", "cycles", "det", "order", "elements", "fixed each");
  for (const auto& [key, elements] : types) {
    const ElementRow& row = table.elements[elements.front()];
    fmt::print("{:<12} {:>+3} {:>6} {:>9} {:>11}  {}\n", cycles_text(row.cycles), row.element.det, row.order,
               elements.size(), row.fixed, word_of(table, elements.front()));
  }
}

/// The number of signatures with this many high corners: K in table 6.9. A class with inversion has signatures of two
/// such numbers, so it is not printed then.
std::uint64_t signatures_with(int high_corners, int dim) {
  std::uint64_t result = 1;
  const auto corners = std::uint64_t{1} << dim;
  for (std::uint64_t k = 1; k <= static_cast<std::uint64_t>(high_corners); ++k) result = result * (corners + 1 - k) / k;
  return result;
}

/// One line for each class. The first one with this many high corners has the number of signatures with as many.
void print_classes(const GroupTable& table) {
  fmt::print("high corners {}signature  orbit  order  isotropy group\n", table.inversion ? " " : " in all  ");
  int before = -1;
  for (const ClassRow& row : table.classes) {
    fmt::print("{:>12} ", row.high_corners);
    if (!table.inversion)
      fmt::print("{:>7} ",
                 row.high_corners == before ? "" : fmt::to_string(signatures_with(row.high_corners, table.dim)));
    fmt::print("{:>10} {:>6} {:>6}  {}\n", row.signature, row.orbit_length, row.isotropy.size(),
               isotropy_name(table, row));
    before = row.high_corners;
  }
}

std::string json_of(const GroupTable& table, std::size_t g) {
  const ElementRow& row = table.elements[g];
  std::string fixed_signatures;
  if (table.dim <= 3) fixed_signatures = fmt::format(", \"signatures\": [{}]", fmt::join(row.fixed_signatures, ", "));
  return fmt::format(
      "{{\"word\": \"{}\", \"kind\": {}, \"cycles\": [{}], \"det\": {}, \"inverts\": {}, \"order\": {}, \"corners\": "
      "[{}], \"fixed\": {}{}}}",
      word_of(table, g), row.kind.empty() ? "null" : "\"" + row.kind + "\"", fmt::join(row.cycles, ", "),
      row.element.det, row.element.inverts, row.order, fmt::join(corner_permutation(row.element, table.dim), ", "),
      row.fixed, fixed_signatures);
}

std::string json_of(const GroupTable& table, const ClassRow& row) {
  return fmt::format(
      "{{\"signature\": {}, \"high_corners\": {}, \"orbit_length\": {}, \"isotropy\": {{\"order\": {}, \"name\": "
      "\"{}\", \"elements\": [\"{}\"], \"generators\": [{}]}}}}",
      row.signature, row.high_corners, row.orbit_length, row.isotropy.size(), isotropy_name(table, row),
      fmt::join(words_of(table, row.isotropy), "\", \""),
      row.isotropy_by.empty() ? "" : fmt::format("\"{}\"", fmt::join(words_of(table, row.isotropy_by), "\", \"")));
}

void print_json(const GroupTable& table) {
  std::vector<std::string> generators, elements, classes;
  for (const Generator& generator : table.generators)
    generators.push_back(fmt::format("{{\"name\": \"{}\", \"meaning\": \"{}\", \"corners\": [{}], \"inverts\": {}}}",
                                     generator.name, generator.meaning,
                                     fmt::join(corner_permutation(generator.element, table.dim), ", "),
                                     generator.element.inverts));
  for (std::size_t g = 0; g < table.elements.size(); ++g) elements.push_back(json_of(table, g));
  for (const ClassRow& row : table.classes) classes.push_back(json_of(table, row));
  fmt::print(
      "{{\"dim\": {}, \"group\": \"{}\", \"inversion\": {}, \"order\": {}, \"fixed_sum\": {}, \"generators\": [\n  "
      "{}\n], \"elements\": [\n  {}\n], \"classes\": [\n  {}\n]}}\n",
      table.dim, group_name(table), table.inversion, table.elements.size(), table.fixed_sum,
      fmt::join(generators, ",\n  "), fmt::join(elements, ",\n  "), fmt::join(classes, ",\n  "));
}

}  // namespace

int run_symmetries(const Options& options) {
  const GroupTable table = group_table(options.dim, options.group, options.inversion);
  if (options.json) {
    print_json(table);
    return 0;
  }
  print_heading(table);
  table.dim <= 3 ? print_elements(table) : print_cycle_types(table);
  print_fixed_sum(table);
  print_classes(table);
  return 0;
}

}  // namespace tegl::gen
