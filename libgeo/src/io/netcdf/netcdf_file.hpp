#pragma once

#include <netcdf.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "geo/core/field.hpp"

namespace geo::io::nc {

/// What the netCDF library refused, in its own words. Callers turn it into an Error of ours that
/// says where.
struct Failure : std::runtime_error {
  explicit Failure(int status) : std::runtime_error(nc_strerror(status)), status(status) {}
  int status;
};

inline void check(int status) {
  if (status != NC_NOERR) throw Failure(status);
}

/// The netCDF and HDF5 libraries must not be entered by two threads at once.
std::unique_lock<std::recursive_mutex> lock_library();

constexpr nc_type type_of(Type type) {
  switch (type) {
    case Type::float32:
      return NC_FLOAT;
    case Type::float64:
      return NC_DOUBLE;
    case Type::int8:
      return NC_BYTE;
    case Type::int16:
      return NC_SHORT;
    case Type::int32:
      return NC_INT;
  }
  return NC_NAT;
}

/// An attribute of a group or file, or of one of its variables.
std::optional<std::string> text_of(int group, int variable, const char* name);

/// An open file. Holds the library's lock as long as it lives.
class File {
 public:
  static File create(const std::filesystem::path& path);
  static File open(const std::filesystem::path& path);
  ~File();
  File(File&& other) noexcept;
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  [[nodiscard]] int id() const noexcept { return id_; }
  /// Closes and reports what only closing reveals.
  void close();

  int define_dimension(std::string_view name, int size) const;
  int define_variable(std::string_view name, nc_type type, std::span<const int> dimensions) const;

  /// Attributes; `variable` may be NC_GLOBAL. Empty text writes nothing.
  void put(int variable, const char* name, std::string_view text) const;
  void put(int variable, const char* name, std::span<const double> values) const;
  void put(int variable, const char* name, double value) const { put(variable, name, {&value, 1}); }

  [[nodiscard]] std::optional<std::string> text(int variable, const char* name) const {
    return text_of(id_, variable, name);
  }
  /// The value of a scalar variable that holds text; nothing where there is no such.
  [[nodiscard]] std::optional<std::string> text_in(const char* variable) const;
  [[nodiscard]] std::vector<double> numbers(int variable, const char* name) const;

  [[nodiscard]] int variables() const;
  [[nodiscard]] std::optional<int> find_variable(std::string_view name) const;
  [[nodiscard]] std::string variable_name(int variable) const;
  [[nodiscard]] nc_type variable_type(int variable) const;
  [[nodiscard]] std::vector<int> dimensions_of(int variable) const;
  [[nodiscard]] std::string dimension_name(int dimension) const;
  [[nodiscard]] std::size_t dimension_size(int dimension) const;
  /// The same as a count of rows or columns; InputError where it is no such count.
  [[nodiscard]] int length_of(int dimension) const;
  /// Before memory is asked for: throws InputError when a variable of any group has more values
  /// than its file can hold however well they are packed, or than there is memory for.
  void check_size(int variable) const { check_size(id_, variable); }
  void check_size(int group, int variable) const;
  /// The same of cells that its fields have a value for each of, and rows and columns a coordinate.
  void check_cells(int nx, int ny) const;

 private:
  File() : lock_(lock_library()) {}
  std::unique_lock<std::recursive_mutex> lock_;
  int id_ = -1;
  std::uintmax_t bytes_ = 0;
};

}  // namespace geo::io::nc
