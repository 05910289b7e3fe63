#include "parcel.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

namespace geo::io {

Parcel::~Parcel() { ::close(socket_); }

void Parcel::put_bytes(const void* data, std::size_t size) {
  const auto* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = ::send(socket_, from, size, MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) throw Incomplete();
    from += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

void Parcel::take_bytes(void* data, std::size_t size) {
  auto* to = static_cast<char*>(data);
  while (size > 0) {
    const ssize_t received = ::recv(socket_, to, size, 0);
    if (received < 0 && errno == EINTR) continue;
    if (received <= 0) throw Incomplete();
    to += received;
    size -= static_cast<std::size_t>(received);
  }
}

void put(Parcel& parcel, const Values& values) {
  put(parcel, static_cast<std::uint8_t>(values.index()));
  std::visit([&](const auto& array) { put(parcel, array); }, values);
}

void take(Parcel& parcel, Values& values) {
  const auto take_as = [&]<class T>(std::vector<T> array) {
    take(parcel, array);
    values = std::move(array);
  };
  std::uint8_t type = 0;
  take(parcel, type);
  switch (static_cast<Type>(type)) {
    case Type::float32:
      return take_as(std::vector<float>());
    case Type::float64:
      return take_as(std::vector<double>());
    case Type::int8:
      return take_as(std::vector<std::int8_t>());
    case Type::int16:
      return take_as(std::vector<std::int16_t>());
    case Type::int32:
      return take_as(std::vector<std::int32_t>());
  }
  throw Parcel::Incomplete();
}

namespace {

enum class Kind : std::uint8_t { sphere, window, plane, equal_area, torus };

Kind kind_of(const Grid& grid) {
  if (grid.topology() == Topology::sphere) return Kind::sphere;
  if (grid.topology() == Topology::torus) return Kind::torus;
  if (grid.is_latitude_longitude()) return Kind::window;
  return grid.is_projected() ? Kind::equal_area : Kind::plane;
}

template <class T>
T taken(Parcel& parcel) {
  T value{};
  take(parcel, value);
  return value;
}

void put(Parcel& parcel, const Axis& axis) {
  put(parcel, axis.centres);
  put(parcel, axis.edges);
  put(parcel, axis.period);
}
Axis take_axis(Parcel& parcel) {
  Axis axis;
  take(parcel, axis.centres);
  take(parcel, axis.edges);
  take(parcel, axis.period);
  return axis;
}

}  // namespace

void put(Parcel& parcel, const Grid& grid) {
  put(parcel, kind_of(grid));
  put(parcel, grid.nx());
  put(parcel, grid.ny());
  put(parcel, grid.edges());
  put(parcel, grid.figure().radius_m);
  put(parcel, grid.figure().flattening);
  const Window& window = grid.window();
  for (const double edge : {window.south_deg, window.north_deg, window.west_deg, window.east_deg}) {
    put(parcel, edge);
  }
  put(parcel, grid.spacing_east_m(0));
  put(parcel, grid.step_north_m());
  put(parcel, grid.centre().has_value());
  const Centre centre = grid.centre().value_or(Centre{});
  put(parcel, centre.latitude_deg);
  put(parcel, centre.longitude_deg);
  for (const double part : grid.turn()) put(parcel, part);
}

Grid take_grid(Parcel& parcel) {
  const auto kind = taken<Kind>(parcel);
  const int nx = taken<int>(parcel), ny = taken<int>(parcel);
  const auto edges = taken<Edges>(parcel);
  Ellipsoid figure;
  take(parcel, figure.radius_m);
  take(parcel, figure.flattening);
  Window window{};
  for (double* edge : {&window.south_deg, &window.north_deg, &window.west_deg, &window.east_deg}) {
    take(parcel, *edge);
  }
  const auto east_m = taken<double>(parcel), north_m = taken<double>(parcel);
  const bool has_centre = taken<bool>(parcel);
  Centre centre;
  take(parcel, centre.latitude_deg);
  take(parcel, centre.longitude_deg);
  std::array<double, 3> turn{};
  for (double& part : turn) take(parcel, part);
  switch (kind) {
    case Kind::sphere:
      return Grid::sphere(nx, ny, figure, turn);
    case Kind::window:
      return Grid::window(nx, ny, window, figure, edges);
    case Kind::plane:
      return Grid::plane(nx, ny, east_m, north_m, edges,
                         has_centre ? std::optional(centre) : std::nullopt, figure);
    case Kind::equal_area:
      return Grid::equal_area(nx, ny, east_m, centre, figure, edges);
    case Kind::torus:
      return Grid::torus(nx, ny, east_m, north_m);
  }
  throw Parcel::Incomplete();
}

void put(Parcel& parcel, const Dem& dem) {
  put(parcel, dem.grid);
  put(parcel, dem.elevation_m);
  put(parcel, dem.source);
  put(parcel, dem.variable);
  put(parcel, dem.raster.rows);
  put(parcel, dem.raster.columns);
  put(parcel, dem.raster.geographic);
  put(parcel, dem.raster_m);
}

Dem take_answer(Parcel& parcel, std::type_identity<Dem>) {
  Dem dem{{}, take_grid(parcel), {}, {}, {}, {}};
  take(parcel, dem.elevation_m);
  take(parcel, dem.source);
  take(parcel, dem.variable);
  dem.raster.rows = take_axis(parcel);
  dem.raster.columns = take_axis(parcel);
  take(parcel, dem.raster.geographic);
  take(parcel, dem.raster_m);
  return dem;
}

void put(Parcel& parcel, const Snapshot& snapshot) {
  put(parcel, *snapshot.grid);
  put(parcel, snapshot.stage);
  put(parcel, snapshot.fields.size());
  for (const auto& [spec, values] : snapshot.fields) {
    put(parcel, spec->name);
    put(parcel, *values);
  }
}

Snapshot take_answer(Parcel& parcel, std::type_identity<Snapshot>) {
  Snapshot snapshot;
  snapshot.grid = std::make_shared<const Grid>(take_grid(parcel));
  take(parcel, snapshot.stage);
  for (auto left = taken<std::size_t>(parcel); left > 0; --left) {
    const FieldSpec* const spec = field::find(taken<std::string>(parcel));
    if (spec == nullptr) throw Parcel::Incomplete();
    auto values = std::make_shared<Values>();
    take(parcel, *values);
    snapshot.fields.emplace_back(spec, std::move(values));
  }
  return snapshot;
}

void put(Parcel& parcel, const Provenance& provenance) {
  for (const std::string* text : {&provenance.title, &provenance.config_toml, &provenance.version,
                                  &provenance.history, &provenance.references}) {
    put(parcel, *text);
  }
  put(parcel, provenance.seed);
}

Provenance take_answer(Parcel& parcel, std::type_identity<Provenance>) {
  Provenance provenance;
  for (std::string* text : {&provenance.title, &provenance.config_toml, &provenance.version,
                            &provenance.history, &provenance.references}) {
    take(parcel, *text);
  }
  take(parcel, provenance.seed);
  return provenance;
}

void put(Parcel& parcel, const Checkpoint& checkpoint) {
  put(parcel, checkpoint.time_myr);
  put(parcel, checkpoint.arrays.size());
  for (const auto& [name, values] : checkpoint.arrays) {
    put(parcel, name);
    put(parcel, values);
  }
}

Checkpoint take_answer(Parcel& parcel, std::type_identity<Checkpoint>) {
  Checkpoint checkpoint;
  take(parcel, checkpoint.time_myr);
  for (auto left = taken<std::size_t>(parcel); left > 0; --left) {
    take(parcel, checkpoint.arrays[taken<std::string>(parcel)]);
  }
  return checkpoint;
}

void put(Parcel& parcel, const std::optional<std::string>& text) {
  put(parcel, text.has_value());
  put(parcel, text.value_or(""));
}

std::optional<std::string> take_answer(Parcel& parcel,
                                       std::type_identity<std::optional<std::string>>) {
  const bool there = taken<bool>(parcel);
  auto text = taken<std::string>(parcel);
  return there ? std::optional(std::move(text)) : std::nullopt;
}

void put(Parcel& parcel, const std::vector<Exemplar>& exemplars) {
  put(parcel, exemplars.size());
  for (const Exemplar& e : exemplars) {
    put(parcel, e.name);
    put(parcel, e.nx);
    put(parcel, e.ny);
    put(parcel, e.cell_m);
    put(parcel, e.periodic);
    put(parcel, e.elevation_m);
  }
}

std::vector<Exemplar> take_answer(Parcel& parcel, std::type_identity<std::vector<Exemplar>>) {
  std::vector<Exemplar> exemplars;
  for (auto left = taken<std::size_t>(parcel); left > 0; --left) {
    Exemplar& e = exemplars.emplace_back();
    take(parcel, e.name);
    take(parcel, e.nx);
    take(parcel, e.ny);
    take(parcel, e.cell_m);
    take(parcel, e.periodic);
    take(parcel, e.elevation_m);
  }
  return exemplars;
}

}  // namespace geo::io
