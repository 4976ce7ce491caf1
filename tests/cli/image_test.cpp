#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "image/picture_file.h"
#include "image/tone.h"

namespace nepho {
namespace {

namespace fs = std::filesystem;

class Picture : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("nephoscope_image_test_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static FloatImage ramp(int channels) {
    FloatImage image(5, 3, channels);
    for (std::size_t i = 0; i < image.values.size(); ++i)
      image.values[i] = 0.01f + float(i) * 0.0317f;
    return image;
  }
  const Metadata metadata_{{"nephoscope:scene", "{\"a\": 1.5, \"b\": \"x y\"}"},
                           {"nephoscope:error", "error (estimated): integration 1 %"},
                           {"nephoscope:assumptions", ""}};
  const PictureFiles files_{{NEPHO_MODULE_DIR}};
  fs::path folder_;
};

TEST_F(Picture, pfm_keeps_every_bit_and_its_metadata) {
  for (const int channels : {1, 3}) {
    write_pfm(folder_ / "a.pfm", ramp(channels), metadata_);
    Metadata found;
    const FloatImage back = read_pfm(folder_ / "a.pfm", found);
    EXPECT_EQ(back.values, ramp(channels).values);
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(found, metadata_);
  }
}

// IEC 61966-2-1 and the rounding, without the table that spares most powers. Values close to where
// a byte ends are among them: both neighbours of each such place.
TEST(Tone, BytesAreTheCurvesOwn) {
  std::vector<float> values;
  for (int i = 0; i <= 100000; ++i) values.push_back(float(i) / 100000);
  for (int byte = 0; byte < 255; ++byte) {
    const double code = (byte + 0.5) / 255;
    const auto edge = float(code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4));
    for (const float value : {std::nextafter(edge, 0.0f), edge, std::nextafter(edge, 1.0f)})
      values.push_back(value);
  }
  FloatImage image(int(values.size()), 1, 3);
  for (std::size_t p = 0; p < values.size(); ++p)
    for (std::size_t c = 0; c < 3; ++c) image.values[3 * p + c] = values[p];
  const ByteImage shown = to_display(image, 0, ToneMap::kNone, false);
  for (std::size_t p = 0; p < values.size(); ++p) {
    const double v = double(values[p]);
    const double code = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
    ASSERT_EQ(int(shown.values[3 * p]), int(std::floor(255 * code + 0.5))) << v;
  }
}

// The bytes of the format, so that other programs read it: rows from the bottom up.
TEST_F(Picture, pfm_bytes_are_the_published_ones) {
  FloatImage image(1, 2, 1);
  image.values = {1.0f, 2.0f};  // above, below
  write_pfm(folder_ / "a.pfm", image, {});
  std::ifstream in(folder_ / "a.pfm", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  EXPECT_EQ(bytes, std::string("Pf\n1 2\n-1.0\n\0\0\0\x40\0\0\x80\x3f", 20));
}

TEST_F(Picture, ppm_keeps_every_byte_and_its_metadata) {
  ByteImage image(4, 2, 3);
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = std::uint8_t(i * 11);
  write_ppm(folder_ / "a.ppm", image, metadata_);
  Metadata found;
  EXPECT_EQ(read_ppm(folder_ / "a.ppm", found).values, image.values);
  EXPECT_EQ(found, metadata_);
}

// A header that promises more than the file holds must not make us allocate.
TEST_F(Picture, short_or_foreign_files_are_refused) {
  const std::pair<const char*, const char*> cases[] = {{"a.ppm", "P6\n60000 60000\n255\nabc"},
                                                       {"b.ppm", "P3\n1 1\n255\n1 2 3"},
                                                       {"c.ppm", "P6\n-1 1\n255\n"},
                                                       {"d.pfm", "PF\n60000 60000\n-1.0\nabc"},
                                                       {"e.pfm", "PF\n1 1\n1.0\n0123456789ab"},
                                                       {"f.pfm", ""},
                                                       {"g.ppm", "P6\n99999999999 1\n255\n"}};
  for (const auto& [name, bytes] : cases) {
    std::ofstream(folder_ / name) << bytes;
    Metadata found;
    EXPECT_THROW(files_.read(folder_ / name, found), Error) << name;
  }
}

TEST_F(Picture, unknown_ending_lists_the_known) {
  try {
    picture_format("x.jpeg");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find(".png, .exr, .hdr, .pfm or .ppm"), std::string::npos);
  }
  EXPECT_EQ(picture_format("X.PNG"), PictureFormat::kPng);
}

TEST_F(Picture, without_the_module_the_message_names_the_package) {
  const PictureFiles none{{folder_}};
  for (const char* name : {"x.png", "x.exr", "x.hdr"}) try {
      none.check_format(name);
      FAIL() << name;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find("libopenimageio-dev"), std::string::npos) << e.what();
    }
  EXPECT_NO_THROW(none.check_format("x.pfm"));
  EXPECT_NO_THROW(none.check_format("x.ppm"));
}

#ifdef NEPHO_HAS_OIIO
TEST_F(Picture, png_exr_hdr_keep_pixels_and_metadata) {
  const FloatImage linear = ramp(4);
  const ByteImage shown = to_display(linear, 0, ToneMap::kNone);
  for (const char* name : {"a.png", "a.exr", "a.hdr"}) {
    const fs::path path = folder_ / name;
    files_.write(path, picture_format(path), shown, linear, metadata_);
    Metadata found;
    const FloatImage back = files_.read(path, found);
    ASSERT_EQ(back.width, linear.width) << name;
    for (const auto& [key, value] : metadata_) {
      if (value.empty()) continue;  // some formats drop it
      EXPECT_EQ(found[key], value) << name;
      EXPECT_EQ(files_.read_metadata(path).at(key), value) << name;
    }
    for (std::size_t p = 0; p < linear.count(); ++p)
      for (std::size_t c = 0; c < 3; ++c) {
        const float value = back.values[p * std::size_t(back.channels) + c];
        const float is = linear.values[4 * p + c];
        const double bytes = double(value) * 255;
        switch (name[2]) {
          case 'p':
            EXPECT_NEAR(bytes, shown.values[3 * p + c], 1e-4);
            break;
          case 'e':
            EXPECT_EQ(value, is);
            break;
          case 'h':
            EXPECT_NEAR(value, is, 0.016);
            break;  // 8 bits under a shared exponent
        }
      }
  }
  EXPECT_TRUE(PictureFiles::module_loaded());
}
#endif

TEST(Tone, display_values_are_those_of_srgb) {
  FloatImage image(3, 1, 3);
  image.values = {0.5f, 0.5f, 0.5f, 0.0f, 0.0f, 0.0f, 2.0f, 2.0f, 2.0f};
  const ByteImage shown = to_display(image, 0, ToneMap::kNone);
  // sRGB of 1/2 is 0.735357 = 187.5/255: IEC 61966-2-1.
  EXPECT_NEAR(shown.values[0], 188, 0);
  EXPECT_EQ(shown.values[3], 0);
  EXPECT_EQ(shown.values[6], 255);
  // One stop is a factor of two.
  const ByteImage brighter = to_display(image, 1, ToneMap::kNone);
  EXPECT_EQ(brighter.values[0], 255);
}

TEST(Tone, not_a_number_is_black_and_infinity_is_white) {
  FloatImage image(2, 1, 3);
  image.values.assign(3, std::nanf(""));
  image.values.resize(6, INFINITY);
  for (const ToneMap tone_map : {ToneMap::kNone, ToneMap::kAces}) {
    const ByteImage shown = to_display(image, 0, tone_map);
    EXPECT_EQ(shown.values[0], 0);
    EXPECT_EQ(shown.values[3], 255);
  }
}

TEST(Tone, dither_keeps_the_mean) {
  FloatImage image(64, 64, 3);
  const double level = 100.3 / 255;  // an sRGB value between two bytes
  const double linear = std::pow((level + 0.055) / 1.055, 2.4);
  std::fill(image.values.begin(), image.values.end(), float(linear));
  double sum = 0, plain = 0;
  for (const auto v : to_display(image, 0, ToneMap::kNone, true).values) sum += v;
  for (const auto v : to_display(image, 0, ToneMap::kNone, false).values) plain += v;
  EXPECT_NEAR(sum / double(image.values.size()), 100.3, 0.02);
  EXPECT_NEAR(plain / double(image.values.size()), 100, 1e-9);
}

TEST(Tone, exposure_puts_the_cloud_and_not_the_sky_at_its_level) {
  FloatImage image(10, 10, 3);
  std::vector<float> optical_depth(100, 0.0f);
  std::fill(image.values.begin(), image.values.end(), 7.0f);  // a bright sky
  for (std::size_t p = 0; p < 50; ++p) {
    optical_depth[p] = 5;
    for (std::size_t c = 0; c < 3; ++c) image.values[3 * p + c] = 0.02f;
  }
  const double ev = exposure_from(image, optical_depth);
  EXPECT_NEAR(0.02 * std::exp2(ev), kBrightCloud, 0.01 * kBrightCloud);
  // Scaling the light by 8 lowers it by 3 stops.
  for (float& v : image.values) v *= 8;
  EXPECT_NEAR(exposure_from(image, optical_depth), ev - 3, 0.011);
  EXPECT_EQ(exposure_from(FloatImage(4, 4, 3), {}), 0);
}

// On a planet: what is in the dark, grey or clear.
FloatImage grey(int width, int height, float value) {
  FloatImage image(width, height, 3);
  std::fill(image.values.begin(), image.values.end(), value);
  return image;
}
void fill(FloatImage& image, std::size_t from, std::size_t to, float value) {
  std::fill(image.values.begin() + std::ptrdiff_t(3 * from),
            image.values.begin() + std::ptrdiff_t(3 * to), value);
}

TEST(Tone, the_night_side_does_not_set_a_planets_exposure) {
  FloatImage image = grey(100, 100, 1e-4f);  // a globe, most of its clouds in the dark
  fill(image, 0, 200, 0.3f);
  const std::vector<float> cloud(10000, 5.0f);
  EXPECT_NEAR(std::exp2(exposure_on_planet(image, cloud, 0.4)) * 0.3, kBrightCloud, 0.01);
  // Twice the light, one stop less.
  for (float& v : image.values) v *= 2;
  EXPECT_NEAR(std::exp2(exposure_on_planet(image, cloud, 0.8)) * 0.6, kBrightCloud, 0.01);
}

TEST(Tone, glint_does_not_put_clouds_into_the_dark) {
  FloatImage image = grey(100, 100, 0.02f);  // sea, with the sun's image on a tenth of it
  std::vector<float> cloud(10000, 0.0f);
  std::fill(cloud.begin(), cloud.begin() + 3000, 5.0f);
  fill(image, 0, 3000, 0.1f);
  const double without = exposure_on_planet(image, cloud, 0.2);
  EXPECT_NEAR(std::exp2(without) * 0.1, kBrightCloud, 0.01);
  fill(image, 9000, 10000, 20.0f);
  EXPECT_EQ(exposure_on_planet(image, cloud, 0.2), without);
}

TEST(Tone, a_grey_sky_stays_grey_and_a_clear_one_is_measured_by_white) {
  const std::vector<float> overcast(10000, 30.0f), clear(10000, 0.0f);
  const double ev = exposure_on_planet(grey(100, 100, 0.05f), overcast, 0.4);
  EXPECT_NEAR(std::exp2(ev) * 0.4 * kGreyCloud, kBrightCloud, 0.01);
  EXPECT_LT(std::exp2(ev) * 0.05, 0.4 * kBrightCloud);
  const double blue = std::exp2(exposure_on_planet(grey(100, 100, 0.05f), clear, 0.4)) * 0.05;
  EXPECT_NEAR(blue, 0.05 / 0.4 / 0.8, 0.01);
  // A low sun: the picture is brighter than a surface in what is left of it. And night.
  EXPECT_GT(std::exp2(exposure_on_planet(grey(100, 100, 0.05f), clear, 1e-3)) * 0.05, 0.9);
  EXPECT_GT(std::exp2(exposure_on_planet(grey(100, 100, 1e-6f), clear, 0)) * 1e-6, 0.9);
  EXPECT_EQ(exposure_on_planet(grey(4, 4, 0), {}, 0), 0);
}

TEST(Tone, white_is_shown_grey) {
  FloatImage image(1, 1, 3);
  image.values = {0.3f, 0.36f, 0.4f};
  const glm::dvec3 white(1.5, 1.8, 2.0);
  const ByteImage shown = to_display(image, 0, ToneMap::kNone, false, white);
  EXPECT_NEAR(shown.values[0], shown.values[1], 1);
  EXPECT_NEAR(shown.values[1], shown.values[2], 1);
  EXPECT_EQ(to_display(image, 0, ToneMap::kNone).values,
            to_display(image, 0, ToneMap::kNone, false, glm::dvec3(3)).values);
}

}  // namespace
}  // namespace nepho
