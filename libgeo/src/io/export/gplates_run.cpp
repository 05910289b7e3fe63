#include "gplates_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>

#include "geo/core/error.hpp"
#include "geo/core/place.hpp"
#include "geo/io/input/table.hpp"
#include "geo/io/run/manifest.hpp"
#include "geo/io/run/recorded_file.hpp"
#include "geo/kernels/plates/plate_motion.hpp"

namespace geo::io {
namespace {

namespace fs = std::filesystem;

/// How long before the present a planet without a history is taken to have moved as it does.
constexpr double kSnapshot_myr = 1.0;

const StageRecord& plates_of(const Manifest& manifest, const fs::path& folder) {
  for (const StageRecord& record : manifest.stages) {
    if (record.name == "plates") return record;
  }
  throw ConfigurationError(fmt::format(
      "export: {} has no plates: its run did not begin with stage plates", folder.string()));
}

bool is_wanted(const FieldSpec& spec) {
  static const std::initializer_list<const FieldSpec*> kWanted{&field::plate_id,
                                                               &field::boundary_type,
                                                               &field::subduction_polarity,
                                                               &field::crust_elevation,
                                                               &field::elevation,
                                                               &field::crust_age,
                                                               &field::continental_fraction,
                                                               &field::plate_velocity_east,
                                                               &field::plate_velocity_north};
  return std::find(kWanted.begin(), kWanted.end(), &spec) != kWanted.end();
}

int number_or_none(const Table& table, std::size_t row, std::size_t column) {
  return table.text(row, column).empty() ? -1 : static_cast<int>(table.number(row, column));
}

std::vector<PlateTurn> turns_of(const Table& table) {
  const std::size_t plate = table.column("plate_id"), from = table.column("from_myr"),
                    to = table.column("to_myr"), latitude = table.column("pole_latitude_deg"),
                    longitude = table.column("pole_longitude_deg"),
                    rate = table.column("rate_deg_myr");
  std::vector<PlateTurn> turns;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    turns.push_back({static_cast<int>(table.number(row, plate)), table.number(row, from),
                     table.number(row, to),
                     euler_rotation(table.number(row, latitude), table.number(row, longitude),
                                    table.number(row, rate))});
  }
  return turns;
}

std::vector<PlateSpan> spans_of(const Table& table) {
  const std::size_t plate = table.column("plate_id"), parent = table.column("parent_id"),
                    born = table.column("born_myr"), ended = table.column("ended_myr"),
                    joined = table.column("joined_id");
  std::vector<PlateSpan> spans;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    PlateSpan span{.plate = static_cast<int>(table.number(row, plate)),
                   .parent = number_or_none(table, row, parent),
                   .joined = number_or_none(table, row, joined),
                   .born_myr = table.number(row, born)};
    if (!table.text(row, ended).empty()) span.ended_myr = table.number(row, ended);
    spans.push_back(span);
  }
  return spans;
}

/// "frames/plates-0010.00.nc" is of 10 Myr.
double time_in_name(const fs::path& file) {
  const std::string stem = file.stem().string();
  const std::string_view digits = std::string_view(stem).substr(stem.rfind('-') + 1);
  double time_myr = 0.0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), time_myr);
  if (error != std::errc() || end != digits.data() + digits.size()) {
    throw InputError(fmt::format("{}: its name must end in its time in Myr", file.string()));
  }
  return time_myr;
}

}  // namespace

GplatesRun::GplatesRun(const fs::path& folder) {
  const RunFolder run(folder);
  if (!fs::exists(run.manifest())) {
    throw ConfigurationError(fmt::format(
        "export: {} holds no run: --format gplates takes the folder of one", folder.string()));
  }
  const Manifest manifest = read_manifest(run.manifest());
  const StageRecord& record = plates_of(manifest, folder);
  const fs::path present = folder / netcdf_of(record);
  const auto table = [&](const char* name) {
    fs::path file = present;
    file.replace_extension();
    file += fmt::format("-{}.csv", name);
    return file;
  };
  if (fs::exists(table("rotations"))) {
    read_history(folder, table("rotations"), table("lives"));
    find_frames(folder, record.files);
  } else {
    read_velocities(present);
  }
  files_.push_back({present, 0.0});
}

void GplatesRun::read_history(const fs::path& folder, const fs::path& rotations,
                              const fs::path& lives) {
  const std::vector<PlateTurn> turns = turns_of(Table::of_file(rotations));
  if (turns.empty()) {
    throw ConfigurationError(fmt::format("export: {}: its plates never moved", folder.string()));
  }
  spans_ = spans_of(Table::of_file(lives));
  for (const PlateTurn& turn : turns) {
    for (const double time_myr : {turn.from_myr, turn.to_myr}) times_myr_.push_back(time_myr);
  }
  std::sort(times_myr_.begin(), times_myr_.end());
  times_myr_.erase(std::unique(times_myr_.begin(), times_myr_.end()), times_myr_.end());
  end_myr_ = times_myr_.back();
  try {
    rotations_ =
        rotations_of_drift(turns, spans_, times_myr_.front(), end_myr_, kFirstGplatesNumber);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", lives.string(), error.what()));
  }
  const auto in_run = [](int number) { return number - kFirstGplatesNumber; };
  for (const RotationSequence& sequence : rotations_.sequences()) {
    const int plate = in_run(sequence.moving), fixed = in_run(sequence.fixed);
    const auto span = std::find_if(spans_.begin(), spans_.end(),
                                   [&](const PlateSpan& other) { return other.plate == plate; });
    const bool has_joined =
        span->joined == fixed && sequence.rotations.back().time_ma <= end_myr_ - span->ended_myr;
    comments_.push_back(fmt::format("plate {}", plate));
    if (sequence.fixed == 0) continue;
    comments_.back() += fmt::format(", {} part of plate {}",
                                    has_joined ? "since it became" : "while it was", fixed);
  }
}

void GplatesRun::find_frames(const fs::path& folder, const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    if (!file.starts_with("frames/") || !file.ends_with(".nc")) continue;
    // Names have two decimals, steps may have more.
    const double named_myr = time_in_name(file);
    const double time_myr = *std::min_element(
        times_myr_.begin(), times_myr_.end(),
        [&](double a, double b) { return std::abs(a - named_myr) < std::abs(b - named_myr); });
    if (time_myr < end_myr_) files_.push_back({folder / file, end_myr_ - time_myr});
  }
  std::sort(files_.begin(), files_.end(),
            [](const FrameFile& a, const FrameFile& b) { return a.time_ma > b.time_ma; });
}

void GplatesRun::read_velocities(const fs::path& present) {
  const Snapshot fields = read_perhaps_recorded(present, is_wanted);
  const Grid& grid = *fields.grid;
  if (grid.topology() != Topology::sphere) {
    throw ConfigurationError(fmt::format(
        "export: {}: GPlates knows whole planets alone, and this is a torus", present.string()));
  }
  const auto values = [&]<class T>(const Field<T>& spec) -> const std::vector<T>& {
    for (const auto& [held, found] : fields.fields) {
      if (held == &spec) return std::get<std::vector<T>>(*found);
    }
    throw InputError(fmt::format("{}: has no field {}", present.string(), spec.name));
  };
  const auto& east = values(field::plate_velocity_east);
  const auto& north = values(field::plate_velocity_north);
  std::map<int, VelocityFit> fits;
  for (Index cell = 0; cell < grid.size(); ++cell) {
    const Vector3 at = unit_vector_of(grid.position(grid.column(cell), grid.row(cell)));
    fits[values(field::plate_id)[cell]].add(at, {east[cell], north[cell]},
                                            grid.area_m2(grid.row(cell)));
  }
  if (fits.size() < 2) {
    throw ConfigurationError(
        fmt::format("export: {} has one plate, which does not move", present.string()));
  }
  const double radius_km = 1e-3 * grid.figure().radius_m;
  std::vector<RotationSequence> sequences;
  for (const auto& [plate, fit] : fits) {
    const Vector3 back = scaled(fit.rotation_rad_myr(radius_km), -kSnapshot_myr);
    sequences.push_back(
        {plate + kFirstGplatesNumber, 0, {{0.0, {}}, {kSnapshot_myr, Quaternion::about(back)}}});
    spans_.push_back({.plate = plate});
    comments_.push_back(fmt::format("plate {}, as it moves today", plate));
  }
  rotations_ = RotationModel(std::move(sequences));
}

GplatesFrame GplatesRun::frame(std::size_t k) const {
  // A frame gives way to the next one just before its time, so that no time has two.
  constexpr double kBefore_myr = 0.001;
  GplatesFrame frame{.fields = read_perhaps_recorded(files_[k].path, is_wanted),
                     .from_ma = files_[k].time_ma};
  if (k + 1 < files_.size()) frame.to_ma = files_[k + 1].time_ma + kBefore_myr;
  if (files_.size() == 1 && times_myr_.empty()) frame.from_ma = kSnapshot_myr;
  return frame;
}

double GplatesRun::ended_ma(int plate) const {
  for (const PlateSpan& span : spans_) {
    if (span.plate == plate) return std::max(0.0, end_myr_ - span.ended_myr);
  }
  throw InputError(fmt::format("plate {} is in a frame and not in the table of plates", plate));
}

}  // namespace geo::io
