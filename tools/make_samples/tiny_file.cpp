#include "tiny_file.h"

#include <algorithm>

namespace nepho::samples {
namespace {

std::size_t size_of(const NcLayout& layout, const std::vector<std::string>& axes) {
  std::size_t size = 1;
  for (const std::string& axis : axes) size *= layout.length(axis);
  return size;
}

}  // namespace

void TinyFile::reverse(const std::string& axis) {
  for (const NcField& f : layout.fields) {
    const auto found = std::ranges::find(f.axes, axis);
    if (found == f.axes.end()) continue;
    const std::size_t inner = size_of(layout, {found + 1, f.axes.end()});
    const std::size_t length = layout.length(axis);
    std::vector<double>& all = values.at(f.name);
    for (std::size_t block = 0; block < all.size(); block += inner * length)
      for (std::size_t a = 0, b = length - 1; a < b; ++a, --b)
        std::swap_ranges(all.begin() + std::ptrdiff_t(block + a * inner),
                         all.begin() + std::ptrdiff_t(block + (a + 1) * inner),
                         all.begin() + std::ptrdiff_t(block + b * inner));
  }
}

void write_tiny(const std::filesystem::path& path, const TinyFile& file, const NcWriter& writer) {
  NcOutput output(writer, path, file.layout);
  for (const NcField& f : file.layout.fields) {
    const std::size_t leading = f.axes.size() > 2 ? f.axes.size() - 2 : 0;
    const std::size_t slab =
        size_of(file.layout, {f.axes.begin() + std::ptrdiff_t(leading), f.axes.end()});
    const std::vector<double>& all = file.values.at(f.name);
    for (std::size_t at = 0; at * slab < all.size(); ++at)
      output.put(
          f.name, at,
          {all.begin() + std::ptrdiff_t(at * slab), all.begin() + std::ptrdiff_t((at + 1) * slab)});
  }
  output.finish();
}

}  // namespace nepho::samples
