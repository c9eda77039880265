// SPDX-License-Identifier: BSD-3-Clause
//
// Packs the parts of a table into words; checks every number against its number of bits.
#include "tables/packed_table.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "base/error.hpp"

namespace tegl::gen {

namespace {

/// Places `value` into `bits` bits at position `shift`. Throws if it does not fit.
std::uint32_t field(std::uint64_t value, int bits, int shift, const char* what) {
  if (value >> bits != 0)
    throw Error(ErrorCode::Internal, fmt::format("packed table: {} is {}, expected less than 2^{}", what, value, bits));
  return static_cast<std::uint32_t>(value) << shift;
}

std::uint32_t size_of(const std::vector<std::uint32_t>& words) { return static_cast<std::uint32_t>(words.size()); }

void pack_bytes(const std::vector<std::uint8_t>& bytes, std::vector<std::uint32_t>& words) {
  const std::size_t first = words.size();
  words.resize(first + (bytes.size() + 3) / 4, 0);
  for (std::size_t i = 0; i < bytes.size(); ++i) words[first + i / 4] |= std::uint32_t{bytes[i]} << (8 * (i % 4));
}

void pack_class_layout(const TileTables& table, PackedTable& packed) {
  packed.signatures = size_of(packed.words);
  for (std::size_t s = 0; s < table.list_of.size(); ++s)
    packed.words.push_back(field(table.list_of[s], 12, 0, "a list's number") |
                           field(table.element_of[s], 12, 12, "a group element's number") |
                           field(table.slot_swaps.empty() ? 0 : table.slot_swaps[s], 8, 24, "a set of slot swaps"));
  packed.permutations = size_of(packed.words);
  pack_bytes(table.permutations, packed.words);
  packed.reversals = size_of(packed.words);
  packed.words.resize(packed.words.size() + (table.reverses.size() + 31) / 32, 0);
  for (std::size_t g = 0; g < table.reverses.size(); ++g)
    packed.words[packed.reversals + g / 32] |= std::uint32_t{table.reverses[g]} << (g % 32);
}

void pack_lists(const TileTables& table, PackedTable& packed) {
  packed.lists = size_of(packed.words);
  for (const tables::List& l : table.lists) {
    if (packed.list_stride == 1) {
      packed.words.push_back(field(l.first_simplex, 16, 0, "a first simplex") |
                             field(l.simplex_count, 8, 16, "a number of simplices") |
                             field(l.cone_vertices, 8, 24, "a number of cone vertices"));
      continue;
    }
    packed.words.push_back(l.first_simplex);
    packed.words.push_back(field(l.simplex_count, 16, 0, "a number of simplices") |
                           field(l.cone_vertices, 8, 16, "a number of cone vertices") |
                           field(l.side_vertices, 8, 24, "a number of side vertices"));
    packed.words.push_back(l.first_side);
  }
}

}  // namespace

PackedTable pack(const TileTables& table) {
  PackedTable packed;
  packed.list_stride = table.dim < 4 ? 1 : 3;  // only 4D has side vertices
  if (packed.list_stride == 1 && !table.side_masks.empty())
    throw Error(ErrorCode::Internal, fmt::format("packed table: {} side masks in dimension {}, expected none",
                                                 table.side_masks.size(), table.dim));
  // parts after the header
  packed.words.assign(kPackedHeader, 0);
  if (table.layout == Layout::by_class) pack_class_layout(table, packed);
  pack_lists(table, packed);
  packed.simplices = size_of(packed.words);
  const auto n = static_cast<std::size_t>(table.dim);
  for (std::size_t i = 0; i < table.simplices.size(); i += n) {
    std::uint32_t word = 0;
    for (std::size_t j = 0; j < n; ++j) word |= std::uint32_t{table.simplices[i + j]} << (8 * j);
    packed.words.push_back(word);
  }
  packed.side_masks = size_of(packed.words);
  for (const std::uint64_t mask : table.side_masks) {
    packed.words.push_back(static_cast<std::uint32_t>(mask));
    packed.words.push_back(static_cast<std::uint32_t>(mask >> 32));
  }
  // header
  const std::uint32_t header[kPackedHeader] = {kPackedMagic,
                                               tables::kContractVersion,
                                               static_cast<std::uint32_t>(table.dim),
                                               table.triangulation == Triangulation::compact ? 1u : 0u,
                                               static_cast<std::uint32_t>(table.lists.size()),
                                               static_cast<std::uint32_t>(table.simplices.size() / n),
                                               static_cast<std::uint32_t>(table.reverses.size()),
                                               table.permutation_stride,
                                               table.max_simplices,
                                               table.max_tile_vertices,
                                               packed.list_stride,
                                               packed.signatures,
                                               packed.lists,
                                               packed.simplices,
                                               packed.permutations,
                                               packed.reversals,
                                               packed.side_masks,
                                               static_cast<std::uint32_t>(table.side_masks.size())};
  std::copy(std::begin(header), std::end(header), packed.words.begin());
  return packed;
}

std::string to_bytes(const std::vector<std::uint32_t>& words) {
  std::string bytes;
  bytes.reserve(4 * words.size());
  for (const std::uint32_t word : words)
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>((word >> shift) & 0xffu));
  return bytes;
}

}  // namespace tegl::gen
