// Elevation models that are not sound.
#include <cmath>
#include <fstream>

#include "cli/bad_input/bad_input.hpp"
#include "cli/folder_contents.hpp"
#include "cli/program.hpp"
#include "cli/relief_file.hpp"

namespace geo {
namespace {

/// A run of a relief that is not sound.
auto run_relief(ReliefFile relief, std::string variable = "") {
  return [relief, variable = std::move(variable)](const fs::path& folder) {
    relief.write(folder / "bad.nc");
    return quick_run((folder / "bad.nc").string() + variable, folder / "out");
  };
}

/// A run of a relief file with such bytes.
auto run_bytes(std::function<std::string(const std::string& sound)> bytes) {
  return [bytes = std::move(bytes)](const fs::path& folder) {
    std::ofstream(folder / "bad.nc", std::ios::binary) << bytes(text_of(folder / "relief.nc"));
    return quick_run(folder / "bad.nc", folder / "out");
  };
}

const BadInput kReliefs[] = {
    {"NaN",
     kInput,
     {"bad.nc", "variable z", "1 cell(s) are missing or NaN", "row 18, column 5", "latitude 2.5"},
     run_relief({.hole = std::nan("")})},
    {"MissingValue",
     kInput,
     {"bad.nc", "variable z", "1 cell(s) are missing or NaN", "row 18, column 5"},
     run_relief({.hole = -32768.0})},
    {"Infinity",
     kInput,
     {"bad.nc", "variable z", "row 18, column 5"},
     run_relief({.hole = INFINITY})},
    {"HeightsBeyondAnyPlanet",
     kInput,
     {"bad.nc:z", "elevation of", "within 100000 m"},
     run_relief({.hole = 1e30})},
    {"WrongUnits",
     kInput,
     {"bad.nc", "variable z", "units are \"K\"", "must be a length"},
     run_relief({.units = "K"})},
    {"AbsentVariable",
     kInput,
     {"bad.nc", "variable height is missing", "holds z"},
     run_relief({}, ":height")},
    {"OneDimension",
     kInput,
     {"bad.nc", "holds no raster over latitude and longitude"},
     run_relief({.one_dimensional = true})},
    {"OneDimensionByName",
     kInput,
     {"bad.nc", "variable z"},
     run_relief({.one_dimensional = true}, ":z")},
    {"UnevenLatitudes",
     kInput,
     {"bad.nc", "axis lat", "uneven at index"},
     run_relief({.latitude_kink_deg = 1.0})},
    {"Truncated", kInput, {"bad.nc", "truncated"}, run_bytes([](const std::string& sound) {
       return sound.substr(0, sound.size() * 2 / 3);
     })},
    {"Empty", kInput, {"bad.nc", "not a NetCDF file"}, run_bytes([](auto&) { return ""; })},
    {"TextFile", kInput, {"bad.nc", "not a NetCDF file"}, run_bytes([](auto&) {
       return "latitude,longitude,elevation\n";
     })},
    {"FieldBelowItsBound",
     kInput,
     {"k.nc:k: erodibility is -", "yr-1 somewhere; must be at least 0"},
     [](const fs::path& folder) {
       ReliefFile{.variable = "k", .units = "yr-1"}.write(folder / "k.nc");
       return quick_run(folder / "relief.nc", folder / "out",
                        {"--set", "fields.erodibility=" + (folder / "k.nc").string()});
     }},
    {"FieldThatAStageMakes",
     kConfiguration,
     {"fields.erodibility = ", "stage isostasy of this run makes erodibility itself"},
     [](const fs::path& folder) {
       return Words{"run", "--grid",      "64x32", "--set", "fields.erodibility=k.nc",
                    "-o",  folder / "out"};
     }},
    {"Folder",
     kIo,
     {"Is a directory"},
     [](const fs::path& folder) { return quick_run(folder, folder / "out"); }},
    {"Absent",
     kIo,
     {"nowhere.nc", "No such file"},
     [](const fs::path& folder) { return quick_run(folder / "nowhere.nc", folder / "out"); }},
    {"NameBeyondAllNames",
     kIo,
     {"File name too long"},
     [](const fs::path& folder) { return quick_run(std::string(5000, 'x'), folder / "out"); }},
    {"InfoOfARelief",
     kInput,
     {"relief.nc", "not a stage file"},
     [](const fs::path& folder) {
       return Words{"info", folder / "relief.nc"};
     }},
    {"InfoOfText",
     kInput,
     {"note.txt", "not a NetCDF file"},
     [](const fs::path& folder) {
       std::ofstream(folder / "note.txt") << "hello\n";
       return Words{"info", folder / "note.txt"};
     }},
    {"InfoOfAFolder", kConfiguration, {"info: . is a folder", "--verify"}, words({"info", "."})},
    {"InfoOfNothing", kIo, {"nowhere.nc", "No such file"}, words({"info", "nowhere.nc"})},
};

INSTANTIATE_TEST_SUITE_P(Relief, BadInputTest, testing::ValuesIn(kReliefs), name_of_input);

}  // namespace
}  // namespace geo
