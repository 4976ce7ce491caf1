#pragma once

#include <cmath>

#include "cases.h"
#include "random.h"

namespace nepho::test {

using Real = long double;

// What float can hold of it: rows whose truth is that of the rounded inputs.
inline double rounded(double value) {
  return double(float(value));
}

std::vector<Row> rows_of_angular_walls();
std::vector<Row> rows_of_spheres();
std::vector<Row> rows_of_offsets();
std::vector<Row> rows_of_box_walls();
std::vector<Row> rows_of_swept_angles();
std::vector<Row> rows_of_heights_along_rays();
std::vector<Row> rows_of_heights_of_offsets();
std::vector<Row> rows_of_geodetic_heights();
std::vector<Row> rows_of_simpson_steps();

template <typename MakeRow>
std::vector<Row> random_rows(int count, MakeRow make_row) {
  Random random;
  std::vector<Row> rows;
  rows.reserve(std::size_t(count));
  while (int(rows.size()) < count) {
    Row row;
    if (make_row(random, row)) rows.push_back(row);
  }
  return rows;
}

}  // namespace nepho::test
