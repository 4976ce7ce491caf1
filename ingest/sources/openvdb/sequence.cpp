#include "sequence.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <optional>

#include "core/error.h"

namespace nepho::vdb {
namespace {

constexpr long kMostFrames = 1000000;

struct Pattern {
  std::filesystem::path folder;
  std::string before, after;
  std::size_t digits;
};

Pattern parse(const std::string& file) {
  const std::filesystem::path path(file);
  const std::string name = path.filename().string();
  const std::size_t first = name.find('#'), end = name.find_first_not_of('#', first);
  const std::size_t stop = end == std::string::npos ? name.size() : end;
  if (first == std::string::npos || name.find('#', stop) != std::string::npos)
    throw Error({"bad sequence pattern", file, "one run of '#' in the file's name",
                 first == std::string::npos ? "none" : "more than one", ""});
  return {path.parent_path(), name.substr(0, first), name.substr(stop), stop - first};
}

std::optional<long> frame_number(const Pattern& p, const std::string& name) {
  const std::size_t around = p.before.size() + p.after.size();
  if (name.size() < around + p.digits || name.size() > around + 9) return {};
  if (!name.starts_with(p.before) || !name.ends_with(p.after)) return {};
  const std::string digits = name.substr(p.before.size(), name.size() - around);
  const auto is_digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  if (digits.empty() || !std::ranges::all_of(digits, is_digit)) return {};
  return std::stol(digits);
}

}  // namespace

Sequence find_sequence(const std::string& file) {
  if (file.find('#') == std::string::npos) return {{file}, {{0, 0}}, {}, false};
  const Pattern pattern = parse(file);
  std::map<long, std::string> found;
  std::error_code error;
  const auto folder = pattern.folder.empty() ? std::filesystem::path(".") : pattern.folder;
  for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
       it.increment(error))
    if (const auto number = frame_number(pattern, it->path().filename().string())) {
      const auto [at, is_new] = found.emplace(*number, it->path().string());
      if (!is_new)
        throw Error({"two files for one frame", file, "one file per number",
                     at->second + " and " + it->path().string(), ""});
    }
  if (found.empty())
    throw Error({"no file matches the sequence", file, "files with digits in place of '#'",
                 error ? error.message() : "none", ""});
  const long first = found.begin()->first, last = found.rbegin()->first;
  if (last - first >= kMostFrames)
    throw Error({"the sequence is too long", file, "at most 1000000 frames",
                 std::to_string(first) + " to " + std::to_string(last), ""});
  Sequence sequence;
  sequence.is_pattern = true;
  for (long number = first; number <= last; ++number) {
    if (const auto at = found.find(number); at != found.end())
      sequence.files.push_back(at->second);
    else
      sequence.gaps.push_back(number);
    sequence.frames.push_back({number, sequence.files.size() - 1});
  }
  return sequence;
}

}  // namespace nepho::vdb
