#include "sources/grib/open_grib.h"

#include <tbb/task_arena.h>

#include <algorithm>

#include "api/module_support.h"
#include "sources/grib/grib_file.h"

namespace nepho::grib {
namespace {

// The grid of a file's cloud water; null where it has none.
const Grid* grid_of_water(const FieldTable& table) {
  for (const Field& field : table.fields)
    if (field.header.parameter.water) return &table.grids[std::size_t(field.grid)];
  return nullptr;
}

}  // namespace

GribDomains::GribDomains(const std::vector<std::string>& files, IoLock io_lock,
                         forecast::UserNames names)
    : io_lock_(io_lock), names_(std::move(names)) {
  struct Domain {
    Grid grid;
    std::vector<std::string> files;
  };
  std::vector<Domain> domains;
  std::vector<std::string> dry;
  for (std::size_t n = 0; files.size() > 1 && n < files.size(); ++n) {
    const FieldTable table = tbb::this_task_arena::isolate([&] {
      const IoGuard guard(io_lock_);
      return table_of({files[n]}, names_);
    });
    const Grid* grid = grid_of_water(table);
    if (!grid) {
      dry.push_back(files[n]);
      continue;
    }
    const auto known = std::ranges::find_if(
        domains, [&](const Domain& domain) { return domain.grid.same_places(*grid); });
    if (known != domains.end())
      known->files.push_back(files[n]);
    else
      domains.push_back({*grid, {files[n]}});
  }
  if (domains.size() < 2) {
    if (files.empty()) return;
    first_ = {files.front()};
    together_[files.front()] = files;
    return;
  }
  for (Domain& domain : domains) {
    first_.push_back(domain.files.front());
    domain.files.insert(domain.files.end(), dry.begin(), dry.end());
    together_[first_.back()] = std::move(domain.files);
  }
}

std::shared_ptr<const forecast::DataFile> GribDomains::open(const std::string& path) const {
  const auto known = together_.find(path);
  if (known == together_.end())
    return std::make_shared<const GribFile>(std::vector<std::string>{path}, io_lock_);
  const auto file = std::make_shared<GribFile>(known->second, io_lock_, names_);
  forecast::apply_names(names_, *file);
  return file;
}

std::unique_ptr<forecast::Forecast> open_grib(forecast::OpenRequest request, IoLock io_lock) {
  GribDomains domains(request.files, io_lock, forecast::read_user_names(request.names_file));
  request.files = domains.files();
  request.open_file = [domains = std::move(domains)](const std::string& path) {
    return domains.open(path);
  };
  return forecast::open_forecast(request);
}

}  // namespace nepho::grib
