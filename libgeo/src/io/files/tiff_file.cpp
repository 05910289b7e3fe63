#include "tiff_file.hpp"

#include <xtiffio.h>

#include <array>
#include <cstdarg>
#include <cstdio>

namespace geo::io {
namespace {

int keep_reason(TIFF*, void* reason, const char*, const char* format, va_list arguments) {
  std::array<char, 256> text;
  std::vsnprintf(text.data(), text.size(), format, arguments);
  auto& kept = *static_cast<std::string*>(reason);
  if (kept.empty()) kept = text.data();
  return 1;
}

int ignore(TIFF*, void*, const char*, const char*, va_list) { return 1; }

}  // namespace

TiffFile::TiffFile(const std::filesystem::path& path, const char* mode) {
  XTIFFInitialize();
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
      TIFFOpenOptionsAlloc(), TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_reason, &reason_);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore, nullptr);
  tiff_.reset(TIFFOpenExt(path.c_str(), mode, options.get()));
}

}  // namespace geo::io
