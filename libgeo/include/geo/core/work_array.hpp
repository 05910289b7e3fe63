#pragma once

#include <cstddef>
#include <memory>
#include <utility>

namespace geo {

/// Working memory of a kernel: as many elements as it is made with, which all threads set at first
/// if there are many. A vector has one thread set them, and the system clear the pages that this
/// one touches: on rasters that takes longer than many a loop over them.
template <class T>
class WorkArray {
 public:
  WorkArray() = default;
  explicit WorkArray(std::size_t size, const T& value = T{}) : values_(new T[size]), size_(size) {
    fill(value);
  }
  /// A copy of a range of as many elements as a container has.
  template <class Range>
  static WorkArray copy_of(const Range& range) {
    WorkArray copy;
    copy.size_ = range.size();
    copy.values_.reset(new T[copy.size_]);
    copy.each([&](std::size_t n) { copy.values_[n] = static_cast<T>(range[n]); });
    return copy;
  }
  WorkArray(WorkArray&& other) noexcept
      : values_(std::move(other.values_)), size_(std::exchange(other.size_, 0)) {}
  WorkArray& operator=(WorkArray&& other) noexcept {
    values_ = std::move(other.values_);
    size_ = std::exchange(other.size_, 0);
    return *this;
  }

  void fill(const T& value) {
    each([&](std::size_t n) { values_[n] = value; });
  }
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  [[nodiscard]] T* data() noexcept { return values_.get(); }
  [[nodiscard]] const T* data() const noexcept { return values_.get(); }
  [[nodiscard]] T* begin() noexcept { return data(); }
  [[nodiscard]] const T* begin() const noexcept { return data(); }
  [[nodiscard]] T* end() noexcept { return data() + size_; }
  [[nodiscard]] const T* end() const noexcept { return data() + size_; }
  T& operator[](std::size_t n) noexcept { return values_[n]; }
  const T& operator[](std::size_t n) const noexcept { return values_[n]; }

 private:
  template <class Set>
  void each(const Set& set) {
    constexpr std::size_t kMany = 50'000;
#pragma omp parallel for schedule(static) if (size_ >= kMany)
    for (std::size_t n = 0; n < size_; ++n) set(n);
  }

  std::unique_ptr<T[]> values_;
  std::size_t size_ = 0;
};

}  // namespace geo
