#pragma once

#include <concepts>
#include <cstdio>
#include <string>
#include <type_traits>
#include <utility>

// NEPHO_CHECK_EQ NE LT LE GT GE (a, b): for bugs, in all builds. Prints both values and aborts.
// Each argument is evaluated once; integers of unlike sign compare by value.

namespace nepho::detail {

template <class T>
concept PlainInteger = std::integral<T> && !std::same_as<T, bool> && !std::same_as<T, char> &&
                       !std::same_as<T, wchar_t> && !std::same_as<T, char8_t> &&
                       !std::same_as<T, char16_t> && !std::same_as<T, char32_t>;

template <class T>
std::string check_text(const T& value) {
  if constexpr (std::floating_point<T>) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", double(value));
    return text;
  } else if constexpr (std::is_enum_v<T>) {
    return std::to_string(std::underlying_type_t<T>(value));
  } else if constexpr (std::integral<T>) {
    return std::to_string(value);
  } else {
    return std::string(value);
  }
}

[[noreturn]] void check_failed(const char* file, int line, const char* expression,
                               const std::string& left, const std::string& right) noexcept;

// std::cmp_less and friends for integers, the plain operator for all else.
#define NEPHO_COMPARE_(name, op, cmp)                   \
  template <class A, class B>                           \
  constexpr bool name(const A& a, const B& b) {         \
    if constexpr (PlainInteger<A> && PlainInteger<B>) { \
      return std::cmp(a, b);                            \
    } else {                                            \
      return a op b;                                    \
    }                                                   \
  }
NEPHO_COMPARE_(check_eq, ==, cmp_equal)
NEPHO_COMPARE_(check_ne, !=, cmp_not_equal)
NEPHO_COMPARE_(check_lt, <, cmp_less)
NEPHO_COMPARE_(check_le, <=, cmp_less_equal)
NEPHO_COMPARE_(check_gt, >, cmp_greater)
NEPHO_COMPARE_(check_ge, >=, cmp_greater_equal)
#undef NEPHO_COMPARE_

}  // namespace nepho::detail

#define NEPHO_CHECK_(compare, text, a, b)                                      \
  do {                                                                         \
    const auto& nepho_left = (a);                                              \
    const auto& nepho_right = (b);                                             \
    if (!::nepho::detail::compare(nepho_left, nepho_right))                    \
      ::nepho::detail::check_failed(__FILE__, __LINE__, #a " " text " " #b,    \
                                    ::nepho::detail::check_text(nepho_left),   \
                                    ::nepho::detail::check_text(nepho_right)); \
  } while (false)
#define NEPHO_CHECK_EQ(a, b) NEPHO_CHECK_(check_eq, "==", a, b)
#define NEPHO_CHECK_NE(a, b) NEPHO_CHECK_(check_ne, "!=", a, b)
#define NEPHO_CHECK_LT(a, b) NEPHO_CHECK_(check_lt, "<", a, b)
#define NEPHO_CHECK_LE(a, b) NEPHO_CHECK_(check_le, "<=", a, b)
#define NEPHO_CHECK_GT(a, b) NEPHO_CHECK_(check_gt, ">", a, b)
#define NEPHO_CHECK_GE(a, b) NEPHO_CHECK_(check_ge, ">=", a, b)
