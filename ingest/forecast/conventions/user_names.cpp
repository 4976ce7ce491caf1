#include "forecast/conventions/user_names.h"

#include <algorithm>
#include <charconv>
#include <fstream>

#include "core/error.h"
#include "forecast/conventions/names.h"
#include "forecast/conventions/vertical.h"
#include "units/parse_unit.h"

namespace nepho::forecast {
namespace {

constexpr const char* kShape = "QUANTITY NAME [units=UNIT] [per=dry_air|moist_air]";

// Words between blanks; quotes keep blanks in a word. A `#` that begins a word begins a comment.
std::vector<std::string> words_of(const std::string& line, const std::string& where) {
  std::vector<std::string> words;
  std::string word;
  bool quoted = false, any = false;
  for (const char c : line) {
    if (c == '"') {
      quoted = !quoted;
      any = true;
      continue;
    }
    const bool blank = !quoted && (c == ' ' || c == '\t' || c == '\r');
    if (!blank) {
      if (c == '#' && !any && !quoted) break;
      word += c;
      any = true;
    } else if (any) {
      words.push_back(std::move(word));
      word.clear();
      any = false;
    }
  }
  if (quoted) throw Error({"a quote is not closed", where, "\"...\" around a unit", line, ""});
  if (any) words.push_back(std::move(word));
  return words;
}

struct AxisWord {
  const char* word;
  char axis;
};
constexpr AxisWord kAxes[] = {
    {"x_axis", 'X'}, {"y_axis", 'Y'}, {"level_axis", 'Z'}, {"time_axis", 'T'}};

void read_quantity(UserName& row, const std::string& word) {
  std::string known;
  for (const AxisWord& axis : kAxes) {
    if (word == axis.word) {
      row.axis = axis.axis;
      return;
    }
    known += axis.word + std::string(", ");
  }
  for (int n = 0; n < kQuantities; ++n) {
    if (word == word_of(Quantity(n))) {
      row.quantity = Quantity(n);
      return;
    }
    known += (n ? ", " : "") + std::string(word_of(Quantity(n)));
  }
  throw Error({"no such quantity", row.where, "one of " + known, "\"" + word + "\"",
               std::string("lines are: ") + kShape});
}

bool starts(std::string& text, const std::string& prefix) {
  if (!text.starts_with(prefix)) return false;
  text.erase(0, prefix.size());
  return true;
}

void read_code(UserName& row, const std::string& text, const char* shape) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int n = 0; n < 3; ++n) {
    const auto [next, error] = std::from_chars(at, end, row.code[n]);
    const bool last = n == 2;
    if (error != std::errc() || row.code[n] < 0 ||
        (last ? next != end : next == end || *next != '/'))
      throw Error({"no numbers of a GRIB field", row.where, shape, "\"" + text + "\"", ""});
    at = next + 1;
  }
}

void read_name(UserName& row, std::string text) {
  if (starts(text, "grib2:")) {
    row.kind = UserName::Kind::kGrib2;
    read_code(row, text, "grib2:DISCIPLINE/CATEGORY/NUMBER");
  } else if (starts(text, "grib1:")) {
    row.kind = UserName::Kind::kGrib1;
    read_code(row, text, "grib1:CENTRE/TABLE/NUMBER");
  } else {
    row.kind =
        starts(text, "standard_name:") ? UserName::Kind::kStandardName : UserName::Kind::kName;
    row.name = std::move(text);
  }
}

void read_option(UserName& row, std::string text) {
  if (starts(text, "units=")) {
    try {
      parse_unit(text);
    } catch (const Error& e) {
      throw Error({"the unit is not known", row.where, e.parts().expected, "\"" + text + "\"",
                   "with blanks in quotes: units=\"kg m-3\""});
    }
    row.units = std::move(text);
  } else if (starts(text, "per=")) {
    if (text != "dry_air" && text != "moist_air")
      throw Error({"per what is not known", row.where, "per=dry_air or per=moist_air",
                   "\"" + text + "\"", "contents per volume are told by their units, kg m-3"});
    row.per = std::move(text);
  } else {
    throw Error({"a word too many", row.where, kShape, "\"" + text + "\"", ""});
  }
}

std::string text_of(const UserName& row) {
  const std::string code = std::to_string(row.code[0]) + "/" + std::to_string(row.code[1]) + "/" +
                           std::to_string(row.code[2]);
  switch (row.kind) {
    case UserName::Kind::kGrib1:
      return "grib1:" + code;
    case UserName::Kind::kGrib2:
      return "grib2:" + code;
    default:
      return row.name;
  }
}

}  // namespace

const UserName* UserNames::of_grib(long edition, long a, long b, long c,
                                   const std::string& short_name) const {
  const auto at = std::ranges::find_if(rows, [&](const UserName& row) {
    if (row.axis) return false;
    if (row.kind == UserName::Kind::kName) return row.name == short_name;
    const bool same = row.kind == (edition == 2 ? UserName::Kind::kGrib2 : UserName::Kind::kGrib1);
    return same && row.code[0] == a && row.code[1] == b && row.code[2] == c;
  });
  return at == rows.end() ? nullptr : &*at;
}

UserNames read_user_names(const std::string& path) {
  UserNames names;
  names.path = path;
  if (path.empty()) return names;
  std::ifstream in(path);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    UserName row{.quantity = Quantity::kOther,
                 .name = {},
                 .units = {},
                 .per = {},
                 .where = path + ", line " + std::to_string(number)};
    const std::vector<std::string> words = words_of(line, row.where);
    if (words.empty()) continue;
    read_quantity(row, words[0]);
    if (words.size() < 2)
      throw Error({"a quantity without a name", row.where, kShape, "\"" + words[0] + "\"", ""});
    read_name(row, words[1]);
    for (std::size_t n = 2; n < words.size(); ++n) read_option(row, words[n]);
    names.rows.push_back(std::move(row));
  }
  if (names.rows.empty())
    throw Error({"there are no names in the names file", path, std::string("lines of ") + kShape,
                 in.eof() ? "none" : "no such file", ""});
  return names;
}

namespace {

bool has_no_unit(Quantity quantity) {
  return quantity == Quantity::kCloudFraction || quantity == Quantity::kLandFraction ||
         quantity == Quantity::kLogSurfacePressure || quantity == Quantity::kOther;
}

// A variable without a unit would be left aside without a word.
void check_units(const UserNames& names, const DataFile& file) {
  for (const FileVariable& variable : file.variables()) {
    const std::string word = variable.text(kQuantityAttribute), unit = variable.text("units");
    if (word.empty() || !(unit.empty() || unit == "unknown")) continue;
    int n = 0;
    while (word != word_of(Quantity(n))) ++n;
    if (has_no_unit(Quantity(n))) continue;
    throw Error({"the unit of a variable that the names file names is not known",
                 file.where(variable), "units in the file, or units=UNIT in its row",
                 "\"" + unit + "\"",
                 "in " + names.path + ": " + word + " ... units=K, or Pa, m, kg/kg"});
  }
}

// Of scalar points: CM1's up to release 19. Lengths only: IFS calls a geopotential z.
void adopt_coordinates(DataFile& file) {
  for (int d = 0; d < int(file.dimensions().size()); ++d) {
    const auto along = [&](const FileVariable* v) {
      return v && v->numeric && v->dimensions == std::vector<int>{d};
    };
    if (along(file.find(file.name(d)))) continue;
    for (const char* name : {"xh", "yh", "zh", "z"})
      if (along(file.find(name)) && unit_of(*file.find(name), kLength).fits) {
        file.rename_dimension(d, name);
        break;
      }
  }
}

}  // namespace

void apply_names(const UserNames& names, DataFile& file) {
  adopt_coordinates(file);
  std::string missing;
  std::size_t used = 0;
  for (const UserName& row : names.rows) {
    bool any = false;
    for (int d = 0; row.axis && d < int(file.dimensions().size()); ++d)
      if (file.name(d) == row.name) {
        file.set_axis(d, row.axis);
        any = true;
      }
    for (const FileVariable& variable : file.variables()) {
      if (row.axis) break;
      const bool is = row.kind == UserName::Kind::kName ? variable.name == row.name
                      : row.kind == UserName::Kind::kStandardName
                          ? variable.text("standard_name") == row.name
                          : false;
      any |= is || variable.text(kRowAttribute) == row.where;
      if (!is) continue;
      file.set_attribute(variable.id, kQuantityAttribute, word_of(row.quantity));
#ifndef NEPHO_MUTANT_USER_UNITS
      if (!row.units.empty()) file.set_attribute(variable.id, "units", row.units);
#endif
      if (!row.per.empty()) file.set_attribute(variable.id, kPerAttribute, row.per);
    }
    used += any;
    if (!any) missing += (missing.empty() ? "" : ", ") + text_of(row);
  }
  if (names.rows.empty()) return;
  check_units(names, file);
  file.add_fact(std::to_string(used) + " of " + std::to_string(names.rows.size()) + " rows of " +
                names.path + " are of this file" +
                (missing.empty() ? "." : "; it does not hold " + missing + "."));
}

}  // namespace nepho::forecast
