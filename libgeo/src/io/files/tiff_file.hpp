#pragma once

#include <tiffio.h>

#include <filesystem>
#include <memory>
#include <string>

namespace geo::io {

/// A file of libtiff that knows GeoTIFF's tags. What libtiff complains of is kept, not printed, and
/// its warnings are dropped.
class TiffFile {
 public:
  /// `mode` as TIFFOpen has it; `get()` is null where libtiff refuses.
  TiffFile(const std::filesystem::path& path, const char* mode);
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  [[nodiscard]] TIFF* get() const { return tiff_.get(); }
  /// Why libtiff gave up, in its own words; the first reason, which is the best. May be empty.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  std::string reason_;
  std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff_{nullptr, TIFFClose};
};

}  // namespace geo::io
