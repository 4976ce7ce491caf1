#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace nepho::grib {

// Where the fields of GRIB files lie, by the lengths of sections alone (WMO Manual on Codes, FM 92
// GRIB editions 1 and 2). A message of edition 2 may hold several fields, each repeating sections
// from 2, 3 or 4 on; here each field is one message of its own, which needs no state in a library.

struct Section {
  std::uint64_t offset = 0, bytes = 0;  // 0: not there
};

struct FieldPlace {
  int file = 0;  // index among the files of a forecast
  int edition = 2;
  std::uint64_t message = 0;       // offset of its message, for errors
  std::array<Section, 8> section;  // edition 2: 0 to 7; edition 1: 0 to 4 (4: the data)
  std::uint64_t bytes() const;     // of its message, alone
};

// In the file's order. What stands between messages (headers of bulletins, padding) is passed over.
// Reads headers of sections only. Throws Error: no file, no GRIB, another edition, a message that
// is cut short or whose sections do not add up.
std::vector<FieldPlace> scan_fields(const std::string& path, int file);

// The field as one message: with its data, or with sections of data cut to what tells their
// packing. Throws Error where the file has become shorter.
std::vector<unsigned char> read_field(const std::string& path, const FieldPlace& place);
std::vector<unsigned char> read_headers(const std::string& path, const FieldPlace& place);

}  // namespace nepho::grib
