// SPDX-License-Identifier: BSD-3-Clause
//
// ITK's ImageIO classes, used directly: the raw buffer, no templates and no factories.
#include "itk_values.hpp"

#include <iostream>
#include <new>
#include <streambuf>
#include <string>

#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

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

itk::ImageIOBase::Pointer make_io(ItkFormat format) {
  switch (format) {
    case ItkFormat::Nifti:
      return itk::NiftiImageIO::New().GetPointer();
    case ItkFormat::Nrrd:
      return itk::NrrdImageIO::New().GetPointer();
    default:
      return itk::MetaImageIO::New().GetPointer();
  }
}

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

ItkValues read_all(itk::ImageIOBase& io, const std::filesystem::path& path, std::uint64_t expected) {
  io.SetFileName(path.string());
  io.ReadImageInformation();
  const std::uint64_t count = select_all(io);
  if (count != expected)
    fail(ErrorCode::MalformedFile, path, "ITK finds {} values; expected {} from the header", count, expected);
  ItkValues result{array_for(io.GetComponentType(), path), io.GetNumberOfComponents()};
  std::visit(
      [&](auto& values) {
        values.resize(static_cast<std::size_t>(count));
        io.Read(values.data());
      },
      result.values);
  return result;
}

}  // namespace

ItkValues read_itk_values(ItkFormat format, const std::filesystem::path& path, std::uint64_t expected) {
  const Quiet quiet;
  try {
    return read_all(*make_io(format), path, expected);
  } catch (const Error&) {
    throw;
  } catch (const itk::ExceptionObject& e) {
    fail(ErrorCode::MalformedFile, path, "cannot be read ({})", one_line(e.GetDescription()));
  } catch (const std::bad_alloc&) {
    fail(ErrorCode::TooLarge, path, "{} values do not fit into memory", expected);
  } catch (const std::exception& e) {
    fail(ErrorCode::MalformedFile, path, "cannot be read ({})", one_line(e.what()));
  }
}

}  // namespace tegl::io_detail
