#include "chunk_compressor.hpp"

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>

#include <cstdint>
#include <new>

namespace geo::io {

ChunkCompressor::ChunkCompressor(int level) : thorough_(libdeflate_alloc_compressor(level)) {
  if (!thorough_) throw std::bad_alloc();
  if (level != 1) return;
  fast_ = std::make_unique<isal_zstream>();
  tables_.resize(ISAL_DEF_LVL2_DEFAULT);
}
ChunkCompressor::ChunkCompressor(ChunkCompressor&&) noexcept = default;
ChunkCompressor::~ChunkCompressor() = default;
void ChunkCompressor::Free::operator()(libdeflate_compressor* compressor) const {
  libdeflate_free_compressor(compressor);
}

std::size_t ChunkCompressor::bound(std::size_t bytes) const {
  return libdeflate_zlib_compress_bound(thorough_.get(), bytes);
}

std::size_t ChunkCompressor::compress(std::span<const unsigned char> from,
                                      std::span<unsigned char> to) {
  if (fast_) {
    if (const std::size_t size = compress_fast(from, to); size > 0) return size;
  }
  return libdeflate_zlib_compress(thorough_.get(), from.data(), from.size(), to.data(), to.size());
}

/// 0 if `to` has no room, as ISA-L tells no bound.
std::size_t ChunkCompressor::compress_fast(std::span<const unsigned char> from,
                                           std::span<unsigned char> to) {
  isal_deflate_init(fast_.get());
  fast_->level = 2;
  fast_->level_buf = tables_.data();
  fast_->level_buf_size = static_cast<std::uint32_t>(tables_.size());
  fast_->gzip_flag = IGZIP_ZLIB;
  fast_->end_of_stream = 1;
  fast_->next_in = const_cast<unsigned char*>(from.data());
  fast_->avail_in = static_cast<std::uint32_t>(from.size());
  fast_->next_out = to.data();
  fast_->avail_out = static_cast<std::uint32_t>(to.size());
  const bool is_done =
      isal_deflate(fast_.get()) == COMP_OK && fast_->internal_state.state == ZSTATE_END;
  return is_done ? fast_->total_out : 0;
}

}  // namespace geo::io
