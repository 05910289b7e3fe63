// Every kind of bad input: the right exit code, one line that says what and where, no harm done.
#include "cli/bad_input/bad_input.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/folder_contents.hpp"
#include "cli/program.hpp"
#include "cli/relief_file.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

TEST_P(BadInputTest, IsRefusedInOneLineAndHarmsNothing) {
  const BadInput& input = GetParam();
  const TemporaryFolder folder;
  ReliefFile{}.write(folder / "relief.nc");
  Call call{.arguments = input.arguments(folder.path()),
            .environment = {},
            .working_folder = folder.path()};
  if (!input.environment.empty()) {
    call.environment.emplace_back(input.environment[0], input.environment[1]);
  }
  const auto before = contents_of(folder.path());
  const Outcome outcome = terrane(call);
  EXPECT_EQ(outcome.code, input.code);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
  EXPECT_THAT(outcome.err, StartsWith("terrane: error: "));
  for (const std::string& words : input.says) EXPECT_THAT(outcome.err, HasSubstr(words));
  EXPECT_TRUE(before == contents_of(folder.path())) << "files were touched";
}

}  // namespace
}  // namespace geo
