// SPDX-License-Identifier: BSD-3-Clause
//
// Tables: aligned columns for display, and CSV.
#pragma once

#include <string>
#include <vector>

namespace tegl::cli {

/// A number with the fewest digits that read back as the same double.
std::string exact_number(double value);

/// Rows of cells under headings.
struct Table {
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;  ///< each row has as many cells as there are headings

  /// The first `most` rows in right-aligned columns, separated by two spaces and indented by two. Cells are made
  /// printable.
  [[nodiscard]] std::string to_text(std::size_t most) const;
  /// CSV, headings first (RFC 4180: cells are quoted if necessary).
  [[nodiscard]] std::string to_csv() const;
};

}  // namespace tegl::cli
