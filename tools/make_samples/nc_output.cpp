#include "nc_output.h"

#include <algorithm>
#include <stdexcept>

#include "loaded_module.h"

namespace nepho::samples {
namespace {

std::vector<NcAttribute> listed(const std::vector<NcNote>& notes) {
  std::vector<NcAttribute> list;
  for (const NcNote& n : notes)
    list.push_back({n.name.c_str(), n.numbers.empty() ? n.text.c_str() : nullptr, n.value,
                    n.numbers.data(), n.numbers.size()});
  return list;
}

}  // namespace

std::size_t NcLayout::length(const std::string& axis) const {
  for (const NcAxis& a : axes)
    if (a.name == axis) return a.length;
  throw std::out_of_range("no axis " + axis);
}

NcField& NcLayout::field(const std::string& name) {
  for (NcField& f : fields)
    if (f.name == name) return f;
  throw std::out_of_range("no field " + name);
}

void NcLayout::set_note(const std::string& name, const NcNote& note) {
  std::vector<NcNote>& all = name.empty() ? notes : field(name).notes;
  std::erase_if(all, [&](const NcNote& n) { return n.name == note.name; });
  all.push_back(note);
}

NcWriter::NcWriter(const std::vector<std::filesystem::path>& folders) {
  const LoadedModule module = load_writer(folders, "nepho_nc_writer.so", "NetCDF",
                                          "build with NetCDF (package libnetcdf-dev)");
  create_ = module.function<nc_create_fn>("nepho_nc_create");
  put_ = module.function<nc_put_fn>("nepho_nc_put");
  close_ = module.function<nc_close_fn>("nepho_nc_close");
}

NcOutput::NcOutput(const NcWriter& writer, const std::filesystem::path& path,
                   const NcLayout& layout)
    : writer_(writer), path_(path.string()) {
  std::vector<NcDimension> dimensions;
  for (const NcAxis& a : layout.axes) dimensions.push_back({a.name.c_str(), a.length, a.unlimited});
  std::vector<std::vector<std::int32_t>> axes;
  std::vector<std::vector<NcAttribute>> notes;
  for (const NcField& f : layout.fields) {
    std::vector<std::int32_t> places;
    std::size_t slab_size = 1;
    for (std::size_t at = 0; at < f.axes.size(); ++at) {
      const auto found = std::ranges::find(layout.axes, f.axes[at], &NcAxis::name);
      if (found == layout.axes.end()) throw std::out_of_range("no axis " + f.axes[at]);
      places.push_back(std::int32_t(found - layout.axes.begin()));
      if (at + 2 >= f.axes.size()) slab_size *= found->length;
    }
    axes.push_back(std::move(places));
    notes.push_back(listed(f.notes));
    entries_.push_back({f.name, slab_size});
  }
  std::vector<NcVariable> variables;
  for (std::size_t at = 0; at < axes.size(); ++at)
    variables.push_back({layout.fields[at].name.c_str(), layout.fields[at].value, axes[at].data(),
                         axes[at].size(), notes[at].data(), notes[at].size()});
  const std::vector<NcAttribute> global = listed(layout.notes);
  const NcFileSpec spec = {path_.c_str(),     layout.format,    dimensions.data(),
                           dimensions.size(), variables.data(), variables.size(),
                           global.data(),     global.size(),    layout.deflate};
  char reason[512] = {};
  if (writer_.create_(&spec, &file_, reason, sizeof reason) != 0) fail(reason);
}

NcOutput::~NcOutput() {
  char reason[512];
  if (file_) writer_.close_(file_, false, reason, sizeof reason);
}

bool NcOutput::has(const std::string& field) const {
  return std::ranges::find(entries_, field, &Entry::name) != entries_.end();
}

void NcOutput::put(const std::string& field, std::size_t slab, const std::vector<double>& values) {
  const auto found = std::ranges::find(entries_, field, &Entry::name);
  if (found == entries_.end() || found->slab_size != values.size())
    throw std::invalid_argument(field + ": no such field, or another number of values");
  char reason[512] = {};
  const auto variable = std::size_t(found - entries_.begin());
  if (writer_.put_(file_, variable, slab, values.data(), reason, sizeof reason) != 0) fail(reason);
}

void NcOutput::put_text(const std::string& field, const std::string& text) {
  put(field, 0, std::vector<double>(text.begin(), text.end()));
}

void NcOutput::finish() {
  char reason[512] = {};
  NcOpenFile* const file = file_;
  file_ = nullptr;
  if (writer_.close_(file, true, reason, sizeof reason) != 0) fail(reason);
}

void NcOutput::fail(const char* reason) const {
  throw Error({"cannot write the file", path_, "a writable place with room", reason, ""});
}

}  // namespace nepho::samples
