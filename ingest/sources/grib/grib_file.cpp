#include "sources/grib/grib_file.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "api/module_support.h"
#include "core/error.h"
#include "units/constants.h"

namespace nepho::grib {
namespace {

using forecast::FileVariable;

template <class Action>
auto locked(IoLock lock, Action&& action) {
  return tbb::this_task_arena::isolate([&] {
    const IoGuard guard(lock);
    return action();
  });
}

// The hyperslab of an array in memory.
template <class T>
std::vector<T> slab(const std::vector<double>& all, const std::vector<std::size_t>& shape,
                    const std::vector<std::size_t>& start, const std::vector<std::size_t>& count) {
  const std::size_t total =
      std::accumulate(count.begin(), count.end(), std::size_t{1}, std::multiplies<>());
  std::vector<T> result;
  result.reserve(total);
  for (std::size_t n = 0; n < total; ++n) {
    std::size_t rest = n, at = 0, stride = 1;
    for (std::size_t d = shape.size(); d-- > 0; rest /= count[d], stride *= shape[d])
      at += (start[d] + rest % count[d]) * stride;
    result.push_back(T(all[at]));
  }
  return result;
}

}  // namespace

GribFile::GribFile(const std::vector<std::string>& paths, IoLock io_lock,
                   const forecast::UserNames& names)
    : DataFile(paths.size() == 1
                   ? paths.front()
                   : paths.front() + " and " + std::to_string(paths.size() - 1) + " more"),
      io_lock_(io_lock) {
  table_ = locked(io_lock_, [&] { return table_of(paths, names); });
  CfDataset dataset = cf_dataset(table_);
  dimensions_ = std::move(dataset.dimensions);
  variables_ = std::move(dataset.variables);
  values_ = std::move(dataset.values);
  facts_ = std::move(dataset.facts);
  assumptions_ = std::move(dataset.assumptions);
  global_.attributes = {{"Conventions", "CF-1.11", {}}};
  bytes_ = std::vector<std::atomic<std::uint64_t>>(variables_.size());
}

forecast::VariableBytes GribFile::bytes_read(const FileVariable& variable) const {
  const std::size_t id = std::size_t(variable.id);
  std::uint64_t held = 0;
  for (const int field : values_[id].fields)
    if (field >= 0) held += table_.fields[std::size_t(field)].place.bytes();
  return {variable.name, bytes_[id], held};
}

std::vector<float> GribFile::plane(const FileVariable& variable, int index) const {
  const Field& field = table_.fields[std::size_t(index)];
  const std::string where = table_.where(field);
  std::vector<unsigned char> bytes =
      read_field(table_.paths[std::size_t(field.place.file)], field.place);
  bytes_[std::size_t(variable.id)] += bytes.size();
  const Grid& grid = table_.grids[std::size_t(field.layout)];
  const std::vector<double> values =
      locked(io_lock_, [&] { return Message(std::move(bytes), where).values(); });
  std::vector<float> plane = arranged(grid, values, where);
  switch (values_[std::size_t(variable.id)].change) {
    case Change::kNone:
      break;
    case Change::kExponential:
      for (float& value : plane) value = float(std::exp(double(value)));
      break;
    case Change::kPerGravity:
      for (float& value : plane)
        value = float(double(value) / constants::kStandardGravity_m_per_s2);
      break;
  }
  return plane;
}

template <class T>
std::vector<T> GribFile::read(const FileVariable& variable, const std::vector<std::size_t>& start,
                              const std::vector<std::size_t>& count) const {
  const VariableValues& source = values_[std::size_t(variable.id)];
  const std::vector<std::size_t> sizes = shape(variable);
  if (source.fields.empty()) return slab<T>(source.here, sizes, start, count);
  // Times and levels are fields; the rest are places, one dimension or two.
  const std::size_t of_place =
      table_.grids[std::size_t(table_.fields[std::size_t(source.first())].grid)].kind ==
              Grid::Kind::kCells
          ? 1
          : 2;
  const std::size_t outer = sizes.size() - of_place;
  const std::size_t fields = std::accumulate(count.begin(), count.begin() + std::ptrdiff_t(outer),
                                             std::size_t{1}, std::multiplies<>());
  const std::size_t y0 = of_place == 2 ? start[outer] : 0, ny = of_place == 2 ? count[outer] : 1;
  const std::size_t x0 = start.back(), nx = count.back(), row = sizes.back();
  std::vector<T> result;
  result.reserve(fields * ny * nx);
  for (std::size_t n = 0; n < fields; ++n) {
    std::size_t rest = n, at = 0, stride = 1;
    for (std::size_t d = outer; d-- > 0; rest /= count[d], stride *= sizes[d])
      at += (start[d] + rest % count[d]) * stride;
    const int field = source.fields[at];
    if (field < 0 || ny * nx == 0) {
      result.insert(result.end(), ny * nx, T(NAN));
      continue;
    }
    const std::vector<float> values = plane(variable, field);
    for (std::size_t j = 0; j < ny; ++j) {
      const auto from = values.begin() + std::ptrdiff_t((y0 + j) * row + x0);
      result.insert(result.end(), from, from + std::ptrdiff_t(nx));
    }
  }
  return result;
}

std::vector<float> GribFile::read_floats(const FileVariable& variable,
                                         const std::vector<std::size_t>& start,
                                         const std::vector<std::size_t>& count) const {
  return read<float>(variable, start, count);
}

std::vector<double> GribFile::read_doubles(const FileVariable& variable,
                                           const std::vector<std::size_t>& start,
                                           const std::vector<std::size_t>& count) const {
  return read<double>(variable, start, count);
}

std::vector<std::string> GribFile::read_texts(const FileVariable&) const {
  return {};  // GRIB holds numbers only
}

}  // namespace nepho::grib
