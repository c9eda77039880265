// SPDX-License-Identifier: BSD-3-Clause
//
// Traverses the objects of an HDF5 file group by group, without recursion: first the links of a group, then the objects
// of its hard links, each once by address.
#include "base/hdf5_links.hpp"

#include <array>
#include <set>
#include <string>
#include <vector>

#include <hdf5.h>

#include "base/common.hpp"
#include "base/hdf5_handle.hpp"
#include "base/named_path.hpp"
#include "base/reading_process.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

/// HDF5's driver for files in memory copies the bytes. These callbacks share the caller's bytes instead.
struct SharedImage {
  void* bytes;
  static void* allocate(std::size_t, H5FD_file_image_op_t, void* data) {
    return static_cast<SharedImage*>(data)->bytes;
  }
  static void* copy(void* to, const void*, std::size_t, H5FD_file_image_op_t, void*) { return to; }
  static void* reallocate(void*, std::size_t, H5FD_file_image_op_t, void*) { return nullptr; }
  static herr_t release(void*, H5FD_file_image_op_t, void*) { return 0; }
  static void* copy_data(void* data) { return data; }
  static herr_t release_data(void*) { return 0; }
};

H5Handle open_file(const fs::path& path, std::span<const unsigned char> content, SharedImage& image) {
  const H5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  if (!content.empty()) {
    image.bytes = const_cast<unsigned char*>(content.data());  // the file is opened read-only
    H5FD_file_image_callbacks_t callbacks{SharedImage::allocate,     SharedImage::copy,      SharedImage::reallocate,
                                          SharedImage::release,      SharedImage::copy_data, SharedImage::release_data,
                                          static_cast<void*>(&image)};
    H5Pset_fapl_core(access.id(), 1, false);
    H5Pset_file_image_callbacks(access.id(), &callbacks);
    H5Pset_file_image(access.id(), image.bytes, content.size());
  }
  // The memory driver refuses the name of an existing file.
  const std::string name = content.empty() ? path.string() : path.string() + ".in-memory";
  return {H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose};
}

/// The links of one group.
struct Links {
  std::vector<haddr_t> hard;
  std::vector<haddr_t> soft;          ///< targets of soft links
  std::vector<std::string> external;  ///< file names
  bool out_of_memory = false;
};

/// Callback of H5Literate. Exceptions must not pass through HDF5.
herr_t add_link(hid_t group, const char* name, const H5L_info_t* info, void* to) {
  auto& links = *static_cast<Links*>(to);
  try {
    if (info->type == H5L_TYPE_HARD) links.hard.push_back(info->u.address);
    if (info->type == H5L_TYPE_SOFT) {
      H5O_info_t object;
      if (H5Oget_info_by_name(group, name, &object, H5P_DEFAULT) >= 0) links.soft.push_back(object.addr);
    }
    if (info->type == H5L_TYPE_EXTERNAL) {
      std::vector<char> value(info->u.val_size);
      const char* file = nullptr;
      unsigned flags = 0;
      if (H5Lget_val(group, name, value.data(), value.size(), H5P_DEFAULT) < 0 ||
          H5Lunpack_elink_val(value.data(), value.size(), &flags, &file, nullptr) < 0)
        return -1;
      links.external.emplace_back(file);
    }
  } catch (const std::bad_alloc&) {
    links.out_of_memory = true;
    return -1;
  }
  return 0;
}

class LinkChecker {
 public:
  LinkChecker(const fs::path& path, Hdf5Reader reader, bool allow_outside)
      : path_(path), reader_(reader), allow_outside_(allow_outside) {}

  std::uint64_t run(std::span<const unsigned char> content) {
    bytes_ = content.empty() ? size_of_file(path_) : content.size();
    in_memory_ = !content.empty();
    walk(path_, content);
    while (!files_.empty()) {
      const fs::path next = files_.back();
      files_.pop_back();
      walk(next, {});
    }
    if (reader_ == Hdf5Reader::netcdf) expect_objects(objects_);
    return bytes_;
  }

 private:
  struct Object {
    haddr_t address;
    int depth;
  };

  [[noreturn]] void damaged(const fs::path& file) const {
    fail(ErrorCode::MalformedFile, file, "its groups cannot be listed by HDF5; expected a whole HDF5 file");
  }

  void walk(const fs::path& file, std::span<const unsigned char> content) {
    SharedImage image{};
    const H5Handle handle = open_file(file, content, image);
    if (handle.id() < 0)
      fail(ErrorCode::MalformedFile, file, "cannot be opened as HDF5; expected a whole, undamaged HDF5 file");
    std::set<haddr_t> seen;
    std::vector<Object> open;
    H5O_info_t root;
    if (H5Oget_info(handle.id(), &root) >= 0) seen.insert(root.addr);
    list(file, handle.id(), 0, seen, open);
    while (!open.empty()) {
      const Object object = open.back();
      open.pop_back();
      const H5Handle opened(H5Oopen_by_addr(handle.id(), object.address), H5Oclose);
      if (opened.id() < 0) continue;  // readers get the same failure
      const H5I_type_t type = H5Iget_type(opened.id());
      if (type == H5I_GROUP) list(file, opened.id(), object.depth, seen, open);
      if (type == H5I_DATASET) check_dataset(file, opened.id());
    }
  }

  /// Checks the links of a group, and adds its objects to `open`.
  void list(const fs::path& file, hid_t group, int depth, std::set<haddr_t>& seen, std::vector<Object>& open) {
    constexpr int kDeepest = 32;
    if (depth > kDeepest)
      fail(ErrorCode::MalformedFile, file, "groups nested deeper than {}; expected at most {}", kDeepest, kDeepest);
    Links links;
    if (H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add_link, &links) < 0) {
      if (links.out_of_memory) throw std::bad_alloc();
      damaged(file);
    }
    for (const std::string& name : links.external) check_name(file, name, "an external link");
    objects_ += links.hard.size() + links.soft.size() + links.external.size();
    for (const haddr_t address : links.hard)
      if (seen.insert(address).second)
        open.push_back({address, depth + 1});
      else if (reader_ == Hdf5Reader::netcdf)
        require_no_group(file, group, address);
    if (reader_ != Hdf5Reader::netcdf) return;
    for (const haddr_t address : links.soft) require_no_group(file, group, address);
  }

  /// netCDF-C reads groups as a tree: a group with two links would be read twice, and a group inside itself endlessly.
  void require_no_group(const fs::path& file, hid_t group, haddr_t address) const {
    const H5Handle object(H5Oopen_by_addr(group, address), H5Oclose);
    if (object.id() >= 0 && H5Iget_type(object.id()) == H5I_GROUP)
      fail(ErrorCode::MalformedFile, file,
           "two links lead to the group at byte {}; expected groups that form a tree, as netCDF has them", address);
  }

  void check_dataset(const fs::path& file, hid_t dataset) {
    const H5Handle properties(H5Dget_create_plist(dataset), H5Pclose);
    if (properties.id() < 0) return;
    const H5D_layout_t layout = H5Pget_layout(properties.id());
    const int external = layout == H5D_CONTIGUOUS ? H5Pget_external_count(properties.id()) : 0;
    for (int i = 0; i < external; ++i) check_external(file, properties.id(), static_cast<unsigned>(i));
    if (layout != H5D_VIRTUAL) return;
    std::size_t sources = 0;
    H5Pget_virtual_count(properties.id(), &sources);
    std::string last;
    for (std::size_t i = 0; i < sources; ++i) {
      const ssize_t length = H5Pget_virtual_filename(properties.id(), i, nullptr, 0);
      if (length < 0) damaged(file);
      std::string name(static_cast<std::size_t>(length) + 1, '\0');
      H5Pget_virtual_filename(properties.id(), i, name.data(), name.size());
      name.pop_back();
      if (name == "." || name == last) continue;  // "." is the file itself
      // HDF5 replaces %b by block numbers.
      if (!allow_outside_ && name.find('%') != std::string::npos)
        fail(ErrorCode::UnsupportedData, file,
             "a virtual dataset of the files '{}'; expected names without '%', or the option allow_outside_paths "
             "(--allow-outside-paths)",
             name);
      check_name(file, name, "a virtual dataset");
      last = std::move(name);
    }
  }

  void check_external(const fs::path& file, hid_t properties, unsigned i) {
    std::array<char, 8192> name{};
    off_t offset = 0;
    hsize_t size = 0;
    if (H5Pget_external(properties, i, name.size() - 1, name.data(), &offset, &size) < 0) damaged(file);
    const fs::path from = reader_ == Hdf5Reader::netcdf ? fs::current_path() : fs::absolute(file).parent_path();
    const fs::path target = named_path(path_, (from / name.data()).string(), allow_outside_);
    require_no_device(file, target);
    if (named_.insert(target).second && fs::is_regular_file(target)) bytes_ += size_of_file(target);
  }

  /// HDF5 would block forever at a pipe.
  static void require_no_device(const fs::path& file, const fs::path& target) {
    std::error_code error;
    if (fs::exists(target, error) && !fs::is_regular_file(target, error))
      fail(ErrorCode::UnsupportedData, file, "refers to '{}', which is not a regular file; expected one",
           target.string());
  }

  /// Checks a file whose datasets or groups HDF5 opens.
  void check_name(const fs::path& file, const std::string& name, const char* what) {
    // HDF5 does not know the folder of a file in memory.
    const fs::path folder = in_memory_ && file == path_ ? fs::current_path() : fs::absolute(file).parent_path();
    const fs::path target = named_path(path_, (folder / name).string(), allow_outside_);
    require_no_device(file, target);
    std::error_code error;
    if (!fs::is_regular_file(target, error)) {
      if (allow_outside_) return;
      fail(ErrorCode::UnsupportedData, file, "{} to the file '{}', which does not exist as {}; expected a file there",
           what, name, target.string());
    }
    if (!named_.insert(fs::canonical(target)).second) return;
    bytes_ += size_of_file(target);
    files_.push_back(target);
  }

  const fs::path& path_;
  Hdf5Reader reader_;
  bool allow_outside_;
  bool in_memory_ = false;
  std::uint64_t bytes_ = 0;
  std::uint64_t objects_ = 0;    ///< number of links
  std::set<fs::path> named_;     ///< files already counted
  std::vector<fs::path> files_;  ///< HDF5 files still to be checked
};

}  // namespace

std::uint64_t check_hdf5_links(const fs::path& path, std::span<const unsigned char> content, Hdf5Reader reader,
                               bool allow_outside_paths) {
  const H5Quiet quiet;
  return LinkChecker(path, reader, allow_outside_paths).run(content);
}

}  // namespace tegl::io_detail
