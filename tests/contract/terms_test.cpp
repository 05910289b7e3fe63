// Words that geoscientists do not use, or use for something else, stay out of what they read.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <regex>

#include "support.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;

struct Term {
  std::string_view key;  // what of it is sought first: expressions alone are slow
  const char* pattern;
  const char* instead;
};

// In lower case: texts are sought without regard to case.
const std::vector<Term> kTerms{
    {"false", R"(\bfalse dams?\b)", "spurious depressions, which least-cost breaching opens"},
    {"below",
     R"(\b(go|goes|gone|going|went) below (each other|another|others|one|its|their|the other)\b)",
     "to subduct; continents are thrust below each other"},
    {"down", R"(\b(plates?|floor|crust|the one|what) (that )?(goes|go) down\b)", "to subduct"},
    {"founder", R"(\bfounder(s|ed|ing)?\b)", "subduction initiation"},
    {"book", R"(\bbook(s|ed|ing|keeping)?\b)", "budget, mass balance; counted as"},
    {"front", R"(\b(subduction fronts?|nearest.front|front of a plate)\b)",
     "trench, edge of the overriding plate, deformation front"},
    {"overlay", R"(\b(class \w*|healpix)overlay\b)", "conservative remapping"},
    {"match", R"(rank.?match)", "quantile mapping"},
    {"beginning", R"(\b(struct|class) beginning\b)", "initial conditions"},
    {"objective", R"(\bobjective(::|\.)(route|follow)\b)", "evaluate, linearise"},
    {"lift", R"(\b(struct|class) lift\b)", "seeding of active variables"},
    {"swell", R"(\b(struct|class) swells?\b)", "names of noise; a swell is of the sea floor"},
    {"hot", R"(\bhot (foot|feet)\b)", "lower crust"},
    {"longest", R"(longest.?upstream)", "flow length"},
    {"relief", R"(\b(real|given|first) reliefs?\b)", "elevation model (DEM), initial elevation"},
    {"relief", R"(\b(reliefs|earth's( own)? relief|relief's own)\b)",
     "elevation, topography; relief is a range of elevations"},
    {"relief", R"(\b((every|each) relief|over a relief)\b)", "elevation, topography"},
    {"relief", R"(\bgivenrelief\b|\bread_relief|\bio::relief\b)", "names with elevation or dem"},
    {"relief", R"(\bplanetrelief\b|\bisland_?relief\b|\brelief_?(events|finish)\b|stages/relief)",
     "names with surface, terrain or elevation"},
    {"relief", R"(\b(draw|take|shape|finish)_relief\b)", "names with surface or elevation"},
    {"held", R"(\bheld.?fast\b)", "frozen drainage"},
    {"anew", R"(\bread anew\b)", "resampled"},
    {"way", R"(\bways? of (the )?waters?\b)", "drainage, flow path, drainage rerouting"},
    {"rivers", R"(\brivers feel\b)", "lithology, erodibility of the rock"},
    {"root", R"(\broots? gives? back\b)", "isostatic rebound"},
    {"aside", R"(\bflows? aside\b)", "lower-crustal flow"},
    {"rise", R"(\brise of the surface per\b)", "elevation-thickness slope"},
    {"commonest", R"(\bcommonest\b)", "mode, most frequent, dominant"},
    {"same", R"(\bthe same at sea\b)", "annual temperature range, ocean"},
    {"month", R"(\bno month thaws\b)", "frozen all year"},
    {"befall", R"(\bbefalls?\b)", "discrete events"},
    {"evaporation", R"(\bpotential.evaporation\b)", "potential evapotranspiration"},
};

struct Exception {
  const char* text;  // of the line, with its case
  const char* why;
};

// What stays: names by which numbers are drawn or recorded, and names of the past.
const std::vector<Exception> kExceptions{
    {"\"plates.foundering\"", "name of a random stream: another one would draw other planets"},
    {"\"plates.first_relief\"", "name of a noise: another one would draw other continents"},
    {"was\n  `potential_evaporation`", "a name of the past, for those who look for it"},
    {"was `rank_match`", "a name of the past, for those who look for it"},
};

/// A text as it is read, in lower case: exceptions taken out; breaks of lines, comments and string
/// literals joined.
std::string as_read(std::string text) {
  for (const Exception& exception : kExceptions) {
    const std::string_view part = exception.text;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at)) {
      text.erase(at, part.size());
    }
  }
  std::string plain;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char letter = text[at];
    if (letter != '\n' && letter != ' ' && letter != '\t') {
      plain += static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
      continue;
    }
    if (letter == '\n') {
      if (plain.ends_with('"')) plain.pop_back();
      at = std::min(text.find_first_not_of(" \t", at + 1), text.size());
      const bool joins = at < text.size() && (text[at] == '"' || text[at] == '#');
      while (at < text.size() && (text[at] == '/' || (joins && text[at] == '#'))) ++at;
      if (joins && text[at] == '"') ++at;
      --at;
    }
    if (!plain.ends_with(' ')) plain += ' ';
  }
  return plain;
}

/// The terms that a text has, each with what would be right.
std::vector<std::string> terms_in(const std::string& text) {
  constexpr std::size_t kAround = 60;  // longest that a term is before or behind its key
  static const std::vector<std::regex> kPatterns = [] {
    std::vector<std::regex> patterns;
    for (const Term& term : kTerms) patterns.emplace_back(term.pattern);
    return patterns;
  }();
  std::vector<std::string> found;
  const std::string plain = as_read(text);
  for (std::size_t k = 0; k < kTerms.size(); ++k) {
    const std::string_view key = kTerms[k].key;
    for (auto at = plain.find(key); at != std::string::npos; at = plain.find(key, at + 1)) {
      const std::size_t from = at - std::min(at, kAround);
      const std::string part = plain.substr(from, at - from + key.size() + kAround);
      std::smatch match;
      if (!std::regex_search(part, match, kPatterns[k])) continue;
      found.push_back("\"" + match.str() + "\": say " + kTerms[k].instead);
      at += kAround;
    }
  }
  return found;
}

TEST(Terms, AreThoseOfTheField) {
  std::vector<fs::path> files = test::files_in(
      {"apps", "bench", "calibration", "data/presets", "data/scenarios", "data/targets", "docs",
       "libgeo", "paraview", "python", "scripts", "workflows"},
      {".hpp", ".cpp", ".md", ".py", ".toml", ".csv", ".yaml", ".yml", ".ipynb", ""});
  for (const char* file : {"README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"}) {
    files.push_back(test::repository() / file);
  }
  EXPECT_GT(files.size(), 400U);
  for (const fs::path& path : files) {
    for (const std::string& term : terms_in(test::read_text(path))) {
      ADD_FAILURE() << path << ": " << term;
    }
  }
}

TEST(Terms, AreFoundAcrossLinesCommentsAndLiterals) {
  EXPECT_TRUE(terms_in("Plates subduct; what stands on them sinks with a valley.").empty());
  EXPECT_EQ(terms_in("plates that go below\n/// each other").size(), 1U);
  EXPECT_EQ(terms_in("\"cuts false \"\n    \"dams open\"").size(), 1U);
  EXPECT_EQ(terms_in("Potential evaporation").size(), 1U);
  EXPECT_EQ(terms_in("RandomStream random(seed, \"plates.foundering\")").size(), 0U);
  EXPECT_EQ(terms_in("the plate was foundering").size(), 1U);
  EXPECT_EQ(terms_in("counted in the\n/// books, see the notebook").size(), 1U);
}

TEST(Terms, EachExceptionIsStillNeeded) {
  std::string all;
  for (const char* folder : {"libgeo", "docs"}) {
    for (const fs::path& path : test::files_in({folder}, {".cpp", ".md"})) {
      all += test::read_text(path);
    }
  }
  all += test::read_text(test::repository() / "CHANGELOG.md");
  for (const Exception& exception : kExceptions) {
    EXPECT_NE(all.find(exception.text), std::string::npos) << exception.text << " is there no more";
  }
}

}  // namespace
}  // namespace geo
