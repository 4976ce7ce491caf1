#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nc_writer.h"

namespace nepho::samples {

// A NetCDF file to be, in terms of the standard library.
struct NcNote {  // an attribute: text, or numbers of one type
  std::string name, text;
  std::vector<double> numbers{};
  NcValue value = NcValue::kFloat;
};
struct NcAxis {
  std::string name;
  std::size_t length = 0;
  bool unlimited = false;
};
struct NcField {
  std::string name;
  NcValue value = NcValue::kFloat;
  std::vector<std::string> axes;  // slowest first
  std::vector<NcNote> notes{};
};
struct NcLayout {
  NcFormat format = NcFormat::kNetcdf4;
  std::vector<NcAxis> axes;
  std::vector<NcField> fields;
  std::vector<NcNote> notes;
  std::int32_t deflate = 9;

  std::size_t length(const std::string& axis) const;
  NcField& field(const std::string& name);                      // throws std::out_of_range
  void set_note(const std::string& field, const NcNote& note);  // "": of the file
};

// nepho_nc_writer.so, found in the module folders. Throws Error where it is missing.
class NcWriter {
 public:
  explicit NcWriter(const std::vector<std::filesystem::path>& folders);

 private:
  friend class NcOutput;
  nc_create_fn* create_;
  nc_put_fn* put_;
  nc_close_fn* close_;
};

// A file while it is written, slab by slab (nc_writer.h). Throws Error with the writer's reason;
// what was not finished leaves nothing behind.
class NcOutput {
 public:
  NcOutput(const NcWriter& writer, const std::filesystem::path& path, const NcLayout& layout);
  ~NcOutput();
  NcOutput(const NcOutput&) = delete;
  NcOutput& operator=(const NcOutput&) = delete;
  bool has(const std::string& field) const;
  // As many values as the slab has.
  void put(const std::string& field, std::size_t slab, const std::vector<double>& values);
  void put_text(const std::string& field, const std::string& text);  // a slab of characters
  void finish();

 private:
  [[noreturn]] void fail(const char* reason) const;
  struct Entry {
    std::string name;
    std::size_t slab_size;
  };
  NcWriter writer_;
  std::string path_;
  std::vector<Entry> entries_;
  NcOpenFile* file_ = nullptr;
};

}  // namespace nepho::samples
