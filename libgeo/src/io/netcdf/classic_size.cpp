#include "classic_size.hpp"

#include <fmt/format.h>
#include <netcdf.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <vector>

#include "geo/core/error.hpp"

namespace geo::io {
namespace {

/// Walks the header of the NetCDF classic format specification (versions 1, 2 and 5: 32-bit,
/// 64-bit offsets, 64-bit data).
class ClassicHeader {
 public:
  ClassicHeader(std::ifstream& stream, int version) : stream_(stream), version_(version) {
    records_ = count();
    list([this] {
      name();
      dimensions_.push_back(count());
    });
    list([this] { attribute(); });
    list([this] { variable(); });
  }

  /// Bytes that the file must hold, give or take the padding of its last value.
  [[nodiscard]] std::uint64_t size() const {
    std::uint64_t end = fixed_end_;
    // Records of size unknown while streaming are counted as none.
    const std::uint64_t streaming = version_ == 5 ? UINT64_MAX : UINT32_MAX;
    if (records_ > 0 && records_ != streaming && record_bytes_ > 0) {
      end = std::max(end, record_start_ + record_bytes_ * records_);
    }
    return end;
  }
  [[nodiscard]] bool is_whole() const { return static_cast<bool>(stream_); }

 private:
  std::uint64_t big_endian(int bytes) {
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) value = value << 8 | static_cast<unsigned char>(stream_.get());
    return stream_ ? value : 0;
  }
  std::uint64_t count() { return big_endian(version_ == 5 ? 8 : 4); }
  void skip_padded(std::uint64_t bytes) {
    stream_.ignore(static_cast<std::streamsize>((bytes + 3) / 4 * 4));
  }
  void name() { skip_padded(count()); }

  template <class Entry>
  void list(const Entry& entry) {
    big_endian(4);
    const std::uint64_t entries = count();
    for (std::uint64_t i = 0; i < entries && stream_; ++i) entry();
  }

  static std::uint64_t bytes_of(std::uint64_t type) {
    constexpr std::array<std::uint64_t, 12> kBytes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    return type < kBytes.size() ? kBytes[type] : 0;
  }
  void attribute() {
    name();
    const std::uint64_t type = big_endian(4);
    skip_padded(count() * bytes_of(type));
  }

  void variable() {
    name();
    const std::uint64_t dimensions = count();
    bool is_record = false;
    std::uint64_t values = 1;
    for (std::uint64_t i = 0; i < dimensions && stream_; ++i) {
      const std::uint64_t dimension = count();
      const std::uint64_t length = dimension < dimensions_.size() ? dimensions_[dimension] : 1;
      if (length == 0) {
        is_record = true;
      } else {
        values *= length;
      }
    }
    list([this] { attribute(); });
    const std::uint64_t bytes = values * bytes_of(big_endian(4));
    count();  // size in the header: redundant, and too short for large variables
    const std::uint64_t begin = big_endian(version_ == 1 ? 4 : 8);
    if (is_record) {
      record_start_ = record_bytes_ == 0 ? begin : std::min(record_start_, begin);
      // One lone record variable is not padded; the difference is below the tolerance of size().
      record_bytes_ += bytes;
    } else {
      fixed_end_ = std::max(fixed_end_, begin + bytes);
    }
  }

  std::ifstream& stream_;
  int version_;
  std::uint64_t records_ = 0;
  std::vector<std::uint64_t> dimensions_;
  std::uint64_t fixed_end_ = 0, record_start_ = 0, record_bytes_ = 0;
};

}  // namespace

void check_classic_size(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::array<char, 4> magic{};
  stream.read(magic.data(), magic.size());
  if (!stream || magic[0] != 'C' || magic[1] != 'D' || magic[2] != 'F') return;
  const ClassicHeader header(stream, magic[3]);
  const auto size = std::filesystem::file_size(path);
  if (!header.is_whole() || size < header.size()) {
    throw InputError(fmt::format("{}: truncated: {} bytes of {}", path.string(), size,
                                 header.is_whole() ? std::to_string(header.size()) : "its header"));
  }
}

}  // namespace geo::io
