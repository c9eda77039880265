// SPDX-License-Identifier: BSD-3-Clause
//
// Assembles structured arrays from pieces.
#include "vtk/structured.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/common.hpp"
#include "base/raw_image.hpp"

namespace tegl::io_detail {

namespace {

std::uint64_t count_of(const std::array<std::uint64_t, 3>& sizes, std::uint64_t components, const VtkFile& file) {
  return checked_bytes(sizes, components, file.path());
}

/// Calls visit(row in the piece, row in the whole) with the first value of each row.
template <class Visit>
void visit_rows(const VtkExtent& piece, const VtkExtent& whole, bool of_cells, const Visit& visit) {
  const auto own = piece.sizes(of_cells), all = whole.sizes(of_cells);
  std::array<std::uint64_t, 3> shift{};
  for (std::size_t a = 0; a < 3; ++a) shift[a] = static_cast<std::uint64_t>(piece.first[a] - whole.first[a]);
  for (std::uint64_t z = 0; z < own[2]; ++z)
    for (std::uint64_t y = 0; y < own[1]; ++y)
      visit((z * own[1] + y) * own[0], ((z + shift[2]) * all[1] + y + shift[1]) * all[0] + shift[0]);
}

/// Copies a piece to its place in the whole, row by row, and marks it as present.
template <class T>
void place(const ValueVector<T>& from, const VtkExtent& piece, const VtkExtent& whole, std::size_t components,
           bool of_cells, ValueVector<T>& to, std::vector<bool>& present) {
  const std::uint64_t count = piece.sizes(of_cells)[0];
  visit_rows(piece, whole, of_cells, [&](std::uint64_t source, std::uint64_t row) {
    std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(source * components), count * components,
                to.begin() + static_cast<std::ptrdiff_t>(row * components));
    std::fill_n(present.begin() + static_cast<std::ptrdiff_t>(row), count, true);
  });
}

/// The extent of a piece. Errors: MalformedFile if it is not within the whole.
VtkExtent extent_of_piece(const VtkFile& file, const XmlElement& piece, const VtkExtent& whole) {
  const VtkExtent extent = read_extent(file, piece, "Extent");
  for (std::size_t a = 0; a < 3; ++a)
    if (extent.first[a] < whole.first[a] || extent.last[a] > whole.last[a])
      fail(ErrorCode::MalformedFile, file.path(), "a piece from {} to {} along axis {}; expected {} to {} or less",
           extent.first[a], extent.last[a], a, whole.first[a], whole.last[a]);
  return extent;
}

}  // namespace

std::array<std::uint64_t, 3> VtkExtent::sizes(bool of_cells) const {
  std::array<std::uint64_t, 3> result{};
  for (std::size_t a = 0; a < 3; ++a) {
    result[a] = static_cast<std::uint64_t>(last[a] - first[a]) + 1;
    if (of_cells && result[a] > 1) --result[a];
  }
  return result;
}

VtkExtent read_extent(const VtkFile& file, const XmlElement& element, std::string_view key) {
  const std::vector<double> numbers = file.numbers(element, key, 6, {});
  if (numbers.empty()) fail(ErrorCode::MalformedFile, file.path(), "<{}> without {}", element.name, key);
  VtkExtent extent;
  constexpr double kMost = 0x1p40;
  for (std::size_t a = 0; a < 3; ++a) {
    const double first = numbers[2 * a], last = numbers[2 * a + 1];
    if (first != std::trunc(first) || last != std::trunc(last) || std::abs(first) > kMost || std::abs(last) > kMost ||
        last < first)
      fail(ErrorCode::MalformedFile, file.path(),
           "<{}> has {} from {} to {}; expected whole numbers in ascending order", element.name, key, first, last);
    extent.first[a] = static_cast<std::int64_t>(first);
    extent.last[a] = static_cast<std::int64_t>(last);
  }
  count_of(extent.sizes(false), sizeof(double), file);
  return extent;
}

VtkExtent whole_extent(const VtkFile& file) { return read_extent(file, file.data(), "WholeExtent"); }

ValueArray read_structured(const VtkFile& file, std::string_view parent, const std::string& name,
                           std::uint64_t components, bool of_cells, const Progress& progress) {
  const VtkExtent whole = whole_extent(file);
  const auto pieces = file.pieces();
  const auto read_piece = [&](const XmlElement& piece, const VtkExtent& extent) {
    const VtkArray array = file.array(piece, parent, name);
    if (array.components != components)
      fail(ErrorCode::MalformedFile, file.path(), "array {} has {} components; expected {}", shown(array.name),
           array.components, components);
    return file.read(array, count_of(extent.sizes(of_cells), components, file), progress);
  };
  if (pieces.size() == 1) {
    const VtkExtent extent = read_extent(file, *pieces.front(), "Extent");
    if (extent == whole) return read_piece(*pieces.front(), whole);
  }
  // All pieces are read first: their sizes, and the size of the whole, are then known to fit the data.
  std::vector<std::pair<VtkExtent, ValueArray>> parts;
  std::uint64_t sum = 0;
  for (const XmlElement* const piece : pieces) {
    const VtkExtent extent = extent_of_piece(file, *piece, whole);
    parts.emplace_back(extent, read_piece(*piece, extent));
    sum += count_of(extent.sizes(of_cells), 1, file);
  }
  const std::uint64_t total = count_of(whole.sizes(of_cells), 1, file);
  const auto fail_missing = [&](std::uint64_t found) {
    fail(ErrorCode::MalformedFile, file.path(), "{} pieces with {} of {} values; expected pieces of all values",
         pieces.size(), found, total);
  };
  if (sum < total) fail_missing(sum);
  ValueArray all = array_of_type(type_name(parts.front().second));
  std::vector<bool> present(static_cast<std::size_t>(total), false);
  std::visit(
      [&]<class T>(ValueVector<T>& to) {
        to.resize(static_cast<std::size_t>(total * components));
        for (const auto& [extent, values] : parts) {
          const auto* const from = std::get_if<ValueVector<T>>(&values);
          if (from == nullptr)
            fail(ErrorCode::MalformedFile, file.path(), "array '{}' has the type {} in one piece and {} in another",
                 name, type_name(parts.front().second), type_name(values));
          place(*from, extent, whole, static_cast<std::size_t>(components), of_cells, to, present);
        }
      },
      all);
  const auto found = static_cast<std::uint64_t>(std::count(present.begin(), present.end(), true));
  if (found < total) fail_missing(found);
  return all;
}

std::optional<VtkArray> ghosts_of(const VtkFile& file, const XmlElement& piece, bool of_cells) {
  for (VtkArray& array : file.arrays(piece.child(of_cells ? "CellData" : "PointData"))) {
    if (array.name != "vtkGhostType") continue;
    if (array.components == 1 && array.type != "float" && array.type != "double") return std::move(array);
    fail(ErrorCode::MalformedFile, file.path(), "array 'vtkGhostType' has {} components of type {}; expected UInt8",
         array.components, array.type);
  }
  return std::nullopt;
}

std::vector<bool> hidden_in_structured(const VtkFile& file, bool of_cells) {
  const auto pieces = file.pieces();
  if (std::ranges::none_of(pieces, [&](const auto* piece) { return ghosts_of(file, *piece, of_cells).has_value(); }))
    return {};
  const VtkExtent whole = whole_extent(file);
  const auto total = static_cast<std::size_t>(count_of(whole.sizes(of_cells), 1, file));
  std::vector<bool> is_hidden(total, false), is_duplicate(total, false), has_owner(total, false);
  for (const XmlElement* const piece : pieces) {
    const VtkExtent extent = extent_of_piece(file, *piece, whole);
    const std::uint64_t row_size = extent.sizes(of_cells)[0];
    ValueArray ghosts;
    if (const auto array = ghosts_of(file, *piece, of_cells))
      ghosts = file.read(*array, count_of(extent.sizes(of_cells), 1, file));
    const auto mark = [&]<class T>(const ValueVector<T>& values) {
      visit_rows(extent, whole, of_cells, [&](std::uint64_t source, std::uint64_t row) {
        for (std::size_t i = 0; i < row_size; ++i) {
          const GhostMarks marks(values.empty() ? 0 : static_cast<std::uint64_t>(values[source + i]), of_cells);
          if (marks.is_hidden) is_hidden[row + i] = true;
          if (marks.is_duplicate)
            is_duplicate[row + i] = true;
          else
            has_owner[row + i] = true;
        }
      });
    };
    std::visit(mark, ghosts);
  }
  for (std::size_t i = 0; i < total; ++i) is_hidden[i] = is_hidden[i] || (is_duplicate[i] && !has_owner[i]);
  return is_hidden;
}

}  // namespace tegl::io_detail
