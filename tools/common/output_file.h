#pragma once

#include <cstdint>
#include <filesystem>

namespace nepho {

// A file that appears whole or not at all: written under a temporary name beside its target, then
// renamed. The destructor removes what was not committed, and so does a signal (below).
class OutputFile {
 public:
  // Finds out now what would fail later: throws Error where the folder does not exist or refuses
  // the file, where the target is no plain file, or where the disk has not `bytes` left.
  OutputFile(const std::filesystem::path& target, std::uintmax_t bytes);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  // Flushes to the disk, then renames. Throws Error.
  void commit();

 private:
  std::filesystem::path target_, temporary_;
  bool committed_ = false;
};

// Ctrl-C, termination and hang-up remove the temporary file of this moment, then end the process
// as they would have. A write beyond the file size limit becomes an error instead of a signal.
void remove_output_on_signals();

}  // namespace nepho
