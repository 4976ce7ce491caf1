#pragma once

#include <map>

#include "api/source_module.h"
#include "forecast/conventions/convention.h"
#include "forecast/conventions/user_names.h"

namespace nepho::grib {

// GRIB files by the grid of their cloud water: files of one grid are one domain, whatever fields
// and times each holds; those without water go to every domain.
class GribDomains {
 public:
  // Reads headers where there are several files. Throws Error.
  GribDomains(const std::vector<std::string>& files, IoLock io_lock, forecast::UserNames names);

  // One for each domain, in the order given; its name for open().
  const std::vector<std::string>& files() const { return first_; }
  // A domain, or any other file alone (a grid's).
  std::shared_ptr<const forecast::DataFile> open(const std::string& path) const;

 private:
  IoLock io_lock_;
  forecast::UserNames names_;
  std::vector<std::string> first_;
  std::map<std::string, std::vector<std::string>> together_;  // by first
};

// open_forecast() of GRIB files. Throws Error.
std::unique_ptr<forecast::Forecast> open_grib(forecast::OpenRequest request, IoLock io_lock = {});

}  // namespace nepho::grib
