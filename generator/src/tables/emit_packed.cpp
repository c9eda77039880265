// SPDX-License-Identifier: BSD-3-Clause
//
// Emits tables for GPUs in GLSL, WGSL and CUDA. The look-up is written once, in a notation that substitution converts
// to each language. Expressions on unsigned integers are equal in all three if every shift is in parentheses.
#include "base/error.hpp"
#include "tables/emit.hpp"
#include "tables/emit_text.hpp"
#include "tables/packed_table.hpp"

namespace tegl::gen {

namespace {

/// Differences between the languages.
struct Dialect {
  Language language;
  const char* suffix;    ///< file name extension
  const char* let;       ///< declares a constant local
  const char* variable;  ///< declares a variable local
};

const Dialect& dialect_of(Language language) {
  static constexpr Dialect kDialects[] = {{Language::glsl, "glsl", "uint ", "uint "},
                                          {Language::wgsl, "wgsl", "let ", "var "},
                                          {Language::cuda, "cuh", "const uint32_t ", "uint32_t "}};
  for (const Dialect& dialect : kDialects)
    if (dialect.language == language) return dialect;
  throw Error(ErrorCode::Internal,
              fmt::format("packed tables in {}: expected glsl, wgsl or cuda", language_name(language)));
}

/// Builds one file in one dialect; names get the table's prefix.
class Writer {
 public:
  Writer(const Dialect& dialect, std::string prefix) : dialect_(dialect), prefix_(std::move(prefix)) {}

  void comment(const std::string& line) { text_ += "// " + line + "\n"; }
  void raw(const std::string& text) { text_ += text; }

  void constant(const char* name, std::uint32_t value) {
    switch (dialect_.language) {
      case Language::glsl:
        fmt::format_to(Appender(text_), "const uint {}_{} = {}u;\n", prefix_, name, value);
        break;
      case Language::wgsl:
        fmt::format_to(Appender(text_), "const {}_{} : u32 = {}u;\n", prefix_, name, value);
        break;
      default:
        fmt::format_to(Appender(text_), "constexpr uint32_t {}_{} = {}u;\n", prefix_, name, value);
    }
  }

  /// Writes the words as a constant array `<prefix>_words`.
  void words(const std::vector<std::uint32_t>& words) {
    const std::size_t count = words.size();
    if (dialect_.language == Language::glsl)
      fmt::format_to(Appender(text_), "const uint {}_words[{}] = TEGL_ARRAY_BEGIN", prefix_, count);
    else if (dialect_.language == Language::wgsl)
      fmt::format_to(Appender(text_), "const {0}_words : array<u32, {1}> = array<u32, {1}>(", prefix_, count);
    else
      fmt::format_to(Appender(text_), "TEGL_TABLE_DATA uint32_t {}_words[{}] = {{", prefix_, count);
    std::size_t line = text_.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) text_ += ',';
      if (i == 0 || text_.size() - line > 108) {
        text_ += "\n    ";
        line = text_.size();
      }
      fmt::format_to(Appender(text_), "{}u", words[i]);
    }
    text_ += dialect_.language == Language::glsl   ? "\n    TEGL_ARRAY_END;\n"
             : dialect_.language == Language::wgsl ? ");\n"
                                                   : "};\n";
  }

  /// Writes a function of unsigned parameters with an unsigned result. In `body`, LET and VAR declare locals, W[i] is a
  /// word, and @ before a name stands for the table's prefix.
  void function(const std::string& about, const char* name, std::initializer_list<const char*> parameters,
                const std::string& body) {
    std::string list;
    for (const char* parameter : parameters) {
      if (!list.empty()) list += ", ";
      list += dialect_.language == Language::wgsl   ? fmt::format("{} : u32", parameter)
              : dialect_.language == Language::glsl ? fmt::format("uint {}", parameter)
                                                    : fmt::format("uint32_t {}", parameter);
    }
    const char* const form = dialect_.language == Language::wgsl ? "\n// {0}\nfn {1}_{2}({3}) -> u32 {{\n"
                             : dialect_.language == Language::glsl
                                 ? "\n// {0}\nuint {1}_{2}({3}) {{\n"
                                 : "\n// {0}\nTEGL_TABLE_FUNCTION uint32_t {1}_{2}({3}) {{\n";
    fmt::format_to(Appender(text_), fmt::runtime(form), about, prefix_, name, list);
    text_ += substituted(body) + "}\n";
  }

  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  [[nodiscard]] std::string substituted(std::string body) const {
    const auto replace = [&body](const std::string& from, const std::string& to) {
      for (std::size_t at = 0; (at = body.find(from, at)) != std::string::npos; at += to.size())
        body.replace(at, from.size(), to);
    };
    replace("LET ", dialect_.let);
    replace("VAR ", dialect_.variable);
    replace("W[", prefix_ + "_words[");
    replace("@", prefix_ + "_");
    return body;
  }

  const Dialect& dialect_;
  std::string prefix_;
  std::string text_;
};

void constants(Writer& out, const TileTables& table, const PackedTable& packed) {
  const auto n = static_cast<std::uint32_t>(table.dim);
  out.comment("Corners, edges, first of the tile's own vertices, and the most that a signature has.");
  out.constant("CORNERS", 1u << n);
  out.constant("EDGES", tables::edge_count(n));
  out.constant("FIRST_TILE_VERTEX", tables::first_tile_vertex(n));
  out.constant("MAX_SIMPLICES", table.max_simplices);
  out.constant("MAX_TILE_VERTICES", table.max_tile_vertices);
  out.constant("WORDS", static_cast<std::uint32_t>(packed.words.size()));
  out.raw("\n");
}

void list_functions(Writer& out, const TileTables& table, const PackedTable& packed) {
  const bool by_class = table.layout == Layout::by_class;
  const bool wide = packed.list_stride == 3;
  const std::string list =
      by_class ? fmt::format("(W[{}u + signature] & 0xfffu)", packed.signatures) : std::string("signature");
  out.function("Where the list of a signature stands.", "list_at", {"signature"},
               fmt::format("  return {}u + {}{};\n", packed.lists, wide ? "3u * " : "", list));
  out.function("How many simplices the contour of a signature has.", "simplex_count", {"signature"},
               wide ? "  return W[@list_at(signature) + 1u] & 0xffffu;\n"
                    : "  return (W[@list_at(signature)] >> 16u) & 0xffu;\n");
  out.function(
      "How many barycentres it has: they are the first of its own vertices.", "cone_vertices", {"signature"},
      wide ? "  return (W[@list_at(signature) + 1u] >> 16u) & 0xffu;\n" : "  return W[@list_at(signature)] >> 24u;\n");
  if (wide)
    out.function("How many side vertices it has: they follow its barycentres.", "side_vertices", {"signature"},
                 "  return W[@list_at(signature) + 1u] >> 24u;\n");
}

void edge_function(Writer& out, int n) {
  out.function("The corner at an edge's lower (end 0) or upper (end 1) end.", "edge_corner", {"edge", "end"},
               fmt::format("  LET axis = edge >> {0}u;\n"
                           "  LET rest = edge & {1}u;\n"
                           "  LET below = (1u << axis) - 1u;\n"
                           "  return ((rest & (~below)) << 1u) | (rest & below) | (end << axis);\n",
                           n - 1, (1u << (n - 1)) - 1));
}

void vertex_function(Writer& out, const TileTables& table, const PackedTable& packed) {
  const char* const about = "Local vertex `corner` of a signature's simplex, as the table contract numbers them.";
  const std::string first = packed.list_stride == 3 ? "W[@list_at(signature)]" : "(W[@list_at(signature)] & 0xffffu)";
  const std::string word = fmt::format("W[{}u + {} + simplex]", packed.simplices, first);
  if (table.layout == Layout::flat) {
    out.function(about, "vertex", {"signature", "simplex", "corner"},
                 fmt::format("  LET word = {};\n  return (word >> (8u * corner)) & 0xffu;\n", word));
    return;
  }
  out.function("Where group element `element` moves what stands at `place` in its row.", "moved", {"element", "place"},
               fmt::format("  LET at = element * {}u + place;\n"
                           "  return (W[{}u + (at >> 2u)] >> (8u * (at & 3u))) & 0xffu;\n",
                           table.permutation_stride, packed.permutations));
  const std::string swap =
      table.dim == 4 ? "    if (v >= @EDGES) { v = v ^ ((entry >> (24u + ((v - @EDGES) >> 1u))) & 1u); }\n" : "";
  out.function(
      about, "vertex", {"signature", "simplex", "corner"},
      fmt::format("  LET entry = W[{0}u + signature];\n"
                  "  LET element = (entry >> 12u) & 0xfffu;\n"
                  "  VAR j = corner;\n"
                  "  if ((((W[{1}u + (element >> 5u)] >> (element & 31u)) & 1u) != 0u) && (corner >= {2}u)) {{\n"
                  "    j = {3}u - corner;\n"
                  "  }}\n"
                  "  LET word = {4};\n"
                  "  VAR v = (word >> (8u * j)) & 0xffu;\n"
                  "  if (v < @FIRST_TILE_VERTEX) {{\n"
                  "    v = @moved(element, @CORNERS + v);\n{5}"
                  "  }}\n"
                  "  return v;\n",
                  packed.signatures, packed.reversals, table.dim - 2, 2 * table.dim - 3, word, swap));
}

void side_function(Writer& out, const TileTables& table, const PackedTable& packed) {
  if (packed.list_stride == 1) return;
  const std::string at =
      fmt::format("  LET at = {}u + 2u * (W[@list_at(signature) + 2u] + side);\n", packed.side_masks);
  const char* const about =
      "Bits 0-31 (half 0) or 32-63 (half 1) of a side vertex's mask: bit v is corner v, bit CORNERS + e edge e.";
  if (table.layout == Layout::flat) {
    out.function(about, "side_mask", {"signature", "side", "half_of"}, at + "  return W[at + half_of];\n");
    return;
  }
  out.function(about, "side_mask", {"signature", "side", "half_of"},
               at + fmt::format("  LET element = (W[{}u + signature] >> 12u) & 0xfffu;\n"
                                "  VAR mask = 0u;\n"
                                "  for (VAR b = 0u; b < @CORNERS + @EDGES; b = b + 1u) {{\n"
                                "    if (((W[at + (b >> 5u)] >> (b & 31u)) & 1u) != 0u) {{\n"
                                "      VAR to = @moved(element, b);\n"
                                "      if (b >= @CORNERS) {{ to = to + @CORNERS; }}\n"
                                "      if ((to >> 5u) == half_of) {{ mask = mask | (1u << (to & 31u)); }}\n"
                                "    }}\n"
                                "  }}\n"
                                "  return mask;\n",
                                packed.signatures));
}

/// Macros that constant arrays need.
void array_macros(Writer& out, const Dialect& dialect) {
  if (dialect.language == Language::glsl)
    out.raw("#ifndef TEGL_ARRAY_BEGIN\n#define TEGL_ARRAY_BEGIN uint[](\n#define TEGL_ARRAY_END )\n#endif\n\n");
  if (dialect.language == Language::cuda)
    out.raw(
        "#pragma once\n\n#include <stdint.h>\n\n"
        "// Device data and functions for nvcc; for a host compiler, host ones.\n"
        "#if !defined(TEGL_TABLE_DATA)\n#if defined(__CUDACC__)\n"
        "#define TEGL_TABLE_DATA static __device__ const\n#define TEGL_TABLE_FUNCTION static __device__ inline\n"
        "#else\n#define TEGL_TABLE_DATA static const\n#define TEGL_TABLE_FUNCTION static inline\n#endif\n#endif\n\n");
}

/// The array of words, or the instructions for binding it.
void data(Writer& out, const Dialect& dialect, const TileTables& table, const PackedTable& packed,
          const std::string& name) {
  if (dialect.language == Language::cuda || table.dim < 4) array_macros(out, dialect);
  if (dialect.language == Language::cuda) {
    constants(out, table, packed);
    out.words(packed.words);
    return;
  }
  if (table.dim == 4) {
    const std::string words = "tegl_" + name + "_words";
    out.comment(fmt::format(
        "The words of {}.u32 belong into a storage buffer, which you declare, with the numbers that", name));
    out.comment(fmt::format("suit your program{}:", dialect.language == Language::glsl ? ", before this text" : ""));
    out.comment(dialect.language == Language::glsl
                    ? fmt::format("  layout(std430, binding = 0) readonly buffer TeglTable {{ uint {}[]; }};", words)
                    : fmt::format("  @group(0) @binding(0) var<storage, read> {} : array<u32>;", words));
    out.raw("\n");
    constants(out, table, packed);
    return;
  }
  constants(out, table, packed);
  out.words(packed.words);
}

/// The complete table of the cube. Words: 256 by signature (first entry | ambiguous squares << 16); six per entry (for
/// separate, low and high: first triangle | triangles << 16 | own vertices << 24, then the first mask); one per
/// triangle (a byte per vertex); one per mask.
struct PackedResolved {
  std::vector<std::uint32_t> words;
  std::size_t entries = 0, triangles = 0, masks = 0;  ///< index of the first word of each
};

PackedResolved pack_resolved(const ResolvedCube& table) {
  PackedResolved packed;
  std::vector<std::uint32_t>& words = packed.words;
  for (std::size_t s = 0; s < table.first_entry.size(); ++s)
    words.push_back(table.first_entry[s] | std::uint32_t{table.ambiguous[s]} << 16);
  packed.entries = words.size();
  for (const tables::ResolvedEntry& e : table.entries)
    for (const tables::ResolvedList& l : {e.separate, e.low, e.high}) {
      words.push_back(l.first_triangle | std::uint32_t{l.triangle_count} << 16 | std::uint32_t{l.own_vertices} << 24);
      words.push_back(l.first_mask);
    }
  packed.triangles = words.size();
  for (std::size_t t = 0; t < table.triangles.size(); t += 3)
    words.push_back(table.triangles[t] | std::uint32_t{table.triangles[t + 1]} << 8 |
                    std::uint32_t{table.triangles[t + 2]} << 16);
  packed.masks = words.size();
  words.insert(words.end(), table.masks.begin(), table.masks.end());
  return packed;
}

EmittedFile packed_resolved(const TableSet& set, const Dialect& dialect, const ResolvedCube& table) {
  const PackedResolved packed = pack_resolved(table);
  // constants
  Writer out(dialect, "tegl_tile3_resolved");
  out.raw(banner(set, dialect.language, "The cube with every ambiguity resolved freely."));
  out.comment(resolved_certificate(table));
  out.comment(fmt::format("Digest (FNV-1a) {:016x}. How to read it: docs/tables.md.", digest(table)));
  out.raw("\n");
  array_macros(out, dialect);
  out.constant("EDGES", 12);
  out.constant("ENTRIES", static_cast<std::uint32_t>(table.entries.size()));
  out.constant("WORDS", static_cast<std::uint32_t>(packed.words.size()));
  out.raw("\n");
  out.words(packed.words);
  // functions
  out.function("The set of a signature's ambiguous squares.", "ambiguous_squares", {"signature"},
               "  return W[signature] >> 16u;\n");
  out.function("The entry of a signature with these squares' centres high (a set; of the ambiguous ones).", "entry",
               {"signature", "high_squares"},
               "  LET squares = W[signature] >> 16u;\n"
               "  VAR number = W[signature] & 0xffffu;\n"
               "  VAR bit = 1u;\n"
               "  for (VAR q = 0u; q < 6u; q = q + 1u) {\n"
               "    if (((squares >> q) & 1u) != 0u) {\n"
               "      if (((high_squares >> q) & 1u) != 0u) { number = number + bit; }\n"
               "      bit = bit << 1u;\n"
               "    }\n"
               "  }\n"
               "  return number;\n");
  const std::string at = fmt::format("W[{}u + (6u * entry) + (2u * centre)]", packed.entries);
  out.function("How many triangles an entry has: its polygons apart (centre 0), the centre low (1) or high (2).",
               "triangle_count", {"entry", "centre"}, fmt::format("  return ({} >> 16u) & 0xffu;\n", at));
  out.function("Local vertex `corner` of a triangle.", "vertex", {"entry", "centre", "triangle", "corner"},
               fmt::format("  LET word = W[{}u + ({} & 0xffffu) + triangle];\n"
                           "  return (word >> (8u * corner)) & 0xffu;\n",
                           packed.triangles, at));
  out.function("How many vertices it has beside edge points.", "own_vertices", {"entry", "centre"},
               fmt::format("  return {} >> 24u;\n", at));
  out.function("The corners (bit v) and edges (bit 8 + e) that say where an own vertex lies.", "own_mask",
               {"entry", "centre", "own"},
               fmt::format("  LET first = W[{}u + (6u * entry) + (2u * centre) + 1u];\n"
                           "  return W[{}u + first + own];\n",
                           packed.entries, packed.masks));
  return {fmt::format("tile3_resolved.{}", dialect.suffix), out.take()};
}

}  // namespace

std::vector<EmittedFile> emit_packed(const TableSet& set, Language language) {
  const Dialect& dialect = dialect_of(language);
  if (set.tile != TileKind::cube)
    throw Error(ErrorCode::InvalidArgument, fmt::format("tables of the {} in {}: expected cpp or json",
                                                        tile_kind_name(set.tile), language_name(language)));
  std::vector<EmittedFile> files;
  for (const TileTables& table : set.tiles) {
    const PackedTable packed = pack(table);
    const std::string name = fmt::format("tile{}_{}", table.dim, triangulation_name(table.triangulation));
    Writer out(dialect, "tegl_" + name);
    out.raw(banner(set, language,
                   fmt::format("Contours of the {}-tile, low-connected alternative, {} triangulation, {} layout.",
                               table.dim, triangulation_name(table.triangulation), layout_name(table.layout))));
    out.comment(fmt::format("Digest (FNV-1a) {:016x}. How to read it: docs/tables.md.", digest(table)));
    out.raw("\n");
    data(out, dialect, table, packed, name);
    list_functions(out, table, packed);
    edge_function(out, table.dim);
    vertex_function(out, table, packed);
    side_function(out, table, packed);
    files.push_back({fmt::format("{}.{}", name, dialect.suffix), out.take()});
    if (table.dim == 4 && language != Language::cuda) files.push_back({name + ".u32", to_bytes(packed.words)});
  }
  if (set.resolved) files.push_back(packed_resolved(set, dialect, *set.resolved));
  return files;
}

}  // namespace tegl::gen
