#include "netcdf_file.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "geo/core/error.hpp"
#include "io/files/packed_size.hpp"

namespace geo::io::nc {

std::unique_lock<std::recursive_mutex> lock_library() {
  static std::recursive_mutex mutex;
  std::unique_lock lock(mutex);
  // A file that a full disk kept from closing stays open inside HDF5, and its clean-up at exit
  // would try again and complain. Ours are all closed by then.
  static const bool kNoCleanUp = H5dont_atexit() >= 0;
  static_cast<void>(kNoCleanUp);
  // Each thread of HDF5 has an error stack of its own that prints itself unless told otherwise.
  thread_local const bool kQuiet = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  static_cast<void>(kQuiet);
  return lock;
}

File File::create(const std::filesystem::path& path) {
  File file;
  check(nc_create(path.c_str(), NC_NETCDF4 | NC_CLOBBER, &file.id_));
  // Every value is written, so that filling first would write the file twice.
  check(nc_set_fill(file.id_, NC_NOFILL, nullptr));
  return file;
}

File File::open(const std::filesystem::path& path) {
  File file;
  check(nc_open(path.c_str(), NC_NOWRITE, &file.id_));
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  file.bytes_ = error ? 0 : bytes;
  return file;
}

File::File(File&& other) noexcept
    : lock_(std::move(other.lock_)), id_(std::exchange(other.id_, -1)), bytes_(other.bytes_) {}

File::~File() {
  if (id_ >= 0) nc_close(id_);
}

void File::close() { check(nc_close(std::exchange(id_, -1))); }

int File::define_dimension(std::string_view name, int size) const {
  int dimension = -1;
  check(nc_def_dim(id_, std::string(name).c_str(), size, &dimension));
  return dimension;
}

int File::define_variable(std::string_view name, nc_type type,
                          std::span<const int> dimensions) const {
  int variable = -1;
  check(nc_def_var(id_, std::string(name).c_str(), type, static_cast<int>(dimensions.size()),
                   dimensions.data(), &variable));
  return variable;
}

void File::put(int variable, const char* name, std::string_view text) const {
  if (!text.empty()) check(nc_put_att_text(id_, variable, name, text.size(), text.data()));
}

void File::put(int variable, const char* name, std::span<const double> values) const {
  check(nc_put_att_double(id_, variable, name, NC_DOUBLE, values.size(), values.data()));
}

std::optional<std::string> text_of(int group, int variable, const char* name) {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  if (nc_inq_att(group, variable, name, &type, &length) != NC_NOERR) return {};
  if (type == NC_STRING && length == 1) {
    char* string = nullptr;
    check(nc_get_att_string(group, variable, name, &string));
    std::string result = string != nullptr ? string : "";
    nc_free_string(1, &string);
    return result;
  }
  if (type != NC_CHAR) return {};
  std::string result(length, '\0');
  check(nc_get_att_text(group, variable, name, result.data()));
  while (!result.empty() && result.back() == '\0') result.pop_back();
  return result;
}

std::optional<std::string> File::text_in(const char* name) const {
  const auto variable = find_variable(name);
  if (!variable || variable_type(*variable) != NC_STRING || !dimensions_of(*variable).empty()) {
    return {};
  }
  char* string = nullptr;
  check(nc_get_var_string(id_, *variable, &string));
  std::string result = string != nullptr ? string : "";
  nc_free_string(1, &string);
  return result;
}

std::vector<double> File::numbers(int variable, const char* name) const {
  nc_type type = NC_NAT;
  std::size_t length = 0;
  if (nc_inq_att(id_, variable, name, &type, &length) != NC_NOERR || type == NC_CHAR ||
      type == NC_STRING || type > NC_STRING) {
    return {};
  }
  std::vector<double> values(length);
  if (length > 0) check(nc_get_att_double(id_, variable, name, values.data()));
  return values;
}

int File::variables() const {
  int count = 0;
  check(nc_inq_nvars(id_, &count));
  return count;
}

std::optional<int> File::find_variable(std::string_view name) const {
  int variable = -1;
  if (nc_inq_varid(id_, std::string(name).c_str(), &variable) != NC_NOERR) return {};
  return variable;
}

std::string File::variable_name(int variable) const {
  char name[NC_MAX_NAME + 1] = {};
  check(nc_inq_varname(id_, variable, name));
  return name;
}

nc_type File::variable_type(int variable) const {
  nc_type type = NC_NAT;
  check(nc_inq_vartype(id_, variable, &type));
  return type;
}

std::vector<int> File::dimensions_of(int variable) const {
  int count = 0;
  check(nc_inq_varndims(id_, variable, &count));
  std::vector<int> dimensions(count);
  check(nc_inq_vardimid(id_, variable, dimensions.data()));
  return dimensions;
}

std::string File::dimension_name(int dimension) const {
  char name[NC_MAX_NAME + 1] = {};
  check(nc_inq_dimname(id_, dimension, name));
  return name;
}

std::size_t File::dimension_size(int dimension) const {
  std::size_t size = 0;
  check(nc_inq_dimlen(id_, dimension, &size));
  return size;
}

int File::length_of(int dimension) const {
  const std::size_t size = dimension_size(dimension);
  if (size > std::numeric_limits<int>::max()) {
    throw InputError(fmt::format("dimension {} has {} entries: must have {} at most",
                                 dimension_name(dimension), size, std::numeric_limits<int>::max()));
  }
  return static_cast<int>(size);
}

void File::check_size(int group, int variable) const {
  int count = 0;
  check(nc_inq_varndims(group, variable, &count));
  std::vector<int> dimensions(count);
  check(nc_inq_vardimid(group, variable, dimensions.data()));
  double values = 1.0;
  for (const int dimension : dimensions) {
    std::size_t size = 0;
    check(nc_inq_dimlen(group, dimension, &size));
    values *= static_cast<double>(size);
  }
  check_packed_size(values, sizeof(double), static_cast<double>(bytes_));
}

void File::check_cells(int nx, int ny) const {
  const auto bytes = static_cast<double>(bytes_);
  check_packed_size(static_cast<double>(nx) * ny, sizeof(float), bytes);
  // Coordinates differ from each other, and are not packed to less than a bit.
  constexpr double kBits = 8.0, kFew = 1 << 20;
  const double coordinates = static_cast<double>(nx) + ny;
  if (coordinates > std::max(kFew, kBits * bytes)) {
    throw InputError(
        fmt::format("truncated or damaged: claims {:.0f} rows and columns in {:.0f} bytes",
                    coordinates, bytes));
  }
}

}  // namespace geo::io::nc
