// SPDX-License-Identifier: BSD-3-Clause
//
// Constraints of the public headers: dimensions and types within their limits, no view of a temporary, and designated
// initialisers of any subset of an options struct. The checks are static; headers_test compiles this file again with
// the warnings and compilers of users.
#include <concepts>
#include <type_traits>
#include <utility>

#include "tegl/check.hpp"
#include "tegl/components.hpp"
#include "tegl/deviation.hpp"
#include "tegl/eigen.hpp"
#include "tegl/extract.hpp"
#include "tegl/facet_hierarchy.hpp"
#include "tegl/io.hpp"
#include "tegl/io/active_tiles.hpp"
#include "tegl/io/elements.hpp"
#include "tegl/io/series.hpp"
#include "tegl/io/tracks.hpp"
#include "tegl/measure.hpp"
#include "tegl/normals.hpp"
#include "tegl/pick.hpp"
#include "tegl/polygons.hpp"
#include "tegl/project.hpp"
#include "tegl/sample.hpp"
#include "tegl/scrubber.hpp"
#include "tegl/seed_set.hpp"
#include "tegl/simplify.hpp"
#include "tegl/slice.hpp"
#include "tegl/stream.hpp"
#include "tegl/tile/tile_certifier.hpp"
#include "tegl/tile_facets.hpp"
#include "tegl/track.hpp"

namespace {

using namespace tegl;

// --- Dimensions and types. `only_in<kLeast, kMost>(test)`: true if test.operator()<N>() holds exactly for N = kLeast
// to kMost, out of the dimensions 1 to 7.
template <int kLeast, int kMost, class Test>
consteval bool only_in(Test test) {
  return []<int... I>(std::integer_sequence<int, I...>, Test has) {
    return ((has.template operator()<I + 1>() == (I + 1 >= kLeast && I + 1 <= kMost)) && ...);
  }
  (std::make_integer_sequence<int, 7>(), test);
}

// `using` in requires-expressions: a violated constraint makes the expression false.
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename Grid<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename Image<float, N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename OwnedImage<float, N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename Contour<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename TileGrid<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename ActiveTiles<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename LayerReader<float, N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename FunctionLayers<float, N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename Component<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename Measures<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename Elements<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename ElementSum<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename PickReport<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename PickedComponent<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename Extraction<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename Hyperplane<N>; };
}));
static_assert(only_in<2, 5>([]<int N>() {
  return requires { typename HyperplaneFrame<N>; };
}));
static_assert(only_in<2, 4>([]<int N>() {
  return requires { typename SimplifyOptions<N>; };
}));
static_assert(only_in<2, 4>([]<int N>() {
  return requires { typename DeviationOptions<N>; };
}));
static_assert(only_in<2, 4>([]<int N>() {
  return requires { typename FacetHierarchy<N>; };
}));
static_assert(only_in<2, 4>([]<int N>() {
  return requires { typename ContourRoom<N, float>; };
}));
static_assert(only_in<2, 4>([]<int N>() {
  return requires { typename ContourSink<N, float>; };
}));
static_assert(only_in<2, 4>([]<int N>() {
  return requires { typename StreamedContour<N, float>; };
}));
static_assert(only_in<2, 4>([]<int N>() {
  return requires { typename ContourFile<N, float>; };
}));
static_assert(only_in<3, 5>([]<int N>() {
  return requires { typename Scrubber<N, float>; };
}));

// Functions that do not exist in all dimensions, by the dimension of a contour C or an image I.
template <class C>
concept Sliced = requires(const C& c) {
  slice(c, {});
};
template <class C>
concept SlicedOften = requires(const C& c) {
  slice_stack(c, {});
};
template <class I>
concept ImageSliced = requires(const I& image) {
  slice_image(image, 0.0, {});
  slice_image_with_stats(image, 0.0, {});
};
template <class C>
concept CutsMeasured = requires(const C& c, std::span<const double> at) {
  measure_cuts(c, at);
};
template <class C>
concept Tracked = requires(const C& c) {
  track(c);
};
template <class C, int N>
concept Simplified = requires(const C& c, const SimplifyOptions<N>& options) {
  simplify(c, options);
};
template <class C>
concept Scaled = requires(const C& c) {
  automatic_scale(c);
};
template <class C>
concept AxesScaled = requires(const C& c) {
  scale_axes(c, {});
};
template <class C>
concept Compared = requires(const C& c) {
  deviation(c, c);
};
template <class C>
concept FlatNormals = requires(const C& c) {
  flat_normals(c);
};
template <class C>
concept GeometricNormals = requires(const C& c) {
  geometric_normals(c);
};
template <class C, class I>
concept GradientNormals = requires(const C& c, const I& image) {
  gradient_normals(image, c);
};
template <class I>
concept FacetsExtracted = requires(const I& image) {
  extract_facets(image, 0.0);
};
template <class I, int N>
concept ExtractedByIndex = requires(const I& image, const ActiveTiles<N>& active) {
  extract(image, 0.0, active);
};
template <class I, int N>
concept ExtractedInto = requires(const I& image, const ContourRoom<N, float>& room) {
  extract_into(image, 0.0, room);
};
template <class L, int N>
concept Streamed = requires(L& layers, ContourSink<N, float>& sink) {
  extract_streamed(layers, 0.0, sink);
};
template <class L, int N>
concept SeveralStreamed = requires(L& layers, std::span<const StreamedContour<N, float>> contours) {
  extract_streamed_several(layers, contours);
};
template <class C>
concept BecomesMesh = requires(const C& c) {
  to_mesh(c);
};
template <int N>
concept FromMesh = requires(const Mesh& mesh) {
  to_contour<N>(mesh);
  to_contour<N>(Mesh(mesh));
};
template <int N>
concept HasTileFacets = requires {
  tile_facets<N>(1);
}
&&requires { face_number<N>(0, 1); };
template <int N>
concept PolygonsTriangulated = requires(std::span<const std::array<double, N>> points) {
  triangulate_polygon<N>(points, PolygonTriangulation::fan);
  triangulate_polygon(points, PolygonTriangulation::fan);
  polygon_barycentre<N>(points);
  polygon_barycentre(points);
};
template <int N>
concept HasBorderPlanes = requires(const Grid<N>& grid) {
  border_planes(grid);
};

// Tests dimensions 2 to 5, in which contours and images exist; the function is expected in `kLeast` to `kMost`.
template <int kLeast, int kMost, class Test>
consteval bool of_2_to_5_only(Test test) {
  return []<int... I>(std::integer_sequence<int, I...>, Test has) {
    return ((has.template operator()<I + 2>() == (I + 2 >= kLeast && I + 2 <= kMost)) && ...);
  }
  (std::make_integer_sequence<int, 4>(), test);
}
static_assert(of_2_to_5_only<3, 5>([]<int N>() { return Sliced<Contour<N>>; }));
static_assert(of_2_to_5_only<3, 5>([]<int N>() { return SlicedOften<Contour<N>>; }));
static_assert(of_2_to_5_only<3, 5>([]<int N>() { return ImageSliced<Image<float, N>>; }));
static_assert(of_2_to_5_only<3, 5>([]<int N>() { return CutsMeasured<Contour<N>>; }));
static_assert(of_2_to_5_only<2, 5>([]<int N>() { return Tracked<Contour<N>>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return Simplified<Contour<N>, N>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return Scaled<Contour<N>>; }));
static_assert(of_2_to_5_only<2, 5>([]<int N>() { return AxesScaled<Contour<N>>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return Compared<Contour<N>>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return FlatNormals<Contour<N>>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return GeometricNormals<Contour<N>>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return GradientNormals<Contour<N>, Image<float, N>>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return FacetsExtracted<Image<float, N>>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return ExtractedByIndex<Image<float, N>, N>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return ExtractedInto<Image<float, N>, N>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return Streamed<LayerReader<float, N>, N>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return SeveralStreamed<LayerReader<float, N>, N>; }));
static_assert(of_2_to_5_only<2, 5>([]<int N>() { return BecomesMesh<Contour<N>>; }));
static_assert(of_2_to_5_only<2, 4>([]<int N>() { return HasBorderPlanes<N>; }));
static_assert(only_in<2, 5>([]<int N>() { return FromMesh<N>; }));
static_assert(only_in<2, 4>([]<int N>() { return PolygonsTriangulated<N>; }));
static_assert(only_in<2, 6>([]<int N>() { return HasTileFacets<N>; }));

// Types of values and of coordinates.
template <class T>
concept ImageValue = requires {
  typename Image<T, 3>;
};
static_assert(ImageValue<std::uint8_t> && ImageValue<std::int8_t> && ImageValue<std::uint16_t> &&
              ImageValue<std::int16_t> && ImageValue<std::int32_t> && ImageValue<float> && ImageValue<double>);
static_assert(!ImageValue<long double> && !ImageValue<std::uint32_t> && !ImageValue<std::int64_t> &&
              !ImageValue<bool> && !ImageValue<const float>);
template <class Real>
concept ContourCoordinate = requires {
  typename Contour<3, Real>;
};
template <class Real>
concept ExtractedAs = requires(const Image<float, 3>& image) {
  extract<Real>(image, 0.0);
};
static_assert(ContourCoordinate<float> && ContourCoordinate<double> && ExtractedAs<float> && ExtractedAs<double>);
static_assert(!ContourCoordinate<long double> && !ContourCoordinate<int> && !ExtractedAs<long double> &&
              !ExtractedAs<int>);

// --- Temporaries: members that return a reference or a view of their object. `is_safe_of_temporaries(call)`: the call
// works for a named object; for a temporary, const or not, it is deleted or returns a value.
template <class Object, class Call>
consteval bool is_safe_of_temporaries(Call) {
  static_assert(std::invocable<Call, Object&>);
  constexpr auto is_safe = []<class Temporary>(std::type_identity<Temporary>) {
    if constexpr (!std::invocable<Call, Temporary>)
      return true;
    else {
      using Result = std::invoke_result_t<Call, Temporary>;
      using OfNamed = std::remove_cvref_t<std::invoke_result_t<Call, Object&>>;
      // Returns a value if named objects return a reference; a view would still refer to the temporary.
      return !std::is_reference_v<Result> && std::is_reference_v<std::invoke_result_t<Call, Object&>> &&
             std::same_as<Result, OfNamed>;
    }
  };
  return is_safe(std::type_identity<Object&&>{}) && is_safe(std::type_identity<const Object&&>{});
}
// Calls a member. `decltype(auto)` keeps references, and the constraint tests whether the member exists.
#define CALL(member)                                                                           \
  [](auto&& object) -> decltype(std::forward<decltype(object)>(object).member) requires true { \
    return std::forward<decltype(object)>(object).member;                                      \
  }
static_assert(is_safe_of_temporaries<OwnedImage<float, 3>>(CALL(view())));
static_assert(is_safe_of_temporaries<Image<float, 3>>(CALL(grid())));
static_assert(is_safe_of_temporaries<Image<float, 3>>(CALL(strides())));
static_assert(is_safe_of_temporaries<FacetHierarchy<3>>(CALL(down(1, 0))));
static_assert(is_safe_of_temporaries<FacetHierarchy<3>>(CALL(down_signs(1, 0))));
static_assert(is_safe_of_temporaries<FacetHierarchy<3>>(CALL(up(1, 0))));
static_assert(is_safe_of_temporaries<FacetHierarchy<3>>(CALL(up_signs(1, 0))));
static_assert(is_safe_of_temporaries<AmbiguousFace>(CALL(base())));
static_assert(is_safe_of_temporaries<TileRowSet>(CALL(words())));
static_assert(is_safe_of_temporaries<ActiveTiles<3>>(CALL(image())));
static_assert(is_safe_of_temporaries<ActiveTiles<3>>(CALL(grid())));
static_assert(is_safe_of_temporaries<tile::FaceLattice>(CALL(faces())));
static_assert(is_safe_of_temporaries<tile::FacetBuilder>(CALL(lattice())));
static_assert(is_safe_of_temporaries<tile::FacetBuilder>(CALL(build(1))));
static_assert(is_safe_of_temporaries<tile::TileCertifier>(CALL(lattice())));
static_assert(is_safe_of_temporaries<tile::TileCertifier>(CALL(tile())));
#undef CALL

// Views for Eigen: of named objects only.
template <class C>
concept HasVertexMatrix = requires(C&& contour) {
  vertex_matrix(std::forward<C>(contour));
};
template <class C>
concept HasSimplexMatrix = requires(C&& contour) {
  simplex_matrix(std::forward<C>(contour));
};
template <class A>
concept HasEigenView = requires(A&& array) {
  as_eigen(std::forward<A>(array));
};
static_assert(HasVertexMatrix<Contour<4>&> && HasVertexMatrix<const Contour<4>&>);
static_assert(!HasVertexMatrix<Contour<4>> && !HasVertexMatrix<const Contour<4>>);
static_assert(HasSimplexMatrix<Contour<4>&> && HasSimplexMatrix<const Contour<4>&>);
static_assert(!HasSimplexMatrix<Contour<4>> && !HasSimplexMatrix<const Contour<4>>);
static_assert(HasEigenView<Vector<3>&> && HasEigenView<const Vector<3>&>);
static_assert(!HasEigenView<Vector<3>> && !HasEigenView<const Vector<3>>);
static_assert(HasEigenView<Matrix<3>&> && HasEigenView<const Matrix<3>&>);
static_assert(!HasEigenView<Matrix<3>> && !HasEigenView<const Matrix<3>>);

// Constructors that store a reference to an argument.
static_assert(std::constructible_from<Scrubber<4, float>, const Contour<4>&>);
static_assert(!std::constructible_from<Scrubber<4, float>, Contour<4>&&>);
static_assert(!std::constructible_from<Scrubber<4, float>, const Contour<4>&&>);

// --- Options: aggregates with any single field initialised by name, without a warning (-Wextra includes
// -Wmissing-field-initializers). Tested for the first field and one in the middle, as fields after it would cause the
// warning.
[[maybe_unused]] void options_by_name() {
  const auto progress = [](double) { return true; };
  [[maybe_unused]] const WorkOptions work[] = {{.threads = 2}, {.progress = progress}};
  [[maybe_unused]] const ExtractOptions extraction[] = {{.triangulation = Triangulation::barycentric},
                                                        {.ambiguity = Ambiguity::mean},
                                                        {.close = true},
                                                        {.normals = Normals::differences},
                                                        {.work = {.threads = 1}},
                                                        {.work = {.progress = progress}}};
  [[maybe_unused]] const Estimator estimators[] = {{.choose = {}}, {.reach = 1}};
  [[maybe_unused]] const SimplifyOptions<3> simplification[] = {
      {.method = SimplifyMethod::facets}, {.count = 5}, {.ratio = 0.1}, {.max_error = 1.0}, {.work = {.threads = 1}}};
  [[maybe_unused]] const DeviationOptions<4> deviations[] = {
      {.scale = {1, 1, 1, 2}}, {.enough = 1.0}, {.work = {.threads = 1}}};
  [[maybe_unused]] const TrackOptions tracks[] = {{.min_lifetime = 1}, {.times = {1.0}}, {.work = {.threads = 1}}};
  [[maybe_unused]] const TrackPicture picture[] = {{.title = "a"}, {.width = 100}};
  [[maybe_unused]] const SeedSetOptions seeds[] = {
      {.method = SeedMethod::cover}, {.scan_order = {0}}, {.work = {.threads = 1}}};
  [[maybe_unused]] const ActiveTilesOptions tiles[] = {{.work = {.threads = 1}}, {.seed_method = SeedMethod::cover}};
  [[maybe_unused]] const ElementFileOptions elements[] = {{.axes = ElementAxes::as_is}, {.header = true}};
  [[maybe_unused]] const ReadImageOptions reading[] = {{.variable = "a"}, {.work = {.progress = progress}}};
  [[maybe_unused]] const SeriesOptions series[] = {{.variable = "a"}, {.step = 1.0}, {.order = SeriesOrder::by_name}};
  [[maybe_unused]] const WriteOptions writing[] = {{.work = {.progress = progress}},
                                                   {.compression = Compression::none}};
  [[maybe_unused]] const ReadMeshOptions mesh_reading[] = {{.work = {.progress = progress}},
                                                           {.separate_process = true}};
  [[maybe_unused]] const RawLayout raw[] = {{.sizes = {1, 2}}, {.type = ValueType::float32}, {.big_endian = true}};
  [[maybe_unused]] const Projection projections[] = {{.direction = {1, 0, 0, 0}}, {.eye_distance = 1}};
  [[maybe_unused]] const Hyperplane<4> planes[] = {{.normal = {1, 0, 0, 0}}, {.offset = 1}};
  [[maybe_unused]] const tile::Resolution resolution[] = {{.choices = {}}, {.alternative = tile::Alternative::high}};
  [[maybe_unused]] const Attribute attributes[] = {{.name = "a"}, {.width = 2}};
  [[maybe_unused]] const Mesh meshes[] = {{.dim = 1}, {.simplices = {0, 1}}, {.isovalue = 1.0}};
  [[maybe_unused]] const ContourRoom<3, float> room[] = {{.vertices = {}}, {.simplices = {}}};
  [[maybe_unused]] const Grid<2> grids[] = {{.axes = {}}, {.offset = {1, 2}}};
  [[maybe_unused]] const OwnedImage<float, 2> images[] = {{.grid = Grid<2>::unit({1, 1})}, {.values = {1.0F}}};
  [[maybe_unused]] const StreamedContour<3, float> streamed[] = {{.isovalue = 1}, {.sink = nullptr}};
}

}  // namespace
