#include "sources/netcdf/classic_size.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "core/error.h"

namespace nepho::netcdf {
namespace {

struct CutShort {};

// The classic format's header (netCDF classic format specification, Unidata): big-endian numbers
// of 4 bytes, sizes of 8 in CDF-5, offsets of 8 in CDF-2 and CDF-5.
class ClassicHeader {
 public:
  explicit ClassicHeader(std::istream& in) : in_(in) {
    std::array<char, 4> magic{};
    in_.read(magic.data(), 4);
    if (!in_ || magic[0] != 'C' || magic[1] != 'D' || magic[2] != 'F') return;
    version_ = magic[3];
    is_classic_ = version_ == 1 || version_ == 2 || version_ == 5;
  }
  bool is_classic() const { return is_classic_; }

  // Bytes that the file must have.
  std::uint64_t expected_bytes() {
    const std::uint64_t records = size();
    const bool streaming = records == (version_ == 5 ? ~std::uint64_t{0} : 0xffffffffu);
    list([&] { dimension(); });
    list([&] { attribute(); });
    list([&] { variable(); });
    std::uint64_t end = 0, record_size = 0;
    int record_variables = 0;
    for (const Variable& v : variables_)
      if (v.is_record) {
        record_size += v.padded_bytes;
        ++record_variables;
      }
    for (const Variable& v : variables_) {
      if (!v.is_record) end = std::max(end, v.begin + v.bytes);
      if (v.is_record && records > 0 && !streaming) {
        const std::uint64_t step = record_variables == 1 ? v.bytes : record_size;
        end = std::max(end, v.begin + (records - 1) * step + v.bytes);
      }
    }
    return end;
  }

 private:
  struct Variable {
    std::uint64_t bytes = 0, padded_bytes = 0, begin = 0;
    bool is_record = false;
  };

  std::uint64_t number(int bytes) {
    std::uint64_t value = 0;
    for (int b = 0; b < bytes; ++b) {
      const int c = in_.get();
      if (c < 0) throw CutShort{};
      value = value << 8 | std::uint64_t(c);
    }
    return value;
  }
  std::uint64_t size() { return number(version_ == 5 ? 8 : 4); }
  void skip(std::uint64_t bytes) {
    in_.seekg(std::streamoff((bytes + 3) / 4 * 4), std::ios::cur);
    if (!in_) throw CutShort{};
  }
  static std::uint64_t width(std::uint64_t type) {
    constexpr std::array<std::uint64_t, 12> kWidths = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    if (type == 0 || type >= kWidths.size()) throw CutShort{};
    return kWidths[std::size_t(type)];
  }
  template <class Item>
  void list(Item item) {
    number(4);  // the list's tag
    const std::uint64_t count = size();
    for (std::uint64_t n = 0; n < count; ++n) item();
  }
  void dimension() {
    skip(size());
    dimensions_.push_back(size());
  }
  void attribute() {
    skip(size());
    const std::uint64_t type = number(4);
    skip(size() * width(type));
  }
  void variable() {
    skip(size());
    Variable v;
    const std::uint64_t rank = size();
    std::uint64_t values = 1;
    for (std::uint64_t d = 0; d < rank; ++d) {
      const std::uint64_t id = size();
      if (id >= dimensions_.size()) throw CutShort{};
      const std::uint64_t length = dimensions_[std::size_t(id)];
      if (length == 0 && d == 0)
        v.is_record = true;
      else
        values *= length;
    }
    list([&] { attribute(); });
    v.bytes = values * width(number(4));
    size();  // vsize: redundant, and wrong for large variables
    v.padded_bytes = (v.bytes + 3) / 4 * 4;
    v.begin = number(version_ == 1 ? 4 : 8);
    variables_.push_back(v);
  }

  std::istream& in_;
  int version_ = 0;
  bool is_classic_ = false;
  std::vector<std::uint64_t> dimensions_;
  std::vector<Variable> variables_;
};

}  // namespace

void check_classic_size(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  ClassicHeader header(in);
  if (!header.is_classic()) return;
  const std::uint64_t bytes = std::filesystem::file_size(path);
  const auto refuse = [&](const std::string& expected) {
    throw Error({"the file is cut short", path, expected, std::to_string(bytes) + " bytes",
                 "write or copy it again"});
  };
  std::uint64_t expected = 0;
  try {
    expected = header.expected_bytes();
  } catch (const CutShort&) {
    refuse("a whole header");
  }
  if (bytes < expected) refuse(std::to_string(expected) + " bytes");
}

}  // namespace nepho::netcdf
