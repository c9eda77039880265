// SPDX-License-Identifier: BSD-3-Clause
//
// Tables: in columns for people, as CSV for programs.
#pragma once

#include <string>
#include <vector>

namespace tegl::cli {

/// A number to its last bit, as short as can be, for files.
std::string exact_number(double value);

/// Rows of cells under headings.
struct Table {
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;  ///< each as many cells as there are headings

  /// Columns aligned to the right, two spaces between them, indented by two; the first `most` rows. Cells are made
  /// printable.
  [[nodiscard]] std::string to_text(std::size_t most) const;
  /// Lines of cells with commas between them (RFC 4180: quotes where a cell needs them), headings first.
  [[nodiscard]] std::string to_csv() const;
};

}  // namespace tegl::cli
