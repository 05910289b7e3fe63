#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "geo/core/error.hpp"
#include "geo/kernels/plates/region_borders.hpp"
#include "gplates_run.hpp"

namespace geo::io {
namespace {

constexpr double kShelf = 0.5;          // continental share from which a cell is continent
constexpr double kIsochron_myr = 20.0;  // from one line of equal age to the next
constexpr int kBands = 1000;            // labels of ages that one plate has room for

/// The fields of a frame as they are read here.
class Fields {
 public:
  explicit Fields(const GplatesFrame& frame) : snapshot_(frame.fields) {}

  [[nodiscard]] const Grid& grid() const { return *snapshot_.grid; }
  template <class T>
  [[nodiscard]] const std::vector<T>* find(const Field<T>& spec) const {
    for (const auto& [held, values] : snapshot_.fields) {
      if (held == &spec) return &std::get<std::vector<T>>(*values);
    }
    return nullptr;
  }
  template <class T>
  [[nodiscard]] const std::vector<T>& of(const Field<T>& spec) const {
    if (const auto* values = find(spec)) return *values;
    throw InputError(fmt::format("export: a frame has no field {}", spec.name));
  }
  [[nodiscard]] bool is_continent(Index cell) const {
    return of(field::continental_fraction)[cell] >= kShelf;
  }

 private:
  const Snapshot& snapshot_;
};

/// Where a field goes through a level between the middles of two cells.
BorderShare crossing_of(const std::vector<float>& values, double level) {
  return [&values, level](Index a, Index b) {
    constexpr double kClear = 0.01;  // of the middles, so that no two places are one
    const double first = values[a] - level, second = values[b] - level;
    if (first * second > 0.0 || first == second) return 0.5;
    return std::clamp(first / (first - second), kClear, 1.0 - kClear);
  };
}

/// Places lines and polygons where their crust is today.
class Today {
 public:
  Today(const GplatesRun& run, const GplatesFrame& frame) : run_(run), frame_(frame) {}

  [[nodiscard]] GplatesFeature feature(const GplatesType& type, int plate, std::string name) const {
    const double ended_ma = run_.ended_ma(plate);
    return {.type = &type,
            .name = std::move(name),
            .plate = plate + kFirstGplatesNumber,
            .from_ma = frame_.from_ma,
            .to_ma = std::min(frame_.from_ma, std::max(frame_.to_ma, ended_ma))};
  }
  [[nodiscard]] std::vector<Vector3> line(int plate, const std::vector<Vector3>& then) const {
    const Matrix3& frame = frame_of(plate);
    std::vector<Vector3> today;
    today.reserve(then.size());
    for (const Vector3& at : then) today.push_back(back(frame, at));
    return today;
  }
  [[nodiscard]] GplatesPolygon polygon(int plate, const BorderedRegion& region) const {
    GplatesPolygon polygon{line(plate, region.outside), {}};
    for (const auto& hole : region.holes) polygon.holes.push_back(line(plate, hole));
    return polygon;
  }

 private:
  /// From where a plate's crust is today to where it was.
  [[nodiscard]] const Matrix3& frame_of(int plate) const {
    const auto known = frames_.find(plate);
    if (known != frames_.end()) return known->second;
    // A single frame stands for the present, and is there before.
    const double time_ma = run_.frames() == 1 ? 0.0 : frame_.from_ma;
    const auto rotation = run_.rotations().at(plate + kFirstGplatesNumber, time_ma);
    if (!rotation) {
      throw InputError(fmt::format("plate {} is in the frame of {} Ma and has no rotations then",
                                   plate, time_ma));
    }
    return frames_.emplace(plate, rotation->matrix()).first->second;
  }

  const GplatesRun& run_;
  const GplatesFrame& frame_;
  mutable std::map<int, Matrix3> frames_;
};

std::vector<std::int32_t> plate_labels(const Fields& fields) {
  const auto& plate = fields.of(field::plate_id);
  return {plate.begin(), plate.end()};
}

void add_plates(const RegionBorders& borders, const Today& today, GplatesFeatures& plates) {
  std::map<int, GplatesFeature> of_plate;
  for (const BorderedRegion& region : borders.regions()) {
    auto found = of_plate.find(region.label);
    if (found == of_plate.end()) {
      GplatesFeature plate =
          today.feature(gplates::kPlate, region.label, fmt::format("Plate {}", region.label));
      found = of_plate.emplace(region.label, std::move(plate)).first;
    }
    found->second.polygons.push_back(today.polygon(region.label, region));
  }
  for (auto& [number, plate] : of_plate) plates.push_back(std::move(plate));
}

/// What a boundary is at one of its points; nothing where neither cell tells.
struct Boundary {
  const GplatesType* type = nullptr;
  char overriding = ' ';  ///< side of the plate that does: 'L', 'R', or ' '
  bool operator==(const Boundary&) const = default;
};

Boundary boundary_at(const Fields& fields, const BorderPoint& point) {
  const auto& types = fields.of(field::boundary_type);
  const auto type_of = [&](Index cell) { return static_cast<BoundaryType>(types[cell]); };
  const bool left_knows = type_of(point.left) != BoundaryType::interior;
  const BoundaryType type = type_of(left_knows ? point.left : point.right);
  const bool left_land = fields.is_continent(point.left);
  const bool right_land = fields.is_continent(point.right);
  switch (type) {
    case BoundaryType::interior:
      return {};
    case BoundaryType::divergent:
      return {left_land && right_land ? &gplates::kRift : &gplates::kRidge, ' '};
    case BoundaryType::transform:
      return {&gplates::kTransform, ' '};
    case BoundaryType::convergent:
      break;
  }
  if (left_land && right_land) return {&gplates::kCollision, ' '};
  constexpr std::int8_t kOverriding = 1, kSubducting = 2;
  if (const auto* polarity = fields.find(field::subduction_polarity)) {
    const std::int8_t left = (*polarity)[point.left], right = (*polarity)[point.right];
    if (left == kOverriding || right == kSubducting) return {&gplates::kTrench, 'L'};
    if (left == kSubducting || right == kOverriding) return {&gplates::kTrench, 'R'};
  }
  // Of a continent and floor the continent stays up; of two floors nobody said.
  return {&gplates::kTrench, left_land ? 'L' : right_land ? 'R' : ' '};
}

/// What most of the five points about a place of a line are, so that single cells make no pieces.
Boundary dominant_about(const std::vector<Boundary>& line, std::ptrdiff_t place) {
  const auto from = line.begin() + std::max<std::ptrdiff_t>(0, place - 2);
  const auto to = line.begin() + std::min(std::ssize(line), place + 3);
  Boundary dominant;
  std::ptrdiff_t most = 0;
  for (auto at = from; at != to; ++at) {
    const auto votes = at->type == nullptr ? 0 : std::count(from, to, *at);
    if (votes <= most) continue;
    most = votes;
    dominant = *at;
  }
  return dominant;
}

/// Points that do not know what they are take it from the nearest one of their line that does.
void fill_gaps(std::vector<Boundary>& line) {
  const std::vector<Boundary> known = line;
  for (std::size_t k = 0; k < line.size(); ++k) {
    for (std::size_t far = 1; far < line.size() && line[k].type == nullptr; ++far) {
      if (far <= k) line[k] = known[k - far];
      if (line[k].type == nullptr && k + far < known.size()) line[k] = known[k + far];
    }
    if (line[k].type == nullptr) line[k].type = &gplates::kUnknown;
  }
}

std::vector<Boundary> boundaries_along(const Fields& fields, const std::vector<BorderPoint>& line) {
  std::vector<Boundary> raw, smooth;
  for (const BorderPoint& point : line) {
    raw.push_back(point.left == kNoCell ? Boundary{} : boundary_at(fields, point));
  }
  for (std::ptrdiff_t k = 0; k < std::ssize(raw); ++k) smooth.push_back(dominant_about(raw, k));
  fill_gaps(smooth);
  return smooth;
}

/// Pieces of one kind each, which share the points where they meet.
void add_boundaries(const Fields& fields, const RegionBorders& borders, const Today& today,
                    GplatesFeatures& boundaries) {
  for (const BorderLine& line : borders.lines()) {
    const std::vector<Boundary> kinds = boundaries_along(fields, line.points);
    for (std::size_t first = 0; first + 1 < line.points.size();) {
      std::vector<Vector3> places{line.points[first].place};
      const Boundary kind = kinds[first + 1];
      std::size_t last = first;
      while (last + 1 < line.points.size() && kinds[last + 1] == kind) {
        places.push_back(line.points[++last].place);
      }
      first = last;
      // Trenches belong to the plate that stays up.
      const bool of_right = kind.overriding == 'R';
      const int plate = of_right ? line.right : line.left,
                other = of_right ? line.left : line.right;
      GplatesFeature feature =
          today.feature(*kind.type, plate, fmt::format("Plates {} and {}", line.left, line.right));
      feature.conjugate = other + kFirstGplatesNumber;
      if (kind.overriding != ' ') feature.polarity = of_right ? "Right" : "Left";
      feature.lines.push_back(today.line(plate, places));
      boundaries.push_back(std::move(feature));
    }
  }
}

/// Regions of those cells of a plate of which something holds.
template <class Holds>
void add_regions(const Fields& fields, const Today& today, const GplatesType& type,
                 const char* words, Holds holds, const BorderShare& edge, GplatesFeatures& out) {
  std::vector<std::int32_t> label = plate_labels(fields);
  for (Index cell = 0; cell < fields.grid().size(); ++cell) {
    if (!holds(cell)) label[cell] = kNoLabel;
  }
  const RegionBorders borders(fields.grid(), label, [&](Index a, Index b) {
    return holds(a) != holds(b) ? edge(a, b) : 0.5;
  });
  for (const BorderedRegion& region : borders.regions()) {
    GplatesFeature feature =
        today.feature(type, region.label, fmt::format("{} of plate {}", words, region.label));
    feature.polygons.push_back(today.polygon(region.label, region));
    out.push_back(std::move(feature));
  }
}

void add_isochrons(const Fields& fields, const Today& today, GplatesFeatures& isochrons) {
  const auto& age_myr = fields.of(field::crust_age);
  std::vector<std::int32_t> label = plate_labels(fields);
  const auto band_of = [](std::int32_t of_label) { return of_label % kBands; };
  for (Index cell = 0; cell < fields.grid().size(); ++cell) {
    const auto band = static_cast<std::int32_t>(age_myr[cell] / kIsochron_myr);
    const bool is_floor = !fields.is_continent(cell) && std::isfinite(age_myr[cell]);
    label[cell] = is_floor ? kBands * label[cell] + std::clamp(band, 0, kBands - 1) : kNoLabel;
  }
  const RegionBorders borders(fields.grid(), label, [&](Index a, Index b) {
    const double level = kIsochron_myr * std::max(band_of(label[a]), band_of(label[b]));
    return crossing_of(age_myr, level)(a, b);
  });
  for (const BorderLine& line : borders.lines()) {
    // Along fracture zones ages jump by more than one line: no line is of one age there.
    if (line.left == kNoLabel || line.right == kNoLabel) continue;
    const int plate = line.left / kBands;
    if (plate != line.right / kBands) continue;
    if (std::abs(band_of(line.left) - band_of(line.right)) != 1) continue;
    const double age = kIsochron_myr * std::max(band_of(line.left), band_of(line.right));
    GplatesFeature feature = today.feature(
        gplates::kIsochron, plate, fmt::format("{:g} Myr old floor of plate {}", age, plate));
    std::vector<Vector3> places;
    for (const BorderPoint& point : line.points) places.push_back(point.place);
    feature.lines.push_back(today.line(plate, places));
    isochrons.push_back(std::move(feature));
  }
}

}  // namespace

void add_layers(const GplatesRun& run, const GplatesFrame& frame, GplatesLayers& layers) {
  const Fields fields(frame);
  const Today today(run, frame);
  const RegionBorders borders(fields.grid(), plate_labels(fields));
  add_plates(borders, today, layers.plates);
  add_boundaries(fields, borders, today, layers.boundaries);
  add_regions(
      fields, today, gplates::kContinent, "Continental crust",
      [&](Index cell) { return fields.is_continent(cell); },
      crossing_of(fields.of(field::continental_fraction), kShelf), layers.continents);
  // Frames with a landscape know where the sea stands.
  const auto* above_sea_m = fields.find(field::elevation);
  const auto* elevation_m =
      above_sea_m != nullptr ? above_sea_m : fields.find(field::crust_elevation);
  if (elevation_m != nullptr) {
    add_regions(
        fields, today, gplates::kCoast, "Land",
        [&](Index cell) { return (*elevation_m)[cell] > 0.0F; }, crossing_of(*elevation_m, 0.0),
        layers.coastlines);
  }
  add_isochrons(fields, today, layers.isochrons);
}

}  // namespace geo::io
