// What is refused: one clear Error each, within 5 s, with no more memory than the file deserves.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <fstream>

#include "vdb_files.h"

namespace nepho::test {
namespace {

struct Case {
  const char* twin;
  const char* says;   // part of the message
  const char* names;  // another part: what was found
};

const Case kCases[] = {
    {"level_set", "no density", "level set"},
    {"vec3_only", "no density", "vec3s"},
    {"points", "no density", "density"},
    {"several", "several grids", "steam"},
    {"singular", "singular", "[density]"},
    {"far_specks", "too far apart", "4000000016"},
    {"truncated", "truncated", "density"},
    {"truncated_header", "truncated", "80 bytes"},
    {"text", "not a VDB file", "text.vdb"},
    {"no_bytes", "is empty", "0 bytes"},
    {"moving", "transforms differ", "moving.02.vdb"},
};

std::string refusal(const std::string& file, std::vector<SourceParameter> parameters = {}) {
  const auto start = std::chrono::steady_clock::now();
  std::string text;
  try {
    open(file, std::move(parameters));
  } catch (const Error& e) {
    EXPECT_FALSE(e.parts().what.empty());
    EXPECT_FALSE(e.parts().where.empty());
    text = e.what();
  }
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5);
  return text;
}

void expect_says(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' in: " << text;
}

TEST(Malformed, EveryTwinIsRefusedInWords) {
  for (const Case& c : kCases) {
    const std::string text = refusal(twin(c.twin));
    std::printf("measured: %-17s %s\n", c.twin, text.c_str());
    expect_says(text, c.says);
    expect_says(text, c.names);
  }
}

TEST(Malformed, MissingFolderAndNoMatch) {
  expect_says(refusal((folder() / "nothing.vdb").string()), "no such file");
  expect_says(refusal(folder().string()), "folder");
  expect_says(refusal((folder() / "nothing.####.vdb").string()), "no file matches");
  expect_says(refusal("/dev/null"), "device");
}

TEST(Malformed, Parameters) {
  const std::string file = twin("plain");
  EXPECT_EQ(refusal(file), "");  // control
  expect_says(refusal(file, {number("density_scale", -1)}), "density_scale");
  expect_says(refusal(file, {number("density_scal", 1)}), "density_scale");
  expect_says(refusal(file, {word("up", "x")}), "up");
  expect_says(refusal(file, {word("grid", "steam")}), "no grid of this name");
  expect_says(refusal(file, {number("grid", 3)}), "a word");
  expect_says(refusal(file, {number("metres_per_unit", 0)}), "metres_per_unit");
  expect_says(refusal(file, {number("frame", 1)}), "no sequence");
  expect_says(refusal(twin("sequence"), {number("frame", 9)}), "1 to 4");
  expect_says(refusal(file, {number("density_scale", 1e38)}), "out of range");
}

// Each byte of the headers set to extremes: refused or read, never a crash or a long wait.
TEST(Malformed, DamagedHeadersNeverCrash) {
  std::ifstream in(twin("plain"), std::ios::binary);
  const std::string intact((std::istreambuf_iterator<char>(in)), {});
  const std::string file = (folder() / "damaged.vdb").string();
  int refused = 0, read = 0;
  // The file's and the grid's headers, the transform and the tree's top: about 900 bytes.
  for (std::size_t at = 0; at < 1300; at += at < 200 ? 1 : 3)
    if (const char byte = at % 2 ? '\x7f' : '\xff'; intact[at] != byte) {
      std::string damaged = intact;
      damaged[at] = byte;
      std::ofstream(file, std::ios::binary) << damaged;
      refusal(file).empty() ? ++read : ++refused;
    }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("measured: %d damaged files refused, %d read, peak %ld MB\n", refused, read,
              usage.ru_maxrss / 1024);
  EXPECT_GT(refused, 100);
  EXPECT_LT(usage.ru_maxrss, 1024 * 1024);  // kB: nothing is allocated from what a file claims
}

TEST(Malformed, EveryTruncationIsRefused) {
  std::ifstream in(twin("half"), std::ios::binary);
  const std::string intact((std::istreambuf_iterator<char>(in)), {});
  const std::string file = (folder() / "cut.vdb").string();
  for (std::size_t length = 1; length < intact.size();
       length += length < 300 ? 7 : intact.size() / 60) {
    std::ofstream(file, std::ios::binary) << intact.substr(0, length);
    EXPECT_NE(refusal(file), "") << length << " of " << intact.size() << " bytes";
  }
}

}  // namespace
}  // namespace nepho::test
