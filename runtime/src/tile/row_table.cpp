// SPDX-License-Identifier: BSD-3-Clause
//
// Entries of a tile table for the inner loops; see row_table.hpp.
#include "tile/row_table.hpp"

#include <utility>

namespace tegl::detail {

bool RowTable::can_use(const tables::TileTable& table) noexcept {
  return table.element_of == nullptr && table.max_simplices <= kCountMask &&
         table.simplex_count < (1u << (32 - kFirstShift));
}

static std::uint32_t make_entry(const tables::List& list) {
  const bool own = list.cone_vertices != 0 || list.side_vertices != 0;
  return list.first_simplex << RowTable::kFirstShift | (own ? RowTable::kOwnFlag : 0) | list.simplex_count;
}

RowTable::RowTable(const tables::TileTable& table, std::size_t keys)
    : table_(&table), entries_(keys), simplices_(table.simplices) {
  // 4D has 65 536 entries and computes them for each contour.
  std::uint32_t* const entries = entries_.data();
  for (std::size_t s = 0; s < keys; ++s) entries[s] = make_entry(table.lists[table.list_of[s]]);
  count_simplices();
  if (table.dim == 2) choose_segment_bytes();
}

RowTable::RowTable(const tables::TileTable& table, const std::array<unsigned, 256>& counts,
                   std::vector<Variant> variants)
    : table_(&table), simplices_(table.simplices), variants_(std::move(variants)) {
  // Unresolved signatures come first, so that a signature is its own index as in other tables.
  for (unsigned s = 0; s < 256; ++s) entries_.push_back(entry_of_list(s));
  for (unsigned s = 0; s < 256; ++s) {
    variant_places_[s] = static_cast<std::uint16_t>(counts[s] == 1 ? s : entries_.size());
    for (unsigned variant = 0; counts[s] != 1 && variant < counts[s]; ++variant)
      entries_.push_back(entry_of_list(CubeKey::of_variant(s, variant).bits()));
  }
  count_simplices();
}

std::uint32_t RowTable::entry_of_list(unsigned key) const { return make_entry(table_->lists[table_->list_of[key]]); }

void RowTable::count_simplices() {
  for (std::size_t s = 0; s < counts_.size() && table_->dim <= 3 && s < entries_.size(); ++s)
    counts_[s] = static_cast<std::uint8_t>(entries_[s] & kCountMask);
}

void RowTable::choose_segment_bytes() {
  for (unsigned s = 0; s < entries_.size(); ++s)
    for (unsigned v = 0; v < 2 * (entries_[s] & kCountMask); ++v) {
      const unsigned edge = simplices_[2 * (entries_[s] >> kFirstShift) + v];
      for (unsigned byte = 0; byte < 4; ++byte) {
        segment_bytes_[0][s][4 * v + byte] = static_cast<std::uint8_t>(4 * edge + byte);
        segment_bytes_[1][s][4 * (v ^ 1) + byte] = static_cast<std::uint8_t>(4 * edge + byte);
      }
    }
}

}  // namespace tegl::detail
