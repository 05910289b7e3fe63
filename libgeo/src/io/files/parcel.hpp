#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "geo/core/checkpoint.hpp"
#include "geo/core/grid.hpp"
#include "geo/core/state.hpp"
#include "geo/io/input/dem.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/kernels/exemplars/exemplar.hpp"

namespace geo::io {

/// Values one after another on their way between two processes of this program, through a socket.
class Parcel {
 public:
  /// What was to be taken does not come: the other process has ended.
  struct Incomplete : std::runtime_error {
    Incomplete() : std::runtime_error("incomplete") {}
  };

  /// Takes the socket over.
  explicit Parcel(int socket) : socket_(socket) {}
  ~Parcel();
  Parcel(const Parcel&) = delete;
  Parcel& operator=(const Parcel&) = delete;

  void put_bytes(const void* data, std::size_t size);
  void take_bytes(void* data, std::size_t size);

 private:
  int socket_;
};

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <Plain T>
void put(Parcel& parcel, T value) {
  parcel.put_bytes(&value, sizeof value);
}
template <Plain T>
void take(Parcel& parcel, T& value) {
  parcel.take_bytes(&value, sizeof value);
}

inline void put(Parcel& parcel, std::string_view text) {
  put(parcel, text.size());
  parcel.put_bytes(text.data(), text.size());
}
inline void put(Parcel& parcel, const std::string& text) { put(parcel, std::string_view(text)); }
template <class T>
requires(std::is_same_v<T, std::string> || std::is_same_v<T, std::vector<std::string>> ||
         Plain<typename T::value_type>) void take(Parcel& parcel, T& list) {
  std::size_t size = 0;
  take(parcel, size);
  list.resize(size);
  if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    for (std::string& text : list) take(parcel, text);
  } else {
    parcel.take_bytes(list.data(), size * sizeof(list[0]));
  }
}
template <Plain T>
void put(Parcel& parcel, const std::vector<T>& array) {
  put(parcel, array.size());
  parcel.put_bytes(array.data(), array.size() * sizeof(T));
}
inline void put(Parcel& parcel, const std::vector<std::string>& list) {
  put(parcel, list.size());
  for (const std::string& text : list) put(parcel, text);
}

void put(Parcel& parcel, const Values& values);
void take(Parcel& parcel, Values& values);
void put(Parcel& parcel, const Grid& grid);
Grid take_grid(Parcel& parcel);

// What readers give.
void put(Parcel& parcel, const Dem& dem);
void put(Parcel& parcel, const Snapshot& snapshot);  // without a checkpoint
void put(Parcel& parcel, const Provenance& provenance);
void put(Parcel& parcel, const Checkpoint& checkpoint);
void put(Parcel& parcel, const std::optional<std::string>& text);
void put(Parcel& parcel, const std::vector<Exemplar>& exemplars);  // without what is measured
Dem take_answer(Parcel& parcel, std::type_identity<Dem>);
Snapshot take_answer(Parcel& parcel, std::type_identity<Snapshot>);
Provenance take_answer(Parcel& parcel, std::type_identity<Provenance>);
Checkpoint take_answer(Parcel& parcel, std::type_identity<Checkpoint>);
std::optional<std::string> take_answer(Parcel& parcel,
                                       std::type_identity<std::optional<std::string>>);
std::vector<Exemplar> take_answer(Parcel& parcel, std::type_identity<std::vector<Exemplar>>);

}  // namespace geo::io
