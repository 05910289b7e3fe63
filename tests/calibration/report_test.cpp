// What a calibration hands over: five files that hold all it found.
#include "calibration/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <regex>
#include <set>

#include "calibration/report/report_curves.hpp"
#include "calibration/sample_result.hpp"
#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"
#include "geo/io/files/build_info.hpp"
#include "io/temporary_folder.hpp"
#include "support/declarations.hpp"

namespace geo::calibration {
namespace {

using testing::HasSubstr;
using testing::Not;

class CalibrationReport : public testing::Test {
 protected:
  void write(const Result& result) {
    write_results(result, declarations_.all(), events_, folder_.path());
  }
  [[nodiscard]] std::string text_of(const std::string& name) const {
    return io::read_text(folder_ / name);
  }

  Result result_ = made_up_result();
  test::Declarations declarations_;
  std::vector<Event> events_;
  TemporaryFolder folder_;
};

TEST_F(CalibrationReport, LeavesItsFilesAndNothingElse) {
  write(result_);
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    names.insert(entry.path().filename());
  }
  EXPECT_THAT(names, testing::ElementsAre("calibration.json", "fitted.toml", "hypsometry.csv",
                                          "hypsometry.png", "report.html"));
}

TEST_F(CalibrationReport, GoesWithTheStateOfItsFitAndNothingElse) {
  write(result_);
  for (const std::string& name : {std::string(kStateFile), std::string("notes.txt")}) {
    std::ofstream(folder_ / name) << "{}";
  }
  remove_results(folder_.path());
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
    names.insert(entry.path().filename());
  }
  EXPECT_THAT(names, testing::ElementsAre("notes.txt"));
  EXPECT_NO_THROW(remove_results(folder_.path()));
}

TEST_F(CalibrationReport, JsonHoldsEveryFigure) {
  write(result_);
  const auto json = nlohmann::json::parse(text_of("calibration.json"));
  EXPECT_EQ(json["target"], "earth");
  EXPECT_EQ(json["converged"], true);
  ASSERT_EQ(json["parameters"].size(), 3U);
  const auto& first = json["parameters"][0];
  EXPECT_EQ(first["name"], "isostasy.collision_km");
  EXPECT_EQ(first["start"], 30.0);
  EXPECT_EQ(first["fitted"], 38.1846251923);  // every bit of it
  EXPECT_EQ(first["bounds"], nlohmann::json({0.0, 60.0}));
  EXPECT_EQ(first["standard_error"], 0.8);
  EXPECT_EQ(first["seed_error"], 1.6);
  EXPECT_TRUE(first["prior"].is_null());
  EXPECT_EQ(json["parameters"][1]["prior"]["deviation"], 0.05);
  EXPECT_EQ(json["parameters"][1]["at_bound"], true);
  EXPECT_EQ(json["parameters"][2]["scale"], "logarithmic");
  EXPECT_EQ(json["correlation"][1][2], 0.97);
  ASSERT_EQ(json["residuals"].size(), 66U);
  EXPECT_EQ(json["residuals"][64]["name"], "land_fraction");
  EXPECT_TRUE(json["residuals"][64]["share"].is_null());
  ASSERT_EQ(json["iterations"].size(), 27U);
  EXPECT_EQ(json["iterations"][6]["accepted"], false);
  EXPECT_EQ(json["misfit"]["fitted"]["seeds"][3]["seed"], 4);
  EXPECT_DOUBLE_EQ(json["misfit"]["fitted"]["mean_before_m"], 350.0);
  EXPECT_DOUBLE_EQ(json["misfit"]["held_out"]["mean_after_m"], 102.5);
  EXPECT_EQ(json["misfit"]["held_out_resolution"]["seeds"].size(), 4U);
  EXPECT_EQ(json["directions"][2]["weights"][1], 0.79);
  EXPECT_EQ(json["profiles"][0]["cost"][2], 40.1);
  EXPECT_EQ(json["starts"][2]["converged"], false);
  EXPECT_EQ(json["starts"][2]["ending"], "9 iterations did not suffice");
  EXPECT_EQ(json["hypsometry"]["target_m"].size(), 64U);
  EXPECT_EQ(json["program"]["version"], io::build_info().version);
  EXPECT_TRUE(json["program"]["libraries"].contains("netCDF"));
}

TEST_F(CalibrationReport, JsonHasNullForWhatIsNotDetermined) {
  write(result_);
  const auto json = nlohmann::json::parse(text_of("calibration.json"));
  EXPECT_TRUE(json["parameters"][1]["standard_error"].is_null());
  EXPECT_TRUE(json["parameters"][1]["seed_error"].is_null());
}

TEST_F(CalibrationReport, SameResultMakesTheSameBytesWhereTheTimeIsGiven) {
  setenv("SOURCE_DATE_EPOCH", "1700000000", 1);
  write(result_);
  const std::string json = text_of("calibration.json"), page = text_of("report.html");
  result_.seconds *= 2.0;
  result_.seconds_per_forward *= 2.0;
  result_.iterations.front().seconds = 9.0;
  write(result_);
  EXPECT_EQ(text_of("calibration.json"), json);
  EXPECT_EQ(text_of("report.html"), page);
  unsetenv("SOURCE_DATE_EPOCH");
}

TEST_F(CalibrationReport, FittedConfigurationReadsBackTheSame) {
  auto rows = declarations_.all();
  const Parameter* factor = find_parameter(rows, "erosion.erodibility_factor");
  ASSERT_NE(factor, nullptr);
  factor->set(0.051234567890123);
  events_.push_back({"strike", Impact{.latitude_deg = 12.0, .longitude_deg = 34.0}});
  write(result_);
  test::Declarations again;
  auto fresh = again.all();
  std::vector<Event> events;
  const auto set = io::apply_config_file(folder_ / "fitted.toml", fresh, &events);
  EXPECT_EQ(set.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(fresh[i].value(), rows[i].value()) << rows[i].name;
  }
  ASSERT_EQ(events.size(), 1U);
  EXPECT_EQ(events.front().name, "strike");
}

TEST_F(CalibrationReport, TableHasTheThreeCurves) {
  write(result_);
  std::istringstream lines(text_of("hypsometry.csv"));
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "quantile,target_m,before_m,after_m");
  for (int k = 0; k < 64; ++k) {
    ASSERT_TRUE(std::getline(lines, line));
    double quantile = 0.0, target = 0.0, before = 0.0, after = 0.0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &quantile, &target, &before, &after), 4);
    EXPECT_NEAR(quantile, (k + 0.5) / 64, 1e-9);
    EXPECT_NEAR(target, result_.target.elevation_m[k], 1e-3);
    EXPECT_NEAR(before, result_.before.elevation_m[k], 1e-3);
    EXPECT_NEAR(after, result_.after.elevation_m[k], 1e-3);
  }
  EXPECT_FALSE(std::getline(lines, line));
}

TEST_F(CalibrationReport, ShowsThePartThatTheTargetTellsOfAlone) {
  for (Curve* curve : {&result_.target, &result_.before, &result_.after}) {
    curve->share_from = 0.2;
    curve->share_to = 0.6;
  }
  write(result_);
  std::istringstream lines(text_of("hypsometry.csv"));
  std::string line;
  std::getline(lines, line);
  int rows = 0;
  for (double quantile = 0.0; std::getline(lines, line); ++rows) {
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf", &quantile), 1);
    EXPECT_NEAR(quantile, 0.2 + (rows + 0.5) / 64 * 0.4, 1e-9);
  }
  EXPECT_EQ(rows, 64);
  const io::Chart chart = curves_chart(result_);
  for (const io::ChartPanel& panel : chart.panels) {
    EXPECT_DOUBLE_EQ(panel.x.low, 40.0);
    EXPECT_DOUBLE_EQ(panel.x.high, 80.0);
  }
  const auto json = nlohmann::json::parse(text_of("calibration.json"));
  EXPECT_EQ(json["hypsometry"]["share_from"], 0.2);
  EXPECT_EQ(json["hypsometry"]["share_to"], 0.6);
  EXPECT_THAT(text_of("report.html"), HasSubstr("quantiles 0.2 to 0.6"));
}

TEST_F(CalibrationReport, TellsHowFarApartPlanetsLieAndThatTheyBecameAlike) {
  result_.held_out_spread = {200.0, 40.0};
  result_.fitted_spread = {200.0, 160.0};
  write(result_);
  const auto json = nlohmann::json::parse(text_of("calibration.json"));
  EXPECT_EQ(json["misfit"]["held_out"]["spread_before_m"], 200.0);
  EXPECT_EQ(json["misfit"]["held_out"]["spread_after_m"], 40.0);
  EXPECT_EQ(json["misfit"]["held_out"]["collapsed"], true);
  EXPECT_EQ(json["misfit"]["fitted"]["collapsed"], false);
  EXPECT_TRUE(json["misfit"]["held_out_resolution"]["spread_after_m"].is_null());
  EXPECT_EQ(json["misfit"]["held_out_resolution"]["collapsed"], false);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(text_of("report.html").c_str()));
  const auto marked = document.select_nodes("//td[@class='number outside' and contains(., '→')]");
  ASSERT_EQ(marked.size(), 1U);
  EXPECT_STREQ(marked.first().node().child_value(), "200 → 40.0");
}

/// Share of the pixels of each colour of a picture.
std::map<std::array<int, 3>, double> colours_of(const std::filesystem::path& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  std::map<std::array<int, 3>, double> colours;
  if (png_image_begin_read_from_file(&image, path.c_str()) == 0) return colours;
  image.format = PNG_FORMAT_RGB;
  std::vector<png_byte> bytes(PNG_IMAGE_SIZE(image));
  png_image_finish_read(&image, nullptr, bytes.data(), 0, nullptr);
  const double pixels = static_cast<double>(image.width) * image.height;
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) {
    colours[{bytes[i], bytes[i + 1], bytes[i + 2]}] += 1.0 / pixels;
  }
  return colours;
}

TEST_F(CalibrationReport, PictureShowsThreeCurves) {
  write(result_);
  const auto colours = colours_of(folder_ / "hypsometry.png");
  EXPECT_GT(colours.size(), 50U);
  const std::array<int, 3> paper{255, 255, 255}, ink{33, 38, 46}, grey{140, 148, 158},
      red{189, 56, 41};
  EXPECT_LT(colours.at(paper), 0.98);
  for (const auto& wanted : {ink, grey, red}) {
    double share = 0.0;
    for (const auto& [colour, part] : colours) {
      const bool near = std::abs(colour[0] - wanted[0]) < 3 &&
                        std::abs(colour[1] - wanted[1]) < 3 && std::abs(colour[2] - wanted[2]) < 3;
      share += near ? part : 0.0;
    }
    EXPECT_GT(share, 0.001) << wanted[0];  // a line across is 3 px of about 900
  }
}

TEST_F(CalibrationReport, PageIsWellFormedAndNeedsNothingElse) {
  write(result_);
  const std::string page = text_of("report.html");
  pugi::xml_document document;
  const auto parsed = document.load_string(page.c_str(), pugi::parse_full);
  ASSERT_TRUE(parsed) << parsed.description() << " at " << page.substr(parsed.offset, 80);
  EXPECT_THAT(page, Not(HasSubstr("http")));
  EXPECT_THAT(page, Not(HasSubstr("url(")));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("@import")));
  for (const auto& node : document.select_nodes("//@src | //@href")) {
    ADD_FAILURE() << "refers to " << node.attribute().value();
  }
  // Signs that a style sheet may hold but markup would have to write otherwise.
  const std::string style = document.select_node("//style").node().child_value();
  EXPECT_EQ(style.find_first_of("<>&"), std::string::npos);
}

TEST_F(CalibrationReport, PageShowsEveryPart) {
  write(result_);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_string(text_of("report.html").c_str()));
  std::vector<std::string> heads;
  for (const auto& node : document.select_nodes("//main/h2")) {
    heads.emplace_back(node.node().child_value());
  }
  EXPECT_THAT(heads, testing::ElementsAre("Curve", "Parameters", "What the data determine",
                                          "Profiles", "Misfit of each planet", "Residuals",
                                          "Convergence", "Effort and provenance"));
  // Curve, correlations, directions, two profiles, residuals, convergence.
  EXPECT_EQ(document.select_nodes("//svg[@role='img']").size(), 7U);
  EXPECT_EQ(
      document.select_nodes("//svg[@aria-label='Correlations of the parameters']/rect").size(), 9U);
  EXPECT_EQ(document.select_nodes("//li[contains(., 'hardly told apart')]").size(), 1U);
  EXPECT_EQ(document.select_nodes("//td[contains(., 'at its bound')]").size(), 1U);
}

TEST_F(CalibrationReport, PageDrawsNoPointThatIsNoNumber) {
  result_.profiles.front().cost[1] = kUnknown;
  result_.correlation[0][1] = kUnknown;
  write(result_);
  const std::string page = text_of("report.html");
  EXPECT_FALSE(std::regex_search(page, std::regex("[\" ,(]-?(nan|inf)[\" ,)]")));
}

TEST_F(CalibrationReport, SaysThatItDidNotConverge) {
  result_.converged = false;
  write(result_);
  EXPECT_THAT(text_of("report.html"), HasSubstr("did not converge"));
  EXPECT_EQ(nlohmann::json::parse(text_of("calibration.json"))["converged"], false);
}

TEST_F(CalibrationReport, AFitWithoutExtrasStillMakesAPage) {
  result_.warnings.clear();
  result_.profiles.clear();
  result_.directions.clear();
  result_.correlation.clear();
  result_.held_out.clear();
  result_.held_out_resolution.clear();
  result_.starts.clear();
  result_.iterations.clear();
  result_.residuals.clear();
  write(result_);
  pugi::xml_document document;
  EXPECT_TRUE(document.load_string(text_of("report.html").c_str(), pugi::parse_full));
}

TEST_F(CalibrationReport, NamesTheFileThatCannotBeWritten) {
  try {
    write_results(result_, declarations_.all(), events_, folder_ / "absent");
    FAIL() << "wrote into a folder that does not exist";
  } catch (const IoError& error) {
    EXPECT_THAT(error.what(), HasSubstr("fitted.toml"));
  }
}

}  // namespace
}  // namespace geo::calibration
