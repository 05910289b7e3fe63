// What chunks are packed with: streams that zlib itself reads, whatever level.
#include "io/netcdf/chunk_compressor.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <vector>

#include "geo/core/random.hpp"

namespace geo::io {
namespace {

using Bytes = std::vector<unsigned char>;

/// As smooth as the high bytes of a raster, or such as nothing packs.
Bytes sample(std::size_t size, bool is_noise) {
  const RandomStream random(5, "bytes");
  Bytes bytes(size);
  for (std::size_t n = 0; n < size; ++n) {
    bytes[n] = is_noise ? static_cast<unsigned char>(256.0 * random.uniform(n))
                        : static_cast<unsigned char>(n / 500);
  }
  return bytes;
}

TEST(ChunkCompressor, MakesStreamsThatZlibReads) {
  for (const int level : {1, 2, 5, 9}) {
    ChunkCompressor compressor(level);
    for (const bool is_noise : {false, true}) {
      for (const std::size_t size : {1UL, 100UL, 262144UL, 1000003UL}) {
        const Bytes raw = sample(size, is_noise);
        Bytes packed(compressor.bound(size)), back(size);
        const std::size_t packed_size = compressor.compress(raw, packed);
        ASSERT_GT(packed_size, 0U);
        ASSERT_LE(packed_size, packed.size());
        uLongf length = size;
        ASSERT_EQ(uncompress(back.data(), &length, packed.data(), packed_size), Z_OK)
            << level << ' ' << is_noise << ' ' << size;
        EXPECT_EQ(back, raw);
        if (!is_noise && size > 1000) EXPECT_LT(packed_size, size / 20);
      }
    }
  }
}

TEST(ChunkCompressor, MakesTheSameStreamEachTime) {
  const Bytes raw = sample(300000, false);
  ChunkCompressor first(1), second(1);
  Bytes a(first.bound(raw.size())), b(a.size());
  a.resize(first.compress(raw, a));
  first.compress(sample(1000, true), b);  // what went before leaves no trace
  const std::size_t size = first.compress(raw, b);
  EXPECT_EQ(Bytes(b.begin(), b.begin() + static_cast<std::ptrdiff_t>(size)), a);
  Bytes c(a.size() + 100000);
  c.resize(second.compress(raw, c));
  EXPECT_EQ(c, a);
}

}  // namespace
}  // namespace geo::io
