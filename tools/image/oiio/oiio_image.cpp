// PNG, EXR and Radiance HDR through OpenImageIO, behind the plain C entry of picture_module.h.

#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "image/picture_module.h"

namespace nepho {
namespace {

int fail(char* error, std::size_t size, const std::string& text) {
  std::snprintf(error, size, "%s", text.c_str());
  return 1;
}

OIIO::ImageSpec make_spec(const PictureView& picture) {
  const bool bytes = picture.type == PixelType::kByte;
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels,
                       bytes ? OIIO::TypeDesc::UINT8 : OIIO::TypeDesc::FLOAT);
  spec.channelnames.assign(picture.channel_names, picture.channel_names + picture.channels);
  spec.attribute("oiio:ColorSpace", bytes ? "sRGB" : "Linear");
  for (std::size_t i = 0; i < picture.metadata_count; ++i)
    spec.attribute(picture.keys[i], picture.values[i]);
  return spec;
}

int write(const char* path, const char* format, const PictureView* picture, char* error,
          std::size_t error_size) {
  try {
    const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(format);
    if (!out) return fail(error, error_size, OIIO::geterror());
    const OIIO::ImageSpec spec = make_spec(*picture);
    const bool good =
        out->open(path, spec) && out->write_image(spec.format, picture->pixels) && out->close();
    return good ? 0 : fail(error, error_size, out->geterror());
  } catch (const std::exception& e) {
    return fail(error, error_size, e.what());
  }
}

int read(const char* path, int want_pixels, const PictureSink* sink, char* error,
         std::size_t error_size) {
  try {
    const std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(path);
    if (!in) return fail(error, error_size, OIIO::geterror());
    const OIIO::ImageSpec& spec = in->spec();
    for (const OIIO::ParamValue& attribute : spec.extra_attribs)
      if (attribute.type() == OIIO::TypeDesc::STRING)
        sink->metadata(sink->context, attribute.name().c_str(), attribute.get_string().c_str());
    if (!want_pixels) return 0;
    float* pixels = sink->size(sink->context, spec.width, spec.height, spec.nchannels);
    if (!pixels) return fail(error, error_size, "a picture of this size is not read");
    const bool good = in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels);
    return good ? 0 : fail(error, error_size, in->geterror());
  } catch (const std::exception& e) {
    return fail(error, error_size, e.what());
  }
}

constexpr PictureModule kModule{kPictureModuleVersion, write, read};

}  // namespace
}  // namespace nepho

extern "C" __attribute__((visibility("default"))) const nepho::PictureModule*
nepho_picture_module() {
  return &nepho::kModule;
}
