// SPDX-License-Identifier: BSD-3-Clause
//
// The page of `tegl view`: packs contours as numbers for the browser, and assembles one file with them and the program
// that draws them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "input/contour_input.hpp"
#include "output/result.hpp"
#include "tegl/components.hpp"
#include "tegl/track.hpp"

namespace tegl::cli {

/// Whether this build has the viewer: esbuild and three.js were available at configuration.
bool has_viewer() noexcept;

/// The numbers of a page, array after array, in a form that compresses well: component by component, and in each
/// component first all lowest bytes, then all second bytes …
class PageNumbers {
 public:
  /// Adds #rows x width numbers, row = item. Returns the description that the page needs to find them.
  Json add(std::span<const float> values, std::size_t width) { return add_any("f4", values, width); }
  Json add(std::span<const double> values, std::size_t width) { return add_any("f8", values, width); }
  Json add(std::span<const std::uint32_t> values, std::size_t width) { return add_any("u4", values, width); }
  Json add(std::span<const std::int8_t> values, std::size_t width) { return add_any("i1", values, width); }
  /// Adds vertex numbers of simplices: the first as difference from the previous simplex's first, the others as
  /// differences from the first.
  Json add_simplices(std::span<const Index> corners, std::size_t width);

  /// All numbers, compressed by gzip; deterministic. Throws Cancelled.
  [[nodiscard]] std::string packed(const Progress& progress) const;
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_.size(); }

 private:
  template <class T>
  Json add_any(const char* type, std::span<const T> values, std::size_t width);

  std::string bytes_;
};

/// Size of the part of a contour that a page shows.
struct Thinned {
  std::uint64_t components = 0;  ///< kept
  std::uint64_t of_components = 0;
  std::uint64_t simplices = 0;  ///< kept
  std::uint64_t of_simplices = 0;
  [[nodiscard]] bool left_out() const noexcept { return components < of_components; }
};

/// Limits of the number of simplices that a page shows.
struct ViewLimit {
  std::uint64_t of_all = 0;      ///< of all shown components; 0: no limit
  std::uint64_t of_largest = 0;  ///< of the largest component, which is shown even beyond `of_all`
};

/// Keeps the largest components, by simplices, within the limit. Throws TooLarge if the largest component exceeds its
/// limit.
template <int N>
Thinned thin(Contour<N, double>& contour, const ViewLimit& limit, const WorkOptions& options);

/// The track graph of a contour for a page.
struct PageTracks {
  /// Numbers of parts that end and start at an event, in the graph of all tracks.
  struct EventParts {
    std::size_t in = 0;
    std::size_t out = 0;
  };
  TrackGraph graph;                     ///< the shown tracks
  std::vector<EventParts> event_parts;  ///< by event of `graph`
  std::size_t found = 0;                ///< number of all tracks
  std::size_t events_found = 0;         ///< number of all events
  // Data about all tracks, to colour each simplex by the part that contains it at any time. Per simplex (#S): the
  // segment in which it first appears, and the segment after the first split that it passes. Per segment: its end,
  // whether it splits there (1, else 0), its next segment, and the rank of its track by lifetime, the longest first.
  // kNoSegment for none.
  std::vector<std::uint32_t> simplex_segments;
  std::vector<std::uint32_t> simplex_after;
  std::vector<double> ends;
  std::vector<std::uint32_t> splits;
  std::vector<std::uint32_t> next;
  std::vector<std::uint32_t> tracks;
};

/// Tracks the parts of a contour. `first`, `last`: begin and end of the data, if known; `most`: number of tracks to
/// show, the longest-lived.
PageTracks page_tracks(const Contour<4, double>& contour, std::optional<double> first, std::optional<double> last,
                       std::size_t most, const WorkOptions& options);

/// Describes a contour in JSON, and adds its numbers to `numbers`. `input`: its origin.
template <int N>
Json describe_layer(const Contour<N, double>& contour, const ContourInput& input, const Thinned& thinned,
                    const std::optional<PageTracks>& tracks, PageNumbers& numbers, const WorkOptions& options);

/// Assembles the page. `scene`: the descriptions, under "layers"; `packed`: their numbers.
std::string make_page(const Json& scene, const std::string& title, std::string_view packed);

/// Encodes in base64 with the alphabet of RFC 4648.
std::string base64(std::string_view bytes);

}  // namespace tegl::cli
