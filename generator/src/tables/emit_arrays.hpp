// SPDX-License-Identifier: BSD-3-Clause
//
// Arrays as C++ text (private to the generator).
#pragma once

#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "tables/emit_text.hpp"

namespace tegl::gen {

/// Writes `const TYPE NAME[] = {...};` in lines of about 110 columns.
template <class T>
void write_array(std::string& text, const char* type, const char* name, const char* comment,
                 const std::vector<T>& values) {
  if (values.empty()) return;
  fmt::format_to(Appender(text), "\n// {}\nconst {} {}[{}] = {{", comment, type, name, values.size());
  std::size_t line = text.size();
  for (const T v : values) {
    if (text.size() - line > 110 || line == text.size()) {
      text += "\n    ";
      line = text.size();
    }
    fmt::format_to(Appender(text), std::is_same_v<T, std::uint64_t> ? "{:#x}," : "{},", v);
  }
  text += "};\n";
}

/// Writes bytes as string literals, which compilers read a hundred times faster than lists of numbers.
inline void write_bytes(std::string& text, const char* name, const std::string& comment,
                        const std::vector<std::uint8_t>& values, std::size_t per_line) {
  fmt::format_to(Appender(text), "\n// {}\nconst char {}[] =", comment, name);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i % per_line == 0) text += i == 0 ? "\n    \"" : "\"\n    \"";
    fmt::format_to(Appender(text), "\\{:o}", values[i]);
  }
  text += values.empty() ? " \"\";\n" : "\";\n";
}

/// Simplices of lists, followed by what registers read past the last one (RowTable::simplices).
inline std::vector<std::uint8_t> readable_by_registers(std::vector<std::uint8_t> simplices) {
  simplices.resize(simplices.size() + tables::RowTable::kReadAtOnce, 0);
  return simplices;
}

/// Writes `const TYPE NAME[] = {...};` with one element as `write` formats it, several in a line.
template <class T, class Write>
void write_records(std::string& text, const char* type, const char* name, const char* comment,
                   const std::vector<T>& values, const Write& write) {
  fmt::format_to(Appender(text), "\n// {}\nconst {} {}[{}] = {{", comment, type, name, values.size());
  std::size_t line = text.size();
  for (const T& v : values) {
    const std::string record = write(v);
    if (text.size() - line + record.size() > 112 || line == text.size()) {
      text += "\n    ";
      line = text.size() - 4;
    }
    text += record + ",";
  }
  text += "};\n";
}

/// The beginning of every C++ file of tables: banner, include, version check.
inline std::string opening(const TableSet& set, const std::string& what) {
  const char* const header = set.tile == TileKind::cube ? "tegl/generated/tables.hpp" : "tegl/table_contract.hpp";
  return banner(set, Language::cpp, what) +
         fmt::format(
             "\n#include \"{}\"\n\nnamespace tegl::tables {{\n\n"
             "static_assert(kContractVersion == {}u, \"tables of another contract version\");\n\nnamespace {{\n",
             header, tables::kContractVersion);
}

}  // namespace tegl::gen
