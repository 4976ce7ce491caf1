#include "units/parse_unit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "core/error.h"
#include "units/constants.h"

namespace nepho {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr std::size_t kLongestText = 100;  // bounds the recursion and the powers too
constexpr int kHighestPower = 9;

// mantissa * 10^ten: powers of ten are kept apart, so that cm-3 is 1e6 to the last bit.
struct Factor {
  double mantissa = 1;
  int ten = 0;
  Dimension dimension{};
  double offset = 0;  // of a temperature scale that stands alone

  void multiply(const Factor& other, int sign) {
    mantissa = sign > 0 ? mantissa * other.mantissa : mantissa / other.mantissa;
    ten += sign * other.ten;
    dimension.m += sign * other.dimension.m;
    dimension.kg += sign * other.dimension.kg;
    dimension.s += sign * other.dimension.s;
    dimension.K += sign * other.dimension.K;
    dimension.rad += sign * other.dimension.rad;
  }
};

struct Name {
  std::string_view name;
  Factor factor;
};

constexpr Dimension kForce{.m = 1, .kg = 1, .s = -2}, kEnergy{.m = 2, .kg = 1, .s = -2};
constexpr Dimension kPower{.m = 2, .kg = 1, .s = -3}, kVolume{.m = 3};

#ifdef NEPHO_MUTANT_GRAM_IS_KILOGRAM
constexpr int kGramTen = 0;
#else
constexpr int kGramTen = -3;
#endif

// Symbols that take a prefix, and words that take a prefix and a plural.
constexpr std::array kSymbols = std::to_array<Name>({{"m", {.dimension = kLength}},
                                                     {"g", {1, kGramTen, {.kg = 1}}},
                                                     {"s", {.dimension = kTime}},
                                                     {"K", {.dimension = kTemperature}},
                                                     {"rad", {.dimension = kAngle}},
                                                     {"Pa", {.dimension = kPressure}},
                                                     {"bar", {1, 5, kPressure}},
                                                     {"N", {.dimension = kForce}},
                                                     {"J", {.dimension = kEnergy}},
                                                     {"W", {.dimension = kPower}},
                                                     {"Hz", {.dimension = {.s = -1}}},
                                                     {"L", {1, -3, kVolume}},
                                                     {"l", {1, -3, kVolume}}});
constexpr std::array kWords = std::to_array<Name>({{"metre", {.dimension = kLength}},
                                                   {"meter", {.dimension = kLength}},
                                                   {"gram", {1, kGramTen, {.kg = 1}}},
                                                   {"second", {.dimension = kTime}},
                                                   {"kelvin", {.dimension = kTemperature}},
                                                   {"radian", {.dimension = kAngle}},
                                                   {"pascal", {.dimension = kPressure}},
                                                   {"bar", {1, 5, kPressure}},
                                                   {"newton", {.dimension = kForce}},
                                                   {"joule", {.dimension = kEnergy}},
                                                   {"watt", {.dimension = kPower}},
                                                   {"hertz", {.dimension = {.s = -1}}},
                                                   {"litre", {1, -3, kVolume}},
                                                   {"liter", {1, -3, kVolume}},
                                                   {"steradian", {.dimension = {.rad = 2}}}});
// As they stand.
constexpr std::array kOthers =
    std::to_array<Name>({{"sr", {.dimension = {.rad = 2}}},
                         {"t", {1, 3, {.kg = 1}}},
                         {"tonne", {1, 3, {.kg = 1}}},
                         {"tonnes", {1, 3, {.kg = 1}}},
                         {"sec", {.dimension = kTime}},
                         {"min", {60, 0, kTime}},
                         {"minute", {60, 0, kTime}},
                         {"minutes", {60, 0, kTime}},
                         {"h", {3600, 0, kTime}},
                         {"hr", {3600, 0, kTime}},
                         {"hour", {3600, 0, kTime}},
                         {"hours", {3600, 0, kTime}},
                         {"d", {86400, 0, kTime}},
                         {"day", {86400, 0, kTime}},
                         {"days", {86400, 0, kTime}},
                         {"deg", {kDegree_rad, 0, kAngle}},
                         {"arcmin", {kDegree_rad / 60, 0, kAngle}},
                         {"arcsec", {kDegree_rad / 3600, 0, kAngle}},
                         {"degC", {1, 0, kTemperature, constants::kZeroCelsius_K}},
                         {"deg_C", {1, 0, kTemperature, constants::kZeroCelsius_K}},
                         {"celsius", {1, 0, kTemperature, constants::kZeroCelsius_K}},
                         {"Celsius", {1, 0, kTemperature, constants::kZeroCelsius_K}},
                         {"degree_Celsius", {1, 0, kTemperature, constants::kZeroCelsius_K}},
                         {"degrees_Celsius", {1, 0, kTemperature, constants::kZeroCelsius_K}},
                         {"degF", {5.0 / 9, 0, kTemperature, 459.67 * 5 / 9}},
                         {"degK", {.dimension = kTemperature}},
                         {"micron", {1, -6, kLength}},
                         {"microns", {1, -6, kLength}},
                         {"ft", {0.3048, 0, kLength}},
                         {"feet", {0.3048, 0, kLength}},
                         {"kt", {1852.0 / 3600, 0, {.m = 1, .s = -1}}},
                         {"knot", {1852.0 / 3600, 0, {.m = 1, .s = -1}}},
                         {"knots", {1852.0 / 3600, 0, {.m = 1, .s = -1}}},
                         {"atm", {101325, 0, kPressure}},
                         {"%", {1, -2}},
                         {"percent", {1, -2}},
                         {"ppm", {1, -6}}});

struct Prefix {
  std::string_view symbol, word;
  int ten;
};
constexpr std::array kPrefixes = std::to_array<Prefix>({{"da", "deca", 1},
                                                        {"T", "tera", 12},
                                                        {"G", "giga", 9},
                                                        {"M", "mega", 6},
                                                        {"k", "kilo", 3},
                                                        {"h", "hecto", 2},
                                                        {"d", "deci", -1},
                                                        {"c", "centi", -2},
                                                        {"m", "milli", -3},
                                                        {"u", "micro", -6},
                                                        {"n", "nano", -9},
                                                        {"p", "pico", -12},
                                                        {"f", "femto", -15}});

std::optional<Factor> find(std::span<const Name> names, std::string_view name) {
  for (const Name& known : names)
    if (known.name == name) return known.factor;
  return {};
}

std::optional<Factor> find_prefixed(std::span<const Name> names, std::string_view name,
                                    std::string_view Prefix::*spelling) {
  if (const auto bare = find(names, name)) return bare;
  for (const Prefix& prefix : kPrefixes) {
    const std::string_view start = prefix.*spelling;
    if (!name.starts_with(start)) continue;
    if (auto factor = find(names, name.substr(start.size()))) {
      factor->ten += prefix.ten;
      return factor;
    }
  }
  return {};
}

// degree, degrees, and CF's spellings for latitude and longitude: degrees_north, degreeE, ...
bool is_degree(std::string_view name) {
  if (!name.starts_with("degree")) return false;
  name.remove_prefix(name.starts_with("degrees") ? 7 : 6);
  static constexpr std::array kEndings =
      std::to_array<std::string_view>({"", "_north", "_east", "_N", "_E", "N", "E"});
  return std::ranges::find(kEndings, name) != kEndings.end();
}

// Whole names first: min is a minute, not a milli-inch, and d a day.
std::optional<Factor> look_up(std::string_view name) {
  if (is_degree(name)) return Factor{kDegree_rad, 0, kAngle};
  if (const auto factor = find(kOthers, name)) return factor;
  if (const auto factor = find_prefixed(kSymbols, name, &Prefix::symbol)) return factor;
  if (const auto factor = find_prefixed(kWords, name, &Prefix::word)) return factor;
  if (name.ends_with('s'))
    return find_prefixed(kWords, name.substr(0, name.size() - 1), &Prefix::word);
  return {};
}

// UTF-8 spellings to plain ones: a run of superscripts to ^n, micro to u, the degree sign to deg.
std::string plain_text(std::string_view text) {
  struct Spelling {
    std::string_view from, to;
  };
  static constexpr std::array kSuperscripts = std::to_array<Spelling>({{"\u2070", "0"},
                                                                       {"\u00b9", "1"},
                                                                       {"\u00b2", "2"},
                                                                       {"\u00b3", "3"},
                                                                       {"\u2074", "4"},
                                                                       {"\u2075", "5"},
                                                                       {"\u2076", "6"},
                                                                       {"\u2077", "7"},
                                                                       {"\u2078", "8"},
                                                                       {"\u2079", "9"},
                                                                       {"\u207b", "-"}});
  static constexpr std::array kOtherSpellings = std::to_array<Spelling>({{"\u00b5", "u"},
                                                                         {"\u03bc", "u"},
                                                                         {"\u00b0", "deg"},
                                                                         {"\u00b7", "*"},
                                                                         {"\u22c5", "*"},
                                                                         {"\u2212", "-"},
                                                                         {"\u00a0", " "},
                                                                         {"\t", " "}});
  const auto starting = [&](std::span<const Spelling> list) -> const Spelling* {
    for (const Spelling& spelling : list)
      if (text.starts_with(spelling.from)) return &spelling;
    return nullptr;
  };
  std::string plain;
  bool raised = false;
  while (!text.empty()) {
    const Spelling* high = starting(kSuperscripts);
    const Spelling* other = high ? nullptr : starting(kOtherSpellings);
    if (high && !raised) plain += '^';
    raised = high != nullptr;
    plain += high ? high->to : other ? other->to : text.substr(0, 1);
    text.remove_prefix(high ? high->from.size() : other ? other->from.size() : 1);
  }
  return plain;
}

constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
constexpr bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '%';
}

class UnitParser {
 public:
  explicit UnitParser(std::string_view original)
      : original_(original), text_(plain_text(original)) {
    if (text_.size() > kLongestText) fail("a unit is too long", "", "at most 100 characters");
  }

  Unit parse() {
    const Factor all = product();
    if (at_ < text_.size()) fail("a unit has a bracket too many", rest(), "");
    const double power = std::pow(10.0, std::abs(all.ten));
    const double factor = all.ten < 0 ? all.mantissa / power : all.mantissa * power;
    if (!(factor > 0) || !std::isfinite(factor))
      fail("a unit's factor is zero or too large for a number", "", "");
    return {factor, all.offset, all.dimension};
  }

 private:
  [[noreturn]] void fail(std::string what, std::string found, std::string expected) const {
    throw Error({.what = std::move(what),
                 .where = "unit '" + std::string(original_.substr(0, kLongestText)) + "'",
                 .expected = std::move(expected),
                 .found = found.empty() ? found : "'" + found + "'",
                 .hint = ""});
  }
  char peek(std::size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  std::string rest() const { return text_.substr(at_); }
  bool take(std::string_view token) {
    if (!std::string_view(text_).substr(at_).starts_with(token)) return false;
    at_ += token.size();
    return true;
  }
  bool take_per() {
    if (take("/")) return true;
    return !is_letter(peek(3)) && take("per");
  }
  void skip_blanks() {
    while (peek() == ' ') ++at_;
  }

  Factor product() {
    skip_blanks();
    Factor result = factor();
    bool divided = false;
    for (skip_blanks(); at_ < text_.size() && peek() != ')'; skip_blanks()) {
      const bool divides = take_per();
      if (divided && !divides)
        fail("a product after a division has two readings", rest(),
             "brackets or powers: W/(m2 sr) or W m-2 sr-1");
      divided |= divides;
      if (!divides && !take("*")) take(".");
      skip_blanks();
      const Factor next = factor();
      // A scaled Celsius degree could be either; one in a product is an interval.
      if (result.offset + next.offset != 0 &&
          (result.dimension == kDimensionless || next.dimension == kDimensionless))
        fail("a scaled temperature scale has two readings", "", "K, or degC alone");
      result.multiply(next, divides ? -1 : 1);
      result.offset = 0;
    }
    return result;
  }

  Factor factor() {
    Factor base;
    if (take("(")) {
      base = product();
      if (!take(")")) fail("a unit has an open bracket", "", ")");
    } else if (is_digit(peek()) || (peek() == '.' && is_digit(peek(1)))) {
      base.mantissa = number();
      if (base.mantissa == 10) base = {.ten = 1};  // 10^-6 to the last bit
    } else if (is_letter(peek())) {
      base = name();
    } else {
      fail(text_.find_first_not_of(' ') == std::string::npos ? "a unit is missing"
                                                             : "a unit is not understood",
           rest(),
           at_ < text_.size() ? "a name of a unit" : "a name of a unit; 1 for a pure number");
    }
    return raised(base, power());
  }

  double number() {
    double value = 0;
    const char* first = text_.data() + at_;
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), value);
    if (error != std::errc{} || !(value > 0) || !std::isfinite(value))
      fail("a number in a unit is not usable", rest(), "a number above zero");
    at_ += std::size_t(end - first);
    return value;
  }

  Factor name() {
    const std::size_t first = at_;
    while (is_letter(peek())) ++at_;
    const std::string word = text_.substr(first, at_ - first);
    if (word == "since" || word == "after" || word == "from" || word == "ref")
      fail("a time axis with an origin is not a unit", word, "a unit alone, such as s or hours");
    const auto factor = look_up(word);
    if (!factor)
      fail("a unit is not known", word, "names such as m, km, um, g, hPa, degC, deg, s, W, %");
    return *factor;
  }

  // 2, -2, ^2, **-2, or nothing: 1.
  int power() {
    const bool marked = take("**") || take("^");
    const std::size_t first = at_;
    if (peek() == '-' && is_digit(peek(1))) ++at_;
    while (is_digit(peek())) ++at_;
    if (at_ == first && !marked) return 1;
    int value = 0;
    const auto [end, error] = std::from_chars(text_.data() + first, text_.data() + at_, value);
    if (error != std::errc{} || end == text_.data() + first || value == 0 ||
        std::abs(value) > kHighestPower)
      fail("a power in a unit is not usable", text_.substr(first),
           "a whole number, 1 to 9 or -1 to -9");
    return value;
  }

  Factor raised(const Factor& base, int power) const {
    if (power == 1) return base;
    Factor result;
    for (int n = std::abs(power); n > 0; --n) result.multiply(base, power > 0 ? 1 : -1);
    const Dimension& d = result.dimension;
    for (const int total : {result.ten, d.m, d.kg, d.s, d.K, d.rad})
      if (std::abs(total) > 300) fail("a unit's powers are too high", "", "");
    return result;
  }

  std::string_view original_;
  std::string text_;
  std::size_t at_ = 0;
};

}  // namespace

std::string to_string(const Dimension& dimension) {
  std::string text;
  const auto append = [&](const char* symbol, int power) {
    if (power == 0) return;
    if (!text.empty()) text += ' ';
    text += symbol;
    if (power != 1) text += std::to_string(power);
  };
  append("kg", dimension.kg);
  append("m", dimension.m);
  append("s", dimension.s);
  append("K", dimension.K);
  append("rad", dimension.rad);
  return text.empty() ? "1" : text;
}

Unit parse_unit(std::string_view text) {
  return UnitParser(text).parse();
}

double to_si(double value, std::string_view unit, const Dimension& wanted) {
  const Unit parsed = parse_unit(unit);
  if (parsed.dimension != wanted)
    throw Error({.what = "a unit is of the wrong kind",
                 .where = "unit '" + std::string(unit) + "'",
                 .expected = to_string(wanted),
                 .found = to_string(parsed.dimension),
                 .hint = ""});
  return parsed.to_si(value);
}

}  // namespace nepho
