#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace geo::io {

/// A table of comma-separated values (RFC 4180) under a header line, in UTF-8.
///
/// A byte order mark is passed over. Lines end with LF or CRLF; blank ones, and those whose first
/// sign is #, do not count. Cells may stand in double quotes, with "" for a quote, and then hold
/// commas and line breaks; blanks around cells are taken away. Every row has as many cells as the
/// header. Numbers have a decimal point, whatever the locale says.
///
/// Whatever is wrong throws InputError "SOURCE:LINE: ...", where a row counts by the line on which
/// it begins.
class Table {
 public:
  /// Reads `text`, which errors call `source`.
  Table(std::string_view text, std::string source);
  /// Reads a file. Throws IoError when it cannot be read.
  [[nodiscard]] static Table of_file(const std::filesystem::path& path);

  [[nodiscard]] const std::vector<std::string>& header() const { return header_; }
  /// Whether these, in this order, are the columns.
  [[nodiscard]] bool has_columns(std::initializer_list<std::string_view> names) const;
  /// Where a column stands. Throws InputError where there is none, followed by `needs`.
  [[nodiscard]] std::size_t column(std::string_view name, std::string_view needs = {}) const;
  [[nodiscard]] std::size_t rows() const { return rows_.size(); }
  /// Text of a cell; rows and columns count from 0.
  [[nodiscard]] const std::string& text(std::size_t row, std::size_t column) const {
    return rows_.at(row).at(column);
  }
  /// A cell as a finite number.
  [[nodiscard]] double number(std::size_t row, std::size_t column) const;

  /// Throws InputError that names the file and the row's line.
  [[noreturn]] void refuse(std::size_t row, std::string_view what) const;
  /// The same of the header.
  [[noreturn]] void refuse_header(std::string_view what) const;

 private:
  [[noreturn]] void refuse_line(std::size_t line, std::string_view what) const;

  std::string source_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  std::vector<std::size_t> lines_;  ///< on which each row begins
  std::size_t header_line_ = 1;
};

}  // namespace geo::io
