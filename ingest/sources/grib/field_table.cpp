#include "sources/grib/field_table.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <tuple>

#include "core/error.h"

namespace nepho::grib {
namespace {

constexpr std::size_t kMostNames = 6;  // in one sentence

std::string list_of(const std::set<std::string>& names) {
  std::string text;
  std::size_t count = 0;
  for (const std::string& name : names)
    if (++count <= kMostNames) text += (text.empty() ? "" : ", ") + name;
  if (count > kMostNames) text += " and " + std::to_string(count - kMostNames) + " more";
  return text;
}

std::string number_text(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

[[noreturn]] void refuse_grid(const FieldTable& table, const Field& field) {
  const Grid& grid = table.grids[std::size_t(field.grid)];
  throw Error({"this GRIB grid is not read", table.where(field),
               "regular, rotated or reduced latitudes and longitudes, Lambert, Mercator, polar "
               "stereographic, geostationary views, or places that ecCodes knows",
               grid.text() + ": " + grid.why,
               "interpolate it first, for example with cdo "
               "remapcon,r720x360"});
}

int grid_of_water(const FieldTable& table) {
  const Field* first = nullptr;
  std::set<int> grids;
  for (const Field& field : table.fields) {
    if (!field.header.parameter.water || !field.header.instant) continue;
    if (!first) first = &field;
    grids.insert(field.grid);
  }
  if (!first) return table.fields.front().grid;
  if (grids.size() > 1) {
    std::string found;
    for (const int grid : grids)
      found += (found.empty() ? "" : "; ") + table.grids[std::size_t(grid)].text();
    throw Error({"there is cloud water on several grids", table.paths.front(), "one grid", found,
                 "take the messages of one: grib_copy -w gridType=..., or a file for each grid"});
  }
  if (table.grids[std::size_t(first->grid)].kind == Grid::Kind::kUnknown)
    refuse_grid(table, *first);
  return first->grid;
}

void say_count(std::vector<std::string>& to, std::size_t count, const std::string& what) {
  if (count > 0) to.push_back(std::to_string(count) + (count == 1 ? " field" : " fields") + what);
}

// Of several members the lowest.
long member_of(const FieldTable& table, int grid, Choice& choice) {
  std::set<long> members;
  for (const Field& field : table.fields)
    if (field.grid == grid && field.header.parameter.water) members.insert(field.header.member);
  if (members.empty()) return 0;
  if (members.size() > 1)
    choice.assumptions.push_back("Member " + std::to_string(*members.begin()) +
                                 " of an ensemble of " + std::to_string(members.size()) +
                                 " is taken.");
  return *members.begin();
}

}  // namespace

std::string FieldTable::where(const Field& field) const {
  return paths[std::size_t(field.place.file)] + ", message at byte " +
         std::to_string(field.place.message) + " (" + field.header.parameter.name + ", " +
         field.header.level.name + " " + number_text(field.header.level.value) + ")";
}

FieldTable table_of(const std::vector<std::string>& paths, const forecast::UserNames& names) {
  FieldTable table;
  table.paths = paths;
  struct GridIndex {
    int layout, grid;
  };
  std::map<std::string, GridIndex> known;  // by the sum over their section
  for (std::size_t file = 0; file < paths.size(); ++file) {
    for (const FieldPlace& place : scan_fields(paths[file], int(file))) {
      const std::string where = paths[file] + ", message at byte " + std::to_string(place.message);
      const Message message(read_headers(paths[file], place), where);
      Field field{place, header_of(message, names), 0, 0};
      const auto [at, is_new] =
          known.emplace(message.text("md5GridSection"), GridIndex{int(table.grids.size()), 0});
      if (is_new) {
        std::unique_ptr<Message> all;
        table.grids.push_back(grid_of(message, [&] {
          all = std::make_unique<Message>(read_field(paths[file], place), where);
          return all.get();
        }));
        const auto same = std::ranges::find_if(
            table.grids, [&](const Grid& g) { return g.same_places(table.grids.back()); });
        at->second.grid = int(same - table.grids.begin());
      }
      field.layout = at->second.layout;
      field.grid = at->second.grid;
      if (table.pv.empty() && field.header.level.kind == LevelKind::kHybrid)
        table.pv = message.numbers("pv");
      table.fields.push_back(std::move(field));
    }
  }
  return table;
}

Choice usable_fields(const FieldTable& table) {
  Choice choice;
  choice.grid = grid_of_water(table);
  const long member = member_of(table, choice.grid, choice);
  using Key = std::tuple<std::string, std::string, double, std::int64_t>;
  std::map<Key, int> places;
  std::size_t over_time = 0, elsewhere = 0, twice = 0;
  std::set<std::string> elsewhere_names;
  for (std::size_t n = 0; n < table.fields.size(); ++n) {
    const Field& field = table.fields[n];
    const FieldHeader& header = field.header;
    const Parameter& parameter = header.parameter;
    if (!header.instant || !header.valid_ns) {
      ++over_time;
    } else if (field.grid != choice.grid) {
      ++elsewhere;
      const Grid& grid = table.grids[std::size_t(field.grid)];
      elsewhere_names.insert(parameter.name + (grid.why.empty() ? "" : " (" + grid.why + ")"));
    } else if (parameter.constant || header.member == member) {
      const std::int64_t time = parameter.constant ? 0 : *header.valid_ns;
      const Key key{parameter.name, header.level.name, header.level.value, time};
      const auto [at, is_new] = places.emplace(key, int(n));
      if (is_new) continue;
      twice += parameter.known && !parameter.constant && is_vertical(header.level.kind);
#ifdef NEPHO_MUTANT_FIRST_OF_TWO
      continue;
#endif
      at->second = int(n);
    }
  }
  for (const auto& [key, field] : places) choice.fields.push_back(field);
  std::ranges::sort(choice.fields);
  say_count(choice.facts, over_time,
            " of the file are means, sums or extremes over time, and are not used.");
  say_count(choice.facts, elsewhere,
            " of the file are on other grids, and are not used: " + list_of(elsewhere_names) + ".");
  say_count(choice.facts, twice, " occur twice; the later of each is used.");
  if (!table.grids[std::size_t(choice.grid)].row_points.empty())
    choice.assumptions.push_back(
        "Rows of the reduced grid are spread over as many cells as the longest has, by overlap.");
  return choice;
}

}  // namespace nepho::grib
