// Who may include whom: apps -> calibration -> stages -> kernels -> core, and io -> kernels, core.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>

#include "geo/stages/stages.hpp"
#include "support.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::set<std::string>> kMayInclude{
    {"core", {"core"}},
    {"kernels", {"core", "kernels"}},
    {"stages", {"core", "kernels", "stages"}},
    {"io", {"core", "kernels", "io"}},
    {"calibration", {"core", "kernels", "stages", "io", "calibration"}},
    {"apps", {"core", "stages", "io", "calibration"}},
};

/// Libraries that core, kernels and stages may use: numbers and text, no files, no logs.
bool is_plain_library(const std::string& header) {
  if (header == "omp.h") return true;  // threads are the compiler's
  if (header.find('/') == std::string::npos) return header.find('.') == std::string::npos;
  return header.starts_with("Random123/") || header.starts_with("GeographicLib/") ||
         header == "unsupported/Eigen/FFT" || header.starts_with("Eigen/") ||
         header == "fmt/format.h" || header == "fmt/ranges.h";
}

struct Include {
  fs::path file;
  std::string header;
  bool quoted;
};

std::vector<Include> includes_of(const std::string& layer) {
  std::vector<std::string> folders{"libgeo/include/geo/" + layer, "libgeo/src/" + layer};
  if (layer == "apps" || layer == "calibration") folders = {layer};
  if (!fs::exists(test::repository() / folders.front())) return {};
  std::vector<Include> includes;
  static const std::regex kInclude("#include ([<\"])([^>\"]+)[>\"]");
  for (const fs::path& path : test::files_in(folders, {".hpp", ".cpp"})) {
    const std::string text = test::read_text(path);
    for (std::sregex_iterator at(text.begin(), text.end(), kInclude), end; at != end; ++at) {
      includes.push_back({path, (*at)[2], (*at)[1] == "\""});
    }
  }
  return includes;
}

/// The layer whose header it is; empty for private headers and those of other libraries.
std::string layer_of(const std::string& header) {
  if (header.starts_with("calibration/")) return "calibration";
  if (!header.starts_with("geo/")) return {};
  return header.substr(4, header.find('/', 4) - 4);
}

TEST(Layers, IncludesPointOneWay) {
  for (const auto& [layer, allowed] : kMayInclude) {
    const auto includes = includes_of(layer);
    EXPECT_FALSE(includes.empty()) << layer;
    for (const Include& include : includes) {
      const std::string target = layer_of(include.header);
      EXPECT_TRUE(target.empty() || allowed.contains(target))
          << include.file << " includes " << include.header;
    }
  }
}

TEST(Layers, PrivateHeadersStayInTheirLayer) {
  for (const auto& [layer, allowed] : kMayInclude) {
    for (const Include& include : includes_of(layer)) {
      if (!include.quoted || !layer_of(include.header).empty()) continue;
      if (include.header == "terrane_commit.hpp") continue;  // written by the build
      const bool of_another_room = include.header.starts_with(layer + "/");
      EXPECT_TRUE(of_another_room || fs::exists(include.file.parent_path() / include.header))
          << include.file << " includes " << include.header;
    }
  }
}

/// What opens and writes runs learns from StageInfo what a stage is: no names in strings, no keys
/// of parameters; names of files in a run's folder are the public interface. Maps, masks and layers
/// of a report have words of their own, some of them the same.
TEST(Layers, FilesKnowNoStageByItsName) {
  std::string names;
  const Pipeline pipeline = make_pipeline();
  for (const auto& stage : pipeline.stages()) {
    if (!names.empty()) names += '|';
    names += stage->info().name;
  }
  const std::regex name("[^=]\"(" + names + ")(\\.(?!pvd)[a-z_.]+)?\"");
  std::vector<std::string> folders;
  for (const std::string tree : {"libgeo/include/geo/", "libgeo/src/"}) {
    folders.push_back(tree + "core");
    for (const char* room :
         {"config", "files", "input", "netcdf", "report", "run", "score", "vtk"}) {
      if (fs::exists(test::repository() / (tree + "io/" + room))) {
        folders.push_back(tree + "io/" + room);
      }
    }
  }
  for (const fs::path& path : test::files_in(folders, {".hpp", ".cpp"})) {
    const std::string text = test::read_text(path);
    for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at) {
      const auto line = 1 + std::count(text.begin(), text.begin() + at->position(), '\n');
      const auto begin = text.rfind('\n', at->position()) + 1;
      if (text.substr(begin, at->position() - begin).find("//") != std::string::npos) continue;
      ADD_FAILURE() << path << ':' << line << " names " << at->str().substr(1);
    }
  }
}

/// Folders below a layer that hold code, and how many files each holds.
std::map<std::string, int> rooms_in(const std::string& folder) {
  std::map<std::string, int> rooms;
  for (const fs::path& path : test::files_in({folder}, {".hpp", ".cpp"})) {
    ++rooms[fs::relative(path.parent_path(), test::repository() / folder).string()];
  }
  return rooms;
}

TEST(Rooms, AreSmall) {
  constexpr int kMost = 25;
  for (const char* tree : {"libgeo/include/geo", "libgeo/src", "apps", "calibration", "tests"}) {
    for (const auto& [room, files] : rooms_in(tree)) EXPECT_LE(files, kMost) << tree << '/' << room;
  }
}

TEST(Rooms, OfKernelsAreTheSameForHeadersAndSources) {
  const auto headers = rooms_in("libgeo/include/geo/kernels"),
             sources = rooms_in("libgeo/src/kernels");
  EXPECT_GT(headers.size(), 10U);
  for (const auto& [room, files] : headers) EXPECT_TRUE(sources.contains(room)) << room;
  for (const auto& [room, files] : sources) EXPECT_TRUE(headers.contains(room)) << room;
}

TEST(Rooms, OfKernelsHaveNoCycles) {
  std::map<std::string, std::set<std::string>> needs;
  static const std::regex kKernel("(?:geo/)?kernels/(.*)/[^/]+");
  for (const Include& include : includes_of("kernels")) {
    std::smatch match;
    if (!include.quoted || !std::regex_match(include.header, match, kKernel)) continue;
    const std::string path = include.file.parent_path().string();
    const std::string room = path.substr(path.rfind("kernels/") + 8);
    if (match[1] != room) needs[room].insert(match[1]);
  }
  EXPECT_GT(needs.size(), 8U);
  // Rooms that need nothing but what stands below are built; in the end none is left.
  std::set<std::string> built;
  for (bool any = true; any;) {
    any = false;
    for (const auto& [room, files] : rooms_in("libgeo/src/kernels")) {
      if (built.contains(room)) continue;
      const auto& below = needs[room];
      if (std::includes(built.begin(), built.end(), below.begin(), below.end())) {
        built.insert(room);
        any = true;
      }
    }
  }
  for (const auto& [room, below] : needs) EXPECT_TRUE(built.contains(room)) << room;
}

TEST(Layers, PhysicsKnowsNoFilesAndNoLogs) {
  const std::set<std::string> forbidden{"fstream", "filesystem", "iostream", "cstdio"};
  for (const char* layer : {"core", "kernels", "stages"}) {
    for (const Include& include : includes_of(layer)) {
      if (include.quoted) continue;
      EXPECT_TRUE(is_plain_library(include.header) && !forbidden.contains(include.header))
          << include.file << " includes " << include.header;
    }
  }
}

TEST(Layers, PublicHeadersNameNoForeignLibrary) {
  for (const char* layer : {"core", "kernels", "stages", "io"}) {
    for (const Include& include : includes_of(layer)) {
      if (include.file.string().find("/include/") == std::string::npos || include.quoted) continue;
      EXPECT_EQ(include.header.find_first_of("/."), std::string::npos)
          << include.file << " includes " << include.header;
    }
  }
}

TEST(Layers, HeadersThatTheSiteNamesExist) {
  const fs::path page = test::repository() / "docs/site/api.md";
  const std::string text = test::read_text(page);
  static const std::regex kHeader("`([a-z_/0-9]+\\.hpp)`");
  int count = 0;
  for (std::sregex_iterator at(text.begin(), text.end(), kHeader), end; at != end; ++at, ++count) {
    EXPECT_TRUE(fs::exists(test::repository() / "libgeo/include/geo" / (*at)[1].str()))
        << page << " names " << (*at)[1];
  }
  EXPECT_GT(count, 20);
}

TEST(Repository, NamesNoPlaceOnSomebodysMachine) {
  // In two pieces, so that this file does not name them.
  const std::vector<std::string> places{std::string("/ho") + "me/", std::string("/ro") + "ot/",
                                        std::string("/wo") + "rk/", std::string("/Us") + "ers/",
                                        std::string("/tm") + "p/wt"};
  std::vector<fs::path> files = test::files_in({"apps", "bench", "calibration", "cmake", "data",
                                                "docs", "libgeo", "scripts", "tests", "workflows"},
                                               {".hpp", ".cpp", ".txt", ".cmake", ".in", ".md",
                                                ".py", ".toml", ".csv", ".bib", ".yaml", ""});
  for (const auto& entry : fs::directory_iterator(test::repository())) {
    if (entry.is_regular_file() && entry.path().filename() != ".git") files.push_back(entry.path());
  }
  EXPECT_GT(files.size(), 100U);
  for (const fs::path& path : files) {
    const std::string text = test::read_text(path);
    for (const std::string& place : places) {
      EXPECT_EQ(text.find(place), std::string::npos) << path << " names " << place;
    }
  }
}

}  // namespace
}  // namespace geo
