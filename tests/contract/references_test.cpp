#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "bibliography.hpp"

namespace geo {
namespace {

using Entries = std::map<std::string, std::string>;

/// The first author's last name in plain letters: "O'Callaghan" ocallaghan, "Körner" korner.
std::string plain(std::string name) {
  for (const auto& [accented, letter] :
       {std::pair{"ö", "o"}, {"é", "e"}, {"ü", "u"}, {"ä", "a"}, {"'", ""}}) {
    for (std::size_t at; (at = name.find(accented)) != std::string::npos;) {
      name.replace(at, std::string_view(accented).size(), letter);
    }
  }
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char letter) { return std::tolower(letter); });
  return name;
}

/// Keys that a text cites as "Braun & Willett (2013)", "Barnes et al. 2014" or "Strang 1968".
std::set<std::string> cited_in_prose(std::string text, const Entries& entries,
                                     std::vector<std::string>& unknown) {
  text = std::regex_replace(text, std::regex("\\s*\\n\\s*(///?)?\\s*"), " ");
  static const std::regex kCitation(
      "([A-Z][A-Za-z'\\x80-\\xff-]+)((?:, [A-Z][A-Za-z\\x80-\\xff-]+)*"
      " (?:&|and) [A-Z][A-Za-z\\x80-\\xff-]+| et al\\.)?,? \\(?((?:18|19|20)[0-9]{2})\\b");
  static const std::set<std::string> kNoAuthors{"Center", "January", "CF", "Debian", "ETOPO"};
  std::set<std::string> keys;
  for (std::sregex_iterator at(text.begin(), text.end(), kCitation), end; at != end; ++at) {
    const std::string author = (*at)[1], year = (*at)[3];
    if (kNoAuthors.contains(author)) continue;
    const auto entry = std::find_if(entries.begin(), entries.end(), [&](const auto& row) {
      return row.first.ends_with(year) && row.first.find(plain(author)) != std::string::npos;
    });
    if (entry == entries.end()) {
      unknown.push_back((*at)[0]);
    } else {
      keys.insert(entry->first);
    }
  }
  return keys;
}

TEST(References, AreCompleteBibTeX) {
  const Entries entries = test::bibliography();
  EXPECT_GT(entries.size(), 20U);
  for (const auto& [key, entry] : entries) {
    EXPECT_TRUE(std::regex_match(key, std::regex("[a-z]+(18|19|20)[0-9]{2}"))) << key;
    for (const char* part : {"title = {", "year = {"}) {
      EXPECT_NE(entry.find(part), std::string::npos) << key << " lacks " << part;
    }
    if (!entry.starts_with("@misc")) {
      EXPECT_NE(entry.find("author = {"), std::string::npos) << key << " lacks its authors";
    }
    if (entry.starts_with("@article")) {
      EXPECT_NE(entry.find("journal = {"), std::string::npos) << key << " lacks its journal";
    }
  }
}

TEST(References, HaveWhatSourcesCiteAndNothingElse) {
  const Entries entries = test::bibliography();
  std::set<std::string> used;
  test::Declarations declarations;
  for (const Parameter& p : declarations.all()) used.insert(std::string(p.source));
  for (const auto& path :
       test::files_in({"libgeo", "calibration", "apps", "bench"}, {".hpp", ".cpp"})) {
    std::vector<std::string> unknown;
    used.merge(cited_in_prose(test::read_text(path), entries, unknown));
    EXPECT_TRUE(unknown.empty()) << path << " cites " << (unknown.empty() ? "" : unknown.front())
                                 << ", which docs/references.bib lacks";
  }
  static const std::regex kKey("\\[([a-z]+(?:18|19|20)[0-9]{2})\\]");
  for (const auto& path : test::files_in({"docs"}, {".md"})) {
    const std::string text = test::read_text(path);
    for (std::sregex_iterator at(text.begin(), text.end(), kKey), end; at != end; ++at) {
      EXPECT_TRUE(entries.contains((*at)[1])) << path << " cites " << (*at)[0];
      used.insert((*at)[1]);
    }
  }
  // The last column of the scorecard's table names the origin of Earth's value.
  const std::string table =
      test::read_text(test::repository() / "data/targets/earth_scorecard.csv");
  static const std::regex kSource(",([a-z]+(?:18|19|20)[0-9]{2})\n");
  for (std::sregex_iterator at(table.begin(), table.end(), kSource), end; at != end; ++at) {
    EXPECT_TRUE(entries.contains((*at)[1])) << "the scorecard cites " << (*at)[1];
    used.insert((*at)[1]);
  }
  for (const auto& [key, entry] : entries) {
    EXPECT_TRUE(used.contains(key)) << key << " is cited nowhere";
  }
}

}  // namespace
}  // namespace geo
