#pragma once

#include <cmath>

namespace nepho {

// Dimension-checked scalar, length^L radiance^R solid-angle^S: a wrong unit does not compile. Only
// for the check build of the shared equations (render/physics/physics_cpp.h), never for storage.
template <int L, int R, int S>
struct Quantity {
  double value{};
  constexpr Quantity() = default;
  explicit constexpr Quantity(double number) : value(number) {}
  explicit constexpr operator int() const {
    static_assert(L == 0 && R == 0 && S == 0, "only a pure number counts");
    return int(value);
  }
  constexpr Quantity operator-() const { return Quantity(-value); }

  friend constexpr Quantity operator+(Quantity a, Quantity b) {
    return Quantity(a.value + b.value);
  }
  friend constexpr Quantity operator-(Quantity a, Quantity b) {
    return Quantity(a.value - b.value);
  }
  friend constexpr bool operator<(Quantity a, Quantity b) { return a.value < b.value; }
  friend constexpr bool operator<=(Quantity a, Quantity b) { return a.value <= b.value; }
  friend constexpr bool operator>(Quantity a, Quantity b) { return a.value > b.value; }
  friend constexpr bool operator>=(Quantity a, Quantity b) { return a.value >= b.value; }
  friend constexpr bool operator==(Quantity a, Quantity b) { return a.value == b.value; }
  friend constexpr Quantity max(Quantity a, Quantity b) { return a < b ? b : a; }
  friend constexpr Quantity min(Quantity a, Quantity b) { return b < a ? b : a; }
  friend Quantity abs(Quantity a) { return Quantity(std::abs(a.value)); }
};

template <int L, int R, int S, int M, int Q, int T>
constexpr auto operator*(Quantity<L, R, S> a, Quantity<M, Q, T> b) {
  return Quantity<L + M, R + Q, S + T>(a.value * b.value);
}
template <int L, int R, int S, int M, int Q, int T>
constexpr auto operator/(Quantity<L, R, S> a, Quantity<M, Q, T> b) {
  return Quantity<L - M, R - Q, S - T>(a.value / b.value);
}

template <int L, int R, int S>
auto sqrt(Quantity<L, R, S> a) {
  static_assert(L % 2 == 0 && R % 2 == 0 && S % 2 == 0, "the root of this has no unit");
  return Quantity<L / 2, R / 2, S / 2>(std::sqrt(a.value));
}

using PureNumber = Quantity<0, 0, 0>;
inline PureNumber exp(PureNumber a) {
  return PureNumber(std::exp(a.value));
}
inline PureNumber ceil(PureNumber a) {
  return PureNumber(std::ceil(a.value));
}
inline PureNumber pow(PureNumber a, PureNumber b) {
  return PureNumber(std::pow(a.value, b.value));
}

}  // namespace nepho
