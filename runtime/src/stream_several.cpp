// SPDX-License-Identifier: BSD-3-Clause
//
// Several streamed extractions that go through the same layers side by side: the caller's thread reads, and waits with
// each layer until all others have their copy of the one before.
#include "tegl/stream_several.hpp"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "workers.hpp"

namespace tegl {

namespace {

/// One layer at a time, from the extraction that reads to all others.
template <Value T, int N>
class SharedLayers {
 public:
  SharedLayers(LayerReader<T, N>& source, std::size_t takers) : source_(source), takers_(takers) {
    std::size_t size = 1;
    for (int a = 0; a < N - 1; ++a) size *= source.grid().axes[a].size();
    layer_.resize(size);
  }

  [[nodiscard]] const Grid<N>& grid() const noexcept { return source_.grid(); }
  /// Held by whoever calls the reader or a sink.
  [[nodiscard]] std::mutex& calls() noexcept { return calls_; }

  /// Reads layer k, once all have taken the one before. By the caller's thread.
  void read(std::size_t k, T* to) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return taken_ == takers_ || k == 0 || failed_; });
    require_no_failure();
    lock.unlock();
    {
      const std::scoped_lock calling(calls_);
      source_.read(k, to);
    }
    lock.lock();
    std::copy_n(to, layer_.size(), layer_.begin());
    there_ = k + 1;
    taken_ = 0;
    changed_.notify_all();
  }

  /// Copies layer k as soon as it is there.
  void take(std::size_t k, T* to) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return there_ == k + 1 || failed_; });
    require_no_failure();
    std::copy(layer_.begin(), layer_.end(), to);
    ++taken_;
    if (taken_ == takers_) changed_.notify_all();
  }

  /// Ends all: none waits for another that will not come.
  void fail() {
    const std::scoped_lock lock(mutex_);
    failed_ = true;
    changed_.notify_all();
  }

 private:
  void require_no_failure() const {
    if (failed_) throw Error(ErrorCode::Cancelled, "cancelled, as another contour failed");
  }

  LayerReader<T, N>& source_;
  std::size_t takers_;
  std::vector<T> layer_;
  std::size_t there_ = 0;  ///< layers that were read
  std::size_t taken_ = 0;  ///< how many have the last one
  bool failed_ = false;
  std::mutex mutex_;
  std::mutex calls_;
  std::condition_variable changed_;
};

/// The layers as one of the extractions sees them.
template <Value T, int N>
class LayersOfOne final : public LayerReader<T, N> {
 public:
  LayersOfOne(SharedLayers<T, N>& shared, bool reads) : shared_(shared), reads_(reads) {}
  [[nodiscard]] const Grid<N>& grid() const noexcept override { return shared_.grid(); }
  void read(std::size_t k, T* to) override { reads_ ? shared_.read(k, to) : shared_.take(k, to); }

 private:
  SharedLayers<T, N>& shared_;
  bool reads_;
};

/// A sink that is called while nothing else is.
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

/// The error of the first contour that failed by itself, if any did.
void throw_first(const std::vector<std::exception_ptr>& errors) {
  std::exception_ptr cancelled;
  for (const std::exception_ptr& error : errors) {
    if (!error) continue;
    try {
      std::rethrow_exception(error);
    } catch (const Error& one) {
      if (one.code() != ErrorCode::Cancelled) throw;
      if (!cancelled) cancelled = error;
    }
  }
  if (cancelled) std::rethrow_exception(cancelled);
}

}  // namespace

template <class Real, Value T, int N>
void extract_streamed_several(LayerReader<T, N>& layers, std::span<StreamedContour<N, Real>> contours,
                              const ExtractOptions& options) {
  for (const auto& contour : contours)
    if (contour.sink == nullptr) throw Error(ErrorCode::InvalidArgument, "a contour without a sink; expected one each");
  if (contours.empty()) return;
  SharedLayers<T, N> shared(layers, contours.size() - 1);
  std::vector<std::exception_ptr> errors(contours.size());
  const unsigned all = options.threads == 0 ? std::max(1U, std::thread::hardware_concurrency()) : options.threads;
  const auto run = [&](std::size_t i) {
    ExtractOptions own = options;
    own.threads = std::max(1U, all / static_cast<unsigned>(contours.size()));
    if (i > 0) own.progress = nullptr;  // all are at the same layer
    LayersOfOne<T, N> reader(shared, i == 0);
    try {
      SinkInTurn<N, Real> sink(*contours[i].sink, shared.calls());
      contours[i].size = extract_streamed<Real>(reader, contours[i].isovalue, own, sink, &contours[i].stats);
    } catch (...) {
      errors[i] = std::current_exception();
      shared.fail();
    }
  };
  {
    std::vector<std::jthread> threads;
    try {
      for (std::size_t i = 1; i < contours.size(); ++i) threads.emplace_back(run, i);
    } catch (...) {
      shared.fail();
      throw;
    }
    run(0);
  }
  throw_first(errors);
}

#define TEGL_INSTANTIATE_ONE(T, N, Real)                                                                      \
  template void extract_streamed_several<Real, T, N>(LayerReader<T, N>&, std::span<StreamedContour<N, Real>>, \
                                                     const ExtractOptions&);
#define TEGL_INSTANTIATE(T)          \
  TEGL_INSTANTIATE_ONE(T, 2, float)  \
  TEGL_INSTANTIATE_ONE(T, 2, double) \
  TEGL_INSTANTIATE_ONE(T, 3, float)  \
  TEGL_INSTANTIATE_ONE(T, 3, double) \
  TEGL_INSTANTIATE_ONE(T, 4, float)  \
  TEGL_INSTANTIATE_ONE(T, 4, double)
TEGL_INSTANTIATE(std::uint8_t)
TEGL_INSTANTIATE(std::int8_t)
TEGL_INSTANTIATE(std::uint16_t)
TEGL_INSTANTIATE(std::int16_t)
TEGL_INSTANTIATE(std::int32_t)
TEGL_INSTANTIATE(float)
TEGL_INSTANTIATE(double)
#undef TEGL_INSTANTIATE
#undef TEGL_INSTANTIATE_ONE

}  // namespace tegl
