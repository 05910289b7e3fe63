#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "geo/core/array_sizes.hpp"
#include "geo/kernels/landscape/river_courses.hpp"

namespace geo {
namespace {

using Front = std::priority_queue<std::pair<float, Index>, std::vector<std::pair<float, Index>>,
                                  std::greater<>>;

/// Which places of the courses lie upstream of which, and how far.
class Kinship {
 public:
  explicit Kinship(const RiverCourses& courses)
      : first_(courses.cell.size()),
        size_(courses.cell.size(), 1),
        steps_(courses.cell.size()),
        shortcut_(courses.shortcut) {
    const auto n = static_cast<std::int32_t>(first_.size());
    for (std::int32_t k = n - 1; k >= 0; --k) {
      if (courses.next[k] != kCourseEnds) size_[courses.next[k]] += size_[k];
    }
    // Places of a subtree are numbered one after the other, its end first.
    std::vector<std::int32_t> free(first_.size());
    std::int32_t trees = 0;
    for (std::int32_t k = 0; k < n; ++k) {
      std::int32_t& next = courses.next[k] == kCourseEnds ? trees : free[courses.next[k]];
      first_[k] = next;
      next += size_[k];
      free[k] = first_[k] + 1;
      steps_[k] = courses.next[k] == kCourseEnds ? 0 : steps_[courses.next[k]] + 1;
    }
  }
  [[nodiscard]] bool is_upstream(std::int32_t a, std::int32_t b) const {
    return first_[a] >= first_[b] && first_[a] < first_[b] + size_[b];
  }
  /// Whether water of a place may go to another: upstream, to come back, or a little downstream.
  [[nodiscard]] bool may_go(std::int32_t from, std::int32_t to) const {
    return is_upstream(to, from) ||
           (is_upstream(from, to) && steps_[from] - steps_[to] <= shortcut_);
  }

 private:
  std::vector<std::int32_t> first_, size_, steps_;
  std::int32_t shortcut_;
};

/// Passes over which the water of courses would leave them.
class Leaks {
 public:
  Leaks(const Grid& fine, std::span<const std::uint8_t> outlets, const RiverCourses& courses,
        std::span<const float> z)
      : fine_(fine),
        outlets_(outlets),
        courses_(courses),
        z_(z),
        kin_(courses),
        course_(z.size(), kNone),
        search_(z.size(), kNone),
        found_(courses.cell.size()) {
    for (std::size_t k = 0; k < courses.cell.size(); ++k) {
      course_[courses.cell[k]] = static_cast<std::int32_t>(k);
    }
  }

  /// Level of the lowest pass below `level_m` over which water at a place of a course would run
  /// away, `level_m` if there is none.
  float lowest_pass(std::int32_t place, float level_m, std::span<const float> levels_m) {
    front_ = {};
    Found& found = found_[place];
    found = {level_m, false, kNone};
    visit(place, courses_.cell[place], levels_m);
    float pass_m = std::numeric_limits<float>::lowest();
    while (!front_.empty() && front_.top().first < level_m) {
      const auto [height_m, code] = front_.top();
      front_.pop();
      pass_m = std::max(pass_m, height_m);
      if (code < 0) {  // known to run away from there
        found = {pass_m, true, found_[-1 - code].into};
        return pass_m;
      }
      if (course_[code] != kNone || outlets_[code] != 0) {
        found = {pass_m, true, course_[code]};
        return pass_m;
      }
      visit(place, code, levels_m);
    }
    return level_m;
  }

 private:
  static constexpr std::int32_t kNone = -1;
  /// What a search came to: everything it visited is safe below the level, or runs away at it.
  struct Found {
    float level_m = 0.0F;
    bool runs_away = false;
    std::int32_t into = kNone;  ///< place of a course; kNone: an outlet
  };

  void visit(std::int32_t place, Index from, std::span<const float> levels_m) {
    for (int k = 0; k < kDirections; ++k) {
      const Index next = fine_.neighbour(from, k);
      if (next == kNoCell) continue;
      if (const std::int32_t other = course_[next]; other != kNone) {
        if (!kin_.may_go(place, other)) front_.push({std::max(z_[next], levels_m[other]), next});
        continue;
      }
      const std::int32_t earlier = search_[next];
      if (earlier == place) continue;
      search_[next] = place;
      if (earlier != kNone) {
        const Found& then = found_[earlier];
        if (then.runs_away) {
          if (then.into == kNone || !kin_.may_go(place, then.into)) {
            front_.push({std::max(z_[next], then.level_m), -1 - earlier});
          }
        } else if (found_[place].level_m <= then.level_m && kin_.is_upstream(earlier, place)) {
          continue;
        }
      }
      front_.push({z_[next], next});
    }
  }

  const Grid& fine_;
  std::span<const std::uint8_t> outlets_;
  const RiverCourses& courses_;
  std::span<const float> z_;
  Kinship kin_;
  std::vector<std::int32_t> course_, search_;
  std::vector<Found> found_;
  Front front_;
};

/// Finds the levels that the water of courses has, and cuts what is above; returns where.
std::vector<Index> lower_courses(const Grid& fine, std::span<const std::uint8_t> outlets,
                                 RiverCourses& courses, std::span<float> z) {
  constexpr float kFall_m = 2e-3F;  // seen by floats at any height
  std::vector<float>& level_m = courses.level_m;
  const auto n = static_cast<std::int32_t>(courses.cell.size());
  for (std::int32_t k = 0; k < n; ++k) {
    const float bed_m = std::max(z[courses.cell[k]], 0.0F);
    const float stands_m =
        courses.next[k] == kCourseEnds ? bed_m : std::max(bed_m, level_m[courses.next[k]]);
    level_m[k] = std::min(level_m[k], stands_m);
  }
  Leaks leaks(fine, outlets, courses, z);
  std::vector<Index> cut;
  for (std::int32_t k = n - 1; k >= 0; --k) {
    const float pass_m = leaks.lowest_pass(k, level_m[k], level_m);
    if (pass_m < level_m[k]) level_m[k] = std::max(0.0F, pass_m - kFall_m);
    const Index c = courses.cell[k];
    if (z[c] >= 0.0F && z[c] > level_m[k]) {
      z[c] = level_m[k];
      cut.push_back(c);
    }
    if (const std::int32_t next = courses.next[k]; next != kCourseEnds) {
      float most_m = level_m[k];
      most_m = std::clamp(z[c], std::min(most_m, courses.least_m[next]), most_m);
      level_m[next] = std::min(level_m[next], std::max(0.0F, most_m - kFall_m));
    }
  }
  return cut;
}

/// Lays back the sides of cuts.
void lay_back_sides(const Grid& fine, std::span<const Index> cells,
                    std::span<const float> side_slope, std::span<float> z) {
  constexpr double kSlope = 0.15;
  Front cut;
  for (const Index c : cells) cut.push({z[c], c});
  while (!cut.empty()) {
    const auto [height_m, c] = cut.top();
    cut.pop();
    if (height_m > z[c]) continue;
    for (int k = 0; k < kDirections; ++k) {
      const Index next = fine.neighbour(c, k);
      if (next == kNoCell || fine.is_open_edge(fine.column(next), fine.row(next))) continue;
      const double slope = side_slope.empty() ? kSlope : side_slope[next];
      const auto most_m = static_cast<float>(height_m + slope * fine.distances_m(fine.row(c))[k]);
      if (z[next] <= most_m) continue;
      z[next] = most_m;
      cut.push({most_m, next});
    }
  }
}

}  // namespace

void open_river_courses(const Grid& fine, std::span<const std::uint8_t> outlets,
                        RiverCourses& courses, std::span<float> elevation_m) {
  check_sizes("open_river_courses", fine.size(),
              {{"outlets", outlets.size()}, {"elevation_m", elevation_m.size()}});
  lay_back_sides(fine, lower_courses(fine, outlets, courses, elevation_m), courses.side_slope,
                 elevation_m);
  // The sides of a deep cut may open a higher course beside it.
  lower_courses(fine, outlets, courses, elevation_m);
}

}  // namespace geo
