#include "geo/io/input/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "geo/core/error.hpp"
#include "geo/io/config/config.hpp"

namespace geo::io {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kBlanks = " \t";

std::string_view without_blanks(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

/// Walks over the text of a table, row by row.
class Rows {
 public:
  explicit Rows(std::string_view text) : rest_(text) {
    if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
  }

  /// What is wrong with the text, and the line.
  struct Fault {
    std::size_t line;
    std::string what;
  };
  [[nodiscard]] const std::optional<Fault>& fault() const { return fault_; }
  /// Where the last row began.
  [[nodiscard]] std::size_t line() const { return begun_; }

  /// The cells of the next row; none at the end of the text, or where something is wrong.
  std::vector<std::string> next() {
    while (!rest_.empty() && is_passed_over()) skip_line();
    begun_ = line_;
    std::vector<std::string> cells;
    if (rest_.empty()) return cells;
    do {
      cells.push_back(cell());
    } while (!fault_ && take(","));
    if (!fault_ && !rest_.empty() && !take_line_end()) {
      fault_ = {line_, "after a quoted cell must come a comma or the end of the line"};
    }
    if (fault_) cells.clear();
    return cells;
  }

 private:
  [[nodiscard]] bool is_passed_over() const {
    const auto first = rest_.find_first_not_of(kBlanks);
    if (first == std::string_view::npos) return true;
    return rest_[first] == '#' || rest_[first] == '\n' || rest_.substr(first, 2) == "\r\n" ||
           rest_.substr(first) == "\r";
  }
  void skip_line() {
    const auto end = rest_.find('\n');
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++line_;
  }
  bool take(std::string_view text) {
    if (!rest_.starts_with(text)) return false;
    rest_.remove_prefix(text.size());
    return true;
  }
  bool take_line_end() {
    if (!take("\r\n") && !take("\n") && rest_ != "\r") return false;
    if (rest_ == "\r") rest_ = {};
    ++line_;
    return true;
  }
  std::string cell() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    if (take("\"")) return quoted_cell();
    auto end = std::min(rest_.find_first_of(",\n"), rest_.size());
    const bool ends_line = end == rest_.size() || rest_[end] == '\n';
    if (ends_line && end > 0 && rest_[end - 1] == '\r') --end;
    const std::string text(without_blanks(rest_.substr(0, end)));
    rest_.remove_prefix(end);
    return text;
  }
  std::string quoted_cell() {
    std::string text;
    for (;;) {
      const auto quote = rest_.find('"');
      if (quote == std::string_view::npos) {
        fault_ = {begun_, "a quoted cell does not end"};
        return text;
      }
      line_ += static_cast<std::size_t>(
          std::count(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(quote), '\n'));
      text += rest_.substr(0, quote);
      rest_.remove_prefix(quote + 1);
      if (!take("\"")) break;
      text += '"';
    }
    rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
    return text;
  }

  std::string_view rest_;
  std::size_t line_ = 1, begun_ = 1;
  std::optional<Fault> fault_;
};

}  // namespace

Table::Table(std::string_view text, std::string source) : source_(std::move(source)) {
  Rows rows(text);
  for (auto cells = rows.next(); !cells.empty(); cells = rows.next()) {
    if (header_.empty()) {
      header_ = std::move(cells);
      header_line_ = rows.line();
      continue;
    }
    if (cells.size() != header_.size()) {
      refuse_line(rows.line(), fmt::format("must have {} cells, as the header has, not {}",
                                           header_.size(), cells.size()));
    }
    rows_.push_back(std::move(cells));
    lines_.push_back(rows.line());
  }
  if (rows.fault()) refuse_line(rows.fault()->line, rows.fault()->what);
}

Table Table::of_file(const std::filesystem::path& path) { return {read_text(path), path.string()}; }

bool Table::has_columns(std::initializer_list<std::string_view> names) const {
  return std::equal(header_.begin(), header_.end(), names.begin(), names.end());
}

double Table::number(std::size_t row, std::size_t column) const {
  const std::string& cell = text(row, column);
  const bool has_plus = cell.starts_with('+') && !cell.starts_with("+-");
  const std::string_view digits = std::string_view(cell).substr(has_plus ? 1 : 0);
  double value = 0.0;
  const auto [stop, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || stop != digits.data() + digits.size() || !std::isfinite(value)) {
    refuse(row, fmt::format("{}: must be a number, as 1234.5", header_.at(column)));
  }
  return value;
}

void Table::refuse(std::size_t row, std::string_view what) const {
  refuse_line(row < lines_.size() ? lines_[row] : header_line_, what);
}

std::size_t Table::column(std::string_view name, std::string_view needs) const {
  const auto found = std::find(header_.begin(), header_.end(), name);
  if (found == header_.end()) refuse_header(fmt::format("has no column {}{}", name, needs));
  return static_cast<std::size_t>(found - header_.begin());
}

void Table::refuse_header(std::string_view what) const { refuse_line(header_line_, what); }

void Table::refuse_line(std::size_t line, std::string_view what) const {
  throw InputError(fmt::format("{}:{}: {}", source_, line, what));
}

}  // namespace geo::io
