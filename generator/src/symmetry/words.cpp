// SPDX-License-Identifier: BSD-3-Clause
//
// Words by breadth-first search. All words of one length are found before the longer ones. Among words of one length
// that end in the same letter and have the same product, only the first in the order of precedes() is extended: that
// order does not change when both words get the same letter at the end.
#include "symmetry/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "base/error.hpp"

namespace tegl::gen {
namespace {

constexpr std::string_view kAxes = "xyzt";

/// The rotation by a quarter turn that maps the direction of axis `from` to the direction of axis `to`.
Element quarter_turn(std::size_t from, std::size_t to) {
  Element g;
  g.axis[from] = static_cast<std::uint8_t>(to);
  g.axis[to] = static_cast<std::uint8_t>(from);
  g.flip = 1U << from;
  g.det = determinant(g);
  return g;
}

Generator named_turn(std::string name, std::size_t from, std::size_t to) {
  return {std::move(name), fmt::format("quarter turn from {} to {}", kAxes[from], kAxes[to]), quarter_turn(from, to)};
}

std::vector<Generator> named_turns(int n) {
  if (n == 2) return {named_turn("rho", 0, 1)};
  if (n == 3) return {named_turn("rho_x", 1, 2), named_turn("rho_y", 2, 0), named_turn("rho_z", 0, 1)};
  std::vector<Generator> result;
  for (std::size_t from = 0; from < 4; ++from)
    for (std::size_t to = from + 1; to < 4; ++to)
      result.push_back(named_turn(fmt::format("rho_{}{}", kAxes[from], kAxes[to]), from, to));
  return result;
}

Generator named_mirror(int n) {
  Generator mirror =
      n == 3 ? Generator{"mu", "mirror in the centre", {}} : Generator{"mu_x", "mirror that maps x to 1 - x", {}};
  mirror.element.flip = n == 3 ? 7 : 1;
  mirror.element.det = determinant(mirror.element);
  return mirror;
}

/// Exponents of the powers in a word.
std::vector<int> exponents(const Word& word) {
  std::vector<int> result;
  for (std::size_t i = 0; i < word.size(); ++i) {
    if (i == 0 || word[i] != word[i - 1]) result.push_back(0);
    ++result.back();
  }
  return result;
}

/// Finds elements in a group.
class Index {
 public:
  explicit Index(std::span<const Element> group) {
    for (std::size_t i = 0; i < group.size(); ++i) index_.emplace(key(group[i]), i);
  }

  std::size_t operator()(const Element& g) const {
    const auto found = index_.find(key(g));
    if (found == index_.end()) throw Error(ErrorCode::Internal, "a generator leads out of the group");
    return found->second;
  }

 private:
  using Key = std::tuple<bool, std::array<std::uint8_t, kMaxDim>, std::uint32_t>;
  static Key key(const Element& g) { return {g.inverts, g.axis, g.flip}; }

  std::map<Key, std::size_t> index_;
};

/// The first word for each pair of an element and a last letter, all of one length.
using Level = std::map<std::pair<std::size_t, std::uint8_t>, Word>;

}  // namespace

std::vector<Generator> named_generators(int n, GroupKind kind, bool inversion) {
  if (n < 2 || n > 4)
    throw Error(ErrorCode::InvalidArgument, fmt::format("named generators in dimension {}: expected 2 to 4", n));
  std::vector<Generator> result = named_turns(n);
  if (kind == GroupKind::Full) result.push_back(named_mirror(n));
  if (inversion) {
    result.push_back({"iota", "exchange of high and low", {}});
    result.back().element.inverts = true;
  }
  return result;
}

Element product(const Word& word, std::span<const Generator> generators) {
  Element result;
  for (const std::uint8_t letter : word) result = compose(generators[letter].element, result);
  return result;
}

std::string word_text(const Word& word, std::span<const Generator> generators) {
  if (word.empty()) return "1";
  std::string text;
  std::size_t at = 0;
  for (const int exponent : exponents(word)) {
    text += fmt::format("{}{}", text.empty() ? "" : " ", generators[word[at]].name);
    if (exponent > 1) text += fmt::format("^{}", exponent);
    at += static_cast<std::size_t>(exponent);
  }
  return text;
}

bool precedes(const Word& a, const Word& b) {
  if (a.size() != b.size()) return a.size() < b.size();
  const std::vector<int> powers_a = exponents(a), powers_b = exponents(b);
  if (powers_a.size() != powers_b.size()) return powers_a.size() < powers_b.size();
  if (powers_a != powers_b) return powers_a > powers_b;
  return a < b;
}

std::vector<Word> shortest_words(std::span<const Element> group, std::span<const Generator> generators) {
  const Index index(group);
  std::vector<std::optional<Word>> found(group.size());
  found[index(Element{})] = Word{};
  Level level{{{index(Element{}), std::uint8_t{0}}, Word{}}};  // the last letter of the empty word is never read
  while (!level.empty()) {
    Level next;
    for (const auto& [state, word] : level) {
      for (std::uint8_t letter = 0; letter < generators.size(); ++letter) {
        const std::size_t image = index(compose(generators[letter].element, group[state.first]));
        if (found[image]) continue;  // by a shorter word
        Word longer = word;
        longer.push_back(letter);
        const auto [at, is_new] = next.try_emplace({image, letter}, longer);
        if (!is_new && precedes(longer, at->second)) at->second = std::move(longer);
      }
    }
    for (const auto& [state, word] : next) {
      std::optional<Word>& first = found[state.first];
      if (!first || precedes(word, *first)) first = word;
    }
    level = std::move(next);
  }
  std::vector<Word> words;
  for (std::optional<Word>& word : found) {
    if (!word) throw Error(ErrorCode::Internal, "the generators do not generate the group");
    words.push_back(std::move(*word));
  }
  return words;
}

}  // namespace tegl::gen
