// run --turn: planets laid out with another pole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "cli/program.hpp"
#include "cli/relief_file.hpp"
#include "cli/sample_run.hpp"
#include "geo/io/netcdf/stage_file.hpp"
#include "geo/kernels/remapping/turned_planet.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

using testing::HasSubstr;
using Words = std::vector<std::string>;

/// A field of a file, laid out like that of another file, against it: weighted correlation.
double agreement(const std::string& plain, const std::string& turned, const std::string& name) {
  const io::Snapshot a = io::read_netcdf(plain), b = io::read_netcdf(turned);
  const auto values = [&](const io::Snapshot& snapshot) {
    for (const auto& [spec, of] : snapshot.fields) {
      if (spec->name == name) return std::get<std::vector<float>>(*of);
    }
    ADD_FAILURE() << name;
    return std::vector<float>{};
  };
  const auto x = laid_out_turned(*a.grid, values(a), *b.grid), y = values(b);
  double w = 0.0, mx = 0.0, my = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
  for (Index c = 0; c < b.grid->size(); ++c) {
    const double area = b.grid->area_m2(b.grid->row(c));
    w += area, mx += area * x[c], my += area * y[c];
  }
  mx /= w, my /= w;
  for (Index c = 0; c < b.grid->size(); ++c) {
    const double area = b.grid->area_m2(b.grid->row(c)), dx = x[c] - mx, dy = y[c] - my;
    xx += area * dx * dx, yy += area * dy * dy, xy += area * dx * dy;
  }
  return xy / std::sqrt(xx * yy);
}

class Turn : public testing::Test {
 protected:
  Outcome run(const std::string& name, const Words& more) {
    Words words{"run",     "--preset", "preview",   "--seed", "4",       "--grid",
                "256x128", "--no-vtk", "--no-maps", "-o",     path(name)};
    words.insert(words.end(), more.begin(), more.end());
    return terrane(words);
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }
  TemporaryFolder folder_;
};

TEST_F(Turn, LaysTheSamePlanetOutWithAnotherPole) {
  ASSERT_EQ(run("plain", {"--to", "erosion"}).code, 0);
  ASSERT_EQ(run("turned", {"--to", "erosion", "--turn=20,75,130"}).code, 0);
  EXPECT_GT(
      agreement(path("plain/01-plates.nc"), path("turned/01-plates.nc"), "continental_fraction"),
      0.97);
  EXPECT_GT(agreement(path("plain/03-erosion.nc"), path("turned/03-erosion.nc"), "elevation"),
            0.97);
}

TEST_F(Turn, IsKeptByTheFolder) {
  ASSERT_EQ(run("whole", {"--to", "climate", "--turn=-35,10,0"}).code, 0);
  ASSERT_EQ(run("parts", {"--to", "isostasy", "--turn=-35,10,0"}).code, 0);
  const Outcome more = terrane({"run", "--resume", "-o", path("parts"), "--to", "climate"});
  ASSERT_EQ(more.code, 0) << more.err;
  EXPECT_EQ(digests_of(path("parts")), digests_of(path("whole")));
}

TEST_F(Turn, LaysOutAReliefThatIsGiven) {
  ASSERT_EQ(run("plain", {"--to", "isostasy"}).code, 0);
  const Outcome outcome =
      terrane(quick_run(path("plain/02-isostasy.nc"), path("given"), {"--turn=20,75,130"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_GT(agreement(path("plain/02-isostasy.nc"), path("given/03-erosion.nc"), "elevation"),
            0.99);
}

TEST_F(Turn, IsRefusedWhereNothingCanBeTurned) {
  for (const Words& more : {Words{"--turn=95,0,0"}, Words{"--turn=1,2"}, Words{"--turn=pole"}}) {
    const Outcome outcome = run("bad", more);
    EXPECT_NE(outcome.code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("turn"));
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  }
  const Outcome torus = terrane({"run", "--topology", "torus", "--turn=1,2,3", "-o", path("bad")});
  EXPECT_EQ(torus.code, 2) << torus.err;
  EXPECT_THAT(torus.err, HasSubstr("a torus cannot be turned"));
}

}  // namespace
}  // namespace geo
