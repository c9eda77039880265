// SPDX-License-Identifier: BSD-3-Clause
//
// Arrays as JSON text (private to the generator).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <fmt/ranges.h>

#include "tables/emit_text.hpp"

namespace tegl::gen {

/// Writes `"name": [...]` in lines of about 110 columns.
template <class T>
void json_array(std::string& text, const char* name, const std::vector<T>& values) {
  fmt::format_to(Appender(text), ",\n  \"{}\": [", name);
  std::size_t line = text.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) text += ',';
    if (i == 0 || text.size() - line > 110) {
      text += "\n    ";
      line = text.size();
    }
    fmt::format_to(Appender(text), "{}", values[i]);
  }
  text += ']';
}

/// Writes `"name": {"columns": [...], "rows": [[...], ...]}`.
template <class T, class Row>
void json_rows(std::string& text, const char* name, const char* columns, const std::vector<T>& values, const Row& row) {
  fmt::format_to(Appender(text), ",\n  \"{}\": {{\"columns\": [{}], \"rows\": [", name, columns);
  for (std::size_t i = 0; i < values.size(); ++i)
    fmt::format_to(Appender(text), "{}{}[{}]", i == 0 ? "" : ",", i % 6 == 0 ? "\n    " : " ",
                   fmt::join(row(values[i]), ","));
  text += "]}";
}

}  // namespace tegl::gen
