// SPDX-License-Identifier: BSD-3-Clause
//
// The options of commands that contour an image, and what they do before and after the extraction.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/progress.hpp"
#include "base/statistics.hpp"
#include "input/cuts.hpp"
#include "output/output.hpp"
#include "output/result.hpp"
#include "tegl/extract.hpp"
#include "tegl/io.hpp"
#include "tegl/polygons.hpp"

namespace tegl::cli {

/// --iso, --triangulation, --ambiguity, --close, --normals, --gradient-direction, --epsilon, --threads, --precision,
/// and
/// --allow-empty, which saved contours take, too.
class ExtractionOptions {
 public:
  /// Adds the options to a command: one that contours images and nothing else needs --iso, and may triangulate
  /// polygons. This must outlive the parse.
  void add_to(CLI::App& app, bool of_images_alone);

  /// The names of those that were given.
  [[nodiscard]] std::vector<std::string> given() const;

  /// --iso as a number. Throws InvalidArgument if it is missing, not a finite number, or several.
  [[nodiscard]] double isovalue() const;
  /// The numbers of --iso, which may be several, and may be given several times. Throws InvalidArgument if there is
  /// none, or one twice.
  [[nodiscard]] std::vector<SpelledNumber> isovalues() const;
  /// Whether a value outside of the data gives an empty result (--allow-empty).
  [[nodiscard]] bool allows_empty() const { return allow_empty_; }
  /// --threads: 0 for all that the machine has.
  [[nodiscard]] unsigned threads() const { return threads_; }
  /// True for --precision float.
  [[nodiscard]] bool single_precision() const { return precision_ == "float"; }
  /// The triangulation of polygons that --triangulation names; none for those of `extract`.
  [[nodiscard]] std::optional<PolygonTriangulation> polygon_triangulation() const;
  /// The library's options, without progress. Throws InvalidArgument for an epsilon outside of [0, 0.5), and for a
  /// triangulation of polygons unless the caller sees to those itself.
  [[nodiscard]] ExtractOptions library_options(bool knows_polygons = false) const;
  /// The kind that --normals asks for; empty: none.
  [[nodiscard]] const std::string& normals() const { return normals_; }
  /// Whether --normals asks for some that follow the contour's own shape.
  [[nodiscard]] bool wants_shape_normals() const { return normals_ == "geometric" || normals_ == "flat"; }
  /// Gives them to the contour: `geometric` as its normals, `flat` as the attribute "normal" of its simplices.
  template <int N, class Real>
  void add_shape_normals(Contour<N, Real>& contour) const;

 private:
  std::vector<CLI::Option*> options_;
  std::vector<std::string> isos_;
  std::string triangulation_ = "compact";
  std::string ambiguity_ = "low";
  std::string direction_ = "descent";
  std::string epsilon_ = "0";
  std::string precision_ = "double";
  bool close_ = false;
  bool allow_empty_ = false;
  std::string normals_;
  unsigned threads_ = 0;
};

/// The dimension of the image.
int image_dim(const AnyImage& image);

/// Whether an isovalue lies outside of values in this range (of NaN if there are none): no sample is at or above it, or
/// every one is.
bool is_outside(double isovalue, const ValueRange& range);

/// The error of an isovalue that does, EmptyResult. `unit`: of the values; may be empty.
Error outside_error(double isovalue, const ValueRange& range, const std::string& unit);

/// Throws EmptyResult, saying why, unless a contour of the isovalue can exist: two samples along every axis, and
/// samples on both sides of the isovalue. Without the latter there is none, which is no error if `allow_empty`.
void require_contour(const ReadImageResult& input, double isovalue, bool allow_empty);

/// What to say of an extraction that gave nothing: empty if the isovalue is outside of the values, which was allowed
/// then; else that missing samples are in the way.
std::string remark_without_contour(const AnyImage& image, double isovalue);
/// The latter.
std::string remark_on_missing(double isovalue);

/// What `use` makes of the contour, a Contour<N, float> or Contour<N, double>, of an image of any type.
template <class Result, class Use>
Result extract_any(const AnyImage& image, double isovalue, const ExtractOptions& options, bool single_precision,
                   ExtractStats& stats, const Use& use) {
  const auto of_owned = [&](const auto& owned) -> Result {
    if (single_precision) return use(extract<float>(owned.view(), isovalue, options, &stats));
    return use(extract<double>(owned.view(), isovalue, options, &stats));
  };
  return std::visit([&](const auto& typed) { return std::visit(of_owned, typed); }, image);
}

/// Fills the report and the seconds of the check.
void check_result(ContourResult& result, ProgressBar& bar);

/// Writes the mesh to its output, and fills the size of the file and the seconds.
void write_result(ContourResult& result, ProgressBar& bar);
/// The same for one of several files.
void write_result(ContourResult& result, ProgressBar& bar, WrittenFiles& written);

}  // namespace tegl::cli
