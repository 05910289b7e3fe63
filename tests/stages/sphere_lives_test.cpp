// Plates keep their numbers as long as they last, and tell whose they were.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "drifted.hpp"
#include "geo/core/error.hpp"

namespace geo {
namespace {

struct History {
  std::vector<Frame> frames;
  Context told;
  State end{std::make_shared<Grid>(Grid::sphere(96, 48))};
};

PlatesParameters restless() {
  PlatesParameters p = with_frames();
  p.growth.count = 12;
  p.sphere.rift_per_myr = 0.02;
  return p;
}

History history(const PlatesParameters& parameters,
                std::shared_ptr<const Checkpoint> from = nullptr) {
  History out;
  out.frames = frames_of(parameters, out.end, std::move(from), {}, &out.told);
  return out;
}

const TextTable& table_of(const Context& told, const std::string& name) {
  const auto found = std::find_if(told.tables.begin(), told.tables.end(),
                                  [&](const TextTable& table) { return table.name == name; });
  if (found == told.tables.end()) throw Bug("no table of " + name);
  return *found;
}
const TextTable& lives_of(const Context& told) { return table_of(told, "lives"); }

std::map<int, double> shares(const State& state) {
  std::map<int, double> area;
  const auto plate = state.read(field::plate_id);
  for (Index c = 0; c < state.grid().size(); ++c) {
    area[plate[c]] += state.grid().area_m2(state.grid().row(c)) / state.grid().total_area_m2();
  }
  return area;
}

TEST(PlateLives, NumbersInFramesTableAndEndAreThoseOfTheSamePlates) {
  const History run = history(restless());
  const StepTable& steps = run.told.steps;
  const auto first = std::find(steps.columns.begin(), steps.columns.end(), "plate_0_km2");
  ASSERT_NE(first, steps.columns.end());
  const auto area_column = static_cast<std::size_t>(first - steps.columns.begin());
  const double sphere_km2 = 1e-6 * run.end.grid().total_area_m2();
  const auto check = [&](const State& state, std::size_t row) {
    const auto seen = shares(state);
    for (const auto& [id, share] : seen) {
      ASSERT_LT(area_column + id, steps.rows[row].size());
      const double listed = steps.rows[row][area_column + id] / sphere_km2;
      // The table counts what has subducted, the map what is seen.
      EXPECT_NEAR(share, listed, 0.35 * listed + 0.01) << id << " after step " << row + 1;
    }
    for (std::size_t k = area_column; k < steps.rows[row].size(); ++k) {
      const double listed = steps.rows[row][k] / sphere_km2;
      if (std::isfinite(listed) && listed > 0.02) {
        EXPECT_TRUE(seen.contains(static_cast<int>(k - area_column))) << k - area_column;
      }
    }
  };
  for (std::size_t k = 1; k < run.frames.size(); ++k) {
    SCOPED_TRACE("frame " + std::to_string(k));
    check(run.frames[k].fields, 10 * k - 1);
  }
  check(run.end, steps.rows.size() - 1);
}

TEST(PlateLives, APlateStaysWhereItIsFromFrameToFrame) {
  PlatesParameters parameters = restless();
  parameters.frames_myr = 2.0;
  const History run = history(parameters);
  // Samples are 290 km apart and plates go 200 km: most of a plate's cells are its own still.
  for (std::size_t k = 1; k < run.frames.size(); ++k) {
    const State &before = run.frames[k - 1].fields, &after = run.frames[k].fields;
    const auto was = before.read(field::plate_id), is = after.read(field::plate_id);
    std::map<int, double> whole, kept;
    for (Index c = 0; c < before.grid().size(); ++c) {
      const double area = before.grid().area_m2(before.grid().row(c));
      whole[is[c]] += area;
      kept[is[c]] += was[c] == is[c] ? area : 0.0;
    }
    const auto parts = shares(before);
    for (const auto& [id, area] : whole) {
      // Born now, or small.
      if (!parts.contains(id) || area < 0.01 * before.grid().total_area_m2()) continue;
      // What has joined it is not counted.
      const double least = std::min(area, parts.at(id) * before.grid().total_area_m2());
      EXPECT_GT(kept[id], 0.5 * least) << "plate " << id << ", frame " << k;
    }
  }
}

TEST(PlateLives, EachPlateTellsWhoseItWasAndWhatBecameOfIt) {
  const History run = history(restless());
  const TextTable& lives = lives_of(run.told);
  ASSERT_EQ(lives.columns, (std::vector<std::string>{"plate_id", "origin", "parent_id", "born_myr",
                                                     "ended_myr", "joined_id", "end"}));
  const StepTable& steps = run.told.steps;
  const auto area_column = static_cast<std::size_t>(
      std::find(steps.columns.begin(), steps.columns.end(), "plate_0_km2") - steps.columns.begin());
  std::map<std::string, int> origins;
  for (std::size_t id = 0; id < lives.rows.size(); ++id) {
    const auto& row = lives.rows[id];
    SCOPED_TRACE("plate " + row[0]);
    ASSERT_EQ(row.size(), lives.columns.size());
    EXPECT_EQ(row[0], std::to_string(id));
    ++origins[row[1]];
    const double born = std::stod(row[3]);
    EXPECT_EQ(row[1] == "first", born == 0.0 && id < 12) << row[1];
    if (row[1] != "first") {
      const std::size_t parent = std::stoul(row[2]);
      ASSERT_LT(parent, id);
      EXPECT_LE(std::stod(lives.rows[parent][3]), born);
    }
    const double ended = row[4].empty() ? 1e9 : std::stod(row[4]);
    EXPECT_LE(born, ended);
    if (!row[5].empty()) {
      EXPECT_LT(std::stoul(row[5]), lives.rows.size());
    }
    EXPECT_EQ(row[6], row[4].empty() ? "" : row[5].empty() ? "subducted" : "merged");
    // It has an area from its birth to its end and no other time.
    for (const auto& step : steps.rows) {
      const std::size_t at = area_column + id;
      const bool has_area = at < step.size() && std::isfinite(step[at]);
      if (step[0] != born && step[0] != ended) {
        EXPECT_EQ(has_area, step[0] > born && step[0] < ended) << step[0];
      }
    }
  }
  EXPECT_EQ(origins["first"], 12);
  EXPECT_GT(origins["rift"], 2);
}

TEST(PlateRotations, AreThoseWithWhichFramesMove) {
  PlatesParameters parameters = restless();
  parameters.no_net_rotation = false;  // else that is taken away after a frame is shown
  const History run = history(parameters);
  const TextTable& rotations = table_of(run.told, "rotations");
  ASSERT_EQ(rotations.columns,
            (std::vector<std::string>{"from_myr", "to_myr", "plate_id", "pole_latitude_deg",
                                      "pole_longitude_deg", "rate_deg_myr"}));
  constexpr double kRadians = 3.14159265358979323846 / 180.0;
  for (std::size_t k = 0; k + 1 < run.frames.size(); ++k) {
    const State& frame = run.frames[k].fields;
    std::map<int, Vector3> rotation_mm_yr;
    for (const auto& row : rotations.rows) {
      if (std::stod(row[0]) != run.frames[k].checkpoint.time_myr) continue;
      const double latitude = std::stod(row[3]) * kRadians,
                   longitude = std::stod(row[4]) * kRadians;
      const double rate = std::stod(row[5]) * kRadians * 1e-3 * frame.grid().figure().radius_m;
      rotation_mm_yr[std::stoi(row[2])] = {rate * std::cos(latitude) * std::cos(longitude),
                                           rate * std::cos(latitude) * std::sin(longitude),
                                           rate * std::sin(latitude)};
    }
    const auto plate = frame.read(field::plate_id);
    const auto east = frame.read(field::plate_velocity_east);
    const auto north = frame.read(field::plate_velocity_north);
    const Grid& grid = frame.grid();
    for (Index c = 0; c < grid.size(); ++c) {
      ASSERT_TRUE(rotation_mm_yr.contains(plate[c])) << plate[c] << ", frame " << k;
      const Centre at = grid.position(grid.column(c), grid.row(c));
      const double phi = at.latitude_deg * kRadians, lambda = at.longitude_deg * kRadians;
      const Vector3 r{std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda),
                      std::sin(phi)};
      const Vector3 v = cross(rotation_mm_yr[plate[c]], r);
      ASSERT_NEAR(east[c], -v[0] * std::sin(lambda) + v[1] * std::cos(lambda), 1e-3);
      ASSERT_NEAR(north[c],
                  dot(v, {-std::sin(phi) * std::cos(lambda), -std::sin(phi) * std::sin(lambda),
                          std::cos(phi)}),
                  1e-3);
    }
  }
}

TEST(PlateRotations, EndWithThePlateAndAreThereInEachStepOfItsLife) {
  const History run = history(restless());
  const TextTable& rotations = table_of(run.told, "rotations");
  std::map<int, std::vector<double>> steps;
  for (const auto& row : rotations.rows) {
    EXPECT_NEAR(std::stod(row[1]) - std::stod(row[0]), 2.0, 1e-9);
    steps[std::stoi(row[2])].push_back(std::stod(row[0]));
  }
  for (const auto& life : lives_of(run.told).rows) {
    const double born = std::stod(life[3]), ended = life[4].empty() ? 100.0 : std::stod(life[4]);
    EXPECT_EQ(static_cast<double>(steps[std::stoi(life[0])].size()), (ended - born) / 2.0)
        << "plate " << life[0];
  }
}

/// Of two sides of a convergent boundary one subducts below the other: continents stay above floor.
TEST(SubductionPolarity, ContinentsStayAboveFloor) {
  const History run = history(restless());
  int pairs = 0, agree = 0, land = 0, above = 0;
  for (const Frame& frame : run.frames) {
    const State& state = frame.fields;
    const Grid& grid = state.grid();
    const auto polarity = state.read(field::subduction_polarity);
    const auto type = state.read(field::boundary_type);
    const auto plate = state.read(field::plate_id);
    const auto fraction = state.read(field::continental_fraction);
    for (Index c = 0; c < grid.size(); ++c) {
      EXPECT_EQ(polarity[c] != 0, type[c] == static_cast<std::int8_t>(BoundaryType::convergent));
      const int i = grid.column(c), j = grid.row(c);
      const Index other = grid.cell((i + 1) % grid.nx(), j);
      if (plate[c] == plate[other] || polarity[c] == 0 || polarity[other] == 0) continue;
      ++pairs;
      agree += polarity[c] + polarity[other] == 3 ? 1 : 0;
      const bool is_land = fraction[c] > 0.8F;
      if (is_land == (fraction[other] > 0.8F)) continue;
      if (std::min(fraction[c], fraction[other]) > 0.05F) continue;
      ++land;
      above += polarity[is_land ? c : other] == 1 ? 1 : 0;
    }
  }
  // Cells are as wide as samples are apart: some lie at a boundary with a third plate.
  EXPECT_GT(pairs, 200);
  EXPECT_GT(agree, 0.85 * pairs);
  EXPECT_GT(land, 10);
  EXPECT_GT(above, 0.8 * land);
}

TEST(PlateLives, TheLargestPieceOfARiftKeepsThePlatesNumber) {
  const History run = history(restless());
  const TextTable& lives = lives_of(run.told);
  const StepTable& steps = run.told.steps;
  const auto area_column = static_cast<std::size_t>(
      std::find(steps.columns.begin(), steps.columns.end(), "plate_0_km2") - steps.columns.begin());
  int seen = 0;
  for (const auto& row : lives.rows) {
    if (row[1] != "rift") continue;
    for (const auto& step : steps.rows) {
      if (step[0] != std::stod(row[3])) continue;
      const double own = step[area_column + std::stoul(row[0])];
      const double parent = step[area_column + std::stoul(row[2])];
      if (std::isfinite(own) && std::isfinite(parent)) {
        EXPECT_LE(own, parent) << row[0];
      }
      ++seen;
    }
  }
  EXPECT_GT(seen, 2);
}

TEST(PlateLives, GoOnFromAFrame) {
  const History whole = history(restless());
  const History rest =
      history(restless(), std::make_shared<const Checkpoint>(whole.frames[2].checkpoint));
  EXPECT_EQ(lives_of(rest.told).rows, lives_of(whole.told).rows);
  EXPECT_TRUE(same_values(rest.end, whole.end));
  ASSERT_EQ(rest.told.steps.rows.size(), 30U);
  const auto& last = whole.told.steps.rows.back();
  for (std::size_t k = 0; k < last.size(); ++k) {
    const double again = rest.told.steps.rows.back()[k];
    EXPECT_TRUE(again == last[k] || (std::isnan(again) && std::isnan(last[k]))) << k;
  }
}

TEST(PlateLives, FramesWithoutThemGoOn) {
  const History whole = history(restless());
  Checkpoint old = whole.frames[2].checkpoint;
  for (const char* name : {"plate_id", "life_origin", "life_parent", "life_joined", "life_born_myr",
                           "life_ended_myr", "past_myr", "plate_past"}) {
    ASSERT_EQ(old.arrays.erase(name), 1U) << name;
  }
  const History rest = history(restless(), std::make_shared<const Checkpoint>(std::move(old)));
  EXPECT_EQ(rest.frames.size(), 3U);
}

TEST(PlateLives, RefuseFramesWhoseNumbersDoNotFit) {
  const History whole = history(restless());
  for (const char* name : {"plate_id", "life_parent", "life_joined"}) {
    Checkpoint damaged = whole.frames[2].checkpoint;
    std::get<std::vector<std::int16_t>>(damaged.arrays.at(name)).back() = 3000;
    EXPECT_THROW(history(restless(), std::make_shared<const Checkpoint>(std::move(damaged))),
                 InputError)
        << name;
  }
  for (const char* name : {"life_born_myr", "plate_past", "past_myr"}) {
    Checkpoint damaged = whole.frames[2].checkpoint;
    std::get<std::vector<double>>(damaged.arrays.at(name)).push_back(1.0);
    EXPECT_THROW(history(restless(), std::make_shared<const Checkpoint>(std::move(damaged))),
                 InputError)
        << name;
  }
}

}  // namespace
}  // namespace geo
