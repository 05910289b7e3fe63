#include "tridiagonal.hpp"

#include <algorithm>
#include <type_traits>

#include "wide.hpp"

namespace geo {
namespace {

constexpr int kLanes = TridiagonalBlock::kLanes;
using Lanes = std::array<double, kLanes>;

/// Four lanes, in a register (or two) from one unknown to the next.
using Quad = double __attribute__((vector_size(32), aligned(8), may_alias));
constexpr int kQuads = kLanes / 4;

/// Values of a block as they lie in memory: `along` from unknown to unknown, one for each lane or
/// one for all.
template <std::size_t along, bool by_lane>
struct Layout {
  static void load(const double* values, int i, int quad, Quad& to) {
    const double* at = values + i * along;
    if constexpr (by_lane) {
      to = reinterpret_cast<const Quad&>(at[4 * quad]);
    } else {
      to = Quad{*at, *at, *at, *at};
    }
  }
};
using Full = Layout<kLanes, true>;
using ByLane = Layout<0, true>;
using ByUnknown = Layout<1, false>;

/// Elimination from the first unknown to the last: `upper` becomes what each unknown takes from the
/// next, `inverse` that of the diagonal, to whose ends `first` and `last` are added.
TERRANE_WIDE void eliminate(int n, const double* __restrict lower, double* __restrict upper,
                            double* __restrict inverse, const Lanes& first, const Lanes& last) {
  Lanes above{}, added = first;
  for (int i = 0; i < n; ++i) {
    const std::size_t at = std::size_t(i) * kLanes;
    if (i == n - 1) added = last;
    for (int k = 0; k < kLanes; ++k) {
      const double low = lower[at + k], up = upper[at + k];
      const double pivot = 1.0 / (1.0 + low + up - low * above[k] + added[k]);
      inverse[at + k] = pivot;
      above[k] = upper[at + k] = up * pivot;
    }
    added = {};
  }
}

/// The same with one pair of couplings per lane, which stay as they are: away from the first
/// unknown the pivots settle.
TERRANE_WIDE void eliminate_uniform(int n, const double* __restrict lower,
                                    const double* __restrict upper, double* __restrict inverse,
                                    const Lanes& first, const Lanes& last) {
  Lanes above{}, added = first;
  bool settled = false;
  for (int i = 0; i < n; ++i) {
    double* pivot = inverse + std::size_t(i) * kLanes;
    if (i == n - 1) added = last;
    if (settled && i < n - 1) {
      std::copy_n(pivot - kLanes, kLanes, pivot);
      continue;
    }
    const Lanes before = above;
    for (int k = 0; k < kLanes; ++k) {
      pivot[k] = 1.0 / (1.0 + lower[k] + upper[k] - lower[k] * above[k] + added[k]);
      above[k] = upper[k] * pivot[k];
    }
    settled = i > 0 && above == before;
    added = {};
  }
}

/// The same for one system that all lanes share.
void eliminate_shared(int n, const double* lower, double* upper, double* inverse) {
  double above = 0.0;
  for (int i = 0; i < n; ++i) {
    inverse[i] = 1.0 / (1.0 + lower[i] + upper[i] - lower[i] * above);
    above = upper[i] *= inverse[i];
  }
}

/// x may be d. `upper` is what eliminate made of it, or as it was where there is one per lane.
template <class Coupling, class Pivot>
[[gnu::always_inline]] inline void substitute_in(int n, const double* lower, const double* upper,
                                                 const double* inverse, const double* d,
                                                 double* x) {
  Quad last[kQuads] = {};
  for (int i = 0; i < n; ++i) {
    for (int q = 0; q < kQuads; ++q) {
      Quad right, low, pivot;
      Full::load(d, i, q, right);
      Coupling::load(lower, i, q, low);
      Pivot::load(inverse, i, q, pivot);
      last[q] = (right + low * last[q]) * pivot;
      reinterpret_cast<Quad&>(x[std::size_t(i) * kLanes + 4 * q]) = last[q];
    }
  }
  for (int i = n - 2; i >= 0; --i) {
    for (int q = 0; q < kQuads; ++q) {
      Quad taken;
      Coupling::load(upper, i, q, taken);
      if constexpr (std::is_same_v<Coupling, ByLane>) {
        Quad pivot;
        Pivot::load(inverse, i, q, pivot);
        taken *= pivot;
      }
      Quad& here = reinterpret_cast<Quad&>(x[std::size_t(i) * kLanes + 4 * q]);
      here += taken * last[q];
      last[q] = here;
    }
  }
}
TERRANE_WIDE void substitute(int n, const double* lower, const double* upper, const double* inverse,
                             const double* d, double* x) {
  substitute_in<Full, Full>(n, lower, upper, inverse, d, x);
}
TERRANE_WIDE void substitute_uniform(int n, const double* lower, const double* upper,
                                     const double* inverse, const double* d, double* x) {
  substitute_in<ByLane, Full>(n, lower, upper, inverse, d, x);
}
TERRANE_WIDE void substitute_shared(int n, const double* lower, const double* upper,
                                    const double* inverse, const double* d, double* x) {
  substitute_in<ByUnknown, ByUnknown>(n, lower, upper, inverse, d, x);
}

TERRANE_WIDE void subtract(int n, const double* __restrict ring, const Lanes& share,
                           double* __restrict x) {
  for (int i = 0; i < n; ++i) {
    const std::size_t at = std::size_t(i) * kLanes;
    for (int k = 0; k < kLanes; ++k) x[at + k] -= ring[at + k] * share[k];
  }
}

}  // namespace

TridiagonalBlock::TridiagonalBlock(int n, bool periodic, Couplings differ)
    : n_(n), periodic_(periodic), differ_(differ) {
  const std::size_t unknowns = n, values = unknowns * kLanes;
  stride_ = differ == Couplings::all ? kLanes : differ == Couplings::unknowns ? 1 : 0;
  const std::size_t couplings = differ == Couplings::lanes ? kLanes : unknowns * stride_;
  lower_.resize(couplings);
  upper_.resize(couplings);
  inverse_.resize(differ == Couplings::unknowns ? unknowns : values);
  if (periodic) ring_.resize(values);
}

void TridiagonalBlock::factorise() {
  double *lower = lower_.data(), *upper = upper_.data(), *inverse = inverse_.data();
  if (differ_ == Couplings::unknowns) return eliminate_shared(n_, lower, upper, inverse);
  Lanes first{}, last{};
  if (!periodic_) return eliminate(n_, lower, upper, inverse, first, last);
  const double *lower_end = this->lower(0), *upper_end = this->upper(n_ - 1);
  double *ring_begin = ring_.data(), *ring_end = ring_begin + std::size_t(n_ - 1) * kLanes;
  std::fill(ring_.begin(), ring_.end(), 0.0);
  for (int k = 0; k < kLanes; ++k) {
    first[k] = 1.0 + lower_end[k] + this->upper(0)[k];
    last[k] = upper_end[k] * lower_end[k] / first[k];
    ring_begin[k] = -first[k];
    ring_end[k] = -upper_end[k];
    corner_[k] = lower_end[k] / first[k];
  }
  if (differ_ == Couplings::lanes) {
    eliminate_uniform(n_, lower, upper, inverse, first, last);
    substitute_uniform(n_, lower, upper, inverse, ring_begin, ring_begin);
  } else {
    eliminate(n_, lower, upper, inverse, first, last);
    substitute(n_, lower, upper, inverse, ring_begin, ring_begin);
  }
  for (int k = 0; k < kLanes; ++k) {
    ring_weight_[k] = 1.0 / (1.0 + ring_begin[k] + corner_[k] * ring_end[k]);
  }
}

void TridiagonalBlock::solve(const double* d, double* x) const {
  const auto by = differ_ == Couplings::all     ? substitute
                  : differ_ == Couplings::lanes ? substitute_uniform
                                                : substitute_shared;
  by(n_, lower_.data(), upper_.data(), inverse_.data(), d, x);
  if (!periodic_) return;
  Lanes share;
  const double* last = x + std::size_t(n_ - 1) * kLanes;
  for (int k = 0; k < kLanes; ++k) share[k] = (x[k] + corner_[k] * last[k]) * ring_weight_[k];
  subtract(n_, ring_.data(), share, x);
}

}  // namespace geo
