#include "geo/io/input/rotation_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "geo/core/error.hpp"
#include "geo/core/place.hpp"
#include "geo/io/config/config.hpp"

namespace geo::io {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF", kBlanks = " \t\r\v\f";
constexpr int kComment = 999;
constexpr std::size_t kColumns = 6;

/// One line of a file, with its number.
struct Row {
  std::size_t line;
  int moving, fixed;
  double time_ma;
  Vector3 rotation_rad;
};

/// Reads the columns of a line; errors say which one.
class Line {
 public:
  Line(const std::string& source, std::size_t number, std::string_view text)
      : source_(source), number_(number) {
    text = text.substr(0, text.find('!'));
    for (auto at = text.find_first_not_of(kBlanks); at != std::string_view::npos;
         at = text.find_first_not_of(kBlanks)) {
      text.remove_prefix(at);
      const auto size = std::min(text.find_first_of(kBlanks), text.size());
      columns_.push_back(text.substr(0, size));
      text.remove_prefix(size);
    }
  }

  [[nodiscard]] bool counts() const { return !columns_.empty() && !is_comment(); }

  [[nodiscard]] Row row() const {
    if (columns_.size() != kColumns) {
      refuse(
          fmt::format("has {} column{}: must have 6 before any !, the moving plate, time, "
                      "latitude, longitude, angle and the fixed plate",
                      columns_.size(), columns_.size() == 1 ? "" : "s"));
    }
    Row row{number_, plate(0, "moving"), plate(kColumns - 1, "fixed"), 0.0, {}};
    if (row.moving == 0) refuse("moves plate 000, which is the absolute frame");
    if (row.moving == row.fixed) {
      refuse(fmt::format("plate {} is fixed to itself", row.moving));
    }
    row.time_ma = number(1, "time", 0.0, 1e5);
    const Centre pole{number(2, "latitude", -90.0, 90.0), number(3, "longitude", -360.0, 360.0)};
    const double angle_deg = number(4, "angle", -360.0, 360.0);
    row.rotation_rad = scaled(unit_vector_of(pole), angle_deg * std::numbers::pi / 180.0);
    return row;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", source_, number_, what));
  }
  [[nodiscard]] bool is_comment() const {
    int moving = 0;
    return read(columns_.front(), moving) && moving == kComment;
  }
  template <class T>
  static bool read(std::string_view text, T& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
  }
  [[nodiscard]] int plate(std::size_t column, std::string_view name) const {
    constexpr int kHighest = 999'999'999;
    int value = 0;
    if (!read(columns_[column], value) || value < 0 || value > kHighest) {
      refuse(fmt::format("the {} plate is {}: must be a whole number, 0 or more", name,
                         columns_[column]));
    }
    return value;
  }
  [[nodiscard]] double number(std::size_t column, std::string_view name, double least,
                              double most) const {
    double value = 0.0;
    if (!read(columns_[column], value)) {
      refuse(fmt::format("the {} is {}: must be a number", name, columns_[column]));
    }
    if (!(value >= least && value <= most)) {
      refuse(fmt::format("the {} is {}: must be in [{:g}, {:g}]", name, columns_[column], least,
                         most));
    }
    return value;
  }

  const std::string& source_;
  std::size_t number_;
  std::vector<std::string_view> columns_;
};

std::map<int, std::vector<Row>> rows_of(std::string_view text, const std::string& source) {
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::map<int, std::vector<Row>> plates;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const auto end = text.find('\n');
    const Line line(source, number, text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (!line.counts()) continue;
    const Row row = line.row();
    plates[row.moving].push_back(row);
  }
  return plates;
}

bool is_same(const Row& a, const Row& b) {
  constexpr double kRounding = 1e-9;
  const Quaternion p = Quaternion::about(a.rotation_rad), q = Quaternion::about(b.rotation_rad);
  return std::abs(std::abs(p.w * q.w + dot(p.v, q.v)) - 1.0) < kRounding;
}

/// The rows of a plate as sequences, each relative to one plate. Of the rows of one time, at a
/// crossover, the first goes on with the sequence before.
std::vector<RotationSequence> sequences_of(std::vector<Row> rows, const std::string& source) {
  const auto is_younger = [](const Row& a, const Row& b) { return a.time_ma < b.time_ma; };
  std::stable_sort(rows.begin(), rows.end(), is_younger);
  std::vector<RotationSequence> sequences;
  const auto append = [&](const Row& row) {
    if (sequences.empty() || sequences.back().fixed != row.fixed) {
      sequences.push_back({row.moving, row.fixed, {}});
    }
    auto& all = sequences.back().rotations;
    if (!all.empty() && all.back().time_ma == row.time_ma) return;
    all.push_back({row.time_ma, Quaternion::about(row.rotation_rad)});
  };
  for (auto first = rows.begin(); first != rows.end();) {
    const auto end = std::upper_bound(first, rows.end(), *first, is_younger);
    for (auto row = first; row != end; ++row) {
      const auto other =
          std::find_if(first, row, [&](const Row& before) { return before.fixed == row->fixed; });
      if (other == row || is_same(*other, *row)) continue;
      throw InputError(fmt::format(
          "{}:{}: plate {} has another rotation relative to plate {} at {:g} Ma in line {}", source,
          row->line, row->moving, row->fixed, row->time_ma, other->line));
    }
    if (!sequences.empty()) {
      std::stable_partition(first, end,
                            [&](const Row& row) { return row.fixed == sequences.back().fixed; });
    }
    std::for_each(first, end, append);
    first = end;
  }
  return sequences;
}

/// The line of a plate's circuit at a time.
std::size_t line_at(const std::vector<Row>& rows, double time_ma) {
  const auto nearest = std::min_element(rows.begin(), rows.end(), [&](const Row& a, const Row& b) {
    return std::abs(a.time_ma - time_ma) < std::abs(b.time_ma - time_ma);
  });
  return nearest->line;
}

}  // namespace

RotationModel rotations_of(std::string_view text, const std::string& source) {
  const std::map<int, std::vector<Row>> plates = rows_of(text, source);
  if (plates.empty()) throw InputError(fmt::format("{}: holds no rotations", source));
  std::vector<RotationSequence> all;
  for (const auto& [number, rows] : plates) {
    auto sequences = sequences_of(rows, source);
    std::move(sequences.begin(), sequences.end(), std::back_inserter(all));
  }
  try {
    return RotationModel(std::move(all));
  } catch (const CircularPlates& error) {
    throw InputError(fmt::format("{}:{}: {}", source,
                                 line_at(plates.at(error.plate), error.time_ma), error.what()));
  }
}

RotationModel read_rotations(const std::filesystem::path& file) {
  return rotations_of(read_text(file), file.string());
}

}  // namespace geo::io
