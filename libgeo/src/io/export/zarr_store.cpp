#include "zarr_store.hpp"

#include <fmt/format.h>
#include <libdeflate.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/parallel_errors.hpp"
#include "io/netcdf/netcdf_file.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "chunks are written as they lie");

constexpr int kLevel = 1;

[[noreturn]] void refuse(const fs::path& path, const std::string& why) {
  throw IoError(fmt::format("cannot write {}: {}", path.string(), why));
}

void write_file(const fs::path& path, const void* bytes, std::size_t size) {
  std::ofstream stream(path, std::ios::binary);
  stream.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
  stream.flush();
  if (!stream) refuse(path, std::strerror(errno));
}

struct NumberType {
  const char* name;
  std::size_t bytes;
};

NumberType number_type(nc_type type) {
  switch (type) {
    case NC_BYTE:
      return {"|i1", 1};
    case NC_SHORT:
      return {"<i2", 2};
    case NC_INT:
      return {"<i4", 4};
    case NC_FLOAT:
      return {"<f4", 4};
    case NC_DOUBLE:
      return {"<f8", 8};
    default:
      throw Bug("a stage file holds a type that Zarr is not given");
  }
}

Json number(double value, bool whole) {
  if (std::isnan(value)) return "NaN";
  if (whole) return static_cast<std::int64_t>(value);
  return value;
}

/// The value of an attribute: text, a number or a list of them.
Json attribute_of(const nc::File& file, int variable, const char* name) {
  if (const auto text = file.text(variable, name)) return *text;
  nc_type type = NC_NAT;
  nc::check(nc_inq_atttype(file.id(), variable, name, &type));
  const bool whole = type != NC_FLOAT && type != NC_DOUBLE;
  Json list = Json::array();
  for (const double value : file.numbers(variable, name)) list.push_back(number(value, whole));
  return list.size() == 1 ? list[0] : list;
}

/// All but the fill value, which Zarr has beside them.
Json attributes_of(const nc::File& file, int variable) {
  int count = 0;
  nc::check(variable == NC_GLOBAL ? nc_inq_natts(file.id(), &count)
                                  : nc_inq_varnatts(file.id(), variable, &count));
  Json attributes = Json::object();
  for (int k = 0; k < count; ++k) {
    char name[NC_MAX_NAME + 1];
    nc::check(nc_inq_attname(file.id(), variable, k, name));
    const bool own = name[0] == '_' || std::string_view(name) == "terrane_config_digest";
    if (!own) attributes[name] = attribute_of(file, variable, name);
  }
  return attributes;
}

/// Bytes of one significance after another, as numcodecs' filter "shuffle" has them.
std::vector<std::uint8_t> shuffled(const std::vector<std::uint8_t>& bytes, std::size_t width) {
  std::vector<std::uint8_t> result(bytes.size());
  const std::size_t count = bytes.size() / width;
  for (std::size_t k = 0; k < width; ++k) {
    for (std::size_t i = 0; i < count; ++i) result[k * count + i] = bytes[i * width + k];
  }
  return result;
}

std::vector<std::uint8_t> deflated(const std::vector<std::uint8_t>& bytes) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(kLevel), &libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::vector<std::uint8_t> packed(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
  packed.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(),
                                         packed.data(), packed.size()));
  return packed;
}

/// An array of the store: its shape, and its values as the NetCDF file has them.
struct Array {
  std::string name;
  nc_type type;
  std::vector<std::size_t> shape, chunk;
  std::vector<std::string> dimensions;
};

Array array_of(const nc::File& file, int variable) {
  Array array{file.variable_name(variable), file.variable_type(variable), {}, {}, {}};
  for (const int dimension : file.dimensions_of(variable)) {
    array.shape.push_back(file.dimension_size(dimension));
    array.dimensions.push_back(file.dimension_name(dimension));
  }
  array.chunk = array.shape;
  int storage = NC_CONTIGUOUS;
  std::vector<std::size_t> chunk(array.shape.size());
  if (!chunk.empty()) {
    nc::check(nc_inq_var_chunking(file.id(), variable, &storage, chunk.data()));
    if (storage == NC_CHUNKED) array.chunk = chunk;
  }
  return array;
}

Json description_of(const nc::File& file, int variable, const Array& array) {
  const NumberType type = number_type(array.type);
  Json fill;
  const auto given = file.numbers(variable, "_FillValue");
  if (!given.empty()) fill = number(given[0], array.type != NC_FLOAT && array.type != NC_DOUBLE);
  Json filters;
  if (type.bytes > 1) filters = Json::array({{{"id", "shuffle"}, {"elementsize", type.bytes}}});
  return {{"zarr_format", 2},
          {"shape", array.shape},
          {"chunks", array.chunk},
          {"dtype", type.name},
          {"compressor", {{"id", "zlib"}, {"level", kLevel}}},
          {"fill_value", fill},
          {"order", "C"},
          {"filters", filters}};
}

/// Writes the chunks that a band of rows of chunks holds, compressed on all threads. Arrays have
/// any number of dimensions; the first is the one that bands go along.
void write_chunks(const nc::File& file, int variable, const Array& array, const fs::path& folder) {
  const std::size_t width = number_type(array.type).bytes, rank = array.shape.size();
  std::vector<std::size_t> counts(rank);
  std::size_t chunks = 1, chunk_values = 1;
  for (std::size_t d = 0; d < rank; ++d) {
    counts[d] = (array.shape[d] + array.chunk[d] - 1) / array.chunk[d];
    chunks *= counts[d];
    chunk_values *= array.chunk[d];
  }
  const std::size_t per_band = rank == 0 ? 1 : chunks / counts[0];
  for (std::size_t first = 0; first < chunks; first += per_band) {
    std::vector<std::vector<std::uint8_t>> band(per_band);
    std::vector<std::string> names(per_band);
    for (std::size_t k = 0; k < per_band; ++k) {
      std::vector<std::size_t> start(rank), size(rank);
      std::size_t rest = first + k, values = 1;
      for (std::size_t d = rank; d-- > 0;) {
        const std::size_t at = rest % counts[d];
        rest /= counts[d];
        start[d] = at * array.chunk[d];
        size[d] = std::min(array.chunk[d], array.shape[d] - start[d]);
        values *= size[d];
        names[k] = fmt::format("{}{}{}", at, names[k].empty() ? "" : ".", names[k]);
      }
      if (rank == 0) names[k].assign(1, '0');
      std::vector<std::uint8_t> part(values * width);
      nc::check(nc_get_vara(file.id(), variable, start.data(), size.data(), part.data()));
      band[k].resize(chunk_values * width);
      // Line by line into a whole chunk; what lies beyond the array stays zero.
      const std::size_t line = rank == 0 ? 1 : size[rank - 1];
      for (std::size_t done = 0; done < values; done += line) {
        std::size_t left = done / line, to = 0, stride = rank == 0 ? 1 : array.chunk[rank - 1];
        for (std::size_t d = rank < 2 ? 0 : rank - 1; d-- > 0;) {
          to += left % size[d] * stride;
          left /= size[d];
          stride *= array.chunk[d];
        }
        std::memcpy(&band[k][to * width], &part[done * width], line * width);
      }
    }
    ParallelErrors errors;
#pragma omp parallel for schedule(dynamic)
    for (std::size_t k = 0; k < per_band; ++k) {
      errors.guard([&] {
        band[k] = deflated(width > 1 ? shuffled(band[k], width) : band[k]);
        write_file(folder / names[k], band[k].data(), band[k].size());
      });
    }
    errors.rethrow();
  }
}

void write_json(const fs::path& store, const std::string& name, const Json& json, Json& all) {
  const std::string text = json.dump(2, ' ', true, Json::error_handler_t::replace);
  write_file(store / name, text.data(), text.size());
  all[name] = json;
}

void make_folder_for(const fs::path& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) refuse(path, error.message());
}

void fill_store(const nc::File& file, const fs::path& store) {
  make_folder_for(store);
  Json metadata = Json::object();
  write_json(store, ".zgroup", {{"zarr_format", 2}}, metadata);
  Json global = attributes_of(file, NC_GLOBAL);
  for (int variable = 0; variable < file.variables(); ++variable) {
    const std::string name = file.variable_name(variable);
    if (file.variable_type(variable) == NC_STRING) {
      if (const auto text = file.text_in(name.c_str())) global[name] = *text;
      continue;
    }
    const Array array = array_of(file, variable);
    make_folder_for(store / name);
    write_json(store, name + "/.zarray", description_of(file, variable, array), metadata);
    Json attributes = attributes_of(file, variable);
    attributes["_ARRAY_DIMENSIONS"] = array.dimensions;
    write_json(store, name + "/.zattrs", attributes, metadata);
    write_chunks(file, variable, array, store / name);
  }
  write_json(store, ".zattrs", global, metadata);
  Json consolidated{{"zarr_consolidated_format", 1}, {"metadata", metadata}};
  const std::string text = consolidated.dump(2, ' ', true, Json::error_handler_t::replace);
  write_file(store / ".zmetadata", text.data(), text.size());
}

}  // namespace

Scratch::Scratch(const fs::path& beside, const char* what)
    : path_(beside.parent_path() /
            fmt::format(".{}.{}.{}.tmp", beside.filename().string(), ::getpid(), what)) {}

Scratch::~Scratch() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

void write_zarr_store(const fs::path& netcdf, const fs::path& store) {
  std::error_code error;
  const bool there = fs::exists(store, error);
  if (there && !fs::exists(store / ".zgroup", error)) {
    throw ConfigurationError(fmt::format(
        "-o {}: is there and no Zarr store: give another name, or remove it", store.string()));
  }
  const Scratch whole(store, "store");
  try {
    fill_store(nc::File::open(netcdf), whole.path());
  } catch (const nc::Failure& failure) {
    refuse(store, failure.what());
  }
  if (there) fs::remove_all(store, error);
  if (!error) fs::rename(whole.path(), store, error);
  if (error) refuse(store, error.message());
}

}  // namespace geo::io
