// SPDX-License-Identifier: BSD-3-Clause
//
// Files read by a child process: images, layers and meshes equal those read in this process, and crashes become errors.
// (DICOM: dicom_test.py, whose dump_image reads in both ways.)
#include <sys/resource.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <optional>
#include <thread>

#include "images/layers_support.hpp"
#include "images/netcdf_files.hpp"
#include "tegl/extract.hpp"
#include "tegl/io/series.hpp"

namespace tegl::test {
namespace {

using Clock = std::chrono::steady_clock;

const ReadImageOptions kSeparate{.separate_process = true};

/// A process whose parent is this one, if any.
std::optional<pid_t> child_of_this() {
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string stat = read_file(entry.path() / "stat");
    const std::size_t end = stat.rfind(')');
    int parent = 0;
    if (end != std::string::npos && std::sscanf(stat.c_str() + end + 1, " %*c %d", &parent) == 1 && parent == getpid())
      return std::stoi(name);
  }
  return std::nullopt;
}

/// Storage of a variable v(time, y, x); netCDF-4 unless `format` is set.
struct Storage {
  nc_type type = NC_FLOAT;
  std::array<std::size_t, 3> sizes = {40, 150, 200};  ///< 4.8 MB of float
  std::array<std::size_t, 3> chunk = {0, 0, 0};       ///< 0: contiguous
  int deflate = 0;
  bool packed = false;
  bool time_first = true;
  int format = NC_NETCDF4;
  double offset = 0;  ///< added to all values
};

void write_image(const fs::path& path, const Storage& storage) {
  NcWriter file(path, storage.format);
  const std::array<std::string, 3> names =
      storage.time_first ? std::array<std::string, 3>{"time", "y", "x"} : std::array<std::string, 3>{"y", "x", "time"};
  std::vector<int> dimensions;
  for (std::size_t d = 0; d < 3; ++d) dimensions.push_back(file.dimension(names[d], storage.sizes[d]));
  const int variable = file.variable("v", storage.type, dimensions);
  if (storage.chunk[0] > 0) NcWriter::ok(nc_def_var_chunking(file.id(), variable, NC_CHUNKED, storage.chunk.data()));
  if (storage.deflate > 0) NcWriter::ok(nc_def_var_deflate(file.id(), variable, 1, 1, storage.deflate));
  file.text(variable, "units", "K");
  file.text(variable, "long_name", "temperature");
  if (storage.packed) file.number(variable, "scale_factor", NC_DOUBLE, {0.01});
  const int x = file.variable("x", NC_DOUBLE, {dimensions[storage.time_first ? 2 : 1]});
  file.end();
  const std::size_t columns = storage.sizes[storage.time_first ? 2 : 1];
  std::vector<double> coordinates(columns);
  for (std::size_t i = 0; i < columns; ++i) coordinates[i] = static_cast<double>(i * i);
  file.values(x, coordinates);
  std::vector<double> values(storage.sizes[0] * storage.sizes[1] * storage.sizes[2]);
  std::mt19937_64 random(3);
  const std::uint64_t most = storage.type == NC_BYTE || storage.type == NC_UBYTE ? 100 : 20000;
  for (double& value : values) value = storage.offset + static_cast<double>(random() % most);
  file.values(variable, values);
}

void expect_same_info(const ImageInfo& a, const ImageInfo& b) {
  EXPECT_EQ(a.format, b.format);
  EXPECT_EQ(a.variable, b.variable);
  EXPECT_EQ(a.variables, b.variables);
  EXPECT_EQ(a.value_unit, b.value_unit);
  EXPECT_EQ(a.value_name, b.value_name);
  EXPECT_EQ(a.world_frame, b.world_frame);
  EXPECT_EQ(a.stored_type, b.stored_type);
  EXPECT_EQ(a.axis_directions, b.axis_directions);
  EXPECT_EQ(a.remarks, b.remarks);
}

void expect_same_both_ways(const fs::path& path) {
  const ReadImageResult here = read_image(path);
  const ReadImageResult there = read_image(path, kSeparate);
  expect_same_info(here.info, there.info);
  ASSERT_EQ(here.image.index(), there.image.index());
  const auto compare = [&]<Value T, int N>(const OwnedImage<T, N>& a, const OwnedImage<T, N>& b) {
    ASSERT_EQ(a.values.size(), b.values.size());
    EXPECT_EQ(std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(T)), 0);
    for (int axis = 0; axis < N; ++axis) {
      EXPECT_EQ(a.grid.axes[axis].name, b.grid.axes[axis].name);
      EXPECT_EQ(a.grid.axes[axis].unit, b.grid.axes[axis].unit);
      EXPECT_EQ(a.grid.axes[axis].is_uniform(), b.grid.axes[axis].is_uniform());
      for (std::size_t i = 0; i < a.grid.axes[axis].size(); ++i) EXPECT_EQ(a.grid.axes[axis][i], b.grid.axes[axis][i]);
    }
    EXPECT_EQ(a.grid.linear, b.grid.linear);
    EXPECT_EQ(a.grid.offset, b.grid.offset);
  };
  std::visit(
      [&]<class A, class B>(const A& a, const B& b) {
        if constexpr (std::is_same_v<A, B>) {
          ASSERT_EQ(a.index(), b.index());
          std::visit(
              [&]<class C, class D>(const C& c, const D& d) {
                if constexpr (std::is_same_v<C, D>) compare(c, d);
              },
              a, b);
        }
      },
      here.image, there.image);
  OpenLayersResult opened = open_layers(path, ReadImageOptions{.separate_process = true});
  expect_same_info(opened.info, open_layers(path).info);
  expect_layers_of(open_layers(path).layers.index() == here.image.index() ? there.image : here.image, opened.layers);
  const auto variables = list_image_variables(path, kSeparate);
  ASSERT_EQ(variables.size(), list_image_variables(path).size());
  EXPECT_EQ(variables[0].name, "v");
  EXPECT_EQ(variables[0].sizes, list_image_variables(path)[0].sizes);
  EXPECT_EQ(variables[0].unit, "K");
  EXPECT_EQ(variables[0].long_name, "temperature");
}

TEST(SeparateReading, ImagesAndLayersAreTheSame) {
  TempDir dir;
  const std::vector<Storage> all = {
      {},
      {.sizes = {3, 4, 5}},
      {.chunk = {1, 150, 200}, .deflate = 1},
      {.chunk = {7, 31, 64}, .deflate = 1},
      {.sizes = {20000, 2, 2}, .chunk = {1, 1, 2}},  // chunks of old netCDF-4 libraries for an unlimited dimension
      {.type = NC_SHORT, .chunk = {40, 150, 200}, .deflate = 1, .packed = true},
      {.type = NC_DOUBLE, .sizes = {50, 90, 60}, .time_first = false},
      {.type = NC_BYTE, .sizes = {300, 90, 100}, .packed = true},
      {.type = NC_UBYTE, .sizes = {30, 9, 10}},
      {.format = NC_64BIT_OFFSET},
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(i);
    write_image(dir / "a.nc", all[i]);
    expect_same_both_ways(dir / "a.nc");
  }
}

TEST(SeparateReading, KeptIntegersHaveTheirScaling) {
  TempDir dir;
  write_image(dir / "a.nc", {.type = NC_SHORT, .sizes = {3, 4, 5}, .packed = true});
  ReadImageOptions options = kSeparate;
  options.keep_stored = true;
  const auto [any, info] = read_image(dir / "a.nc", options);
  ASSERT_TRUE(info.scaling.has_value());
  EXPECT_EQ(info.scaling->slope, 0.01);
  EXPECT_EQ(info.scaling->greatest, 32767);
  const auto values = image_as<float, 3>(read_image(dir / "a.nc").image).values;
  const auto kept = image_as<std::int16_t, 3>(any).values;
  for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_EQ(info.scaling->value_of(kept[i]), values[i]);
}

TEST(SeparateReading, ValuesOfAFileThatIsMuchSmallerHaveMemory) {
  TempDir dir;
  const std::size_t count = std::size_t{72} * 512 * 512;  // 75 MB; the file has less than 1
  {
    NcWriter file(dir / "a.nc", NC_NETCDF4);
    const std::vector<int> dimensions = {file.dimension("z", 72), file.dimension("y", 512), file.dimension("x", 512)};
    const int variable = file.variable("v", NC_FLOAT, dimensions);
    const std::array<std::size_t, 3> chunk = {8, 512, 512};
    NcWriter::ok(nc_def_var_chunking(file.id(), variable, NC_CHUNKED, chunk.data()));
    NcWriter::ok(nc_def_var_deflate(file.id(), variable, 1, 1, 1));
    file.end();
    file.values(variable, std::vector<double>(count, 2.5));
  }
  ASSERT_LT(fs::file_size(dir / "a.nc"), 1'000'000u);
  const auto image = image_as<float, 3>(read_image(dir / "a.nc", kSeparate).image);
  ASSERT_EQ(image.values.size(), count);
  EXPECT_EQ(image.values.front(), 2.5F);
  EXPECT_EQ(image.values.back(), 2.5F);
}

TEST(SeparateReading, ManyVariablesHaveMemoryForTheirTables) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers take memory of their own";
#endif
  TempDir dir;
  constexpr int kVariables = 1500;  // need more than 64 MiB
  {
    NcWriter file(dir / "many.nc", NC_NETCDF4);
    const std::vector<int> dimensions = {file.dimension("y", 4), file.dimension("x", 5)};
    for (int i = 0; i < kVariables; ++i)
      NcWriter::ok(
          nc_def_var_deflate(file.id(), file.variable("v" + std::to_string(i), NC_FLOAT, dimensions), 1, 1, 1));
  }
  EXPECT_EQ(list_image_variables(dir / "many.nc", kSeparate).size(), kVariables);
}

TEST(SeparateReading, WideIntegersAndGzippedFilesAreTheSame) {
  TempDir dir;
  write_image(dir / "a.nc", {.type = NC_INT64, .sizes = {10, 200, 200}});
  EXPECT_EQ((image_as<std::int32_t, 3>(read_image(dir / "a.nc", kSeparate).image).values),
            (image_as<std::int32_t, 3>(read_image(dir / "a.nc").image).values));
  write_image(dir / "a.nc", {.type = NC_INT64, .sizes = {10, 200, 200}, .offset = 0x1p40});
  EXPECT_EQ((image_as<double, 3>(read_image(dir / "a.nc", kSeparate).image).values),
            (image_as<double, 3>(read_image(dir / "a.nc").image).values));
  write_image(dir / "b.nc", {});
  write_file(dir / "b.nc.gz", compressed(read_file(dir / "b.nc")));
  EXPECT_EQ((image_as<float, 3>(read_image(dir / "b.nc.gz", kSeparate).image).values),
            (image_as<float, 3>(read_image(dir / "b.nc").image).values));
}

TEST(SeparateReading, ValuesBelongToTheImage) {
  TempDir dir;
  write_image(dir / "a.nc", {});
  AnyImage any = read_image(dir / "a.nc", kSeparate).image;
  auto& image = std::get<OwnedImage<float, 3>>(std::get<AnyImageN<3>>(any));
  const OwnedImage<float, 3> copy = image;
  for (float& value : image.values) value += 1;
  image.values.push_back(7);
  ASSERT_EQ(image.values.size(), copy.values.size() + 1);
  for (std::size_t i = 0; i < copy.values.size(); ++i) ASSERT_EQ(image.values[i], copy.values[i] + 1);
  const std::vector<float> moved = std::move(image.values);
  EXPECT_EQ(moved.back(), 7);
  EXPECT_TRUE(image.values.empty());  // the test of the moved-from state
}

TEST(SeparateReading, SeriesAreTheSame) {
  TempDir dir;
  std::vector<fs::path> files;
  for (int i = 0; i < 4; ++i) {
    files.push_back(dir / ("step_" + std::to_string(i) + ".nc"));
    write_image(files.back(), {.sizes = {9, 150, 200}, .deflate = 1, .offset = 100.0 * i});
  }
  SeriesOptions options;
  options.step = 0.5;
  const ReadSeriesResult here = read_series(files, options);
  std::optional<double> last;
  options.separate_process = true;
  options.work.progress = [&](double share) {
    EXPECT_GE(share, last.value_or(0.0));
    last = share;
    return true;
  };
  const ReadSeriesResult there = read_series(files, options);
  EXPECT_TRUE(last.has_value());
  EXPECT_EQ(there.files, here.files);
  EXPECT_EQ((image_as<float, 4>(there.image).values), (image_as<float, 4>(here.image).values));
  last.reset();
  const OpenSeriesResult opened = open_series(files, options);
  EXPECT_EQ(last, 1.0);
  last.reset();
  EXPECT_EQ(opened.files, here.files);
  expect_layers_of(here.image, opened.layers);
  EXPECT_FALSE(last.has_value());
}

TEST(SeparateReading, MeshesAreTheSame) {
  TempDir dir;
  for (const std::size_t count : {std::size_t{0}, std::size_t{20}, std::size_t{200000}})
    for (const int space_dim : {3, 4}) {
      Mesh mesh = random_mesh(space_dim - 1, space_dim, count, count, 1, true);
      add_attributes(mesh, 2);
      mesh.isovalue = 2.5;
      write_mesh(mesh, dir / "a.vtkhdf");
      const Mesh here = read_mesh(dir / "a.vtkhdf");
      const Mesh there = read_mesh(dir / "a.vtkhdf", ReadMeshOptions{.separate_process = true});
      expect_same(there, here);
      EXPECT_EQ(there.isovalue, here.isovalue);
    }
}

TEST(SeparateReading, ErrorsAreTheSame) {
  TempDir dir;
  write_image(dir / "a.nc", {});
  const auto expect = [](const auto& read) {
    const Error here = error_of([&] { read(false); });
    const Error there = error_of([&] { read(true); });
    EXPECT_EQ(here.code(), there.code());
    EXPECT_STREQ(here.what(), there.what());
  };
  const auto image = [&](const std::string& name, const std::string& variable = "") {
    return [=, &dir](bool separate) { read_image(dir / name, {.variable = variable, .separate_process = separate}); };
  };
  expect(image("missing.nc"));
  expect(image("a.nc", "missing"));
  write_file(dir / "cut.nc", read_file(dir / "a.nc").substr(0, 3000));
  expect(image("cut.nc"));
  write_file(dir / "nothing.vtkhdf", "nothing");
  expect([&](bool separate) { read_mesh(dir / "nothing.vtkhdf", ReadMeshOptions{.separate_process = separate}); });
}

TEST(SeparateReading, LayersOfSeveralFilesAtATime) {
  TempDir dir;
  std::vector<OpenLayersResult> opened;
  std::vector<OwnedImage<float, 3>> images;
  for (int i = 0; i < 3; ++i) {
    const fs::path path = dir / (std::to_string(i) + ".nc");
    write_image(path, {.chunk = {3, 150, 200}, .deflate = 1, .offset = 7.0 * i});
    opened.push_back(open_layers(path, ReadImageOptions{.separate_process = true}));
    images.push_back(image_as<float, 3>(read_image(path).image));
  }
  std::vector<float> layer(150 * 200);
  for (std::size_t k = 0; k < 40; ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      auto& reader = std::get<std::unique_ptr<LayerReader<float, 3>>>(std::get<AnyLayersN<3>>(opened[i].layers));
      reader->read(k, layer.data());
      ASSERT_EQ(std::memcmp(layer.data(), images[i].values.data() + k * layer.size(), layer.size() * 4), 0) << k;
    }
}

TEST(SeparateReading, ChildKilledBetweenLayersIsAnErrorThatNamesTheFile) {
  TempDir dir;
  write_image(dir / "a.nc", {.sizes = {200, 150, 200}});
  OpenLayersResult opened = open_layers(dir / "a.nc", ReadImageOptions{.separate_process = true});
  auto& reader = std::get<std::unique_ptr<LayerReader<float, 3>>>(std::get<AnyLayersN<3>>(opened.layers));
  std::vector<float> layer(150 * 200);
  reader->read(0, layer.data());
  const auto child = child_of_this();
  ASSERT_TRUE(child.has_value());
  kill(*child, SIGKILL);
  expect_error(ErrorCode::MalformedFile, {(dir / "a.nc").string(), "ended by signal 9"}, [&] {
    for (std::size_t k = 1; k < 200; ++k) reader->read(k, layer.data());
  });
  EXPECT_THROW(reader->read(199, layer.data()), Error);
  EXPECT_FALSE(child_of_this().has_value());
}

TEST(SeparateReading, CancellingStopsTheChild) {
  TempDir dir;
  write_image(dir / "a.nc", {.sizes = {300, 150, 200}, .chunk = {10, 150, 200}, .deflate = 1});
  ReadImageOptions options = kSeparate;
  options.work.progress = [](double share) { return share <= 0.0; };
  expect_error(ErrorCode::Cancelled, {"a.nc"}, [&] { read_image(dir / "a.nc", options); });
  EXPECT_FALSE(child_of_this().has_value());
}

TEST(SeparateReading, LeavesNothingBehindAndWorksWhileOtherThreadsDo) {
  TempDir dir;
  write_image(dir / "a.nc", {.sizes = {3, 4, 5}});
  write_image(dir / "b.nc", {});
  read_image(dir / "a.nc", kSeparate);
  const std::size_t before = open_descriptors();  // before other threads open files for a moment
  std::atomic<bool> done = false;
  std::thread busy([&] {  // occupies all threads of TBB
    OwnedImage<float, 3> image{Grid<3>::unit({60, 60, 60}), std::vector<float>(60 * 60 * 60)};
    std::mt19937 random(1);
    for (float& value : image.values) value = static_cast<float>(random() % 100);
    while (!done) EXPECT_GT(extract(image.view(), 50.0).vertices.size(), 0U);
  });
  for (int i = 0; i < 1000; ++i) read_image(dir / (i % 10 == 0 ? "b.nc" : "a.nc"), kSeparate);
  for (int i = 0; i < 20; ++i) open_layers(dir / "b.nc", ReadImageOptions{.separate_process = true});
  done = true;
  busy.join();
  EXPECT_EQ(open_descriptors(), before);
  EXPECT_FALSE(child_of_this().has_value());
}

/// Files that crash this process, loop, or take more than a gigabyte if it reads them itself.
TEST(SeparateReading, HostileFilesAreErrors) {
  const fs::path root = fs::path(TEGL_SHARED_DATA_DIR) / "hostile";
  if (!fs::exists(root)) GTEST_SKIP() << "no " << root;
  for (const char* const name : {"n4_byte_0x1545.nc", "chunk.nc", "seq_10000.dcm"}) {
    SCOPED_TRACE(name);
    const auto start = Clock::now();
    expect_error(ErrorCode::MalformedFile, {(root / name).string()}, [&] { read_image(root / name, kSeparate); });
    expect_error(ErrorCode::MalformedFile, {(root / name).string()}, [&] {
      OpenLayersResult opened = open_layers(root / name, ReadImageOptions{.separate_process = true});
      const auto read_first = [](auto& reader) {
        std::vector<typename std::decay_t<decltype(*reader)>::value_type> layer(std::size_t{1} << 20);
        reader->read(0, layer.data());
      };
      std::visit([&](auto& typed) { std::visit(read_first, typed); }, opened.layers);
    });
    EXPECT_LT(std::chrono::duration<double>(Clock::now() - start).count(), 20);
  }
  for (const char* const name :
       {"vtkhdf_sig11_2_149.vtkhdf", "vtkhdf_sig11_2_330.vtkhdf", "vtkhdf_sig14_rss_1_899.vtkhdf"}) {
    SCOPED_TRACE(name);
    expect_error(ErrorCode::MalformedFile, {(root / name).string()},
                 [&] { read_mesh(root / name, ReadMeshOptions{.separate_process = true}); });
  }
  EXPECT_FALSE(child_of_this().has_value());
}

}  // namespace
}  // namespace tegl::test
