// SPDX-License-Identifier: BSD-3-Clause
//
// Every reader against mutations of valid files and of hostile files that once broke it, in watched child processes and
// through the program. Reading must succeed or throw a tegl::Error that names the file. It must print nothing, end
// within ten seconds, and need at most twice the memory of the valid files plus 64 MiB. The valid files (seeds/,
// make_seeds.py) come from several writers.
//
// A mutation is identified by its number. TEGL_FUZZ_ROUNDS sets the number of mutations per format (default 1 000),
// TEGL_FUZZ_FIRST the first number, and TEGL_FUZZ_KEEP a folder for failing files.
#include <spawn.h>

#include <cstdlib>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>

#include "hostile/mutations.hpp"
#include "hostile/watched_runs.hpp"
#include "images/netcdf_files.hpp"
#include "images/nifti_files.hpp"
#include "images/npy_files.hpp"
#include "io_support.hpp"
#include "tegl/io/active_tiles.hpp"

namespace tegl::test {
namespace {

struct Seed {
  std::string name;  ///< with the extension that selects the reader
  std::string bytes;
};

std::uint64_t number_of(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}
std::uint64_t rounds() { return number_of("TEGL_FUZZ_ROUNDS", 1000); }

/// Seeds with these extensions: files of other writers and, if present, hostile files of up to 100 kB.
std::vector<Seed> seeds_with(const std::vector<std::string>& extensions, std::vector<Seed> own) {
  constexpr std::uintmax_t kMost = 100'000;
  for (const fs::path& folder :
       {fs::path(TEGL_SOURCE_DIR "/tests/io/seeds"), fs::path(TEGL_SHARED_DATA_DIR "/hostile")}) {
    if (!fs::is_directory(folder)) continue;
    std::set<fs::path> files;  // ordered, so that a number means the same mutation everywhere
    for (const auto& entry : fs::directory_iterator(folder)) files.insert(entry.path());
    for (const fs::path& file : files) {
      const std::string name = file.filename().string();
      const bool wanted =
          std::any_of(extensions.begin(), extensions.end(), [&](const auto& e) { return name.ends_with(e); });
      if (wanted && fs::file_size(file) <= kMost) own.push_back({name, read_file(file)});
    }
  }
  return own;
}

/// Copies the files to which seeds refer.
void write_companions(const fs::path& folder) {
  for (const char* const name : {"assimp.bin", "vtk_ascii.vti", "vtk_ascii.vtu", "vtk_base64.vts"})
    fs::copy_file(fs::path(TEGL_SOURCE_DIR "/tests/io/seeds") / name, folder / name,
                  fs::copy_options::overwrite_existing);
  write_file(folder / "values.raw", bytes_of(counting<std::int16_t>(120)));
}

class Mutations {
 public:
  Mutations(std::vector<Seed> seeds, std::string folder) : seeds_(std::move(seeds)), folder_(std::move(folder)) {
    for (const Seed& seed : seeds_) {
      bytes_.push_back(seed.bytes);
      if (seed.name.ends_with(".gz")) inflated_.emplace(seed.name, inflated(seed.bytes));
    }
    for (const std::string& bytes : bytes_) others_.push_back(&bytes);
  }

  /// Writes a mutation and returns its path.
  [[nodiscard]] fs::path write(std::uint64_t number) const {
    const Seed& seed = seeds_[number % seeds_.size()];
    Mutator mutator(number, others_);
    const auto content = inflated_.find(seed.name);
    // Compressed files are mutated after decompression every other time.
    const bool inside = content != inflated_.end() && number / seeds_.size() % 2 == 0;
    const fs::path path = fs::path(folder_) / ("m_" + seed.name);
    write_file(path, inside ? compressed(mutator.mutated(content->second)) : mutator.mutated(seed.bytes));
    return path;
  }

 private:
  static std::string inflated(const std::string& bytes) {
    z_stream stream{};
    inflateInit2(&stream, 15 + 16);
    std::string out(1 << 20, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    inflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    inflateEnd(&stream);
    return out;
  }

  std::vector<Seed> seeds_;
  std::string folder_;
  std::vector<std::string> bytes_;
  std::vector<const std::string*> others_;
  std::map<std::string, std::string> inflated_;
};

void keep(const Mutations& mutations, const WatchedSummary& summary) {
  const char* folder = std::getenv("TEGL_FUZZ_KEEP");
  if (folder == nullptr) return;
  for (const std::uint64_t number : summary.failed_runs) {
    const fs::path path = mutations.write(number);
    fs::copy_file(path, fs::path(folder) / (std::to_string(number) + path.filename().string()),
                  fs::copy_options::overwrite_existing);
  }
}

void expect_clean(const char* how, const WatchedSummary& summary, std::uint64_t wanted) {
  std::string all;
  for (const std::string& failure : summary.failures) all += "\n  " + failure;
  EXPECT_TRUE(summary.failures.empty()) << how << ": the numbers of the mutations, and what happened:" << all;
  if (summary.failures.empty()) {
    EXPECT_EQ(summary.runs, wanted);
  }
  // If readers accepted nearly all mutations, the test would be weak.
  EXPECT_GT(summary.refused, wanted / 10) << how;
  // Additional output for runs with many rounds.
  std::printf("  %s: %zu mutations, %zu refused, slowest %.3f s, most memory %zu KiB\n", how, summary.runs,
              summary.refused, summary.slowest_seconds, summary.most_memory >> 10);
}

using Read = std::function<void(const fs::path&)>;

WatchedResult result_of(const Read& read, const fs::path& path) {
  try {
    read(path);
    return {};
  } catch (const Error& error) {
    const bool named = std::string(error.what()).find(path.parent_path().string()) != std::string::npos;
    return {true, named ? "" : std::string("a message without the file: ") + error.what()};
  } catch (const std::exception& error) {
    return {true, std::string("no tegl::Error, but ") + error.what()};
  }
}

#if defined(__SANITIZE_ADDRESS__)
constexpr std::size_t kMemoryFactor = 8;  // shadow memory, and delayed release of freed memory
#else
constexpr std::size_t kMemoryFactor = 1;
#endif

/// Runs in watched children; the valid files run first, and their memory sets the limit.
void fuzz_in_process(const std::vector<Seed>& seeds, const Mutations& mutations, const fs::path& folder,
                     const Read& read) {
  WatchedLimits limits;
  limits.memory = kMemoryFactor * (512u << 20);
  const auto sound = run_watched(seeds.size(), limits, [&](std::uint64_t i) {
    write_file(folder / seeds[i].name, seeds[i].bytes);
    return result_of(read, folder / seeds[i].name);
  });
  EXPECT_THAT(sound.failures, testing::IsEmpty());
  limits.memory = 2 * sound.most_memory + kMemoryFactor * (64u << 20);
  const std::uint64_t first = number_of("TEGL_FUZZ_FIRST", 0);
  const auto summary =
      run_watched(rounds(), limits, [&](std::uint64_t i) { return result_of(read, mutations.write(first + i)); });
  expect_clean("in process", summary, rounds());
  keep(mutations, summary);
}

/// Runs the program; returns its exit status, or 128 + signal.
int status_of_program(std::vector<std::string> words) {
  words.insert(words.begin(), TEGL_PROGRAM);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  pid_t child = 0;
  const int error = posix_spawn(&child, TEGL_PROGRAM, &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (error != 0 || waitpid(child, &status, 0) != child) return 127;
  return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}

/// Runs every 50th mutation through the program, alternating between its commands.
void fuzz_program(const std::vector<Seed>& seeds, const Mutations& mutations, const fs::path& folder,
                  const std::vector<std::vector<std::string>>& commands) {
  const auto run = [&](const std::vector<std::string>& command, const fs::path& file) -> WatchedResult {
    std::vector<std::string> words = command;
    for (std::string& word : words)
      word = word == "FILE" ? file.string() : word == "OUT" ? (folder / "out.vtkhdf").string() : word;
    const int status = status_of_program(words);
    constexpr int kInternal = 70;
    if (status >= 126 || status == kInternal)
      return {true, words.front() + " ended with status " + std::to_string(status)};
    return {status != 0, ""};
  };
  WatchedLimits limits;
  limits.memory = kMemoryFactor * (512u << 20);
  const auto sound = run_watched(seeds.size() * commands.size(), limits, [&](std::uint64_t i) {
    const Seed& seed = seeds[i / commands.size()];
    write_file(folder / seed.name, seed.bytes);
    return run(commands[i % commands.size()], folder / seed.name);
  });
  EXPECT_THAT(sound.failures, testing::IsEmpty());
  limits.memory = 2 * sound.most_memory + kMemoryFactor * (64u << 20);
  constexpr std::uint64_t kEvery = 50;
  const std::uint64_t runs = std::max<std::uint64_t>(1, rounds() / kEvery);
  const auto summary = run_watched(runs, limits, [&](std::uint64_t i) {
    return run(commands[i % commands.size()],
               mutations.write(number_of("TEGL_FUZZ_FIRST", 0) + i * kEvery + i % kEvery));
  });
  expect_clean("by the program", summary, runs);
}

const std::vector<std::vector<std::string>> kImageCommands = {
    {"info", "FILE"},
    {"contour", "FILE", "--iso", "50", "-o", "OUT"},
    {"contour", "FILE", "--iso", "50", "--stream", "-o", "OUT"}};
const std::vector<std::vector<std::string>> kMeshCommands = {
    {"check", "FILE"}, {"measure", "FILE"}, {"components", "FILE", "-o", "OUT"}};

void fuzz(const std::vector<std::string>& extensions, std::vector<Seed> own, const Read& read,
          const std::vector<std::vector<std::string>>& commands) {
  TempDir dir;
  write_companions(dir.path());
  const std::vector<Seed> seeds = seeds_with(extensions, std::move(own));
  ASSERT_GE(seeds.size(), 3u);
  const Mutations mutations(seeds, dir.path().string());
  fuzz_in_process(seeds, mutations, dir.path(), read);
  fuzz_program(seeds, mutations, dir.path(), commands);
}

/// Reads the file as an image, as a list of variables, and its first layer.
void read_as_image(const fs::path& path) {
  ReadImageOptions options;
  options.separate_process = true;
  list_image_variables(path, options);
  read_image(path, options);
}

template <Value T, int N>
void read_first_layer(LayerReader<T, N>& layers) {
  std::size_t samples = 1;
  for (std::size_t a = 0; a + 1 < N; ++a) samples *= layers.grid().axes[a].size();
  std::vector<T> values(samples);
  layers.read(0, values.data());
}

void read_as_layers(const fs::path& path) {
  ReadImageOptions options;
  options.separate_process = true;
  options.variable = "temperature";
  const auto opened = open_layers(path, options);
  std::visit(
      []<class OfDimension>(const OfDimension& of_dimension) {
        std::visit([](const auto& layers) { read_first_layer(*layers); }, of_dimension);
      },
      opened.layers);
}

void read_as_mesh(const fs::path& path) {
  ReadMeshOptions options;
  options.separate_process = true;
  read_mesh(path, options);
}

TEST(Fuzz, Nifti) {
  auto header = NiftiHeader({5, 4, 3, 2}, 4, 16).sform({0, -2, 0, 1, 2, 0, 0, 2, 0, 0, 2, 3}).scaling(2, 1);
  const std::string file = header.bytes() + bytes_of(counting<std::int16_t>(120));
  fuzz({".nii", ".nii.gz"}, {{"own.nii", file}, {"own.nii.gz", compressed(file)}}, read_as_image, kImageCommands);
}

TEST(Fuzz, Nrrd) {
  const std::string header =
      "NRRD0004\n# comment\ntype: short\ndimension: 4\nsizes: 3 4 5 2\nspace: LPS\nkinds: domain domain domain list\n"
      "space directions: (1,2,0) (0,3,-1) (0.5,0,4) none\nspace origin: (10,20,30)\nendian: little\n"
      "labels: \"x\" \"y\" \"z\" \"t\"\nkey:=value\nencoding: ";
  fuzz({".nrrd"},
       {{"own.nrrd", header + "raw\n\n" + bytes_of(counting<std::int16_t>(120))},
        {"own.nhdr", header + "raw\ndata file: values.raw\n"}},
       read_as_image, kImageCommands);
}

TEST(Fuzz, MetaImage) {
  const std::string header =
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 20 30\nElementSpacing = 2 3 4\nAnatomicalOrientation = RAI\n"
      "DimSize = 3 4 10\nElementType = MET_SHORT\nElementDataFile = ";
  fuzz({".mha"},
       {{"own.mha", header + "LOCAL\n" + bytes_of(counting<std::int16_t>(120))}, {"own.mhd", header + "values.raw\n"}},
       read_as_image, kImageCommands);
}

TEST(Fuzz, Npy) {
  const std::string samples = bytes_of(counting<std::int16_t>(120));
  fuzz({".npy"},
       {{"own.npy", npy("<i2", "10, 4, 3", samples)},
        {"fortran.npy", npy(">i2", "10, 4, 3", samples, true)},
        {"version2.npy", npy_with("{'descr': '|u1', 'fortran_order': False, 'shape': (12, 20)}", samples, 2)}},
       read_as_image, kImageCommands);
}

TEST(Fuzz, Npz) {
  const std::string array = npy("<i2", "10, 4, 3", bytes_of(counting<std::int16_t>(120)));
  fuzz({".npz"},
       {{"stored.npz", zip({{"a.npy", array}})},
        {"deflated.npz", zip({{"a.npy", array, true}}, "comment")},
        {"zip64.npz", zip({{"a.npy", array, true, 0, 0, true}, {"text.txt", "text"}})}},
       read_as_image, kImageCommands);
}

std::string collection_of(const std::string& file) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\">\n<Collection>\n<DataSet timestep=\"0\" file=\"" +
         file + "\"/>\n<DataSet timestep=\"1.5\" part=\"0\" file=\"" + file + "\"/>\n</Collection>\n</VTKFile>\n";
}

TEST(Fuzz, VtkImages) {
  fuzz({".vti", ".vtr"}, {{"own.pvd", collection_of("vtk_ascii.vti")}}, read_as_image, kImageCommands);
}

/// A structured grid of VTK in text, by pieces of one row of cells each.
std::string curved_grid_of(int pieces) {
  std::string file = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"StructuredGrid\">\n<StructuredGrid WholeExtent=\"0 3 0 {} 0 1\">\n",
      pieces);
  for (int piece = 0; piece < pieces; ++piece) {
    std::string values, points;
    for (int k = 0; k < 2; ++k)
      for (int j = piece; j < piece + 2; ++j)
        for (int i = 0; i < 4; ++i) {
          values += fmt::format("{} ", 10 * i + 7 * j + 30 * k);
          points += fmt::format("{} {} {} ", i + 0.2 * j, j - 0.1 * i, k + 0.05 * i * j);
        }
    file += fmt::format(
        "<Piece Extent=\"0 3 {} {} 0 1\">\n<PointData><DataArray type=\"Float64\" Name=\"f\" "
        "format=\"ascii\">{}</DataArray>"
        "</PointData>\n<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
        "format=\"ascii\">{}</DataArray></Points>\n"
        "</Piece>\n",
        piece, piece + 1, values, points);
  }
  return file + "</StructuredGrid>\n</VTKFile>\n";
}

TEST(Fuzz, VtkCurvedGrids) {
  fuzz(
      {".vts"},
      {{"own.vts", curved_grid_of(1)}, {"pieces.vts", curved_grid_of(3)}, {"own.pvd", collection_of("vtk_base64.vts")}},
      read_as_image,
      {{"info", "FILE"},
       {"contour", "FILE", "--curved-grid", "--iso", "25", "-o", "OUT"},
       {"contour", "FILE", "--curved-grid", "--periodic", "x", "--iso", "25", "-o", "OUT"}});
}

TEST(Fuzz, CellMeshes) {
  const std::string table =
      "# points\nx, y, f, g\n0,0,1,2\n1,0,100,\n0,1,nan,4\n1e0,1.25,60,\"7\"\n-1,0.5,2,3\n0.25,0.75,55,1\n";
  const auto read = [](const fs::path& path) {
    CellMeshOptions options;
    options.variable = "f";
    read_cell_mesh(std::array{path}, options);
    describe_cell_mesh(path);
  };
  fuzz({".vtu", ".vts"}, {{"own.pvd", collection_of("vtk_ascii.vtu")}, {"own.csv", table}}, read,
       {{"info", "FILE"},
        {"contour", "FILE", "--var", "f", "--iso", "50", "-o", "OUT"},
        {"measure", "FILE", "--var", "f", "--iso", "50"}});
}

TEST(Fuzz, NetCdfClassic) {
  std::vector<Seed> seeds =
      seeds_with({"64bit_offset.nc", "64bit_data.nc", "netcdf3_classic.nc", "scipy.nc", "300.nc", "-1.nc"}, {});
  const std::string zipped = compressed(seeds.front().bytes);
  seeds.push_back({"own.nc.gz", zipped});
  fuzz({}, std::move(seeds), read_as_image, kImageCommands);
}

TEST(Fuzz, NetCdf4) {
  fuzz({"netcdf4.nc", "4_classic.nc", "netcdf_compressed.nc", "n4.nc", "n4_byte_0x1545.nc"}, {}, read_as_image,
       kImageCommands);
}

TEST(Fuzz, Hdf5Layers) {
  fuzz({".h5"}, {}, read_as_layers,
       {{"info", "FILE"}, {"contour", "FILE", "--var", "temperature", "--iso", "50", "--stream", "-o", "OUT"}});
}

TEST(Fuzz, Dicom) { fuzz({".dcm"}, {}, read_as_image, kImageCommands); }

std::string mesh_bytes(const Mesh& mesh, const std::string& name) {
  TempDir dir;
  write_mesh(mesh, dir / name);
  return read_file(dir / name);
}

Mesh mesh_with_attributes(int dim, int space_dim) {
  Mesh mesh = random_mesh(dim, space_dim, 20, 30, 1, true);
  add_attributes(mesh, 2);
  return mesh;
}

TEST(Fuzz, Ply) {
  fuzz({".ply"},
       {{"own.ply", mesh_bytes(mesh_with_attributes(2, 3), "a.ply")},
        {"own_2d.ply", mesh_bytes(random_mesh(1, 2, 20, 30, 1), "a.ply")}},
       read_as_mesh, kMeshCommands);
}

TEST(Fuzz, Obj) {
  fuzz({".obj"},
       {{"own.obj", mesh_bytes(random_mesh(2, 3, 20, 30, 1, true), "a.obj")},
        {"own_2d.obj", mesh_bytes(random_mesh(1, 2, 20, 30, 1), "a.obj")},
        {"hand.obj", "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nvn 0 0 1\r\nf 1//1 -2//-1 \\\r\n3/1/1\r\nl 1 2 3 # end\r\n"}},
       read_as_mesh, kMeshCommands);
}

TEST(Fuzz, Stl) {
  fuzz({".stl"}, {{"own.stl", mesh_bytes(random_mesh(2, 3, 20, 30, 1), "a.stl")}}, read_as_mesh, kMeshCommands);
}

TEST(Fuzz, Gltf) {
  fuzz({".gltf", ".glb"},
       {{"own.gltf", mesh_bytes(mesh_with_attributes(2, 3), "a.gltf")},
        {"own.glb", mesh_bytes(random_mesh(1, 2, 20, 30, 1), "a.glb")}},
       read_as_mesh, kMeshCommands);
}

TEST(Fuzz, VtkHdf) {
  fuzz({".vtkhdf"},
       {{"own.vtkhdf", mesh_bytes(random_mesh(3, 4, 20, 30, 1), "a.vtkhdf")},
        {"own_attributes.vtkhdf", mesh_bytes(mesh_with_attributes(3, 4), "a.vtkhdf")}},
       read_as_mesh, kMeshCommands);
}

/// The image of the test's index files.
OwnedImage<float, 3> indexed_image() {
  OwnedImage<float, 3> image{Grid<3>::unit({12, 10, 9}), {}};
  std::mt19937_64 random(3);
  for (std::size_t i = 0; i < 12 * 10 * 9; ++i) image.values.push_back(static_cast<float>(random() % 100));
  return image;
}

TEST(Fuzz, Index) {
  const OwnedImage<float, 3> image = indexed_image();
  std::vector<Seed> seeds;
  TempDir dir;
  for (const ActiveMethod method : active_methods()) {
    if (method == ActiveMethod::full_scan) continue;  // has no file
    write_active_tiles(*build_active_tiles(image.view(), method), dir / "a.tindex");
    seeds.push_back({"method_" + std::to_string(seeds.size()) + ".tindex", read_file(dir / "a.tindex")});
  }
  const auto read = [&](const fs::path& path) {
    read_active_tiles_head(path);
    check_active_tiles(path);
    read_active_tiles<float, 3>(path, image.view());
  };
  fuzz({}, std::move(seeds), read, {{"info", "FILE"}});
}

}  // namespace
}  // namespace tegl::test
