// SPDX-License-Identifier: BSD-3-Clause
//
// ITK's MetaImageIO, used directly (the raw buffer, no templates and no factories), and ITK's NrrdIO.
#include "itk_values.hpp"

#include <cstdlib>
#include <iostream>
#include <memory>
#include <new>
#include <streambuf>
#include <string>

#include <NrrdIO.h>
#include <itkMetaImageIO.h>

#include "common.hpp"

namespace tegl::io_detail {

namespace {

using Component = itk::IOComponentEnum;

class NullBuffer : public std::streambuf {
 protected:
  int_type overflow(int_type c) override { return traits_type::not_eof(c); }
  std::streamsize xsputn(const char*, std::streamsize count) override { return count; }
};

/// Silences ITK's warnings and MetaIO's writing to cout and cerr for its lifetime; errors come as exceptions.
class Quiet {
 public:
  Quiet()
      : cout_(std::cout.rdbuf(&null_)),
        cerr_(std::cerr.rdbuf(&null_)),
        warnings_(itk::Object::GetGlobalWarningDisplay()) {
    itk::Object::SetGlobalWarningDisplay(false);
  }
  ~Quiet() {
    itk::Object::SetGlobalWarningDisplay(warnings_);
    std::cerr.rdbuf(cerr_);
    std::cout.rdbuf(cout_);
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  NullBuffer null_;
  std::streambuf* cout_;
  std::streambuf* cerr_;
  bool warnings_;
};

/// ITK's descriptions run over several lines and name source files; one line of it is enough.
std::string one_line(const char* description) {
  std::string result;
  for (const std::string_view word : words(description)) {
    if (!result.empty()) result += ' ';
    result += word;
  }
  constexpr std::size_t kLongest = 300;
  if (result.size() > kLongest) result = result.substr(0, kLongest) + "...";
  return result;
}

/// An empty array of the component type.
ValueArray array_for(Component type, const std::filesystem::path& path) {
  static_assert(sizeof(long) == 8, "ITK's LONG is taken as 64 bits");
  switch (type) {
    case Component::UCHAR:
      return std::vector<std::uint8_t>();
    case Component::CHAR:
      return std::vector<std::int8_t>();
    case Component::USHORT:
      return std::vector<std::uint16_t>();
    case Component::SHORT:
      return std::vector<std::int16_t>();
    case Component::UINT:
      return std::vector<std::uint32_t>();
    case Component::INT:
      return std::vector<std::int32_t>();
    case Component::ULONG:
    case Component::ULONGLONG:
      return std::vector<std::uint64_t>();
    case Component::LONG:
    case Component::LONGLONG:
      return std::vector<std::int64_t>();
    case Component::FLOAT:
      return std::vector<float>();
    case Component::DOUBLE:
      return std::vector<double>();
    default:
      break;
  }
  fail(ErrorCode::UnsupportedData, path, "values of type {}; expected integers of 8 to 64 bits, float or double",
       itk::ImageIOBase::GetComponentTypeAsString(type));
}

/// The whole image as region to read, and the number of its samples times components.
std::uint64_t select_all(itk::ImageIOBase& io) {
  const unsigned n = io.GetNumberOfDimensions();
  itk::ImageIORegion region(n);
  std::uint64_t count = io.GetNumberOfComponents();
  for (unsigned d = 0; d < n; ++d) {
    region.SetIndex(d, 0);
    region.SetSize(d, io.GetDimensions(d));
    if (__builtin_mul_overflow(count, std::uint64_t{io.GetDimensions(d)}, &count)) return 0;
  }
  io.SetIORegion(region);
  return count;
}

[[noreturn]] void fail_count(const std::filesystem::path& path, std::uint64_t found, std::uint64_t expected) {
  fail(ErrorCode::MalformedFile, path, "ITK finds {} values; expected {} from the header", found, expected);
}

ValueArray read_all(itk::ImageIOBase& io, const std::filesystem::path& path, std::uint64_t expected) {
  io.SetFileName(path.string());
  io.ReadImageInformation();
  const std::uint64_t count = select_all(io);
  if (count != expected) fail_count(path, count, expected);
  ValueArray result = array_for(io.GetComponentType(), path);
  std::visit(
      [&](auto& values) {
        values.resize(static_cast<std::size_t>(count));
        io.Read(values.data());
      },
      result);
  return result;
}

struct NukeNrrd {
  void operator()(Nrrd* nrrd) const noexcept { nrrdNuke(nrrd); }
};

template <class T>
ValueArray copied(const Nrrd& nrrd, std::uint64_t count) {
  const T* first = static_cast<const T*>(nrrd.data);
  return std::vector<T>(first, first + count);
}

ValueArray values_of(const Nrrd& nrrd, std::uint64_t count, const std::filesystem::path& path) {
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

ValueArray read_metaimage_values(const std::filesystem::path& path, std::uint64_t expected) {
  const Quiet quiet;
  try {
    return read_all(*itk::MetaImageIO::New(), path, expected);
  } catch (const Error&) {
    throw;
  } catch (const itk::ExceptionObject& e) {
    fail(ErrorCode::MalformedFile, path, "cannot be read ({})", one_line(e.GetDescription()));
  } catch (const std::bad_alloc&) {
    fail(ErrorCode::TooLarge, path, "{} values do not fit into memory", expected);
  }
}

ValueArray read_nrrd_values(const std::filesystem::path& path, std::uint64_t expected) {
  const Quiet quiet;
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
    fail(ErrorCode::TooLarge, path, "{} values do not fit into memory", expected);
  }
}

}  // namespace tegl::io_detail
