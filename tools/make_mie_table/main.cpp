// make_mie_table OUT: writes render/optics/mie_table.inc (three CPU minutes). Run it again only
// when the recipe in mie_table.h changes; a test recomputes one column.
#include <array>
#include <cstdio>
#include <cstring>

#include "optics/mie_table.h"

namespace {

using nepho::MieColumn;

void write_bulk(std::FILE* file, const std::array<MieColumn, 3>& columns,
                double MieColumn::*member) {
  std::fprintf(file, "{%.6g, %.6g, %.6g}", columns[0].*member, columns[1].*member,
               columns[2].*member);
}

void write_row(std::FILE* file, double radius_m) {
  std::array<MieColumn, 3> columns;
  for (int w = 0; w < 3; ++w) {
    std::fprintf(stderr, "r_eff %.0f um, %.0f nm\n", radius_m * 1e6,
                 nepho::kWavelengths_m[std::size_t(w)] * 1e9);
    columns[std::size_t(w)] = nepho::compute_mie_column(radius_m, w);
  }
  std::fprintf(file, "{%g,\n {{", radius_m);
  write_bulk(file, columns, &MieColumn::asymmetry);
  std::fputs("},\n  {", file);
  write_bulk(file, columns, &MieColumn::extinction_efficiency);
  std::fputs("},\n  {", file);
  write_bulk(file, columns, &MieColumn::co_albedo);
  std::fputs("}},\n {{", file);
  for (const MieColumn& column : columns) {
    std::fputs("{{", file);
    for (std::size_t texel = 0; texel < column.log_phase_1e4.size(); ++texel)
      std::fprintf(file, "%s%d,", texel % 16 ? "" : "\n", column.log_phase_1e4[texel]);
    std::fputs("}},", file);
  }
  std::fputs("}}},\n", file);
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2 || arguments[1][0] == '-') {
    std::fprintf(stderr, "usage: make_mie_table OUT\n");
    return argument_count == 2 && std::strcmp(arguments[1], "--help") == 0 ? 0 : 2;
  }
  std::FILE* file = std::fopen(arguments[1], "w");
  if (!file) {
    std::perror(arguments[1]);
    return 1;
  }
  std::fputs("// Made by tools/make_mie_table: do not edit. Fields: MieRow of mie_table.h.\n",
             file);
  for (const double radius_m : nepho::kMieRadii_m) write_row(file, radius_m);
  const bool written = !std::ferror(file);
  if (std::fclose(file) != 0 || !written) {
    std::perror(arguments[1]);
    return 1;
  }
  return 0;
}
