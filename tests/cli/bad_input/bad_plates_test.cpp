// Plates, motions and elevations that drift cannot begin with.
#include <fstream>

#include "cli/bad_input/bad_input.hpp"
#include "cli/folder_contents.hpp"
#include "cli/program.hpp"
#include "cli/relief_file.hpp"

namespace geo {
namespace {

/// A run of drifting plates that are in such a file.
auto drift_of(std::string plates, Words more = {}) {
  return [plates = std::move(plates), more = std::move(more)](const fs::path& folder) {
    if (!plates.empty()) std::ofstream(folder / "plates.geojson", std::ios::binary) << plates;
    Words arguments{"run",
                    "-o",
                    (folder / "out").string(),
                    "--grid",
                    "64x32",
                    "--to",
                    "plates",
                    "--set",
                    "plates.model=sphere",
                    "--set",
                    "fields.plates=" + (folder / "plates.geojson").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
}

std::string two_plates(const std::string& properties, const std::string& ring) {
  return R"({"type": "FeatureCollection", "features": [)"
         R"({"properties": {"Code": "PA"}, "geometry": {"type": "Polygon", "coordinates": )"
         R"([[[0, 0], [90, 0], [90, 45], [0, 0]]]}}, {"properties": {)" +
         properties + R"(}, "geometry": {"type": "Polygon", "coordinates": [)" + ring + "]}}]}";
}

const BadInput kPlates[] = {
    {"WithARelief",
     kConfiguration,
     {"fields.plates = earth: is for stage plates", "begins with erosion", "--dem",
      "must be empty"},
     [](const fs::path& folder) {
       return quick_run(folder / "relief.nc", folder / "out", {"--set", "fields.plates=earth"});
     }},
    {"FirstReliefWithARelief",
     kConfiguration,
     {"fields.initial_elevation = x.nc: is for stage plates", "must be empty"},
     [](const fs::path& folder) {
       return quick_run(folder / "relief.nc", folder / "out",
                        {"--set", "fields.initial_elevation=x.nc"});
     }},
    {"OthersBehindAStageThatStays",
     kConfiguration,
     {"--from isostasy", "fields.plates is \"earth\", was \"\"", "--overwrite"},
     [](const fs::path& folder) {
       const Words drift{"run", "-o", (folder / "out").string(), "--set", "plates.model=sphere"};
       Words first = drift, again = drift;
       for (const char* word :
            {"--grid", "64x32", "--to", "plates", "--set", "plates.sphere.samples=2000", "--set",
             "plates.sphere.time_myr=4", "--no-vtk", "--no-maps"}) {
         first.emplace_back(word);
       }
       for (const char* word : {"--overwrite", "--from", "isostasy", "--to", "isostasy", "--set",
                                "plates.sphere.samples=2000", "--set", "plates.sphere.time_myr=4",
                                "--set", "fields.plates=earth"}) {
         again.emplace_back(word);
       }
       const Outcome outcome = terrane(first);
       EXPECT_EQ(outcome.code, 0) << outcome.err;
       return again;
     }},
    {"NoFile", kInput, {"fields.plates", "no such file", "must be earth or"}, drift_of("")},
    {"NoJson", kInput, {"plates.geojson: is no JSON"}, drift_of("<kml/>")},
    {"UnknownCode",
     kInput,
     {"plates.geojson: feature 2 (XY): XY is no Code of PB2002"},
     drift_of(two_plates(R"("Code": "XY")", "[[0, 0], [9, 0], [9, 9], [0, 0]]"))},
    {"CrossesItself",
     kInput,
     {"feature 2 (AF): a ring crosses itself"},
     drift_of(two_plates(R"("Code": "AF")", "[[0, 0], [9, 9], [9, 0], [0, 9], [0, 0]]"))},
    {"InMetres",
     kInput,
     {"feature 2 (AF): 900000, 0 is no longitude"},
     drift_of(two_plates(R"("Code": "AF")", "[[0, 0], [9e5, 0], [9e5, 9], [0, 0]]"))},
    {"MotionsOfOutlines",
     kConfiguration,
     {"fields.plate_rotations = x.csv", "by number", "must be empty"},
     drift_of("<>", {"--set", "fields.plate_rotations=x.csv"})},
    {"NumbersWithoutMotions",
     kConfiguration,
     {"relief.nc", "plates by number", "fields.plate_rotations"},
     [](const fs::path& folder) {
       ReliefFile{}.write(folder / "relief.nc");
       return drift_of("", {"--set", "fields.plates=" + (folder / "relief.nc").string()})(folder);
     }},
    {"NoFirstRelief",
     kConfiguration,
     {"plates.sphere.initial_elevation = given", "fields.initial_elevation"},
     drift_of("",
              {"--set", "fields.plates=earth", "--set", "plates.sphere.initial_elevation=given"})},
    {"FirstReliefOfAPart",
     kInput,
     {"fields.initial_elevation", "must cover the whole planet"},
     [](const fs::path& folder) {
       ReliefFile{.north_deg = 60.0}.write(folder / "part.nc");
       return drift_of(
           "", {"--set", "fields.plates=earth", "--set", "plates.sphere.initial_elevation=given",
                "--set", "fields.initial_elevation=" + (folder / "part.nc").string()})(folder);
     }},
};

INSTANTIATE_TEST_SUITE_P(Plates, BadInputTest, testing::ValuesIn(kPlates), name_of_input);

}  // namespace
}  // namespace geo
