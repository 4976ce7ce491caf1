#include "sources/grib/message.h"

#include <eccodes.h>

#include <cmath>

#include "core/error.h"
#include "sources/grib/decode_apart.h"

namespace nepho::grib {
namespace {

// No field holds it: bitmaps are told by it.
constexpr double kMissing = -1.2345e300;
constexpr long kMostPoints = 2'000'000'000;

// Unwinds through C frames: they hold no destructors, and what they leak is small.
[[noreturn]] void failed(const char* what) {
  throw Error({"ecCodes cannot read a GRIB message", "ecCodes", "an intact message",
               std::string(what ? what : "a failed assertion"),
               "the file is damaged: copy or download it again"});
}

// Unpacked by plain loops over bits. All else trusts lengths in the data: of damaged fields about 1
// in 200 ended the process or wrote beyond its memory (ecCodes 2.28, libaec 1.0.6).
bool is_plain(const std::string& packing) {
  return packing == "grid_simple" || packing == "grid_ieee";
}

void name_missing([[maybe_unused]] std::vector<double>& values) {
#ifndef NEPHO_MUTANT_BITMAP
  for (double& value : values)
    if (value == kMissing) value = NAN;
#endif
}

void quiet() {
  static const bool once = [] {
    codes_context_set_logging_proc(codes_context_get_default(),
                                   [](const codes_context*, int, const char*) {});
    codes_set_codes_assertion_failed_proc([](const char* what) { failed(what); });
    return true;
  }();
  static_cast<void>(once);
}

}  // namespace

struct Message::Handle {
  explicit Handle(codes_handle* opened) : codes(opened) {}
  ~Handle() {
    if (codes) codes_handle_delete(codes);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  codes_handle* codes;
};

Message::Message(std::vector<unsigned char> bytes, std::string where)
    : bytes_(std::move(bytes)), where_(std::move(where)) {
  quiet();
  handle_ = std::make_unique<Handle>(
      codes_handle_new_from_message(nullptr, bytes_.data(), bytes_.size()));
  if (!handle_->codes)
    throw Error({"ecCodes cannot read a GRIB message", where_, "a template that ecCodes knows",
                 "none, or no definitions of ecCodes on this machine",
                 "grib_dump of the same file says more; is ECCODES_DEFINITION_PATH right?"});
}

Message::~Message() = default;

std::optional<long> Message::integer(const char* key) const {
  long value = 0;
  int error = 0;
  if (codes_get_long(handle_->codes, key, &value) != CODES_SUCCESS) return {};
  if (value == CODES_MISSING_LONG || codes_is_missing(handle_->codes, key, &error)) return {};
  return value;
}

std::optional<double> Message::number(const char* key) const {
  double value = 0;
  int error = 0;
  if (codes_get_double(handle_->codes, key, &value) != CODES_SUCCESS) return {};
  if (!std::isfinite(value) || value == CODES_MISSING_DOUBLE ||
      codes_is_missing(handle_->codes, key, &error))
    return {};
  return value;
}

std::string Message::text(const char* key) const {
  char value[256] = {};
  std::size_t length = sizeof value;
  return codes_get_string(handle_->codes, key, value, &length) == CODES_SUCCESS ? value : "";
}

std::vector<double> Message::numbers(const char* key) const {
  std::size_t count = 0;
  if (codes_get_size(handle_->codes, key, &count) != CODES_SUCCESS || count == 0) return {};
  if (count > std::size_t(kMostPoints)) return {};
  std::vector<double> values(count);
  if (codes_get_double_array(handle_->codes, key, values.data(), &count) != CODES_SUCCESS)
    return {};
  values.resize(count);
  return values;
}

long Message::need_integer(const char* key) const {
  if (const auto value = integer(key)) return *value;
  throw Error({"a GRIB message lacks a number", where_, key, "a missing value", ""});
}

double Message::need_number(const char* key) const {
  if (const auto value = number(key)) return *value;
  throw Error({"a GRIB message lacks a number", where_, key, "a missing value", ""});
}

std::vector<double> Message::values() const {
  const std::string packing = text("packingType");
  const auto refuse = [&](const std::string& found, const std::string& hint) {
    throw Error({"ecCodes cannot unpack a GRIB field", where_, "an intact field", found, hint});
  };
  codes_set_double(handle_->codes, "missingValue", kMissing);
  // Told by the data's own header, which may be damaged: without data it may be any number.
  std::size_t count = 0;
  int status = codes_get_size(handle_->codes, "values", &count);
  const long points = integer("numberOfPoints").value_or(0);
  if (status == CODES_SUCCESS &&
      (points < 0 || points > kMostPoints || count != std::size_t(points)))
    refuse(std::to_string(count) + " values for " + std::to_string(points) + " points",
           "the file is damaged: copy or download it again");
  std::vector<double> values(status == CODES_SUCCESS ? count : 0);
  const auto decode = [&](double* to) {
    return codes_get_double_array(handle_->codes, "values", to, &count);
  };
  if (status == CODES_SUCCESS && is_plain(packing)) {
    status = decode(values.data());
  } else if (status == CODES_SUCCESS) {
    const auto apart = decode_apart(count, decode, values);
    if (!apart)
      refuse("numbers that ecCodes breaks down on (" + packing + ")",
             "the file is damaged: copy or download it again");
    status = *apart;
  }
  if (status == CODES_FUNCTIONALITY_NOT_ENABLED || status == CODES_NOT_IMPLEMENTED)
    refuse("packing " + packing + ", which this build of ecCodes was made without",
           "grib_set -r -s packingType=grid_simple unpacks it where ecCodes can");
  if (status != CODES_SUCCESS)
    refuse(std::string(codes_get_error_message(status)) + " (" + packing + ")",
           "the file is damaged: copy or download it again");
  values.resize(count);
  name_missing(values);
  return values;
}

Message::Places Message::places() const {
  const auto points = integer("numberOfPoints");
  if (!points || *points <= 0 || *points > kMostPoints / 3) return {};
  const auto count = std::size_t(*points);
  std::vector<double> all;
  const auto status = decode_apart(
      3 * count,
      [&](double* to) {
        return codes_grib_get_data(handle_->codes, to, to + count, to + 2 * count);
      },
      all);
  if (status != CODES_SUCCESS) return {};
  const auto end_of = [&](std::size_t n) { return all.begin() + std::ptrdiff_t(n * count); };
  return {{all.begin(), end_of(1)}, {end_of(1), end_of(2)}};
}

std::vector<double> gaussian_latitudes_deg(long count) {
  quiet();
  if (count < 1 || count > 100000) return {};
  std::vector<double> latitudes(2 * std::size_t(count));
  if (codes_get_gaussian_latitudes(count, latitudes.data()) != CODES_SUCCESS) return {};
  return latitudes;
}

}  // namespace nepho::grib
