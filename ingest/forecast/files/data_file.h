#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "forecast/forecast.h"

namespace nepho::forecast {

// A file of named fields on named dimensions, with attributes: all that conventions know of a
// format. Formats whose files are otherwise made (GRIB messages) speak CF here. Thread-safe, read
// only.

struct FileDimension {
  std::string name;
  std::size_t size = 0;
  char axis = 0;  // T, Z, Y or X where a user says so
};

struct FileAttribute {
  std::string name, text;       // text of characters and strings, blanks at its ends removed
  std::vector<double> numbers;  // of numbers
};

struct FileVariable {
  std::string name;   // by its path where several groups have one of that name
  std::string group;  // of NetCDF-4, as a path; "" for the root
  int id = 0;         // its index in variables()
  bool numeric = true;
  std::size_t value_bytes = 0;  // of one value in the file, unpacked from compression
  std::vector<int> dimensions;  // in the file's order, slowest first
  std::vector<FileAttribute> attributes;

  const FileAttribute* attribute(const std::string& name) const;
  std::string text(const std::string& name) const;  // "" where there is none
  std::optional<double> number(const std::string& name) const;
};

class DataFile {
 public:
  virtual ~DataFile() = default;
  DataFile(const DataFile&) = delete;
  DataFile& operator=(const DataFile&) = delete;

  const std::string& path() const { return path_; }
  const std::vector<FileDimension>& dimensions() const { return dimensions_; }
  const std::vector<FileVariable>& variables() const { return variables_; }
  const FileVariable* find(const std::string& name) const;
  // Global attributes.
  std::string text(const std::string& name) const { return global_.text(name); }
  std::optional<double> number(const std::string& name) const { return global_.number(name); }
  const FileAttribute* attribute(const std::string& name) const { return global_.attribute(name); }

  // What the format's reader took for granted, and what it left out: for `info`.
  const std::vector<std::string>& assumptions() const { return assumptions_; }
  const std::vector<std::string>& facts() const { return facts_; }

  std::size_t size(int dimension) const { return dimensions_[std::size_t(dimension)].size; }
  const std::string& name(int dimension) const { return dimensions_[std::size_t(dimension)].name; }
  std::vector<std::size_t> shape(const FileVariable& variable) const;
  std::string shape_text(const FileVariable& variable) const;  // "name(time 4, lat 73, lon 144)"
  std::size_t values_in(const FileVariable& variable) const;
  // "file [variable]", for errors.
  std::string where(const FileVariable& variable) const {
    return path_ + " [" + variable.name + "]";
  }

  // A hyperslab in the file's own order, in the units of the file; NaN where a value is missing.
  // Throws Error on damage.
  virtual std::vector<float> read_floats(const FileVariable& variable,
                                         const std::vector<std::size_t>& start,
                                         const std::vector<std::size_t>& count) const = 0;
  virtual std::vector<double> read_doubles(const FileVariable& variable,
                                           const std::vector<std::size_t>& start,
                                           const std::vector<std::size_t>& count) const = 0;
  // A variable of characters: one string per row of its last dimension; of strings: each.
  virtual std::vector<std::string> read_texts(const FileVariable& variable) const = 0;
  // Bytes of this variable's values that have been asked for, and of all its values.
  virtual VariableBytes bytes_read(const FileVariable& variable) const = 0;

  std::vector<double> read_all(const FileVariable& variable) const;

  // Before the file is shared: what is said of a variable from elsewhere, in place of what it says.
  void set_attribute(int variable, const std::string& name, const std::string& text);
  void rename_dimension(int dimension, const std::string& name) {
    dimensions_[std::size_t(dimension)].name = name;
  }
  void set_axis(int dimension, char axis) { dimensions_[std::size_t(dimension)].axis = axis; }
  void add_fact(std::string fact) { facts_.push_back(std::move(fact)); }

 protected:
  explicit DataFile(std::string path) : path_(std::move(path)) {}

  std::string path_;
  std::vector<FileDimension> dimensions_;
  std::vector<FileVariable> variables_;
  FileVariable global_;  // its attributes only
  std::vector<std::string> assumptions_, facts_;
};

}  // namespace nepho::forecast
