// SPDX-License-Identifier: BSD-3-Clause
//
// NrrdIO and MetaIO, as they come with ITK.
#include "itk_values.hpp"

#include <cstdlib>
#include <iostream>
#include <memory>
#include <new>
#include <streambuf>
#include <string>

#include <NrrdIO.h>
#include <metaImage.h>

#include "common.hpp"

namespace tegl::io_detail {

namespace fs = std::filesystem;

namespace {

class NullBuffer : public std::streambuf {
 protected:
  int_type overflow(int_type c) override { return traits_type::not_eof(c); }
  std::streamsize xsputn(const char*, std::streamsize count) override { return count; }
};

/// Keeps MetaIO from writing to cout and cerr for its lifetime; there is no other way to stop it.
class Quiet {
 public:
  Quiet() : cout_(std::cout.rdbuf(&null_)), cerr_(std::cerr.rdbuf(&null_)) {}
  ~Quiet() {
    std::cerr.rdbuf(cerr_);
    std::cout.rdbuf(cout_);
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  NullBuffer null_;
  std::streambuf* cout_;
  std::streambuf* cerr_;
};

/// NrrdIO's reasons run over several lines, one per function on the way; as one line, and not too long.
std::string one_line(const char* reasons) {
  std::string result = fmt::format("{}", fmt::join(words(reasons), " "));
  constexpr std::size_t kLongest = 300;
  if (result.size() > kLongest) result = result.substr(0, kLongest) + "...";
  return result;
}

[[noreturn]] void fail_count(const fs::path& path, std::uint64_t found, std::uint64_t expected) {
  fail(ErrorCode::MalformedFile, path, "{} values found; expected {} from the header", found, expected);
}

[[noreturn]] void fail_memory(const fs::path& path, std::uint64_t expected) {
  fail(ErrorCode::TooLarge, path, "{} values do not fit into memory", expected);
}

struct NukeNrrd {
  void operator()(Nrrd* nrrd) const noexcept { nrrdNuke(nrrd); }
};

template <class T>
ValueArray copied(const Nrrd& nrrd, std::uint64_t count) {
  const T* first = static_cast<const T*>(nrrd.data);
  return ValueVector<T>(first, first + count);
}

ValueArray values_of(const Nrrd& nrrd, std::uint64_t count, const fs::path& path) {
  switch (nrrd.type) {
    case nrrdTypeChar:
      return copied<std::int8_t>(nrrd, count);
    case nrrdTypeUChar:
      return copied<std::uint8_t>(nrrd, count);
    case nrrdTypeShort:
      return copied<std::int16_t>(nrrd, count);
    case nrrdTypeUShort:
      return copied<std::uint16_t>(nrrd, count);
    case nrrdTypeInt:
      return copied<std::int32_t>(nrrd, count);
    case nrrdTypeUInt:
      return copied<std::uint32_t>(nrrd, count);
    case nrrdTypeLLong:
      return copied<std::int64_t>(nrrd, count);
    case nrrdTypeULLong:
      return copied<std::uint64_t>(nrrd, count);
    case nrrdTypeFloat:
      return copied<float>(nrrd, count);
    case nrrdTypeDouble:
      return copied<double>(nrrd, count);
    default:
      fail(ErrorCode::UnsupportedData, path, "values that are no numbers; expected integers, float or double");
  }
}

}  // namespace

void read_metaimage_values(const fs::path& path, std::uint64_t expected, ValueArray& values) {
  const Quiet quiet;
  MetaImage image;
  const bool known = image.Read(path.c_str(), false);
  auto found = static_cast<std::uint64_t>(known ? image.ElementNumberOfChannels() : 0);
  for (int d = 0; known && d < image.NDims(); ++d) found *= static_cast<std::uint64_t>(image.DimSize(d));
  if (known && found != expected) fail_count(path, found, expected);
  const bool read = known && std::visit(
                                 [&](auto& array) {
                                   try {
                                     array.resize(static_cast<std::size_t>(expected), {});
                                   } catch (const std::bad_alloc&) {
                                     fail_memory(path, expected);
                                   }
                                   return image.Read(path.c_str(), true, array.data());
                                 },
                                 values);
  if (!read) fail(ErrorCode::MalformedFile, path, "cannot be read (MetaIO gives no reason)");
  image.ElementByteOrderFix();
}

ValueArray read_nrrd_values(const fs::path& path, std::uint64_t expected) {
  const std::unique_ptr<Nrrd, NukeNrrd> nrrd(nrrdNew());
  if (nrrdLoad(nrrd.get(), path.c_str(), nullptr) != 0) {
    const std::unique_ptr<char, decltype(&std::free)> reasons(biffGetDone(NRRD), &std::free);
    fail(ErrorCode::MalformedFile, path, "cannot be read ({})", one_line(reasons ? reasons.get() : "no reason given"));
  }
  const std::uint64_t count = nrrdElementNumber(nrrd.get());
  if (count != expected) fail_count(path, count, expected);
  try {
    return values_of(*nrrd, count, path);
  } catch (const std::bad_alloc&) {
    fail_memory(path, expected);
  }
}

}  // namespace tegl::io_detail
