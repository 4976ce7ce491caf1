#include "cli/values.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "scene/scene_grammar.h"

namespace nepho {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& expected,
                         const std::string& text) {
  throw Error({"bad value", option, expected, "'" + text + "'", ""});
}

std::string shown(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

// A field of an object of that name, anywhere below `in`.
const FieldGrammar* find_field(const ObjectGrammar& in, std::string_view object,
                               std::string_view field) {
  for (const FieldGrammar& known : in.fields) {
    if (in.name == object && known.name == field) return &known;
    if (!known.object) continue;
    if (const FieldGrammar* found = find_field(*known.object, object, field)) return found;
  }
  return nullptr;
}

const FieldGrammar& grammar_of(std::string_view object, std::string_view field) {
  if (const FieldGrammar* found = find_field(scene_grammar(), object, field)) return *found;
  throw std::logic_error("no field " + std::string(field));
}

double in_range(const std::string& option, const std::string& text, double value,
                const FieldGrammar& grammar) {
  const bool whole = grammar.kind != FieldKind::kInteger || value == std::floor(value);
  if (!whole || value < grammar.low || value > grammar.high)
    refuse(option,
           std::string(grammar.kind == FieldKind::kInteger ? "a whole number" : "a number") +
               " from " + shown(grammar.low) + " to " + shown(grammar.high),
           text);
  return value;
}

}  // namespace

double number_value(const std::string& option, const std::string& text) {
  double value = 0;
  const char* start = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(start, end, value);
  if (failure != std::errc{} || stop != end || !std::isfinite(value))
    refuse(option, "a number", text);
  return value;
}

double number_value(const std::string& option, const std::string& text, const char* object,
                    const char* field) {
  return in_range(option, text, number_value(option, text), grammar_of(object, field));
}

double share_value(const std::string& option, const std::string& text, const char* object,
                   const char* field) {
  const bool percent = text.ends_with('%');
  const double value = number_value(option, percent ? text.substr(0, text.size() - 1) : text);
  return in_range(option, text, percent ? value / 100 : value, grammar_of(object, field));
}

int integer_value(const std::string& option, const std::string& text, const char* object,
                  const char* field) {
  return int(number_value(option, text, object, field));
}

std::string choice_value(const std::string& option, const std::string& text, const char* object,
                         const char* field) {
  std::string_view left = grammar_of(object, field).choices;
  std::string listed;
  while (!left.empty()) {
    const std::size_t bar = left.find('|');
    if (left.substr(0, bar) == text) return text;
    listed += (listed.empty() ? "" : " or ") + std::string(left.substr(0, bar));
    left.remove_prefix(bar == std::string_view::npos ? left.size() : bar + 1);
  }
  refuse(option, listed, text);
}

ToneMap tone_map_value(const std::string& text) {
  const std::string word = choice_value("--tone-map", text, "scene", "tone_map");
  return word == "none" ? ToneMap::kNone : ToneMap::kAces;
}

const char* tone_map_name(ToneMap tone_map) {
  return tone_map == ToneMap::kNone ? "none" : "aces";
}

std::vector<double> list_value(const std::string& option, const std::string& text,
                               std::size_t count, const char* shape) {
  std::vector<double> values;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    try {
      values.push_back(number_value(option, text.substr(at, comma - at)));
    } catch (const Error&) {
      refuse(option, shape, text);
    }
    at = comma + 1;
  }
  if (values.size() != count) refuse(option, shape, text);
  return values;
}

glm::ivec2 size_value(const std::string& option, const std::string& text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string::npos) refuse(option, "WIDTHxHEIGHT", text);
  return {integer_value(option, text.substr(0, cross), "image", "width"),
          integer_value(option, text.substr(cross + 1), "image", "height")};
}

}  // namespace nepho
