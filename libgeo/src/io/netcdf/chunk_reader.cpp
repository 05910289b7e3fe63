#include "chunk_reader.hpp"

#include <hdf5.h>
#include <libdeflate.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string>
#include <vector>

#include "geo/core/parallel_errors.hpp"
#include "netcdf_file.hpp"

namespace geo::io {
namespace {

/// An HDF5 object that closes itself; negative when it could not be opened.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  [[nodiscard]] hid_t id() const { return id_; }
  [[nodiscard]] bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

struct FreeDecompressor {
  void operator()(libdeflate_decompressor* decompressor) const {
    libdeflate_free_decompressor(decompressor);
  }
};
using Decompressor = std::unique_ptr<libdeflate_decompressor, FreeDecompressor>;

template <class T>
hid_t native_type() {
  switch (type_of<T>()) {
    case Type::float32:
      return H5T_NATIVE_FLOAT;
    case Type::float64:
      return H5T_NATIVE_DOUBLE;
    case Type::int8:
      return H5T_NATIVE_SCHAR;
    case Type::int16:
      return H5T_NATIVE_SHORT;
    case Type::int32:
      return H5T_NATIVE_INT;
  }
  return -1;
}

/// How a raster is cut. `leading` is 1 where rows and columns follow a time of one entry.
struct Chunks {
  hsize_t rows = 0, columns = 0;
  int leading = 0;
};

/// Whether a raster is stored as ny rows of nx native values, shuffled and deflated; its chunks.
template <class T>
bool is_ours(hid_t dataset, int ny, int nx, Chunks& chunks) {
  const Handle type(H5Dget_type(dataset), H5Tclose), space(H5Dget_space(dataset), H5Sclose);
  const Handle layout(H5Dget_create_plist(dataset), H5Pclose);
  if (!type.good() || !space.good() || !layout.good()) return false;
  const int dimensions = H5Sget_simple_extent_ndims(space.id());
  if (dimensions != 2 && dimensions != 3) return false;
  chunks.leading = dimensions - 2;
  std::array<hsize_t, 3> sizes{1, 0, 0}, chunk{1, 0, 0};
  hsize_t* const size = sizes.data() + 1 - chunks.leading;
  if (H5Sget_simple_extent_dims(space.id(), size, nullptr) != dimensions) return false;
  const auto filter = [&](unsigned position) {
    unsigned flags = 0;
    std::size_t parameters = 0;
    return H5Pget_filter2(layout.id(), position, &flags, &parameters, nullptr, 0, nullptr, nullptr);
  };
  if (sizes != std::array{hsize_t{1}, static_cast<hsize_t>(ny), static_cast<hsize_t>(nx)} ||
      H5Tequal(type.id(), native_type<T>()) <= 0 || H5Pget_layout(layout.id()) != H5D_CHUNKED ||
      H5Pget_chunk(layout.id(), dimensions, chunk.data() + 1 - chunks.leading) != dimensions ||
      H5Pget_nfilters(layout.id()) != 2 || filter(0) != H5Z_FILTER_SHUFFLE ||
      filter(1) != H5Z_FILTER_DEFLATE) {
    return false;
  }
  chunks.rows = chunk[1];
  chunks.columns = chunk[2];
  // A chunk is asked for at once, and none of ours is larger than the raster.
  return chunk[0] == 1 && chunk[1] >= 1 && chunk[2] >= 1 && chunk[1] <= sizes[1] &&
         chunk[2] <= sizes[2];
}

std::uintmax_t file_bytes(hid_t dataset) {
  const Handle file(H5Iget_file_id(dataset), H5Fclose);
  hsize_t bytes = 0;
  return file.good() && H5Fget_filesize(file.id(), &bytes) >= 0 ? bytes : 0;
}

/// A chunk as it lies in the file.
struct Packed {
  std::size_t row, column;
  std::vector<unsigned char> bytes;
};

bool read_packed(hid_t dataset, int ny, int nx, const Chunks& chunks, std::vector<Packed>& all) {
  const std::uintmax_t most = file_bytes(dataset);
  for (std::size_t row = 0; row < static_cast<std::size_t>(ny); row += chunks.rows) {
    for (std::size_t column = 0; column < static_cast<std::size_t>(nx); column += chunks.columns) {
      const std::array<hsize_t, 3> offsets{0, row, column};
      const hsize_t* const offset = offsets.data() + 1 - chunks.leading;
      hsize_t size = 0;
      std::uint32_t skipped_filters = 0;
      if (H5Dget_chunk_storage_size(dataset, offset, &size) < 0 || size == 0 || size > most) {
        return false;
      }
      Packed packed{row, column, std::vector<unsigned char>(size)};
      if (H5Dread_chunk(dataset, H5P_DEFAULT, offset, &skipped_filters, packed.bytes.data()) < 0 ||
          skipped_filters != 0) {
        return false;
      }
      all.push_back(std::move(packed));
    }
  }
  return true;
}

/// Puts the part of a shuffled chunk that lies in the raster where it belongs.
template <class T>
void place(const Packed& packed, const std::vector<unsigned char>& shuffled, const Chunks& chunks,
           int ny, int nx, std::vector<T>& values) {
  const std::size_t cells = chunks.rows * chunks.columns;
  const std::size_t rows = std::min<std::size_t>(chunks.rows, ny - packed.row);
  const std::size_t columns = std::min<std::size_t>(chunks.columns, nx - packed.column);
  for (std::size_t j = 0; j < rows; ++j) {
    auto* const to =
        reinterpret_cast<unsigned char*>(values.data() + (packed.row + j) * nx + packed.column);
    const unsigned char* const from = shuffled.data() + j * chunks.columns;
    for (std::size_t i = 0; i < columns; ++i) {
      for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        to[i * sizeof(T) + byte] = from[byte * cells + i];
      }
    }
  }
}

template <class T>
bool read_chunks(hid_t dataset, std::vector<T>& values, int ny, int nx) {
  Chunks chunks;
  std::vector<Packed> packed;
  if (!is_ours<T>(dataset, ny, nx, chunks) || !read_packed(dataset, ny, nx, chunks, packed)) {
    return false;
  }
  const std::size_t bytes = chunks.rows * chunks.columns * sizeof(T);
  std::atomic<bool> good = true;
  ParallelErrors errors;
#pragma omp parallel
  {
    const Decompressor decompressor(libdeflate_alloc_decompressor());
    errors.guard([&] {
      if (!decompressor) throw std::bad_alloc();
    });
    auto shuffled = errors.make<std::vector<unsigned char>>(bytes);
#pragma omp for schedule(dynamic, 1)
    for (std::size_t k = 0; k < packed.size(); ++k) {
      if (errors.any()) continue;
      const auto& from = packed[k].bytes;
      if (libdeflate_zlib_decompress(decompressor.get(), from.data(), from.size(), shuffled.data(),
                                     bytes, nullptr) != LIBDEFLATE_SUCCESS) {
        good = false;
        continue;
      }
      place(packed[k], shuffled, chunks, ny, nx, values);
    }
  }
  errors.rethrow();
  return good;
}

}  // namespace

struct ChunkReader::Implementation {
  std::unique_lock<std::recursive_mutex> lock = nc::lock_library();
  hid_t file = -1;
};

ChunkReader::ChunkReader(const std::filesystem::path& path)
    : implementation_(std::make_unique<Implementation>()) {
  implementation_->file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
}

ChunkReader::~ChunkReader() {
  if (implementation_->file >= 0) H5Fclose(implementation_->file);
}

bool ChunkReader::read(std::string_view variable, Values& values, int ny, int nx) const {
  if (implementation_->file < 0) return false;
  const Handle dataset(H5Dopen2(implementation_->file, std::string(variable).c_str(), H5P_DEFAULT),
                       H5Dclose);
  if (!dataset.good()) return false;
  return std::visit([&](auto& array) { return read_chunks(dataset.id(), array, ny, nx); }, values);
}

}  // namespace geo::io
