#include "io/run/parked_fields.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/io/files/digest.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "io/sample_snapshot.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

/// A stage's file in a folder, and its record.
struct Written {
  explicit Written(const TemporaryFolder& folder) : snapshot(sample_snapshot(Grid::sphere(16, 8))) {
    write_netcdf(folder / "03-erosion.nc", snapshot, sample_provenance());
    record.name = snapshot.stage;
    record.files = {"03-erosion.nc"};
    for (const auto& [spec, values] : snapshot.fields) {
      record.fields.push_back(summarise(*spec, *values, *snapshot.grid));
    }
  }
  [[nodiscard]] State state() const {
    State all(snapshot.grid);
    for (const auto& [spec, values] : snapshot.fields) all.share(*spec, values);
    return all;
  }
  Snapshot snapshot;
  StageRecord record;
};

TEST(ParkedFields, ComeBackAsTheyWere) {
  const TemporaryFolder folder;
  const Written written(folder);
  const State before = written.state();
  const ParkedFields parked(folder / "", std::vector{written.record}, before);
  for (const FieldSpec* spec : before.present()) {
    ASSERT_TRUE(parked.has(*spec)) << spec->name;
    State after(before.shared_grid());
    parked.fetch(*spec, after);
    EXPECT_TRUE(same_bits(*after.values(*spec), *before.values(*spec))) << spec->name;
  }
}

TEST(ParkedFields, LeaveOutWhatWasGivenInPlaceOfAStages) {
  const TemporaryFolder folder;
  const Written written(folder);
  State given = written.state();
  given.update(field::elevation)[0] += 1.0F;
  const ParkedFields parked(folder / "", std::vector{written.record}, given);
  EXPECT_FALSE(parked.has(field::elevation));
}

TEST(ParkedFields, ThatAreGoneOrChangedAreAnIoError) {
  const TemporaryFolder folder;
  Written written(folder);
  const State state = written.state();
  const ParkedFields parked(folder / "", std::vector{written.record}, state);
  written.snapshot = sample_snapshot(Grid::sphere(16, 8), 2);
  write_netcdf(folder / "03-erosion.nc", written.snapshot, sample_provenance());
  State after(state.shared_grid());
  EXPECT_THROW(parked.fetch(field::elevation, after), IoError);
  std::filesystem::remove(folder / "03-erosion.nc");
  EXPECT_THROW(parked.fetch(field::elevation, after), IoError);
}

}  // namespace
}  // namespace geo::io
