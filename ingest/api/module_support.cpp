#include "api/module_support.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <span>
#include <utility>

namespace nepho {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string written(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", number);
  return text;
}

// Levenshtein.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

template <std::size_t N>
void fill(char (&field)[N], const std::string& text) {
  std::strncpy(field, text.c_str(), N - 1);
  field[N - 1] = 0;
}

void fill(ModuleError& error, const Error::Parts& parts) {
  fill(error.what, parts.what);
  fill(error.where, parts.where);
  fill(error.expected, parts.expected);
  fill(error.found, parts.found);
  fill(error.hint, parts.hint);
}

// Where the ending of a name begins that says its unit in SI: radius_m, water_kg_per_m3.
std::size_t unit_ending(const std::string& name) {
  std::size_t end = name.size();
  for (std::size_t at; (at = name.rfind('_', end - 1)) != std::string::npos && at > 0; end = at) {
    std::string word = name.substr(at + 1, end - at - 1);
    while (!word.empty() && word.back() >= '0' && word.back() <= '9') word.pop_back();
    const auto words = {"kg", "m", "s", "K", "rad", "per"};
    if (std::ranges::find(words, word) == words.end()) break;
  }
  return end;
}

// "_kg_per_m3" as "kg/m3".
std::string unit_text(std::string ending) {
  if (ending.empty()) return "no unit";
  ending = ending.starts_with("_per_") ? "1" + ending : ending.substr(1);
  if (const std::size_t at = ending.find("_per_"); at != std::string::npos)
    ending.replace(at, 5, "/");
  std::ranges::replace(ending, '_', ' ');
  return "a unit like " + ending;
}

}  // namespace

Parameters::Parameters(const SourceRequest& request) : request_(request) {}

std::string Parameters::where(const std::string& name) const {
  return "volume '" + std::string(request_.volume_name ? request_.volume_name : "") +
         "', parameter '" + name + "'";
}

const RequestParameter* Parameters::find(const std::string& name) {
  if (std::ranges::find(known_, name) == known_.end()) known_.push_back(name);
  const std::span all(request_.parameters, request_.parameter_count);
  const auto found = std::ranges::find_if(all, [&](const auto& p) { return name == p.name; });
  return found == all.end() ? nullptr : &*found;
}

std::optional<double> Parameters::number(const std::string& name) {
  const RequestParameter* p = find(name);
  if (!p) return std::nullopt;
  if (p->text)
    throw Error({"wrong type", where(name), "a number", '"' + std::string(p->text) + '"', ""});
  if (!std::isfinite(p->number))
    throw Error({"bad value", where(name), "a finite number", written(p->number), ""});
  return p->number;
}

double Parameters::number(const std::string& name, double otherwise) {
  return number(name).value_or(otherwise);
}

double Parameters::number_in(const std::string& name, double otherwise, double low, double high) {
  const double value = number(name, otherwise);
  if (!(value >= low && value <= high))
    throw Error(
        {"out of range", where(name), written(low) + " to " + written(high), written(value), ""});
  return value;
}

std::optional<double> Parameters::positive(const std::string& name) {
  const std::optional<double> value = number(name);
  if (value && !(*value > 0))
    throw Error({"out of range", where(name), "more than 0", written(*value), ""});
  return value;
}

double Parameters::positive(const std::string& name, double otherwise) {
  return positive(name).value_or(otherwise);
}

int Parameters::integer(const std::string& name, int otherwise, int low, int high) {
  const double value = number_in(name, otherwise, low, high);
  if (value != std::round(value))
    throw Error({"bad value", where(name), "a whole number", written(value), ""});
  return int(value);
}

std::string Parameters::word(const std::string& name, const std::string& otherwise) {
  const RequestParameter* p = find(name);
  if (!p) return otherwise;
  if (!p->text) throw Error({"wrong type", where(name), "a word", written(p->number), ""});
  return p->text;
}

std::string Parameters::choice(const std::string& name, const std::vector<std::string>& choices) {
  const std::string value = word(name, choices.front());
  if (std::ranges::find(choices, value) == choices.end()) {
    const auto near = did_you_mean(value, choices);
    throw Error({"unknown word", where(name), "one of " + joined(choices), '"' + value + '"',
                 near ? "did you mean " + *near + "?" : ""});
  }
  return value;
}

void Parameters::finish() const {
  for (const RequestParameter& p : std::span(request_.parameters, request_.parameter_count)) {
    if (std::ranges::find(known_, p.name) != known_.end()) continue;
    // The host puts the unit into the name: what nobody knows may be known with another one.
    const std::string name = p.name, base = name.substr(0, unit_ending(name));
    const auto same = std::ranges::find_if(known_, [&](const std::string& known) {
      return known.substr(0, unit_ending(known)) == base;
    });
    if (same != known_.end() && !p.text) {
      const bool none = base == name;
      throw Error(
          {none ? "missing unit" : "wrong unit", where(name), unit_text(same->substr(base.size())),
           none
               ? "none"
               : "'" + std::string(p.unit && *p.unit ? p.unit : name.substr(base.size() + 1)) + "'",
           ""});
    }
    const auto near = did_you_mean(p.name, known_);
    throw Error({"unknown parameter", where(p.name), "one of " + joined(known_), p.name,
                 near ? "did you mean " + *near + "?" : ""});
  }
}

std::optional<std::string> did_you_mean(const std::string& word,
                                        const std::vector<std::string>& known) {
  const auto nearest = std::ranges::min_element(
      known, {}, [&](const std::string& other) { return edit_distance(word, other); });
  if (nearest == known.end() || edit_distance(word, *nearest) > 1 + word.size() / 3)
    return std::nullopt;
  return *nearest;
}

BrickSource* open_guarded(ModuleError* error,
                          const std::function<std::unique_ptr<BrickSource>()>& open) noexcept {
  *error = {};
  try {
    return open().release();
  } catch (const Error& e) {
    fill(*error, e.parts());
  } catch (const std::bad_alloc&) {
    fill(error->what, "out of memory");
  } catch (const std::exception& e) {
    fill(error->what, e.what());
  } catch (...) {
    fill(error->what, "an exception of unknown type");
  }
  return nullptr;
}

}  // namespace nepho
