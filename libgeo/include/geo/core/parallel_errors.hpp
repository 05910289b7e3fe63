#pragma once

#include <atomic>
#include <exception>
#include <optional>
#include <type_traits>
#include <utility>

namespace geo {

/// Carries the first exception out of a parallel region, which none may leave by itself: whatever
/// can throw there, memory that runs out above all, is done by `guard` or `make`, and the thread
/// that began the region calls `rethrow` behind it. After the first exception nothing more is done.
///
///     ParallelErrors errors;
///     #pragma omp parallel
///     {
///       auto line = errors.make<std::vector<double>>(nx);
///     #pragma omp for
///       for (int j = 0; j < ny; ++j) errors.guard([&] { ... });
///     }
///     errors.rethrow();
class ParallelErrors {
 public:
  ParallelErrors() = default;
  ParallelErrors(const ParallelErrors&) = delete;
  ParallelErrors& operator=(const ParallelErrors&) = delete;

  /// Calls `work` unless something has been thrown before.
  template <class Work>
  void guard(Work&& work) noexcept {
    if (any()) return;
    const Guarding guarding;
    try {
      work();
    } catch (...) {
      keep(std::current_exception());
    }
  }

  /// A thread's own T. If it cannot be made it is empty, and no later `guard` touches it. A T that
  /// cannot be empty comes as an optional.
  template <class T, class... Arguments>
  [[nodiscard]] auto make(Arguments&&... arguments) noexcept {
    using Made =
        std::conditional_t<std::is_nothrow_default_constructible_v<T>, T, std::optional<T>>;
    Made made;
    guard([&] {
      if constexpr (std::is_same_v<Made, T>) {
        made = T(std::forward<Arguments>(arguments)...);
      } else {
        made.emplace(std::forward<Arguments>(arguments)...);
      }
    });
    return made;
  }

  /// Whether something has been thrown.
  [[nodiscard]] bool any() const noexcept { return any_.load(std::memory_order_relaxed); }
  /// Throws what was thrown first. Behind the region, on the thread that began it.
  void rethrow() const {
    if (first_) std::rethrow_exception(first_);
  }

  /// Whether what the calling thread throws now would be carried out of the parallel region that it
  /// is in; true outside of all regions.
  [[nodiscard]] static bool is_carried() noexcept;

 private:
  /// Marks the calling thread as guarded within the region that it is in.
  class Guarding {
   public:
    Guarding() noexcept;
    ~Guarding();
    Guarding(const Guarding&) = delete;
    Guarding& operator=(const Guarding&) = delete;

   private:
    int before_;
  };

  void keep(std::exception_ptr error) noexcept;

  std::atomic<bool> any_{false};
  std::exception_ptr first_;
};

}  // namespace geo
