// SPDX-License-Identifier: BSD-3-Clause
//
// Makes, certifies and emits the words about cubes.
#include "builders/cube_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/error.hpp"

namespace tegl::gen {

namespace {

constexpr unsigned kNumber = (1u << CubeWords::kBits) - 1;

const CubeLists& lists_of(const TesseractArrays& arrays, Triangulation triangulation) {
  const CubeLists& first = arrays.lists.front();
  return first.triangulation == triangulation ? first : arrays.lists.back();
}

std::uint32_t word_of(CubeWords::Content content, std::size_t entry, const CubeLists& lists,
                      const TesseractArrays& arrays) {
  const auto number = [&](std::size_t choice) {
    const std::uint16_t list = lists.list_of[3 * entry + choice];
    return list == CubeLists::kNone ? lists.lists.size() : std::size_t{list};
  };
  const auto has_vertices = [&](std::size_t list) {
    return list < lists.lists.size() && lists.lists[list].own_vertices != 0;
  };
  const bool by_centre = content == CubeWords::Content::by_centre;
  const bool with_joins = content == CubeWords::Content::with_joins;
  const std::size_t first = number(by_centre ? 1 : 0), second = number(by_centre ? 2 : 0);
  const unsigned pairs = with_joins ? arrays.joins[entry].pairs : 0;
  auto word = static_cast<std::uint32_t>(first | (with_joins ? entry : second) << CubeWords::kBits);
  if (has_vertices(first)) word |= 1u << CubeWords::kFirstHasVertices;
  if (has_vertices(second)) word |= 1u << CubeWords::kSecondHasVertices;
  if ((by_centre && arrays.cube.entries[entry].components > 1) || pairs == 1) word |= 1u << CubeWords::kHasChoiceOrPair;
  if (pairs > 1) word |= 1u << CubeWords::kHasPairs;
  return word;
}

/// A resolution of a signature, and the word about it.
struct Resolved {
  unsigned signature, high_squares, entry;
  std::uint32_t word;

  void expect(bool is_so, const char* what) const {
    if (is_so) return;
    throw Error(ErrorCode::CertificateFailed,
                fmt::format("word {:#x} of entry {}, signature {} with the high squares {:#x}: expected {}", word,
                            entry, signature, high_squares, what));
  }

  /// The number of a list for one of the centre's choices, and the flag that it has own vertices.
  void expect_list(unsigned number, unsigned flag, unsigned choice, const CubeLists& lists,
                   const tables::ResolvedEntry& of) const {
    const bool is_none = signature == 0 || signature == 255;
    expect(is_none ? number == lists.lists.size() : number < lists.lists.size(),
           "a list if, and only if, the cube has corners of both signs");
    if (!is_none) {
      const CubeLists::List& list = lists.lists[number];
      expect(list.signature == signature && list.high_squares == high_squares, "a list of this resolution");
      const tables::ResolvedList* const by_choice[3] = {&of.separate, &of.low, &of.high};
      expect(by_choice[list.choice]->first_triangle == by_choice[choice]->first_triangle, "a list of this choice");
    }
    const bool has_vertices = !is_none && lists.lists[number].masks[0] != 0;
    expect((word >> flag & 1u) == (has_vertices ? 1u : 0u), "the flag of own vertices as in the list");
  }
};

void certify(const Resolved& resolved, CubeWords::Content content, const CubeLists& lists,
             const TesseractArrays& arrays) {
  const tables::ResolvedEntry& of = arrays.cube.entries[resolved.entry];
  const unsigned first = resolved.word & kNumber, second = resolved.word >> CubeWords::kBits & kNumber;
  const unsigned choice_or_pair = resolved.word >> CubeWords::kHasChoiceOrPair & 1u;
  const unsigned pairs = arrays.joins[resolved.entry].pairs;
  const bool by_centre = content == CubeWords::Content::by_centre;
  const bool with_joins = content == CubeWords::Content::with_joins;
  resolved.expect_list(first, CubeWords::kFirstHasVertices, by_centre ? 1 : 0, lists, of);
  if (with_joins) {
    resolved.expect(second == resolved.entry, "its entry");
    resolved.expect_list(first, CubeWords::kSecondHasVertices, 0, lists, of);
  } else {
    resolved.expect_list(second, CubeWords::kSecondHasVertices, by_centre ? 2 : 0, lists, of);
  }
  const bool has_choice = by_centre && first != second, has_pair = with_joins && pairs == 1;
  resolved.expect(choice_or_pair == (has_choice || has_pair ? 1u : 0u), "the flag of a choice, or of one pair");
  const bool has_pairs = with_joins && pairs > 1;
  resolved.expect(resolved.word >> CubeWords::kHasPairs == (has_pairs ? 1u : 0u), "the flag of several pairs");
}

/// `constexpr TYPE NAME = {...};`, in lines of up to 112 columns.
template <class Range>
std::string array_text(const std::string& declaration, const Range& values) {
  std::string text = fmt::format("constexpr {} = {{", declaration);
  std::size_t line = text.size();
  bool is_first = true;
  for (const auto& v : values) {
    const std::string element = fmt::format("{}", v);
    if (is_first || text.size() - line + element.size() > 112) {
      text += "\n    ";
      line = text.size() - 4;
      is_first = false;
    }
    text += element + ",";
  }
  return text + "};\n";
}

}  // namespace

void certify(const CubeWords& words, const TesseractArrays& arrays) {
  const CubeLists& lists = lists_of(arrays, words.triangulation);
  unsigned entry = 0;
  for (unsigned s = 0; s < 256; ++s) {
    const unsigned ambiguous = arrays.cube.ambiguous[s];
    unsigned high = 0;  // each subset of the ambiguous squares
    do {
      if (entry >= words.words.size()) throw Error(ErrorCode::CertificateFailed, "fewer words than entries");
      certify({s, high, entry, words.words[entry]}, words.content, lists, arrays);
      ++entry;
      high = (high - ambiguous) & ambiguous;
    } while (high != 0);
  }
  if (entry != words.words.size())
    throw Error(ErrorCode::CertificateFailed, fmt::format("{} words for {} entries", words.words.size(), entry));
}

std::vector<CubeWords> make_cube_words(const TesseractArrays& arrays) {
  static_assert(kNumber == 1023);
  std::vector<CubeWords> result;
  for (const CubeWords::Content content : CubeWords::kContents)
    for (const CubeLists& lists : arrays.lists) {
      CubeWords& of = result.emplace_back();
      of.content = content;
      of.triangulation = lists.triangulation;
      for (std::size_t entry = 0; entry < arrays.cube.entries.size(); ++entry)
        of.words.push_back(word_of(content, entry, lists, arrays));
      certify(of, arrays);
    }
  return result;
}

std::string words_text(const std::vector<CubeWords>& words, const TesseractArrays& arrays) {
  std::vector<unsigned> pairs;
  for (const tables::CubeJoin& join : arrays.joins) pairs.push_back(join.pairs);
  std::string text = fmt::format("constexpr unsigned kEntries = {};\n\n", arrays.cube.entries.size());
  text += "/// By signature: the first entry, for low squares only.\n";
  text += array_text("std::array<std::uint16_t, 256> kFirstEntry", arrays.cube.first_entry);
  text += "/// By signature: the ambiguous squares.\n";
  text += array_text("std::array<std::uint8_t, 256> kAmbiguous", arrays.cube.ambiguous);
  text += "/// By entry: the number of pairs of edges that may join inside the cube.\n";
  text += array_text("std::array<std::uint8_t, kEntries> kPairs", pairs);
  text += "/// The words by entry, for each content; of each, barycentric and compact.\n";
  for (const CubeWords& of : words) {
    static constexpr const char* kNames[] = {"Separate", "ByCentre", "WithJoins"};
    text += array_text(fmt::format("std::array<std::uint32_t, kEntries> k{}{}", kNames[static_cast<int>(of.content)],
                                   of.triangulation == Triangulation::compact ? "Compact" : "Barycentric"),
                       of.words);
  }
  return text;
}

}  // namespace tegl::gen
