// SPDX-License-Identifier: BSD-3-Clause
//
// The page of `tegl view`: contours as numbers that a browser unpacks, and the one file that holds them with the
// program that draws them.
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

/// Whether this build has the viewer: it was configured where esbuild and three.js were at hand.
bool has_viewer() noexcept;

/// The numbers of a page, one array after the other. Each is stored so that it packs well: component by component, and
/// of each component first all lowest bytes, then all second ones …
class PageNumbers {
 public:
  /// Adds #rows x width numbers, row = item, and gives what the page has to know to find them again.
  Json add(std::span<const float> values, std::size_t width) { return add_any("f4", values, width); }
  Json add(std::span<const double> values, std::size_t width) { return add_any("f8", values, width); }
  Json add(std::span<const std::uint32_t> values, std::size_t width) { return add_any("u4", values, width); }
  Json add(std::span<const std::int8_t> values, std::size_t width) { return add_any("i1", values, width); }
  /// Adds vertex numbers of simplices: the first as its difference from the one before, the others as theirs from it.
  Json add_simplices(std::span<const Index> corners, std::size_t width);

  /// All of them, packed by gzip: the same bytes for the same numbers. Throws Cancelled.
  [[nodiscard]] std::string packed(const Progress& progress) const;
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_.size(); }

 private:
  template <class T>
  Json add_any(const char* type, std::span<const T> values, std::size_t width);

  std::string bytes_;
};

/// What of a contour a page shows.
struct Thinned {
  std::uint64_t components = 0;  ///< kept
  std::uint64_t of_components = 0;
  std::uint64_t simplices = 0;  ///< kept
  std::uint64_t of_simplices = 0;
  [[nodiscard]] bool left_out() const noexcept { return components < of_components; }
};

/// How many simplices of a contour a page shows.
struct ViewLimit {
  std::uint64_t of_all = 0;      ///< of several components together; 0: no limit
  std::uint64_t of_largest = 0;  ///< of the largest component, which is shown even if it has more than `of_all`
};

/// Leaves out all but the largest components, by simplices, as many as the limit lets in. Throws TooLarge if the
/// largest component is beyond it.
template <int N>
Thinned thin(Contour<N, double>& contour, const ViewLimit& limit, const WorkOptions& options);

/// A contour's graph of tracks as a page shows it.
struct PageTracks {
  /// Parts that end and start at an event, in the graph of all tracks.
  struct EventParts {
    std::size_t in = 0;
    std::size_t out = 0;
  };
  TrackGraph graph;                     ///< of the tracks that are shown
  std::vector<EventParts> event_parts;  ///< by event of `graph`
  std::size_t found = 0;                ///< number of all tracks
  std::size_t events_found = 0;         ///< number of all events
  // Of all of them, to colour each simplex by the part that it is in at any time. #S: the segment that it first appears
  // in, and the one after the first split that it passes. And of each segment its end, whether it splits there (1; else
  // 0), the segment that goes on after it, and the place of its track when ordered by how long they live, the longest
  // first. kNoSegment for none.
  std::vector<std::uint32_t> simplex_segments;
  std::vector<std::uint32_t> simplex_after;
  std::vector<double> ends;
  std::vector<std::uint32_t> splits;
  std::vector<std::uint32_t> next;
  std::vector<std::uint32_t> tracks;
};

/// Follows the parts of a contour. `first`, `last`: when the data begin and end, if it is known; `most`: how many
/// tracks are shown, those that live longest.
PageTracks page_tracks(const Contour<4, double>& contour, std::optional<double> first, std::optional<double> last,
                       std::size_t most, const WorkOptions& options);

/// Describes a contour, with its numbers added to `numbers`. `input` is what it was read from.
template <int N>
Json describe_layer(const Contour<N, double>& contour, const ContourInput& input, const Thinned& thinned,
                    const std::optional<PageTracks>& tracks, PageNumbers& numbers, const WorkOptions& options);

/// The whole page. `scene` has the descriptions under "layers"; `packed` are their numbers.
std::string make_page(const Json& scene, const std::string& title, std::string_view packed);

/// In the alphabet of RFC 4648.
std::string base64(std::string_view bytes);

}  // namespace tegl::cli
