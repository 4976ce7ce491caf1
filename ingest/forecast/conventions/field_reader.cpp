#include "forecast/conventions/field_reader.h"

#include <algorithm>
#include <array>

namespace nepho::forecast {
namespace {

bool has(const FileVariable& variable, int dimension) {
  return std::ranges::find(variable.dimensions, dimension) != variable.dimensions.end();
}

}  // namespace

bool FieldReader::is_field(const FileVariable& variable, int z) const {
  return variable.numeric && has(variable, z) && (y < 0 || has(variable, y)) && has(variable, x) &&
         std::ranges::all_of(variable.dimensions, [&](int d) {
           return d == time || d == z || d == y || d == x || file->size(d) == 1;
         });
}

bool FieldReader::is_surface(const FileVariable& variable) const {
  return variable.numeric && (y < 0 || has(variable, y)) && has(variable, x) &&
         std::ranges::all_of(variable.dimensions, [&](int d) {
           return d == time || d == y || d == x || file->size(d) == 1;
         });
}

void FieldReader::restrict_to(const CellWindow& window, bool around) {
  turn = around ? nx : 0;
  x0 = window.x0;
  y0 = window.y0;
  nx = window.nx;
  ny = window.ny;
}

std::vector<float> FieldReader::columns(const FileVariable& variable, int z, bool from_top,
                                        std::size_t time_index, int first, int count, int x_from,
                                        int x_count) const {
  const std::size_t rank = variable.dimensions.size();
  std::vector<std::size_t> start(rank, 0), counts(rank, 1);
  for (std::size_t d = 0; d < rank; ++d) {
    const int id = variable.dimensions[d];
    if (id == time) start[d] = time_index;
    if (id == y) {
      start[d] = std::size_t(y0);
      counts[d] = std::size_t(ny);
    }
    if (id == x) {
      start[d] = std::size_t(x_from);
      counts[d] = std::size_t(x_count);
    }
    if (id == z) {
      counts[d] = std::size_t(count);
      start[d] = std::size_t(from_top ? int(file->size(z)) - first - count : first);
    }
  }
  std::vector<float> values = file->read_floats(variable, start, counts);
  // Strides of z, y, x in what was read.
  std::array<std::size_t, 3> stride = {0, 0, 0};
  std::size_t step = 1;
  for (std::size_t d = rank; d-- > 0;) {
    const int id = variable.dimensions[d];
    for (const auto& [axis, dimension] : {std::pair{0, z}, {1, y}, {2, x}})
      if (id == dimension) stride[std::size_t(axis)] = step;
    step *= counts[d];
  }
  const std::size_t row = std::size_t(x_count), plane = row * std::size_t(ny);
  const bool in_order =
      stride[2] == 1 && (y < 0 || stride[1] == row) && stride[0] == (z < 0 ? 0 : plane);
  if (in_order && (!from_top || count == 1)) return values;
  std::vector<float> ordered(values.size());
  for (int k = 0; k < count; ++k) {
    const std::size_t from = std::size_t(from_top ? count - 1 - k : k) * stride[0];
    for (std::size_t j = 0; j < std::size_t(ny); ++j)
      for (std::size_t i = 0; i < row; ++i)
        ordered[std::size_t(k) * plane + j * row + i] =
            values[from + j * stride[1] + i * stride[2]];
  }
  return ordered;
}

// Columns across the end of the longitudes are two reads, side by side.
std::vector<float> FieldReader::read(const FileVariable& variable, int z, bool from_top,
                                     std::size_t time_index, int first, int count) const {
  const int west = turn > 0 ? std::min(nx, turn - x0) : nx, east = nx - west;
  std::vector<float> a = columns(variable, z, from_top, time_index, first, count, x0, west);
  if (east == 0) return a;
  const std::vector<float> b = columns(variable, z, from_top, time_index, first, count, 0, east);
  std::vector<float> all;
  all.reserve(a.size() + b.size());
  auto from_a = a.begin();
  for (auto from_b = b.begin(); from_b != b.end(); from_b += east, from_a += west) {
    all.insert(all.end(), from_a, from_a + west);
    all.insert(all.end(), from_b, from_b + east);
  }
  return all;
}

std::vector<float> FieldReader::levels(const FileVariable& variable, int z, bool from_top,
                                       std::size_t time_index, int first, int count) const {
  return read(variable, z, from_top, time_index, first, count);
}

std::vector<float> FieldReader::field(const FileVariable& variable, int z, bool from_top,
                                      std::size_t time_index) const {
  return read(variable, z, from_top, time_index, 0, int(file->size(z)));
}

std::vector<float> FieldReader::surface(const FileVariable& variable,
                                        std::size_t time_index) const {
  return read(variable, -1, false, time_index, 0, 1);
}

}  // namespace nepho::forecast
