#include "image/picture_file.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>

#include "core/error.h"
#include "image/picture_module.h"

namespace nepho {
namespace {

struct Ending {
  const char* text;
  PictureFormat format;
};
constexpr std::array kEndings{
    Ending{".png", PictureFormat::kPng}, Ending{".exr", PictureFormat::kExr},
    Ending{".hdr", PictureFormat::kHdr}, Ending{".pfm", PictureFormat::kPfm},
    Ending{".ppm", PictureFormat::kPpm}};
constexpr const char* kModuleFile = "nepho_image_oiio.so";
constexpr const char* kPngWriterFile = "nepho_image_png.so";   // writes only, without OpenImageIO
constexpr std::size_t kLargestPicture = std::size_t{1} << 30;  // values of a picture that is read

std::atomic<bool> the_module_loaded = false;

const Ending* find_ending(const std::filesystem::path& path) {
  std::string text = path.extension().string();
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  for (const Ending& ending : kEndings)
    if (text == ending.text) return &ending;
  return nullptr;
}

bool needs_module(PictureFormat format) {
  return format != PictureFormat::kPfm && format != PictureFormat::kPpm;
}

// Never closed: OpenImageIO keeps threads and global state.
const PictureModule& load_module(const std::filesystem::path& file) {
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!library) throw Error({"the picture module does not load", file.string(), "", dlerror(), ""});
  const auto entry =
      reinterpret_cast<nepho_picture_module_fn*>(dlsym(library, "nepho_picture_module"));
  const PictureModule* module = entry ? entry() : nullptr;
  if (!module || module->version != kPictureModuleVersion)
    throw Error({"the picture module is of another version", file.string(),
                 std::to_string(kPictureModuleVersion),
                 module ? std::to_string(module->version) : "none", ""});
  the_module_loaded = true;
  return *module;
}

enum class Use { kRead, kWrite };

const PictureModule& open_module(const std::vector<std::filesystem::path>& folders,
                                 const std::filesystem::path& picture, Use use) {
  const Ending* ending = find_ending(picture);
  std::vector<const char*> names{kModuleFile};
  if (use == Use::kWrite && ending->format == PictureFormat::kPng)
    names.insert(names.begin(), kPngWriterFile);
  for (const char* name : names)
    for (const std::filesystem::path& folder : folders)
      if (std::filesystem::exists(folder / name)) return load_module(folder / name);
  throw Error({"no " + std::string(ending->text) + " pictures in this build", picture.string(), "",
               std::string("no module ") + kModuleFile,
               "install OpenImageIO (Debian: libopenimageio-dev) and build again, or write .pfm "
               "or .ppm"});
}

FloatImage read_through_module(const PictureModule& module, const std::filesystem::path& path,
                               bool want_pixels, Metadata& metadata) {
  struct Target {
    FloatImage image;
    Metadata* metadata;
  } target{{}, &metadata};
  const PictureSink sink{&target,
                         [](void* context, int width, int height, int channels) -> float* {
                           const auto most = kLargestPicture / std::size_t(std::max(1, channels));
                           if (width < 1 || height < 1 || channels < 1 ||
                               std::size_t(width) > most / std::size_t(height))
                             return nullptr;
                           FloatImage& image = static_cast<Target*>(context)->image;
                           image = FloatImage(width, height, channels);
                           return image.values.data();
                         },
                         [](void* context, const char* key, const char* value) {
                           (*static_cast<Target*>(context)->metadata)[key] = value;
                         }};
  char error[1024] = "";
  if (module.read(path.c_str(), want_pixels, &sink, error, sizeof error))
    throw Error({"cannot read", path.string(), "a picture", error, ""});
  return std::move(target.image);
}

void write_through_module(const PictureModule& module, const std::filesystem::path& path,
                          const char* format, PictureView view, const Metadata& metadata) {
  static constexpr const char* kChannelNames[] = {"R", "G", "B", "optical_depth"};
  std::vector<const char*> keys, values;
  for (const auto& [key, value] : metadata) {
    keys.push_back(key.c_str());
    values.push_back(value.c_str());
  }
  view.channel_names = kChannelNames;
  view.keys = keys.data();
  view.values = values.data();
  view.metadata_count = keys.size();
  char error[1024] = "";
  if (module.write(path.c_str(), format, &view, error, sizeof error))
    throw Error({"cannot write", path.string(), "", error, ""});
}

FloatImage first_three(const FloatImage& image) {
  FloatImage out(image.width, image.height, 3);
  for (std::size_t p = 0; p < image.count(); ++p)
    std::copy_n(image.values.begin() + std::ptrdiff_t(p * std::size_t(image.channels)), 3,
                out.values.begin() + std::ptrdiff_t(3 * p));
  return out;
}

}  // namespace

bool is_picture_name(const std::filesystem::path& path) {
  return find_ending(path) != nullptr;
}

PictureFormat picture_format(const std::filesystem::path& path) {
  if (const Ending* ending = find_ending(path)) return ending->format;
  throw Error({"unknown picture format", path.string(), ".png, .exr, .hdr, .pfm or .ppm",
               "'" + path.extension().string() + "'", ""});
}

void PictureFiles::check_format(const std::filesystem::path& path) const {
  if (needs_module(picture_format(path))) open_module(folders_, path, Use::kWrite);
}

void PictureFiles::write(const std::filesystem::path& path, PictureFormat format,
                         const ByteImage& shown, const FloatImage& linear,
                         const Metadata& metadata) const {
  PictureView view{linear.width, linear.height, 3, PixelType::kFloat, nullptr, nullptr,
                   nullptr,      nullptr,       0};
  switch (format) {
    case PictureFormat::kPpm:
      return write_ppm(path, shown, metadata);
    case PictureFormat::kPfm:
      return write_pfm(path, first_three(linear), metadata);
    case PictureFormat::kPng:
      view.width = shown.width;
      view.height = shown.height;
      view.type = PixelType::kByte;
      view.pixels = shown.values.data();
      return write_through_module(open_module(folders_, "x.png", Use::kWrite), path, "png", view,
                                  metadata);
    case PictureFormat::kExr:
      view.channels = linear.channels;
      view.pixels = linear.values.data();
      return write_through_module(open_module(folders_, "x.exr", Use::kWrite), path, "openexr",
                                  view, metadata);
    case PictureFormat::kHdr: {
      const FloatImage rgb = first_three(linear);
      view.pixels = rgb.values.data();
      write_through_module(open_module(folders_, "x.hdr", Use::kWrite), path, "hdr", view, {});
      return append_trailer(path, metadata);
    }
  }
}

Metadata PictureFiles::read_metadata(const std::filesystem::path& path) const {
  Metadata metadata;
  const PictureFormat format = picture_format(path);
  if (format == PictureFormat::kPpm) {
    read_ppm(path, metadata);
  } else if (!needs_module(format) || format == PictureFormat::kHdr) {
    metadata = read_trailer(path);
  } else {
    read_through_module(open_module(folders_, path, Use::kRead), path, false, metadata);
  }
  return metadata;
}

FloatImage PictureFiles::read(const std::filesystem::path& path, Metadata& metadata) const {
  const PictureFormat format = picture_format(path);
  if (format == PictureFormat::kPfm) return read_pfm(path, metadata);
  if (format == PictureFormat::kPpm) {
    const ByteImage bytes = read_ppm(path, metadata);
    FloatImage image(bytes.width, bytes.height, 3);
    std::transform(bytes.values.begin(), bytes.values.end(), image.values.begin(),
                   [](std::uint8_t v) { return float(v) / 255.0f; });
    return image;
  }
  FloatImage image =
      read_through_module(open_module(folders_, path, Use::kRead), path, true, metadata);
  if (format == PictureFormat::kHdr) metadata = read_trailer(path);
  return image;
}

bool PictureFiles::module_loaded() {
  return the_module_loaded;
}

}  // namespace nepho
