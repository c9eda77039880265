// SPDX-License-Identifier: BSD-3-Clause
//
// Implements the packing of contours as numbers and JSON, and the assembly of the page.
#include "view/view_page.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

#include "base/numbers.hpp"
#include "base/printable.hpp"
#include "tegl/io/tracks.hpp"
#include "tegl/normals.hpp"
#include "view/view_assets.hpp"

namespace tegl::cli {

namespace {

static_assert(std::endian::native == std::endian::little, "pages hold numbers as this machine has them");

/// Zigzag encoding: maps small signed numbers to small unsigned numbers.
std::uint32_t zigzag(std::uint32_t difference) {
  return (difference << 1) ^ static_cast<std::uint32_t>(static_cast<std::int32_t>(difference) >> 31);
}

template <int N>
struct Box {
  std::array<double, N> lower;
  std::array<double, N> upper;
};

template <int N>
Box<N> box_of(const Contour<N, double>& contour) {
  Box<N> box;
  box.lower.fill(std::numeric_limits<double>::infinity());
  box.upper.fill(-std::numeric_limits<double>::infinity());
  for (const auto& simplex : contour.simplices)
    for (const Index v : simplex)
      for (int a = 0; a < N; ++a) {
        box.lower[a] = std::min(box.lower[a], contour.vertices[v][a]);
        box.upper[a] = std::max(box.upper[a], contour.vertices[v][a]);
      }
  return box;
}

/// Spatial coordinates as float, relative to the centre of the box.
template <int N>
std::vector<float> places(const Contour<N, double>& contour, const std::vector<double>& center) {
  std::vector<float> result;
  result.reserve(contour.vertices.size() * center.size());
  for (const auto& vertex : contour.vertices)
    for (std::size_t a = 0; a < center.size(); ++a) result.push_back(static_cast<float>(vertex[a] - center[a]));
  return result;
}

/// The distinct times of the vertices, ascending, and the index of each vertex's time among them. With these the page's
/// cuts are as exact as the library's.
std::pair<std::vector<double>, std::vector<std::uint32_t>> ranked_times(const Contour<4, double>& contour) {
  std::vector<double> times;
  times.reserve(contour.vertices.size());
  for (const auto& vertex : contour.vertices) times.push_back(vertex[3]);
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  std::vector<std::uint32_t> ranks;
  ranks.reserve(contour.vertices.size());
  for (const auto& vertex : contour.vertices)
    ranks.push_back(
        static_cast<std::uint32_t>(std::lower_bound(times.begin(), times.end(), vertex[3]) - times.begin()));
  return {std::move(times), std::move(ranks)};
}

/// The spatial part of the normals, scaled to length 127 and rounded to integers, or 0 if it is zero.
template <int N>
std::vector<std::int8_t> normals_in_space(const Contour<N, double>& contour, const WorkOptions& options) {
  Buffer<std::array<double, N>> made;
  if (contour.normals.empty()) made = geometric_normals(contour, NormalWeights::angle, options);
  const auto& normals = contour.normals.empty() ? made : contour.normals;
  std::vector<std::int8_t> result;
  result.reserve(3 * normals.size());
  for (const auto& normal : normals) {
    const double length = std::hypot(normal[0], normal[1], normal[2]);
    for (int a = 0; a < 3; ++a)
      result.push_back(static_cast<std::int8_t>(length > 1e-9 ? std::lround(127 * normal[a] / length) : 0));
  }
  return result;
}

/// The label of each vertex's component; components are numbered by decreasing number of simplices.
template <int N>
std::vector<std::uint32_t> components_by_size(const ComponentLabels& labels) {
  std::vector<std::uint64_t> sizes(labels.count, 0);
  for (const Index label : labels.simplices) ++sizes[label];
  std::vector<Index> order(labels.count);
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return sizes[a] > sizes[b]; });
  std::vector<std::uint32_t> place(labels.count);
  for (std::size_t i = 0; i < order.size(); ++i) place[order[i]] = static_cast<std::uint32_t>(i);
  std::vector<std::uint32_t> result;
  result.reserve(labels.vertices.size());
  for (const Index label : labels.vertices) result.push_back(label == kNoComponent ? 0 : place[label]);
  return result;
}

/// Attributes as scalars: vectors are replaced by their length.
Json describe_attributes(const std::vector<Attribute>& attributes, PageNumbers& numbers) {
  Json list = Json::array();
  for (const Attribute& attribute : attributes) {
    const auto width = static_cast<std::size_t>(attribute.width);
    std::vector<float> values;
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (std::size_t i = 0; i + width <= attribute.values.size(); i += width) {
      double value = attribute.values[i];
      if (width > 1) {
        value = 0;
        for (std::size_t k = 0; k < width; ++k) value = std::hypot(value, attribute.values[i + k]);
      }
      values.push_back(static_cast<float>(value));
      if (!std::isfinite(value)) continue;
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
    if (!(lowest <= highest)) continue;  // no finite value for a colour scale
    Json& one = list.emplace_back();
    one["name"] = width > 1 ? fmt::format("|{}|", attribute.name) : attribute.name;
    one["unit"] = attribute.unit;
    one["lowest"] = lowest;
    one["highest"] = highest;
    one["values"] = numbers.add(std::span<const float>(values), 1);
  }
  return list;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else
      result += c;
  }
  return result;
}

/// Makes all strings of a document printable: names and units from files may contain anything.
Json with_printable_strings(Json json) {
  if (json.is_string()) return printable(json.get_ref<const std::string&>());
  if (json.is_structured())
    for (Json& item : json) item = with_printable_strings(std::move(item));
  return json;
}

/// Formats JSON for a <script> element: without "<".
std::string script_json(const Json& json) {
  std::string result;
  for (const char c : json.dump(-1, ' ', false, Json::error_handler_t::replace)) {
    if (c == '<')
      result += "\\u003c";
    else
      result += c;
  }
  return result;
}

/// The graph of the shown tracks; events also have the numbers of parts in the graph of all tracks.
Json graph_of(const PageTracks& tracks) {
  Json graph = Json::parse(track_json(tracks.graph));
  for (std::size_t i = 0; i < tracks.event_parts.size(); ++i) {
    graph["events"][i]["parts_in"] = tracks.event_parts[i].in;
    graph["events"][i]["parts_out"] = tracks.event_parts[i].out;
  }
  return graph;
}

}  // namespace

bool has_viewer() noexcept { return !kViewerProgram.empty(); }

template <class T>
Json PageNumbers::add_any(const char* type, std::span<const T> values, std::size_t width) {
  const std::size_t rows = width == 0 ? 0 : values.size() / width;
  Json json = {{"type", type}, {"rows", rows}, {"width", width}, {"from", bytes_.size()}};
  const std::size_t from = bytes_.size();
  bytes_.resize(from + rows * width * sizeof(T));
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t k = 0; k < width; ++k) {
      std::array<char, sizeof(T)> raw;
      std::memcpy(raw.data(), &values[i * width + k], sizeof(T));
      for (std::size_t b = 0; b < sizeof(T); ++b) bytes_[from + (k * sizeof(T) + b) * rows + i] = raw[b];
    }
  return json;
}

Json PageNumbers::add_simplices(std::span<const Index> corners, std::size_t width) {
  std::vector<std::uint32_t> differences;
  differences.reserve(corners.size());
  Index before = 0;
  for (std::size_t i = 0; i + width <= corners.size(); i += width) {
    differences.push_back(zigzag(corners[i] - before));
    for (std::size_t k = 1; k < width; ++k) differences.push_back(zigzag(corners[i + k] - corners[i]));
    before = corners[i];
  }
  return add(std::span<const std::uint32_t>(differences), width);
}

std::string PageNumbers::packed(const Progress& progress) const {
  z_stream stream{};
  constexpr int kGzip = 15 + 16;
  constexpr int kMemory = 8;
  if (deflateInit2(&stream, 6, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK) throw std::bad_alloc();
  std::string result;
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::string piece(kPiece, '\0');
  bool is_cancelled = false;
  for (std::size_t at = 0; !is_cancelled && at <= bytes_.size(); at += kPiece) {
    const std::size_t count = std::min(kPiece, bytes_.size() - at);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes_.data() + at));  // zlib does not write there
    stream.avail_in = static_cast<uInt>(count);
    const int flush = at + kPiece > bytes_.size() ? Z_FINISH : Z_NO_FLUSH;
    do {
      stream.next_out = reinterpret_cast<Bytef*>(piece.data());
      stream.avail_out = static_cast<uInt>(kPiece);
      deflate(&stream, flush);
      result.append(piece, 0, kPiece - stream.avail_out);
    } while (stream.avail_out == 0);
    is_cancelled = progress && !progress(static_cast<double>(at) / static_cast<double>(bytes_.size() + 1));
  }
  deflateEnd(&stream);
  if (is_cancelled) throw Error(ErrorCode::Cancelled, "packing the page was cancelled");
  return result;
}

template <int N>
Thinned thin(Contour<N, double>& contour, const ViewLimit& limit, const WorkOptions& options) {
  const ComponentLabels labels = label_components(contour, options);
  Thinned result{labels.count, labels.count, contour.simplices.size(), contour.simplices.size()};
  if (limit.of_all == 0 || result.simplices <= limit.of_all) return result;
  // order components by size
  std::vector<std::uint64_t> sizes(labels.count, 0);
  for (const Index label : labels.simplices) ++sizes[label];
  std::vector<Index> order(labels.count);
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return sizes[a] > sizes[b]; });
  if (sizes[order[0]] > limit.of_largest)
    throw Error(ErrorCode::TooLarge, fmt::format("the largest component has {}; expected at most {}: --limit {} shows "
                                                 "it, 'tegl simplify --count {}' makes it smaller",
                                                 counted_simplices(N - 1, sizes[order[0]]), grouped(limit.of_largest),
                                                 sizes[order[0]], limit.of_all));
  // keep the largest ones within the limit
  std::vector<bool> keep(labels.count, false);
  result.components = result.simplices = 0;
  for (const Index label : order) {
    if (result.components > 0 && result.simplices + sizes[label] > limit.of_all) break;
    keep[label] = true;
    result.simplices += sizes[label];
    ++result.components;
  }
  contour = select_components(contour, labels, keep, options);
  return result;
}

/// The source of a contour, its axes and its size.
template <int N>
Json describe_contour(const Contour<N, double>& contour, const ContourInput& input, const Box<N>& box,
                      const std::vector<double>& center, const Thinned& thinned) {
  Json json;
  json["file"] = input.file.text();
  json["variable"] = input.variable;
  json["isovalue"] = input.isovalue ? Json(*input.isovalue) : Json(nullptr);
  json["dim"] = N;
  json["axes"] = Json::array();
  for (int a = 0; a < N; ++a)
    json["axes"].push_back({{"name", input.axis_name(a)},
                            {"unit", input.axis_unit(a)},
                            {"lowest", box.lower[a]},
                            {"highest", box.upper[a]}});
  json["center"] = center;
  json["vertices"] = contour.vertices.size();
  json["simplices"] = contour.simplices.size();
  json["components"] = thinned.components;
  json["of_components"] = thinned.of_components;
  json["of_simplices"] = thinned.of_simplices;
  return json;
}

/// Adds the numbers of a contour to the page. Returns their places.
template <int N>
Json add_arrays(const Contour<N, double>& contour, const std::vector<double>& center,
                const std::optional<PageTracks>& tracks, PageNumbers& numbers, const WorkOptions& options) {
  Json arrays;
  // vertices
  arrays["places"] = numbers.add(std::span<const float>(places(contour, center)), center.size());
  if constexpr (N == 4) {
    const auto [times, ranks] = ranked_times(contour);
    arrays["times"] = numbers.add(std::span<const double>(times), 1);
    arrays["ranks"] = numbers.add(std::span<const std::uint32_t>(ranks), 1);
  }
  if constexpr (N > 2)
    arrays["normals"] = numbers.add(std::span<const std::int8_t>(normals_in_space(contour, options)), 3);
  // simplices and components
  arrays["simplices"] = numbers.add_simplices(
      {contour.simplices.empty() ? nullptr : contour.simplices.data()->data(), N * contour.simplices.size()}, N);
  arrays["component"] =
      numbers.add(std::span<const std::uint32_t>(components_by_size<N>(label_components(contour, options))), 1);
  if (tracks) {
    arrays["segment"] = numbers.add(std::span<const std::uint32_t>(tracks->simplex_segments), 1);
    arrays["segment_after"] = numbers.add(std::span<const std::uint32_t>(tracks->simplex_after), 1);
    arrays["segment_splits"] = numbers.add(std::span<const std::uint32_t>(tracks->splits), 1);
    arrays["segment_ends"] = numbers.add(std::span<const double>(tracks->ends), 1);
    arrays["segment_next"] = numbers.add(std::span<const std::uint32_t>(tracks->next), 1);
    arrays["segment_tracks"] = numbers.add(std::span<const std::uint32_t>(tracks->tracks), 1);
  }
  return arrays;
}

template <int N>
Json describe_layer(const Contour<N, double>& contour, const ContourInput& input, const Thinned& thinned,
                    const std::optional<PageTracks>& tracks, PageNumbers& numbers, const WorkOptions& options) {
  constexpr std::size_t kSpace = N == 2 ? 2 : 3;
  const Box<N> box = box_of(contour);
  std::vector<double> center;
  for (std::size_t a = 0; a < kSpace; ++a) center.push_back((box.lower[a] + box.upper[a]) / 2);
  Json json = describe_contour(contour, input, box, center, thinned);
  json["arrays"] = add_arrays(contour, center, tracks, numbers, options);
  // attributes and tracks
  json["vertex_attributes"] = describe_attributes(contour.vertex_attributes, numbers);
  json["simplex_attributes"] = describe_attributes(contour.simplex_attributes, numbers);
  json["tracks_found"] = tracks ? tracks->found : 0;
  json["events_found"] = tracks ? tracks->events_found : 0;
  json["graph"] = tracks ? graph_of(*tracks) : Json(nullptr);
  return json;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// A script that reports a truncated page. It is placed before all parts that could be missing, and runs when the
/// browser has reached the end. It also reports a browser that cannot run the program.
constexpr std::string_view kEndCheck = R"(<script>
addEventListener('DOMContentLoaded', function () {
  if (window.teglStarted) return;
  var text = document.getElementById('end')
    ? 'This browser cannot run the program of the page; expected a newer one.'
    : 'The page is cut off: its end is missing. Get the whole file once more.';
  var place = document.getElementById('fatal');
  if (place) {
    place.getElementsByTagName('p')[0].textContent = text;
    place.hidden = false;
  } else document.body.textContent = text;
  window.teglError = text;
});
</script>
)";

std::string make_page(const Json& scene, const std::string& title, std::string_view packed) {
  std::string page;
  page.reserve(kViewerProgram.size() + packed.size() / 3 * 4 + (std::size_t{1} << 20));
  page += "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  // The policy forbids all requests: the page contains everything it needs.
  page +=
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
      "style-src 'unsafe-inline'; img-src data: blob:\">\n";
  page += kEndCheck;
  page += "<link rel=\"icon\" href=\"data:,\">\n";
  page += fmt::format("<title>{}</title>\n<!--\n{}-->\n<style>\n{}</style>\n</head>\n<body>\n{}",
                      escaped(printable(title)), kViewerNotice, kViewerStyle, kViewerMarkup);
  page += fmt::format("<script type=\"application/json\" id=\"scene\">{}</script>\n",
                      script_json(with_printable_strings(scene)));
  page += "<script type=\"text/plain\" id=\"numbers\">";
  page += base64(packed);
  page += "</script>\n<script>\n";
  page += kViewerProgram;
  page += "</script>\n<i id=\"end\" hidden></i>\n</body>\n</html>\n";
  return page;
}

#define TEGL_INSTANTIATE_VIEW(N)                                                               \
  template Thinned thin(Contour<N, double>&, const ViewLimit&, const WorkOptions&);            \
  template Json describe_layer(const Contour<N, double>&, const ContourInput&, const Thinned&, \
                               const std::optional<PageTracks>&, PageNumbers&, const WorkOptions&);
TEGL_INSTANTIATE_VIEW(2)
TEGL_INSTANTIATE_VIEW(3)
TEGL_INSTANTIATE_VIEW(4)
#undef TEGL_INSTANTIATE_VIEW

}  // namespace tegl::cli
