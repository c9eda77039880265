// SPDX-License-Identifier: BSD-3-Clause
//
// Reads tables of scattered points.
#include "vtk/point_table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string_view>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

/// The fields of a line, without blanks and quotes around them. A separator of ' ' means any number of blanks.
std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  if (separator == ' ') return words(line);
  std::vector<std::string_view> fields;
  bool is_quoted = false;
  for (std::size_t begin = 0, at = 0; at <= line.size(); ++at) {
    if (at < line.size() && line[at] == '"') is_quoted = !is_quoted;
    if (at < line.size() && (is_quoted || line[at] != separator)) continue;
    std::string_view field = trim(line.substr(begin, at - begin));
    if (field.size() >= 2 && field.front() == '"' && field.back() == '"') field = field.substr(1, field.size() - 2);
    fields.push_back(field);
    begin = at + 1;
  }
  return fields;
}

/// The separator of a line; one within quotes does not count.
char separator_of(std::string_view line) {
  for (const char separator : {',', ';', '\t'})
    if (fields_of(line, separator).size() > 1) return separator;
  return ' ';
}

bool is_number(std::string_view field) {
  double number = 0;
  return field.empty() || parse_number(field, number);
}

/// The name of the values in tables without names.
constexpr const char* kUnnamed = "value";

/// The meaning of the columns: the first `axes.size()` entries of a row of the table are coordinates.
struct Columns {
  std::vector<std::size_t> axes;
  std::vector<std::size_t> values;
};

/// The columns with the names x, y, z and t in any case, lower case first, in this order; empty without x and y.
std::vector<std::size_t> named_axes(const std::vector<std::string>& names) {
  std::vector<std::size_t> axes;
  for (const std::string_view axis : {"x", "y", "z", "t"}) {
    auto found = std::find(names.begin(), names.end(), axis);
    if (found == names.end())
      found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
        return lower(name) == axis || (axis == "t" && lower(name) == "time");
      });
    if (found != names.end()) axes.push_back(static_cast<std::size_t>(found - names.begin()));
    if (axis == "y" && axes.size() < 2) return {};
  }
  return axes;
}

/// Throws if another column has the name of this one. `any_case`: also in other letters, unless it is `variable`.
void require_one_of_name(const std::vector<std::string>& names, std::size_t column, bool any_case,
                         const std::string& variable, const fs::path& path) {
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (c == column) continue;
    const bool is_same_in_any_case = any_case && names[c] != variable && lower(names[c]) == lower(names[column]);
    if (names[c] == names[column] || is_same_in_any_case)
      fail(ErrorCode::MalformedFile, path,
           "the columns {} ('{}') and {} ('{}') have one name; expected different names", std::min(c, column) + 1,
           names[std::min(c, column)], std::max(c, column) + 1, names[std::max(c, column)]);
  }
}

/// Throws if another column has the name of a coordinate, whose names may have any case, or of the chosen column.
void require_clear_names(const Columns& columns, const std::vector<std::string>& names, const std::string& variable,
                         const fs::path& path) {
  if (names.empty()) return;
  for (const std::size_t axis : columns.axes) require_one_of_name(names, axis, true, variable, path);
  const auto chosen = std::find(names.begin(), names.end(), variable);
  if (chosen != names.end())
    require_one_of_name(names, static_cast<std::size_t>(chosen - names.begin()), false, variable, path);
}

Columns columns_of(const std::vector<std::string>& names, std::size_t count, const std::string& variable,
                   const fs::path& path) {
  Columns columns;
  columns.axes = named_axes(names);
  if (columns.axes.empty()) {
    std::size_t value = count - 1;
    if (!variable.empty()) {
      const auto found = std::find(names.begin(), names.end(), variable);
      if (found == names.end() && !(names.empty() && variable == kUnnamed))
        fail(ErrorCode::VariableNotFound, path, "has no column '{}'; it has {}", variable,
             names.empty() ? fmt::format("columns without names, of which the last is '{}'", kUnnamed)
                           : fmt::format("{}", fmt::join(names, ", ")));
      if (found != names.end()) value = static_cast<std::size_t>(found - names.begin());
    }
    for (std::size_t c = 0; c < count; ++c)
      if (c != value) columns.axes.push_back(c);
  }
  for (std::size_t c = 0; c < count; ++c)
    if (std::find(columns.axes.begin(), columns.axes.end(), c) == columns.axes.end()) columns.values.push_back(c);
  if (columns.axes.size() < 2 || columns.axes.size() > 4 || columns.values.empty())
    fail(ErrorCode::UnsupportedData, path,
         "has {} columns, {} of them coordinates; expected x and y, or also z and t, and a value", count,
         columns.axes.size());
  require_clear_names(columns, names, variable, path);
  return columns;
}

/// Throws for two equal points.
void require_different(const PointTable& table, const fs::path& path) {
  const std::size_t dim = table.dim();
  const auto at = [&](std::size_t p) { return std::span(table.coordinates).subspan(p * dim, dim); };
  std::vector<std::size_t> order(table.lines.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto left = at(a), right = at(b);
    const auto [l, r] = std::mismatch(left.begin(), left.end(), right.begin());
    return l == left.end() ? a < b : *l < *r;
  });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (std::ranges::equal(at(order[i - 1]), at(order[i])))
      fail(ErrorCode::MalformedFile, path, "line {} has the same point as line {}; expected different points",
           table.lines[order[i]], table.lines[order[i - 1]]);
}

/// Reads the rows of a table, line by line.
class TableReader {
 public:
  TableReader(const fs::path& path, const std::string& variable) : path_(path), variable_(variable) {}

  void read_line(std::string_view line) {
    ++line_;
    if (line_ == 1 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);  // byte order mark
    line = trim_end(line);
    if (trim(line).empty() || trim(line).starts_with('#')) return;
    if (separator_ == 0) {
      separator_ = separator_of(line);
      if (start(fields_of(line, separator_))) return;
    }
    read_row(fields_of(line, separator_));
  }

  PointTable take() {
    if (separator_ == 0 || table_.lines.empty())
      fail(ErrorCode::MalformedFile, path_, "a table without a row of numbers; expected at least 3");
    require_different(table_, path_);
    return std::move(table_);
  }

 private:
  /// Without the end of the line; a tab at the end ends a last, empty field.
  static std::string_view trim_end(std::string_view line) {
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
    return line;
  }

  /// Returns whether this first line has the names of the columns.
  bool start(const std::vector<std::string_view>& fields) {
    const bool has_names = !std::all_of(fields.begin(), fields.end(), &is_number);
    const auto numeric = std::find_if(fields.begin(), fields.end(), &is_number);
    if (has_names && numeric != fields.end())
      fail(ErrorCode::MalformedFile, path_, "line {} has numbers, such as {}, and {}; expected numbers only, or names",
           line_, shown(*numeric), shown(*std::find_if_not(fields.begin(), fields.end(), &is_number)));
    std::vector<std::string> names;
    if (has_names) names.assign(fields.begin(), fields.end());
    count_ = fields.size();
    columns_ = columns_of(names, count_, variable_, path_);
    for (std::size_t a = 0; a < columns_.axes.size(); ++a)
      table_.axis_names.push_back(has_names ? names[columns_.axes[a]] : std::string(1, "xyzt"[a]));
    for (const std::size_t c : columns_.values) table_.value_names.push_back(has_names ? names[c] : kUnnamed);
    return has_names;
  }

  [[nodiscard]] double number(std::string_view field, std::size_t column, const char* expected) const {
    double value = 0;
    if (!parse_number(field, value))
      fail(ErrorCode::MalformedFile, path_, "line {}, column {} is {}; expected {}", line_, column + 1, shown(field),
           expected);
    return value;
  }

  /// Leaves out columns with text in the first row, such as names of stations. Text in later rows is an error.
  void leave_out_text(const std::vector<std::string_view>& fields) {
    std::vector<std::size_t> kept;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < columns_.values.size(); ++i) {
      const std::size_t c = columns_.values[i];
      const bool is_chosen = variable_.empty() ? columns_.values.size() == 1 : table_.value_names[i] == variable_;
      if (!is_number(fields[c]) && !is_chosen) continue;
      kept.push_back(c);
      names.push_back(table_.value_names[i]);
    }
    if (kept.empty())
      fail(ErrorCode::MalformedFile, path_, "line {} has text in all columns of values: {}; expected a number", line_,
           fmt::join(table_.value_names, ", "));
    columns_.values = std::move(kept);
    table_.value_names = std::move(names);
  }

  void read_row(const std::vector<std::string_view>& fields) {
    if (fields.size() != count_)
      fail(ErrorCode::MalformedFile, path_, "line {} has {} fields; expected {}, as in the first line", line_,
           fields.size(), count_);
    if (table_.lines.empty()) leave_out_text(fields);
    for (const std::size_t c : columns_.axes) {
      const double x = number(fields[c], c, "a coordinate");
      if (!std::isfinite(x))
        fail(ErrorCode::MalformedFile, path_, "line {}, column {} is {}; expected a finite coordinate", line_, c + 1,
             x);
      table_.coordinates.push_back(x);
    }
    for (const std::size_t c : columns_.values)
      table_.values.push_back(fields[c].empty() ? std::numeric_limits<double>::quiet_NaN()
                                                : number(fields[c], c, "a number, nan or nothing"));
    table_.lines.push_back(line_);
  }

  fs::path path_;
  std::string variable_;
  PointTable table_;
  Columns columns_;
  std::size_t count_ = 0;
  std::size_t line_ = 0;
  char separator_ = 0;  ///< 0 before the first line
};

}  // namespace

std::vector<double> PointTable::column(std::size_t number) const {
  std::vector<double> result;
  result.reserve(lines.size());
  for (std::size_t i = number; i < values.size(); i += value_names.size()) result.push_back(values[i]);
  return result;
}

bool is_point_table(const fs::path& path) { return lower_name(path).ends_with(".csv"); }

PointTable read_point_table(const fs::path& path, const std::string& variable, const Progress& progress) {
  require_readable_file(path);
  TableReader reader(path, variable);
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  constexpr std::size_t kLongestLine = std::size_t{1} << 20;
  const std::uint64_t size = size_of_file(path);
  std::string rest;
  for (std::uint64_t at = 0; at < size; at += kBlock) {
    tick(progress, static_cast<double>(at) / static_cast<double>(size), path);
    const auto block = read_bytes(path, at, kBlock);
    rest.append(block.begin(), block.end());
    std::size_t begin = 0;
    for (std::size_t end = rest.find('\n'); end != std::string::npos; end = rest.find('\n', begin)) {
      reader.read_line(std::string_view(rest).substr(begin, end - begin));
      begin = end + 1;
    }
    rest.erase(0, begin);
    if (rest.size() > kLongestLine)
      fail(ErrorCode::MalformedFile, path, "a line of more than {} bytes; expected rows of numbers", kLongestLine);
  }
  if (!rest.empty()) reader.read_line(rest);
  return reader.take();
}

std::size_t choose_column(const PointTable& table, const std::string& variable, const fs::path& path) {
  const auto& names = table.value_names;
  if (variable.empty() && names.size() == 1) return 0;
  const auto found = std::find(names.begin(), names.end(), variable);
  if (!variable.empty() && found != names.end()) return static_cast<std::size_t>(found - names.begin());
  if (variable.empty())
    fail(ErrorCode::VariableNotFound, path, "{} columns, and none chosen; expected one of {}", names.size(),
         fmt::join(names, ", "));
  fail(ErrorCode::VariableNotFound, path, "has no column '{}' of values; it has {}", variable, fmt::join(names, ", "));
}

}  // namespace tegl::io_detail
