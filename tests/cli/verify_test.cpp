// A run's files are what its manifest says, or no command takes them for it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netcdf.h>

#include <fstream>
#include <set>

#include "cli/folder_contents.hpp"
#include "cli/program.hpp"
#include "cli/relief_file.hpp"
#include "cli/sample_run.hpp"
#include "io/temporary_folder.hpp"

namespace geo {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

void change_value(const fs::path& file, const char* name, float other) {
  int id = 0, variable = 0;
  const std::size_t cell[2] = {3, 4};
  ASSERT_EQ(nc_open(file.c_str(), NC_WRITE, &id), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(id, name, &variable), NC_NOERR);
  ASSERT_EQ(nc_put_var1_float(id, variable, cell, &other), NC_NOERR);
  ASSERT_EQ(nc_close(id), NC_NOERR);
}

void change_attribute(const fs::path& file) {
  int id = 0;
  ASSERT_EQ(nc_open(file.c_str(), NC_WRITE, &id), NC_NOERR);
  ASSERT_EQ(nc_put_att_text(id, NC_GLOBAL, "comment", 5, "hello"), NC_NOERR);
  ASSERT_EQ(nc_close(id), NC_NOERR);
}

/// Overwrites bytes in the middle of a file.
void damage(const fs::path& file) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  stream.seekp(static_cast<std::streamoff>(fs::file_size(file) / 2));
  stream << std::string(64, '\x5a');
}

/// A planet with its pictures, and a copy to be changed.
class Verify : public testing::Test {
 protected:
  void SetUp() override {
    const Outcome outcome =
        terrane({"run", "--preset", "preview", "--grid", "64x32", "--set", "output.vtk=true",
                 "--set", "output.map_width_px=300", "--set", "climate.resolution_deg=10",
                 "--threads", "2", "--quiet", "-o", whole_});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    fs::copy(whole_, out_, fs::copy_options::recursive);
  }

  /// Expects one line and exit code 3 that names a file and what is wrong with it.
  void expect_refused(const std::vector<std::string>& call, const std::string& file,
                      const std::string& what) const {
    SCOPED_TRACE(call.front());
    const Outcome outcome = terrane(call);
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    const auto lines = lines_of(outcome.err);
    ASSERT_EQ(lines.size(), 1U) << outcome.err;
    EXPECT_THAT(lines.front(), StartsWith("terrane: error: "));
    EXPECT_THAT(lines.front(), HasSubstr(file));
    EXPECT_THAT(lines.front(), HasSubstr(what));
  }

  TemporaryFolder folder_;
  const fs::path whole_ = folder_ / "whole", out_ = folder_ / "out";
};
TEST_F(Verify, AWholeRunIsAsWritten) {
  const Outcome outcome = terrane({"info", "--verify", out_});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("are as written"));
}

TEST_F(Verify, FilesOfEveryKindAreCompared) {
  std::set<fs::path> kinds;
  for (const auto& [name, bytes] : contents_of(out_)) {
    if (name == "manifest.json" || fs::is_directory(out_ / name)) continue;
    if (!kinds.insert(fs::path(name).extension()).second) continue;
    SCOPED_TRACE(name);
    const fs::path file = out_ / name;
    damage(file);
    const Outcome outcome = terrane({"info", "--verify", out_});
    EXPECT_EQ(outcome.code, 3) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr(name + ": "));
    EXPECT_EQ(lines_of(outcome.out).size(), 1U) << outcome.out;
    EXPECT_EQ(lines_of(outcome.err).size(), 1U) << outcome.err;
    fs::remove(file);
    const Outcome without = terrane({"info", "--verify", out_});
    EXPECT_EQ(without.code, 3);
    EXPECT_THAT(without.out, HasSubstr(name + ": missing"));
    fs::copy(whole_ / name, file);
  }
  EXPECT_GE(kinds.size(), 6U);
  EXPECT_EQ(terrane({"info", "--verify", out_}).code, 0);
}

TEST_F(Verify, EveryFileThatARunLeavesIsInTheManifest) {
  const auto manifest = manifest_of(out_);
  std::set<std::string> known{"manifest.json"};
  for (const auto& [name, digest] : manifest.at("files").items()) known.insert(name);
  for (const auto& stage : manifest.at("stages")) {
    for (const auto& [name, digest] : stage.at("file_digests").items()) known.insert(name);
  }
  for (const auto& [name, bytes] : contents_of(out_)) {
    EXPECT_TRUE(fs::is_directory(out_ / name) || known.contains(name)) << name;
  }
}

TEST_F(Verify, AChangedValueIsNamed) {
  change_value(out_ / "04-climate.nc", "temperature", -77.0F);
  const Outcome outcome = terrane({"info", "--verify", out_});
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.out, HasSubstr("04-climate.nc: temperature: digest differs"));
  const Outcome json = terrane({"info", "--verify", out_, "--json"});
  EXPECT_EQ(json.code, 3);
  EXPECT_EQ(nlohmann::json::parse(json.out).at("differences").size(), 1U);
}

TEST_F(Verify, CommandsRefuseWhatTheManifestDoesNotSay) {
  change_value(out_ / "03-erosion.nc", "elevation", 1234.5F);
  change_value(out_ / "05-hydrology.nc", "elevation", 1234.5F);
  const std::string what = "elevation: digest differs";
  expect_refused({"run", "--resume", "-o", out_}, "03-erosion.nc", what);
  expect_refused({"score", out_}, "05-hydrology.nc", what);
  expect_refused({"score", out_ / "05-hydrology.nc"}, "05-hydrology.nc", what);
  expect_refused({"maps", out_}, ".nc", what);
  expect_refused({"maps", out_, "--field", "elevation"}, ".nc", what);
  expect_refused({"island", out_, "--quiet"}, ".nc", what);
}

TEST_F(Verify, AChangedManifestIsFoundToo) {
  auto manifest = manifest_of(out_);
  for (auto& stage : manifest["stages"]) {
    if (stage["name"] == "hydrology") {
      stage["fields"]["elevation"]["digest"] = "00000000000000000000000000000000";
    }
  }
  std::ofstream(out_ / "manifest.json") << manifest;
  const std::string what = "elevation: digest differs";
  expect_refused({"info", "--verify", out_}, "05-hydrology.nc", what);
  expect_refused({"score", out_}, "05-hydrology.nc", what);
  expect_refused({"run", "--resume", "-o", out_}, "05-hydrology.nc", what);
}

TEST_F(Verify, AnotherAttributeChangesNoValue) {
  change_attribute(out_ / "05-hydrology.nc");
  const Outcome verified = terrane({"info", "--verify", out_});
  EXPECT_EQ(verified.code, 3);
  EXPECT_THAT(verified.out, HasSubstr("05-hydrology.nc: bytes differ, values do not"));
  EXPECT_EQ(terrane({"score", out_}).code, 0);
}

TEST_F(Verify, PicturesDrawnAgainAreOfTheRun) {
  EXPECT_EQ(terrane({"maps", out_, "--width", "400"}).code, 0);
  const Outcome outcome = terrane({"info", "--verify", out_});
  EXPECT_EQ(outcome.code, 0) << outcome.out;
}

TEST_F(Verify, ADamagedStageEndsNoCommandByASignal) {
  const std::string bytes = text_of(out_ / "05-hydrology.nc");
  for (std::size_t at = 0; at < bytes.size(); at += std::max<std::size_t>(1, bytes.size() / 6)) {
    SCOPED_TRACE(at);
    std::string damaged = bytes;
    for (std::size_t k = at; k < std::min(at + 16, bytes.size()); ++k) damaged[k] ^= '\x5a';
    std::ofstream(out_ / "05-hydrology.nc", std::ios::binary) << damaged;
    const Outcome verified = terrane({"info", "--verify", out_});
    EXPECT_EQ(verified.code, 3) << verified.err;
    EXPECT_THAT(verified.out, HasSubstr("05-hydrology.nc: "));
    EXPECT_THAT(terrane({"score", out_}).code, testing::AnyOf(0, 3));
  }
}

TEST_F(Verify, AFolderWithoutARunIsRefused) {
  const Outcome outcome = terrane({"info", "--verify", folder_.path()});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(lines_of(outcome.err).size(), 1U);
}

/// What wrote each stage.
class Builds : public Verify {
 protected:
  void pretend(const std::string& key, const std::string& value) const {
    auto manifest = manifest_of(out_);
    manifest[key] = value;
    for (auto& stage : manifest["stages"]) stage["written_by"][key] = value;
    std::ofstream(out_ / "manifest.json") << manifest;
  }
};

TEST_F(Builds, OfEachStageAreInTheManifest) {
  const auto manifest = manifest_of(out_);
  for (const auto& stage : manifest.at("stages")) {
    const auto& builder = stage.at("written_by");
    EXPECT_EQ(builder.at("version"), manifest.at("version"));
    EXPECT_EQ(builder.at("commit"), manifest.at("commit"));
    EXPECT_EQ(builder.at("build"), manifest.at("build"));
    EXPECT_GE(builder.at("build").get<std::string>().size(), 16U);
  }
  EXPECT_TRUE(manifest.at("allowed").empty());
}

TEST_F(Builds, ThatDifferAreRefusedOrAllowedByAWordThatIsKept) {
  for (const std::string key : {"commit", "build", "version"}) {
    SCOPED_TRACE(key);
    fs::remove_all(out_);
    fs::copy(whole_, out_, fs::copy_options::recursive);
    pretend(key, "0.0.1");
    fs::remove(out_ / "06-biomes.nc");
    const std::vector<std::string> resume{"run",     "--resume", "--to", "biomes",
                                          "--quiet", "-o",       out_};
    const auto before = contents_of(out_);
    const Outcome refused = terrane(resume);
    EXPECT_EQ(refused.code, 2);
    ASSERT_EQ(lines_of(refused.err).size(), 1U) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("was made by terrane "));
    EXPECT_THAT(refused.err, HasSubstr("0.0.1"));
    EXPECT_THAT(refused.err, HasSubstr("--allow-other-build"));
    EXPECT_TRUE(before == contents_of(out_));

    auto allowed = resume;
    allowed.emplace_back("--allow-other-build");
    const Outcome done = terrane(allowed);
    EXPECT_EQ(done.code, 0) << done.err;
    const auto manifest = manifest_of(out_);
    EXPECT_EQ(manifest.at("allowed"), nlohmann::json::array({"other-build"}));
    EXPECT_EQ(manifest.at("stages").front().at("written_by").at(key == "build" ? "build" : key),
              "0.0.1");
    EXPECT_NE(manifest.at("stages").back().at("written_by").at(key), "0.0.1");
    // What was allowed holds for the build that did it, and for no other.
    EXPECT_EQ(terrane(resume).code, 0);
    auto later = manifest;
    later["commit"] = "another";
    std::ofstream(out_ / "manifest.json") << later;
    EXPECT_EQ(terrane(resume).code, 2);
  }
}

TEST_F(Builds, ThatDifferAreRefusedWhereEarlierStagesStay) {
  pretend("commit", "0000000");
  std::vector<std::string> call{"run", "--overwrite", "--from", "hydrology", "--quiet", "-o", out_};
  const Outcome refused = terrane(call);
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--from hydrology"));
  call.emplace_back("--allow-other-build");
  EXPECT_EQ(terrane(call).code, 0);
}

}  // namespace
}  // namespace geo
