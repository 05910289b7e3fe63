// Completion and manual pages say what --help says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "cli/program.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

using testing::Contains;
using testing::HasSubstr;

std::string told_by(const std::vector<std::string>& arguments) {
  const Outcome outcome = terrane(arguments);
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  return outcome.out;
}

std::vector<std::string> output_lines(const std::string& command) {
  std::vector<std::string> lines(1);
  FILE* pipe = popen(command.c_str(), "r");
  for (int letter = std::fgetc(pipe); letter != EOF; letter = std::fgetc(pipe)) {
    if (letter == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += static_cast<char>(letter);
    }
  }
  EXPECT_EQ(pclose(pipe), 0) << command;
  lines.pop_back();
  return lines;
}

/// What bash offers for the last of these words.
std::vector<std::string> offers(const TemporaryFolder& folder, const std::string& words) {
  const auto script = folder / "terrane.bash";
  std::ofstream(script) << told_by({"completion", "bash"});
  return output_lines("bash -c 'compopt() { :; }; source " + script.string() + "; COMP_WORDS=(" +
                      words +
                      "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _terrane; printf \"%s\\n\" "
                      "\"${COMPREPLY[@]}\"'");
}

TEST(Completion, OffersCommandsOptionsPresetsAndParameters) {
  const TemporaryFolder folder;
  EXPECT_THAT(offers(folder, "terrane ca"), testing::ElementsAre("calibrate"));
  EXPECT_THAT(offers(folder, "terrane run --see"), testing::ElementsAre("--seed"));
  EXPECT_THAT(offers(folder, "terrane run --preset pre"), testing::ElementsAre("preview"));
  EXPECT_THAT(offers(folder, "terrane run --set plates.sphere.sam"),
              testing::ElementsAre("plates.sphere.samples="));
  EXPECT_THAT(offers(folder, "terrane run --to \"\""), Contains("climate"));
}

TEST(Completion, IsSoundForShellsThatAreHere) {
  const TemporaryFolder folder;
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const auto script = folder / shell;
    std::ofstream(script) << told_by({"completion", shell});
    EXPECT_GT(std::filesystem::file_size(script), 1000U);
    if (std::system(("command -v " + shell + " >/dev/null").c_str()) != 0) continue;
    EXPECT_EQ(std::system((shell + " -n " + script.string()).c_str()), 0) << shell;
  }
  const Outcome wrong = terrane({"completion", "bush"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean bash?"));
}

TEST(Manual, HasEveryCommandAndEveryOptionOfItsHelp) {
  const std::string all = told_by({"manual"}), help = told_by({"--help"});
  for (const std::string command :
       {"run", "island", "sweep", "score", "calibrate", "maps", "view", "export", "diff", "params",
        "fields", "info", "presets", "completion", "manual"}) {
    EXPECT_THAT(help, HasSubstr(command));
    EXPECT_THAT(all, HasSubstr("terrane\\-" + command));
    const std::string page = told_by({"manual", command});
    EXPECT_THAT(page, HasSubstr(".SH OPTIONS"));
    for (const char* code : {"0", "1", "2", "3", "4", "5", "6", "130"}) {
      EXPECT_THAT(page, HasSubstr(".TP\n" + std::string(code) + "\n"));
    }
    std::istringstream words(told_by({command, "--help"}));
    for (std::string word; words >> word;) {
      if (!word.starts_with("--") || word.size() < 4) continue;
      word = word.substr(0, word.find_first_not_of("abcdefghijklmnopqrstuvwxyz-"));
      std::string shown;
      for (const char letter : word) shown += letter == '-' ? "\\-" : std::string(1, letter);
      EXPECT_THAT(page, HasSubstr(shown)) << command << " " << word;
    }
  }
  if (std::system("command -v groff >/dev/null") == 0) {
    const TemporaryFolder folder;
    std::ofstream(folder / "terrane.1") << all;
    EXPECT_EQ(output_lines("groff -man -ww -z " + (folder / "terrane.1").string() + " 2>&1").size(),
              0U);
  }
  EXPECT_EQ(terrane({"manual", "rum"}).code, 2);
}

TEST(Manual, HasWhatHelpSaysBelowTheOptions) {
  const std::string maps = told_by({"manual", "maps"});
  EXPECT_THAT(maps, HasSubstr(".SH NOTES"));
  EXPECT_THAT(maps, HasSubstr("\n.nf\n  equirectangular"));
  EXPECT_THAT(maps, HasSubstr(".fi\n.SH EXIT STATUS"));
  EXPECT_THAT(told_by({"manual", "export"}), HasSubstr("value = offset + scale * sample."));
  EXPECT_THAT(told_by({"manual", "score"}), testing::Not(HasSubstr(".SH NOTES")));
}

}  // namespace
}  // namespace geo
