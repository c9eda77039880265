// SPDX-License-Identifier: BSD-3-Clause
//
// Finds equal cells by a hash of their corners that does not depend on the corners' order. Each cell sets a bit in a
// word that its smallest corner chooses, so that cells which follow each other touch near words. Only cells with a bit
// that another cell has are kept. This is done twice, and the few cells that are left are sorted.
#include "tegl/equal_cells.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tegl {

namespace {

using Corners = std::span<const Index>;

/// The top bits depend on all corners.
std::uint64_t hash_of(Corners corners) {
  std::uint64_t sum = 0;
  for (const Index corner : corners) {
    const std::uint64_t word = (std::uint64_t{corner} + 1) * 0x9E3779B97F4A7C15u;
    sum += word ^ (word >> 32);
  }
  return sum * 0xD6E8FEB86659FD93u;
}

/// The corners of all cells.
class AllCorners {
 public:
  explicit AllCorners(const CellLists& cells) : corners_(cells.corners), ends_(cells.ends) {
    if (cells.ends.empty()) {
      add_ends(cells.types);
      ends_ = own_ends_;
    } else if (!cells.face_corners.empty()) {
      add_corners_of_faces(cells);
      corners_ = own_corners_;
      ends_ = own_ends_;
    }
  }

  [[nodiscard]] Corners operator()(std::size_t cell) const {
    const std::uint64_t begin = cell == 0 ? 0 : ends_[cell - 1];
    return corners_.subspan(begin, ends_[cell] - begin);
  }

 private:
  void add_ends(const std::vector<CellType>& types) {
    std::uint64_t end = 0;
    std::size_t count = 0;
    own_ends_.reserve(types.size());
    for (std::size_t c = 0; c < types.size(); ++c) {
      if (c == 0 || types[c] != types[c - 1]) count = corner_count(types[c]);
      own_ends_.push_back(end += count);
    }
  }

  /// Cells may have faces, or facets with faces, and no corners.
  void add_corners_of_faces(const CellLists& cells) {
    const auto end_of = [](const std::vector<std::uint64_t>& ends, std::uint64_t count) {
      return count == 0 ? 0 : ends[count - 1];
    };
    for (std::size_t c = 0; c < cells.types.size(); ++c) {
      const auto at = static_cast<std::ptrdiff_t>(own_corners_.size());
      const auto add = [&](const std::vector<Index>& from, std::uint64_t begin, std::uint64_t end) {
        own_corners_.insert(own_corners_.end(), from.begin() + static_cast<std::ptrdiff_t>(begin),
                            from.begin() + static_cast<std::ptrdiff_t>(end));
      };
      add(cells.corners, end_of(cells.ends, c), cells.ends[c]);
      if (own_corners_.size() == static_cast<std::size_t>(at)) {
        const auto faces_before = [&](std::size_t cell) {
          if (!cells.face_lists_ends.empty()) return end_of(cells.face_lists_ends, cell);
          return end_of(cells.facet_ends, cells.facet_lists_ends.empty() ? 0 : end_of(cells.facet_lists_ends, cell));
        };
        add(cells.face_corners, end_of(cells.face_ends, faces_before(c)), end_of(cells.face_ends, faces_before(c + 1)));
        std::sort(own_corners_.begin() + at, own_corners_.end());
        own_corners_.erase(std::unique(own_corners_.begin() + at, own_corners_.end()), own_corners_.end());
      }
      own_ends_.push_back(own_corners_.size());
    }
  }

  std::vector<Index> own_corners_;
  std::vector<std::uint64_t> own_ends_;
  Corners corners_;
  std::span<const std::uint64_t> ends_;
};

struct Candidate {
  std::uint64_t hash;
  Index word, cell;
  [[nodiscard]] bool operator<(const Candidate& other) const {
    return hash != other.hash ? hash < other.hash : cell < other.cell;
  }
};

/// The bits of cells in words, and the bits that several cells have.
class SharedBits {
 public:
  explicit SharedBits(std::size_t cells) : marked_(std::bit_ceil(cells / 4 + 1)), shared_(marked_.size()) {}

  [[nodiscard]] Index word_of(Corners corners) const {
    return corners.empty() ? 0
                           : *std::min_element(corners.begin(), corners.end()) & static_cast<Index>(marked_.size() - 1);
  }
  void mark(Index word, unsigned bit) {
    const std::uint64_t one = std::uint64_t{1} << bit;
    if ((marked_[word] & one) != 0) shared_[word] |= one;
    marked_[word] |= one;
  }
  [[nodiscard]] bool has_shared(Index word) const { return shared_[word] != 0; }
  [[nodiscard]] bool is_shared(Index word, unsigned bit) const { return (shared_[word] >> bit & 1u) != 0; }
  void clear(Index word) { marked_[word] = shared_[word] = 0; }

 private:
  std::vector<std::uint64_t> marked_, shared_;
};

unsigned first_bit(std::uint64_t hash) { return static_cast<unsigned>(hash >> 58); }
unsigned second_bit(std::uint64_t hash) { return static_cast<unsigned>(hash >> 52 & 63u); }

/// The cells with a word and two bits of another cell, sorted by their hashes.
std::vector<Candidate> find_candidates(std::size_t count, const AllCorners& corners_of) {
  SharedBits bits(count);
  for (std::size_t c = 0; c < count; ++c) bits.mark(bits.word_of(corners_of(c)), first_bit(hash_of(corners_of(c))));
  std::vector<Candidate> found;
  for (std::size_t c = 0; c < count; ++c) {
    const Corners corners = corners_of(c);
    const Index word = bits.word_of(corners);
    if (!bits.has_shared(word)) continue;
    const std::uint64_t hash = hash_of(corners);
    if (bits.is_shared(word, first_bit(hash))) found.push_back({hash, word, static_cast<Index>(c)});
  }
  for (const Candidate& one : found) bits.clear(one.word);
  for (const Candidate& one : found) bits.mark(one.word, second_bit(one.hash));
  std::erase_if(found, [&](const Candidate& one) { return !bits.is_shared(one.word, second_bit(one.hash)); });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::optional<EqualCells> find_equal_cells(const CellLists& cells) {
  const AllCorners corners_of(cells);
  const std::vector<Candidate> candidates = find_candidates(cells.types.size(), corners_of);
  std::optional<EqualCells> found;
  for (std::size_t first = 0, i = 0; i < candidates.size(); ++i) {
    if (candidates[i].hash != candidates[first].hash) first = i;
    const std::size_t second = candidates[i].cell;
    if (found && found->second <= second) continue;
    const Corners own = corners_of(second);
    for (std::size_t k = first; k < i; ++k) {
      const Corners other = corners_of(candidates[k].cell);
      if (!std::is_permutation(own.begin(), own.end(), other.begin(), other.end())) continue;
      found = {candidates[k].cell, second};
      break;
    }
  }
  return found;
}

}  // namespace tegl
