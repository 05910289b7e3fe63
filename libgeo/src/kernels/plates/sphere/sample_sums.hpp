#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace geo {

/// Sum of value(i) for i below `count`, in blocks of one size added in order: the same bits for any
/// number of threads.
template <class Value>
double sum_over(std::int32_t count, Value&& value) {
  constexpr std::int32_t kBlock = 8192;
  const std::int32_t blocks = (count + kBlock - 1) / kBlock;
  std::vector<double> part(blocks, 0.0);
#pragma omp parallel for schedule(static)
  for (std::int32_t block = 0; block < blocks; ++block) {
    double sum = 0.0;
    const std::int32_t end = std::min(count, (block + 1) * kBlock);
    for (std::int32_t i = block * kBlock; i < end; ++i) sum += value(i);
    part[block] = sum;
  }
  double sum = 0.0;
  for (const double one : part) sum += one;
  return sum;
}

/// Volume of what lies on the samples of a model, km3, by its thickness on each, m.
template <class Model, class Thickness>
double samples_km3(const Model& model, Thickness&& thickness_m) {
  return 1e-3 * model.sample_km2() * sum_over(model.state.crust.size(), thickness_m);
}

/// Adds to a stored value and tells what it has gained, after rounding: budgets of many steps close
/// only if they hold that.
inline double put(float& value, double gain) {
  const double before = value;
  value = static_cast<float>(before + gain);
  return static_cast<double>(value) - before;
}

/// The same for values whose sum is to change by the sum of their gains: what rounding leaves of
/// one goes to the next.
class WholeGains {
 public:
  void put(float& value, double gain) {
    left_ += gain;
    left_ -= geo::put(value, left_);
  }
  /// Of all gains so far, less than the last value can show.
  [[nodiscard]] double left() const { return left_; }

 private:
  double left_ = 0.0;
};

/// What chunks of a parallel loop found, one after the other.
template <class T>
std::vector<T> joined(const std::vector<std::vector<T>>& parts) {
  std::size_t size = 0;
  for (const auto& part : parts) size += part.size();
  std::vector<T> all;
  all.reserve(size);
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace geo
