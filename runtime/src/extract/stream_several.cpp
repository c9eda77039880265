// SPDX-License-Identifier: BSD-3-Clause
//
// Several streamed extractions from one pass over the layers, a batch of slabs at a time. The caller's thread reads the
// layers of the next batch once; then each contour's part of the batch is a separate task.
#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "base/workers.hpp"
#include "extract/streamed_image.hpp"

namespace tegl {

namespace {

/// A sink whose calls are serialized by a shared mutex.
template <int N, class Real>
class SinkInTurn final : public ContourSink<N, Real> {
 public:
  using typename ContourSink<N, Real>::Vertex;
  using typename ContourSink<N, Real>::Simplex;
  SinkInTurn(ContourSink<N, Real>& sink, std::mutex& calls) : sink_(sink), calls_(calls) {}
  void add_vertices(std::span<const Vertex> vertices) override {
    const std::scoped_lock lock(calls_);
    sink_.add_vertices(vertices);
  }
  void add_normals(std::span<const Vertex> normals) override {
    const std::scoped_lock lock(calls_);
    sink_.add_normals(normals);
  }
  void add_simplices(std::span<const Simplex> simplices) override {
    const std::scoped_lock lock(calls_);
    sink_.add_simplices(simplices);
  }
  void replace_corner(std::uint64_t simplex, int corner, std::uint64_t vertex) override {
    const std::scoped_lock lock(calls_);
    sink_.replace_corner(simplex, corner, vertex);
  }

 private:
  ContourSink<N, Real>& sink_;
  std::mutex& calls_;
};

/// One of the extractions, with the objects that it refers to.
template <int N, class Real>
struct OneOfSeveral {
  OneOfSeveral(detail::StreamedImage<N, Real>& image, const StreamedContour<N, Real>& contour,
               ExtractOptions its_options, std::mutex& calls)
      : options(std::move(its_options)),
        source(image.samples(contour.isovalue)),
        sink(*contour.sink, calls),
        output(image.output(sink)),
        extraction(detail::make_extraction<N, Real>(*source, image.grid(), detail::generated_tables<N>(options),
                                                    options, image.plan(), *output)) {}

  ExtractOptions options;
  std::unique_ptr<detail::SampleSource<N>> source;
  SinkInTurn<N, Real> sink;
  std::unique_ptr<detail::StreamOutput<N, Real>> output;
  std::unique_ptr<detail::SteppedExtraction<N, Real>> extraction;  ///< null if the image has no tiles
  std::exception_ptr error;
};

/// All extractions, processing the same batch in parallel. Compiled once for all value types.
template <int N, class Real>
class SideBySide {
 public:
  SideBySide(detail::StreamedImage<N, Real>& image, std::span<const StreamedContour<N, Real>> contours,
             const ExtractOptions& options)
      : progress_(options.work.progress),
        threads_(options.work.threads == 0 ? std::max(1U, std::thread::hardware_concurrency()) : options.work.threads),
        at_once_(std::min(threads_, static_cast<unsigned>(std::min<std::size_t>(contours.size(), ~0U)))),
        workers_(at_once_, [] { return Nothing{}; }) {
    for (const auto& contour : contours) {
      ExtractOptions own = options;
      own.work.threads = threads_ / at_once_;
      if (progress_) own.work.progress = [this](double share) { return tell(share); };
      all_.push_back(std::make_unique<One>(image, contour, std::move(own), calls_));
    }
  }

  void run() {
    while (prepare()) {
      workers_.for_range(all_.size(), 1, [&](std::size_t from, std::size_t to, Nothing&) {
        for (std::size_t i = from; i < to && !cancelled_; ++i) extract_batch(*all_[i]);
      });
      for (const auto& one : all_)
        if (one->error) std::rethrow_exception(one->error);
    }
  }

  /// In the order of the contours.
  [[nodiscard]] std::vector<ExtractedSize> results() const {
    std::vector<ExtractedSize> results;
    for (const auto& one : all_)
      results.push_back({one->output->size(), one->extraction ? one->extraction->stats() : ExtractStats{}});
    return results;
  }

 private:
  using One = OneOfSeveral<N, Real>;
  struct Nothing {};  ///< per-thread state: none

  /// Reads the layers of the next batch. Returns false after the last one.
  bool prepare() {
    bool any = false;
    for (const auto& one : all_) any = (one->extraction && one->extraction->prepare_batch()) || any;
    return any;
  }

  void extract_batch(One& one) noexcept {
    try {
      one.extraction->extract_batch();
    } catch (...) {
      one.error = std::current_exception();
    }
  }

  /// Reports the maximum progress of all extractions. Called in the caller's thread.
  bool tell(double share) {
    told_ = std::max(told_, share);
    const bool goes_on = progress_(told_);
    if (!goes_on) cancelled_ = true;
    return goes_on;
  }

  const Progress& progress_;
  std::mutex calls_;
  unsigned threads_;
  unsigned at_once_;
  detail::Workers<Nothing> workers_;
  std::vector<std::unique_ptr<One>> all_;
  double told_ = 0;
  std::atomic<bool> cancelled_ = false;  ///< tasks that have not begun are skipped
};

}  // namespace

template <Coordinate Real, Value T, int N>
requires DimensionBetween<N, 2, 4> std::vector<ExtractedSize> extract_streamed_several(
    LayerReader<T, N>& layers, std::type_identity_t<std::span<const StreamedContour<N, Real>>> contours,
    const ExtractOptions& options, const AxisPeriods<N>& periods) {
  for (const auto& contour : contours) {
    if (contour.sink == nullptr) throw Error(ErrorCode::InvalidArgument, "a contour without a sink; expected one each");
    detail::check_arguments(contour.isovalue, options);
  }
  if (contours.empty()) return {};
  detail::StreamedLayers<T, N, Real> image(layers, periods, options);
  SideBySide<N, Real> all(image, contours, options);
  all.run();
  return all.results();
}

#define TEGL_INSTANTIATE_REALS(T, N, Real)                                  \
  template std::vector<ExtractedSize> extract_streamed_several<Real, T, N>( \
      LayerReader<T, N>&, std::span<const StreamedContour<N, Real>>, const ExtractOptions&, const AxisPeriods<N>&);
#include "base/instantiate.hpp"

}  // namespace tegl
