// The one reader of comma-separated tables.
#include "geo/io/input/table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <clocale>
#include <filesystem>
#include <fstream>
#include <locale>

#include "geo/core/error.hpp"
#include "geo/io/files/embedded_data.hpp"
#include "io/temporary_folder.hpp"

namespace geo::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string message(const std::string& text, std::size_t row = 0, std::size_t column = 0) {
  try {
    const Table table(text, "t.csv");
    (void)table.number(row, column);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Table, ReadsRowsUnderAHeader) {
  const Table table("a,b\n1,x\n-2.5e3, y z \n", "t.csv");
  EXPECT_TRUE(table.has_columns({"a", "b"}));
  EXPECT_FALSE(table.has_columns({"a"}));
  EXPECT_FALSE(table.has_columns({"b", "a"}));
  ASSERT_EQ(table.rows(), 2U);
  EXPECT_EQ(table.number(1, 0), -2500.0);
  EXPECT_EQ(table.text(1, 1), "y z");
}

TEST(Table, IsTheSameHoweverItsLinesEndAndWhateverStandsBetween) {
  for (const char* text :
       {"a,b\n1,2\n3,4\n", "a,b\n1,2\n3,4", "a,b\r\n1,2\r\n3,4\r\n", "a,b\r\n1,2\r\n3,4\r",
        "\xEF\xBB\xBF"
        "a,b\n1,2\n3,4\n",
        "# made by hand, 2024\n\na,b\n  # more\n1,2\n \t\n3,4\n\n",
        "\xEF\xBB\xBF# first\r\n\r\n a , b \r\n 1 ,\t2 \r\n \r\n+3,4\r\n",
        "\"a\",\"b\"\n\"1\",2\n 3 , \"4\" \n"}) {
    const Table table(text, "t.csv");
    SCOPED_TRACE(text);
    EXPECT_THAT(table.header(), ElementsAre("a", "b"));
    ASSERT_EQ(table.rows(), 2U);
    EXPECT_EQ(table.number(0, 0), 1.0);
    EXPECT_EQ(table.number(0, 1), 2.0);
    EXPECT_EQ(table.number(1, 0), 3.0);
    EXPECT_EQ(table.number(1, 1), 4.0);
  }
}

TEST(Table, QuotesHoldCommasQuotesLineBreaksAndNumberSigns) {
  const Table table("name,note\n\"a, b\",\"say \"\"so\"\"\"\n\"two\r\nlines\",\"#\"\n\"\",x\n",
                    "t.csv");
  ASSERT_EQ(table.rows(), 3U);
  EXPECT_EQ(table.text(0, 0), "a, b");
  EXPECT_EQ(table.text(0, 1), "say \"so\"");
  EXPECT_EQ(table.text(1, 0), "two\r\nlines");
  EXPECT_EQ(table.text(1, 1), "#");
  EXPECT_EQ(table.text(2, 0), "");
}

TEST(Table, NamesFileAndLineOfWhatIsWrong) {
  EXPECT_EQ(message("a,b\n1,2\n3\n"), "t.csv:3: must have 2 cells, as the header has, not 1");
  EXPECT_EQ(message("a,b\n1,2,\n"), "t.csv:2: must have 2 cells, as the header has, not 3");
  EXPECT_EQ(message("\n# c\na,b\n\n1,x\n", 0, 1), "t.csv:5: b: must be a number, as 1234.5");
  EXPECT_EQ(message("a,b\n\"two\nlines\",1\nx,2\n", 1), "t.csv:4: a: must be a number, as 1234.5");
  EXPECT_EQ(message("a,b\n1,\"2\n3,4\n"), "t.csv:2: a quoted cell does not end");
  EXPECT_EQ(message("a,b\n\"1\"2,3\n"),
            "t.csv:2: after a quoted cell must come a comma or the end of the line");
  for (const char* cell : {"", "nan", "inf", "-inf", "1e999", "1 2", "0x10", "1.2.3", "--1", "+-1",
                           "++1", "+", "\"1,5\"", "1'000"}) {
    EXPECT_THAT(message("a,b\n" + std::string(cell) + ",2\n"), HasSubstr("t.csv:2: a: must be"))
        << cell;
  }
}

TEST(Table, OfNothingHasNothing) {
  for (const char* text : {"", "\n", "\xEF\xBB\xBF", "# a,b\n", "\r\n"}) {
    const Table table(text, "t.csv");
    EXPECT_TRUE(table.header().empty());
    EXPECT_EQ(table.rows(), 0U);
    EXPECT_THROW(table.refuse_header("must have one"), InputError);
    EXPECT_THROW(table.refuse(7, "must have one"), InputError);
  }
}

/// Decimal commas and points between thousands, on any machine.
struct Commas : std::numpunct<char> {
  [[nodiscard]] char do_decimal_point() const override { return ','; }
  [[nodiscard]] char do_thousands_sep() const override { return '.'; }
  [[nodiscard]] std::string do_grouping() const override { return "\3"; }
};

TEST(Table, DoesNotAskTheLocaleOfStreamsForItsPoint) {
  const std::locale before = std::locale::global({std::locale::classic(), new Commas});
  const double read = Table("a\n1234.5\n", "t.csv").number(0, 0);
  std::locale::global(before);
  EXPECT_EQ(read, 1234.5);
}

TEST(Table, DoesNotAskTheLocaleForItsPoint) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  bool any = false;
  for (const char* name : {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "fr_FR"}) {
    if (std::setlocale(LC_ALL, name) == nullptr) continue;
    any = true;
    EXPECT_EQ(Table("a\n1.5\n", "t.csv").number(0, 0), 1.5) << name;
    EXPECT_THROW((void)Table("a\n\"1,5\"\n", "t.csv").number(0, 0), InputError) << name;
  }
  std::setlocale(LC_ALL, before.c_str());
  if (!any) GTEST_SKIP() << "no locale with decimal commas is installed";
}

TEST(Table, OfAFileIsCalledByIt) {
  const TemporaryFolder folder;
  std::ofstream(folder / "x.csv") << "a\nb\n";
  try {
    (void)Table::of_file(folder / "x.csv").number(0, 0);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("x.csv:2: a: must be"));
  }
  EXPECT_THROW((void)Table::of_file(folder / "absent.csv"), IoError);
}

TEST(Table, ReadsAllThatTheProgramHolds) {
  int tables = 0;
  for (const EmbeddedFile& file : embedded_files()) {
    if (!file.name.ends_with(".csv")) continue;
    EXPECT_GE(embedded_table(file.name).rows(), 2U) << file.name;
    ++tables;
  }
  EXPECT_GT(tables, 10);
}

}  // namespace
}  // namespace geo::io
