#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "sources/grib/message.h"
#include "sources/grib/parameters.h"

namespace nepho::grib {

// What a message's headers say of its field.
struct FieldHeader {
  Parameter parameter;
  Level level;
  std::optional<std::int64_t> valid_ns;  // UTC since 1970; nothing where it is not of one moment,
                                         // or its steps are months and years
  bool instant = true;                   // no mean, sum or extreme over time
  long member = 0;                       // of an ensemble
};
FieldHeader header_of(const Message& message, const forecast::UserNames& names = {});

// Reference time plus step.
std::optional<std::int64_t> valid_time_ns(const Message& message);

}  // namespace nepho::grib
