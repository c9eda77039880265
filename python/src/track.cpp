// SPDX-License-Identifier: BSD-3-Clause
//
// The graph of a moving contour's components for Python.
#include "tegl/track.hpp"

#include "binding.hpp"
#include "docs.hpp"
#include "incidence.hpp"
#include "tegl/io/tracks.hpp"

namespace tegl::python {

namespace {

std::unique_ptr<TrackGraph> track_any(const AnyContour& contour, double min_lifetime, const std::vector<double>& times,
                                      std::optional<double> first, std::optional<double> last, bool handles,
                                      bool label_simplices, const AnyIncidence* incidence, unsigned threads,
                                      const py::object& progress) {
  Call call(progress);
  TrackOptions options;
  options.min_lifetime = min_lifetime;
  options.times = times;
  options.first = first;
  options.last = last;
  options.handles = handles;
  options.label_simplices = label_simplices;
  options.work = {threads, call.progress()};
  return call.run([&] {
    return visit_with(contour, incidence, [&](const auto& c, const auto&... shared) {
      return std::make_unique<TrackGraph>(track(c, shared..., options));
    });
  });
}

/// All coordinates except the last, which is time.
std::vector<double> place_of(const TrackGraph& graph, const std::array<double, 4>& place) {
  return to_list(place, static_cast<std::size_t>(std::max(graph.space_dim - 1, 0)));
}

py::list events_of(const TrackGraph& graph) {
  py::list result;
  for (const TrackEvent& event : graph.events) {
    py::dict one;
    put(one, "kind", std::string(name_of(event.kind)));
    put(one, "time", event.time);
    put(one, "place", place_of(graph, event.place));
    put(one, "vertex", event.vertex);
    put(one, "at_border", event.at_border);
    put(one, "segments_in", event.in);
    put(one, "segments_out", event.out);
    put(one, "euler_change", event.euler_change);
    result.append(one);
  }
  return result;
}

py::list handles_of(const TrackGraph& graph) {
  py::list result;
  for (const TrackHandle& handle : graph.handles) {
    py::dict one;
    put(one, "time", handle.time);
    put(one, "place", place_of(graph, handle.place));
    put(one, "vertex", handle.vertex);
    put(one, "at_border", handle.at_border);
    put(one, "segment", handle.segment);
    put(one, "euler_change", handle.euler_change);
    result.append(one);
  }
  return result;
}

py::list samples_of(const TrackGraph& graph, const TrackSegment& segment) {
  py::list result;
  for (const TrackSample& sample : segment.samples) {
    py::dict one;
    put(one, "time", sample.time);
    put(one, "measure", sample.measure);
    put(one, "content", sample.content);
    put(one, "centroid", place_of(graph, sample.centroid));
    put(one, "lower", place_of(graph, sample.lower));
    put(one, "upper", place_of(graph, sample.upper));
    result.append(one);
  }
  return result;
}

py::list segments_of(const TrackGraph& graph) {
  py::list result;
  for (const TrackSegment& segment : graph.segments) {
    py::dict one;
    put(one, "event_from", segment.from);
    put(one, "event_to", segment.to);
    put(one, "start", segment.start);
    put(one, "end", segment.end);
    put(one, "track", segment.track);
    put(one, "size_at_start", segment.size_at_start);
    put(one, "size_at_end", segment.size_at_end);
    put(one, "euler_at_start", segment.euler_at_start);
    put(one, "euler_at_end", segment.euler_at_end);
    one["samples"] = samples_of(graph, segment);
    result.append(one);
  }
  return result;
}

py::list tracks_of(const TrackGraph& graph) {
  py::list result;
  for (const Track& track : graph.tracks) {
    py::dict one;
    put(one, "number", track.number);
    put(one, "segments", track.segments);
    put(one, "start", track.start);
    put(one, "end", track.end);
    result.append(one);
  }
  return result;
}

py::object simplex_segments_of(const py::object& self) {
  const auto& graph = py::cast<const TrackGraph&>(self);
  return read_only(graph.simplex_segments.data(), {static_cast<py::ssize_t>(graph.simplex_segments.size())}, self);
}

void write_any_track(const TrackGraph& graph, const std::string& path, const std::string& title) {
  const py::gil_scoped_release release;
  const FileLock lock;
  TrackPicture picture;
  picture.title = title;
  write_track(graph, path, picture);
}

}  // namespace

void bind_track(py::module_& m) {
  py::class_<TrackGraph>(m, "TrackGraph", doc::TrackGraph)
      .def_readonly("first", &TrackGraph::first)
      .def_readonly("last", &TrackGraph::last)
      .def("events", &events_of)
      .def("segments", &segments_of)
      .def("tracks", &tracks_of)
      .def("handles", &handles_of)
      .def_property_readonly("simplex_segments", &simplex_segments_of);
  m.def("track", &track_any, py::arg("contour"), py::arg("min_lifetime"), py::arg("times"), py::arg("first"),
        py::arg("last"), py::arg("handles"), py::arg("label_simplices"), py::arg("incidence"), py::arg("threads"),
        py::arg("progress"), doc::track);
  m.def("even_times", &even_times, py::arg("first"), py::arg("last"), py::arg("count"), doc::even_times);
  m.def("write_track", &write_any_track, py::arg("graph"), py::arg("path"), py::arg("title"), doc::write_track);
}

}  // namespace tegl::python
