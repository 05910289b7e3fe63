#include "chunk_writer.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "chunk_compressor.hpp"
#include "geo/io/files/background_writer.hpp"
#include "netcdf_file.hpp"

namespace geo::io {
namespace {

void require(bool good) {
  if (!good) throw nc::Failure(NC_EHDFERR);
}

/// A dataset that closes itself. The library is one thread's at a time: it is taken for each call,
/// so that others read while chunks are packed.
class Dataset {
 public:
  Dataset(hid_t file, std::string_view name) {
    const auto lock = nc::lock_library();
    id_ = H5Dopen2(file, std::string(name).c_str(), H5P_DEFAULT);
    require(id_ >= 0);
  }
  ~Dataset() {
    const auto lock = nc::lock_library();
    H5Dclose(id_);
  }
  Dataset(const Dataset&) = delete;
  Dataset& operator=(const Dataset&) = delete;
  [[nodiscard]] hid_t id() const { return id_; }

 private:
  hid_t id_ = -1;
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
  const auto lock = nc::lock_library();
  const hid_t space = H5Dget_space(dataset);
  const int dimensions = H5Sget_simple_extent_ndims(space);
  H5Sclose(space);
  require(dimensions == 2 || dimensions == 3);
  return dimensions - 2;
}

/// Packs chunks one after the other.
template <class T>
class Packer {
 public:
  Packer(ChunkShape chunk, int level)
      : chunk_(chunk),
        compressor_(level),
        raw_(chunk.rows * chunk.columns),
        shuffled_(raw_.size() * sizeof(T)) {
    packed_.resize(compressor_.bound(shuffled_.size()));
  }
  /// Of the raster the chunk that begins at a row and a column; what `copy(row, column, count, to)`
  /// gives are values of a part of a row. Allocates nothing.
  template <class Copy>
  void pack(const Copy& copy, std::size_t row, std::size_t column, std::size_t ny, std::size_t nx) {
    row_ = row, column_ = column;
    const std::size_t rows = std::min(chunk_.rows, ny - row);
    const std::size_t columns = std::min(chunk_.columns, nx - column);
    // Beyond the edge of the raster a chunk holds zeros that nobody reads.
    if (rows < chunk_.rows || columns < chunk_.columns) std::fill(raw_.begin(), raw_.end(), T{});
    for (std::size_t j = 0; j < rows; ++j) {
      copy(row + j, column, columns, raw_.data() + j * chunk_.columns);
    }
    shuffle<sizeof(T)>(reinterpret_cast<const unsigned char*>(raw_.data()), raw_.size(),
                       shuffled_.data());
    size_ = compressor_.compress(shuffled_, packed_);
  }
  void write(hid_t dataset, int slice, int leading) const {
    require(size_ > 0);
    const hsize_t offset[3] = {static_cast<hsize_t>(slice), row_, column_};
    require(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, offset + 1 - leading, size_, packed_.data()) >=
            0);
  }

 private:
  ChunkShape chunk_;
  ChunkCompressor compressor_;
  std::vector<T> raw_;
  std::vector<unsigned char> shuffled_, packed_;
  std::size_t row_ = 0, column_ = 0, size_ = 0;
};

/// Some chunks are packed at a time, on as many threads as there are to take, and written in order.
template <class T, class Copy>
void write_chunks(hid_t dataset, const Copy& copy, int ny, int nx, ChunkShape chunk, int level,
                  int slice) {
  constexpr std::size_t kMost = 16;
  const std::size_t across = (nx + chunk.columns - 1) / chunk.columns;
  const std::size_t count = across * ((ny + chunk.rows - 1) / chunk.rows);
  const int leading = leading_dimensions(dataset);
  std::vector<Packer<T>> packers;
  for (std::size_t first = 0; first < count;) {
    const auto threads = static_cast<std::size_t>(BackgroundWriter::threads_to_take());
    const std::size_t some = std::min({threads, count - first, kMost});
    while (packers.size() < some) packers.emplace_back(chunk, level);
    const auto team = static_cast<int>(some);
#pragma omp parallel for schedule(static) num_threads(team) if (team > 1)
    for (std::size_t k = 0; k < some; ++k) {
      packers[k].pack(copy, (first + k) / across * chunk.rows, (first + k) % across * chunk.columns,
                      ny, nx);
    }
    {
      const auto lock = nc::lock_library();
      for (std::size_t k = 0; k < some; ++k) packers[k].write(dataset, slice, leading);
    }
    first += some;
  }
}

}  // namespace

struct ChunkWriter::Implementation {
  hid_t file = -1;
  int level = 0;
};

ChunkWriter::ChunkWriter(const std::filesystem::path& path, int level)
    : implementation_(std::make_unique<Implementation>()) {
  const auto lock = nc::lock_library();
  implementation_->level = level;
  implementation_->file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  require(implementation_->file >= 0);
}

ChunkWriter::~ChunkWriter() {
  const auto lock = nc::lock_library();
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

void ChunkWriter::close() {
  const auto lock = nc::lock_library();
  require(H5Fclose(std::exchange(implementation_->file, -1)) >= 0);
}

}  // namespace geo::io
