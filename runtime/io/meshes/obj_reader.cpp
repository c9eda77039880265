// SPDX-License-Identifier: BSD-3-Clause
//
// Reads Wavefront OBJ of any program: vertices in the file's order, triangles or, if there are none, segments. Numbers
// are read as double with all digits, and nothing is merged, sorted or removed, so files of the writer are read back
// bit by bit. Colours, texture coordinates, groups, materials and free-form surfaces are skipped.
//
// Based on: Wavefront Technologies, "The Advanced Visualizer", appendix B1, "Object Files (.obj)", 1991.
#include "meshes/obj_reader.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

/// Removes and returns the first word of a line; empty at the end.
std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kBlanks = " \t\r\v\f";
  line.remove_prefix(std::min(line.find_first_not_of(kBlanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlanks));
  line.remove_prefix(word.size());
  return word;
}

class ObjReader {
 public:
  ObjReader(const fs::path& path, ReadProgress& progress)
      : path_(path), progress_(progress), bytes_(read_bytes(path, 0, static_cast<std::size_t>(size_of_file(path)))) {}

  Mesh run() {
    text_ = std::string_view(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
    while (!text_.empty()) read_statement(next_statement());
    require_present(vertex_reference_, rows(mesh_.coordinates));
    require_present(normal_reference_, rows(mesh_.normals));
    if (triangles_.empty() && segments_.empty())
      fail(ErrorCode::UnsupportedData, path_, "no triangles, no lines; expected a surface");
    mesh_.dim = triangles_.empty() ? 1 : 2;
    mesh_.simplices = std::move(triangles_.empty() ? segments_ : triangles_);
    // Lines cannot refer to normals in OBJ: the normals with their vertices' numbers are used.
    const bool is_by_vertex = mesh_.dim == 1 || normals_by_vertex_;
    if (!is_by_vertex || mesh_.normals.size() != mesh_.coordinates.size()) mesh_.normals = {};
    mesh_.axis_names.resize(3);
    mesh_.axis_units.resize(3);
    return std::move(mesh_);
  }

 private:
  /// State of references to v or vn: the largest number used and its line, as definitions may follow later.
  struct Reference {
    std::string_view what;
    std::uint64_t greatest = 0;
    std::uint64_t line = 0;
  };
  struct Corner {
    Index vertex = 0;
    std::optional<Index> normal;
  };

  static std::size_t rows(const MeshArray<double>& numbers) { return numbers.size() / 3; }

  template <class... Args>
  [[noreturn]] void bad(fmt::format_string<Args...> format, Args&&... args) const {
    fail(ErrorCode::MalformedFile, path_, "line {}: {}", line_, fmt::format(format, std::forward<Args>(args)...));
  }

  /// The next line without its comment, joined with the following lines if it ends with a backslash. A backslash in a
  /// comment does not join lines: comments may end with folder names.
  std::string_view next_statement() {
    line_ = lines_ + 1;
    joined_.clear();
    for (;;) {
      const std::size_t end = text_.find('\n');
      std::string_view line = text_.substr(0, end);
      text_.remove_prefix(std::min(line.size() + 1, text_.size()));
      ++lines_;
      progress_.add(line.size() + 1);
      const std::size_t comment = line.find('#');
      line = line.substr(0, comment);
      if (line.ends_with('\r')) line.remove_suffix(1);
      const bool goes_on = comment == std::string_view::npos && line.ends_with('\\');
      if (!goes_on && joined_.empty()) return line;
      joined_.append(line.substr(0, line.size() - (goes_on ? 1 : 0))) += ' ';
      if (!goes_on || text_.empty()) return joined_;
    }
  }

  void read_statement(std::string_view line) {
    const std::string_view key = next_word(line);
    if (key == "v")
      read_vertex(line);
    else if (key == "vn")
      read_row("vn", line, mesh_.normals);
    else if (key == "f" || key == "fo")  // 'fo' occurs in old files
      read_face(line);
    else if (key == "l")
      read_line(line);
  }

  double number(std::string_view word) const {
    double value = 0;
    if (parse_number(word, value)) return value;
    const std::string_view digits = without_plus(word);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool is_number = error == std::errc::result_out_of_range && end == digits.data() + digits.size();
    bad("{}; expected a number{}", shown(word), is_number ? " in the range of double" : "");
  }

  void read_row(std::string_view key, std::string_view line, MeshArray<double>& numbers) {
    std::size_t count = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      const double value = number(word);
      if (count++ < 3) numbers.push_back(value);  // a weight or a colour may follow
    }
    if (count < 3) bad("'{}' with {} numbers; expected 3 or more", key, count);
  }

  void read_vertex(std::string_view line) {
    read_row("v", line, mesh_.coordinates);
    if (rows(mesh_.coordinates) > std::numeric_limits<Index>::max())
      fail(ErrorCode::TooLarge, path_, "line {}: {} vertices; expected at most {}", line_, rows(mesh_.coordinates),
           std::numeric_limits<Index>::max());
  }

  /// Converts a number of the file to an index from 0. Numbers of the file start at 1; negative ones count back from
  /// the current end.
  Index resolve(std::string_view text, Reference& reference, std::size_t present) const {
    std::int64_t value = 0;
    if (!parse_number(text, value)) bad("{}; expected the number of a {}", shown(text), reference.what);
    const auto count = static_cast<std::int64_t>(present);
    if (value == 0) bad("{} number 0; expected 1 or more, or less than 0", reference.what);
    if (value < -count) bad("{} number {}; expected at least {}, the number so far", reference.what, value, -count);
    if (value < 0) return static_cast<Index>(count + value);
    constexpr Index kMost = std::numeric_limits<Index>::max();
    if (value > kMost) bad("{} number {}; expected at most {}", reference.what, value, kMost);
    if (static_cast<std::uint64_t>(value) > reference.greatest)
      reference.greatest = static_cast<std::uint64_t>(value), reference.line = line_;
    return static_cast<Index>(value - 1);
  }

  void require_present(const Reference& reference, std::size_t present) const {
    if (reference.greatest > present)
      fail(ErrorCode::MalformedFile, path_, "line {}: {} number {}; expected at most {}, the number of definitions",
           reference.line, reference.what, reference.greatest, present);
  }

  /// Parses "7", "7/2", "7/2/5" or "7//5": vertex, texture coordinate, normal.
  Corner corner(std::string_view word) {
    const std::size_t slash = word.find('/');
    Corner result;
    result.vertex = resolve(word.substr(0, slash), vertex_reference_, rows(mesh_.coordinates));
    if (slash == std::string_view::npos) return result;
    const std::size_t second = word.find('/', slash + 1);
    if (second != std::string_view::npos && second + 1 < word.size())
      result.normal = resolve(word.substr(second + 1), normal_reference_, rows(mesh_.normals));
    return result;
  }

  /// Triangulates a polygon as a fan from its first corner.
  void read_face(std::string_view line) {
    std::size_t count = 0;
    Index first = 0;
    Index last = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      const Corner at = corner(word);
      if (!at.normal || *at.normal != at.vertex) normals_by_vertex_ = false;
      if (++count > 2)
        for (const Index vertex : {first, last, at.vertex}) triangles_.push_back(vertex);
      if (count == 1) first = at.vertex;
      last = at.vertex;
    }
    if (count < 3) bad("face of {} vertices; expected 3 or more", count);
  }

  void read_line(std::string_view line) {
    std::size_t count = 0;
    Index last = 0;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
      const Index vertex = corner(word).vertex;
      if (++count > 1)
        for (const Index end : {last, vertex}) segments_.push_back(end);
      last = vertex;
    }
    if (count < 2) bad("line of {} vertices; expected 2 or more", count);
  }

  const fs::path& path_;
  ReadProgress& progress_;
  std::vector<unsigned char> bytes_;
  std::string_view text_;    ///< text not read yet
  std::uint64_t lines_ = 0;  ///< number of lines read
  std::uint64_t line_ = 0;   ///< first line of the current statement
  std::string joined_;       ///< a statement joined from several lines
  Reference vertex_reference_{"vertex"};
  Reference normal_reference_{"normal"};
  Buffer<Index> triangles_;
  Buffer<Index> segments_;
  bool normals_by_vertex_ = true;  ///< every corner refers to the normal of its vertex's number
  Mesh mesh_;
};

}  // namespace

Mesh read_obj(const fs::path& path, ReadProgress& progress) { return ObjReader(path, progress).run(); }

}  // namespace tegl::io_detail
