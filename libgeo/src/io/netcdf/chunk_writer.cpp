#include "chunk_writer.hpp"

#include <hdf5.h>
#include <libdeflate.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "netcdf_file.hpp"

namespace geo::io {
namespace {

void require(bool good) {
  if (!good) throw nc::Failure(NC_EHDFERR);
}

struct FreeCompressor {
  void operator()(libdeflate_compressor* compressor) const {
    libdeflate_free_compressor(compressor);
  }
};
using Compressor = std::unique_ptr<libdeflate_compressor, FreeCompressor>;

/// A dataset that closes itself.
class Dataset {
 public:
  Dataset(hid_t file, std::string_view name)
      : id_(H5Dopen2(file, std::string(name).c_str(), H5P_DEFAULT)) {
    require(id_ >= 0);
  }
  ~Dataset() { H5Dclose(id_); }
  Dataset(const Dataset&) = delete;
  Dataset& operator=(const Dataset&) = delete;
  [[nodiscard]] hid_t id() const { return id_; }

 private:
  hid_t id_;
};

/// HDF5's shuffle: first bytes of all values, then second bytes, and so on.
template <std::size_t kBytes>
void shuffle(const unsigned char* from, std::size_t values, unsigned char* to) {
  for (std::size_t byte = 0; byte < kBytes; ++byte) {
    for (std::size_t k = 0; k < values; ++k) to[byte * values + k] = from[k * kBytes + byte];
  }
}

/// Of a raster that is the only one of its time, or of none: dimensions before rows and columns.
int leading_dimensions(hid_t dataset) {
  const hid_t space = H5Dget_space(dataset);
  const int dimensions = H5Sget_simple_extent_ndims(space);
  H5Sclose(space);
  require(dimensions == 2 || dimensions == 3);
  return dimensions - 2;
}

/// `copy(row, column, count, to)` gives values of a part of a row.
template <class T, class Copy>
void write_chunks(hid_t dataset, const Copy& copy, int ny, int nx, ChunkShape chunk, int level,
                  int slice) {
  const std::size_t cells = chunk.rows * chunk.columns, bytes = cells * sizeof(T);
  std::vector<T> raw(cells);
  std::vector<unsigned char> shuffled(bytes);
  const int leading = leading_dimensions(dataset);
  const Compressor compressor(libdeflate_alloc_compressor(level));
  if (!compressor) throw std::bad_alloc();
  std::vector<unsigned char> packed(libdeflate_zlib_compress_bound(compressor.get(), bytes));
  for (std::size_t row = 0; row < static_cast<std::size_t>(ny); row += chunk.rows) {
    for (std::size_t column = 0; column < static_cast<std::size_t>(nx); column += chunk.columns) {
      const std::size_t rows = std::min(chunk.rows, ny - row);
      const std::size_t columns = std::min(chunk.columns, nx - column);
      // Beyond the edge of the raster a chunk holds zeros that nobody reads.
      if (rows < chunk.rows || columns < chunk.columns) std::fill(raw.begin(), raw.end(), T{});
      for (std::size_t j = 0; j < rows; ++j) {
        copy(row + j, column, columns, raw.data() + j * chunk.columns);
      }
      shuffle<sizeof(T)>(reinterpret_cast<const unsigned char*>(raw.data()), cells,
                         shuffled.data());
      const std::size_t size = libdeflate_zlib_compress(compressor.get(), shuffled.data(), bytes,
                                                        packed.data(), packed.size());
      require(size > 0);
      const hsize_t offset[3] = {static_cast<hsize_t>(slice), row, column};
      require(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, offset + 1 - leading, size, packed.data()) >=
              0);
    }
  }
}

}  // namespace

struct ChunkWriter::Implementation {
  std::unique_lock<std::recursive_mutex> lock = nc::lock_library();
  hid_t file = -1;
  int level = 0;
};

ChunkWriter::ChunkWriter(const std::filesystem::path& path, int level)
    : implementation_(std::make_unique<Implementation>()) {
  implementation_->level = level;
  implementation_->file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  require(implementation_->file >= 0);
}

ChunkWriter::~ChunkWriter() {
  if (implementation_->file >= 0) H5Fclose(implementation_->file);
}

void ChunkWriter::write(std::string_view variable, const Values& values, int ny, int nx,
                        ChunkShape chunk, int slice) const {
  const Dataset dataset(implementation_->file, variable);
  const int level = implementation_->level;
  const auto write_array = [&]<class T>(const std::vector<T>& array) {
    const auto copy = [&](std::size_t row, std::size_t column, std::size_t count, T* to) {
      std::copy_n(array.data() + row * nx + column, count, to);
    };
    write_chunks<T>(dataset.id(), copy, ny, nx, chunk, level, slice);
  };
  std::visit(write_array, values);
}

void ChunkWriter::write_rows(std::string_view variable, std::span<const double> value_of_row,
                             int nx, ChunkShape chunk) const {
  const Dataset dataset(implementation_->file, variable);
  const auto copy = [&](std::size_t row, std::size_t /*column*/, std::size_t count, double* to) {
    std::fill_n(to, count, value_of_row[row]);
  };
  write_chunks<double>(dataset.id(), copy, static_cast<int>(value_of_row.size()), nx, chunk,
                       implementation_->level, 0);
}

void ChunkWriter::close() { require(H5Fclose(std::exchange(implementation_->file, -1)) >= 0); }

}  // namespace geo::io
