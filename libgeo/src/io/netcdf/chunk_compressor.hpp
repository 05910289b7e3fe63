#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

struct isal_zstream;
struct libdeflate_compressor;

namespace geo::io {

/// Compresses chunks into streams that any zlib reads. Level 1, the default of files, is ISA-L's:
/// four times as fast as libdeflate's for files that are 3 % larger. The others, 2 to 9, are
/// libdeflate's. One thread at a time.
class ChunkCompressor {
 public:
  explicit ChunkCompressor(int level);
  ChunkCompressor(ChunkCompressor&&) noexcept;
  ~ChunkCompressor();

  /// Of so many bytes, at most.
  [[nodiscard]] std::size_t bound(std::size_t bytes) const;
  /// Bytes written to `to`, which has room for `bound`. Allocates nothing.
  std::size_t compress(std::span<const unsigned char> from, std::span<unsigned char> to);

 private:
  struct Free {
    void operator()(libdeflate_compressor* compressor) const;
  };

  std::size_t compress_fast(std::span<const unsigned char> from, std::span<unsigned char> to);

  std::unique_ptr<libdeflate_compressor, Free> thorough_;
  std::unique_ptr<isal_zstream> fast_;  ///< or none
  std::vector<unsigned char> tables_;   ///< of that
};

}  // namespace geo::io
