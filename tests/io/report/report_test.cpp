// Pages of a report.
#include "geo/io/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/temporary_folder.hpp"
#include "support/text_of.hpp"

namespace geo::io {
namespace {

using test::text_of;

TEST(Report, EscapesTextAndReferencesPicturesRelatively) {
  const TemporaryFolder folder;
  Report report;
  report.title = "planet <b> & \"co\"";
  report.maps = {{folder / "maps/elevation.png", "Elevation", "a < b", 100, 50}};
  report.parameters = "[erosion]\nk = 1 # <script>alert(1)</script>\n";
  report.provenance = {{"seed", "1"}};
  report.fields = {{"elevation", "m", "height", -10.0, 1.5, 20.0}};
  const std::string page = text_of(write_report(folder.path(), report));
  EXPECT_THAT(page, testing::StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(page, testing::HasSubstr("planet &lt;b&gt; &amp; "));
  EXPECT_THAT(page, testing::HasSubstr("src=\"maps/elevation.png\""));
  EXPECT_THAT(page, testing::HasSubstr("[erosion]\nk = 1 # &lt;script&gt;"));
  EXPECT_THAT(page, testing::Not(testing::HasSubstr("<script")));
  EXPECT_THAT(page, testing::Not(testing::HasSubstr("http")));
  EXPECT_THAT(page, testing::HasSubstr("<td class=\"number\">1.5</td>"));
}

TEST(Report, FiguresAreThoseOfTheLastStageThatWroteTheField) {
  const auto record = [](const char* name, double mean) {
    return FieldRecord{name, "", mean - 1.0, mean, mean + 1.0, 0, ""};
  };
  const auto stage = [](const char* name, std::vector<FieldRecord> fields) {
    StageRecord written;
    written.name = name;
    written.fields = std::move(fields);
    return written;
  };
  Manifest manifest;
  manifest.stages = {stage("erosion", {record("elevation", 1.0)}),
                     stage("hydrology", {record("discharge", 5.0), record("lake_id", 7.0),
                                         record("elevation", 2.0)}),
                     stage("island", {record("elevation", 3.0)})};
  manifest.stages.back().own_grid = true;
  const auto fields = field_figures(manifest);
  ASSERT_EQ(fields.size(), 2U);  // a number of a lake is no figure
  EXPECT_EQ(fields[0].name, "elevation");
  EXPECT_EQ(fields[0].mean, 2.0);
  EXPECT_EQ(fields[0].max, 3.0);
  EXPECT_EQ(fields[0].units, "m");
  EXPECT_EQ(fields[1].name, "discharge");
}

TEST(Report, ScorecardMarksWhatLiesWithinBySignAndStyle) {
  const TemporaryFolder folder;
  Report report;
  report.scorecard.emplace();
  report.scorecard->lines = {{"relief", "land", "land <", "%", "x", 30.0, 29.0, 1.5, true},
                             {"relief", "mean", "mean", "m", "x", -3000.0, -3686.0, 150.0, false}};
  report.scorecard->left_out = {"no plate_id: plates"};
  report.events = {"impact & rift"};
  const std::string page = text_of(write_report(folder.path(), report));
  EXPECT_THAT(page, testing::HasSubstr("1 of 2 figures"));
  EXPECT_THAT(page, testing::HasSubstr("land &lt;"));
  EXPECT_THAT(page, testing::HasSubstr("<td class=\"within\">\u2713 within</td>"));
  EXPECT_THAT(page, testing::HasSubstr("<td class=\"outside\">\u2717 outside</td>"));
  EXPECT_THAT(page, testing::HasSubstr("\u00b1 1.5*"));
  EXPECT_THAT(page, testing::HasSubstr("\u22123000"));
  EXPECT_THAT(page, testing::HasSubstr("no plate_id"));
  EXPECT_THAT(page, testing::HasSubstr("impact &amp; rift"));
}

}  // namespace
}  // namespace geo::io
