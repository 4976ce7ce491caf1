#include "common/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "core/error.h"

namespace nepho {
namespace {

namespace fs = std::filesystem;

// What the signal handler may touch: bytes, not objects.
char the_temporary[4096];
volatile std::sig_atomic_t the_temporary_exists = 0;

void note_temporary(const fs::path& path) {
  const std::string text = path.string();
  if (text.size() >= sizeof the_temporary) return;
  std::memcpy(the_temporary, text.c_str(), text.size() + 1);
  the_temporary_exists = 1;
}

void on_signal(int signal) {
  if (the_temporary_exists) unlink(the_temporary);
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

[[noreturn]] void refuse(const fs::path& target, const std::string& found, const char* expected) {
  throw Error({"cannot write", target.string(), expected, found, ""});
}

// A link is written through, as every other program does.
fs::path resolved(const fs::path& target) {
  std::error_code failure;
  const fs::path real = fs::weakly_canonical(target, failure);
  return failure ? target : real;
}

void check_target(const fs::path& target) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status)) refuse(target, "a directory", "a file name");
  if (fs::exists(status) && !fs::is_regular_file(status))
    refuse(target, "a device or pipe", "a plain file");
  if (fs::exists(status) && access(target.c_str(), W_OK) != 0)
    refuse(target, std::strerror(errno), "");
  const fs::path folder = target.parent_path();
  if (!fs::is_directory(folder, ignored))
    refuse(target, "no directory " + folder.string(), "a directory that exists");
}

}  // namespace

OutputFile::OutputFile(const fs::path& target, std::uintmax_t bytes)
    : target_(resolved(fs::absolute(target))) {
  check_target(target_);
  temporary_ = target_.parent_path() / ("." + target_.stem().string() + "." +
                                        std::to_string(getpid()) + target_.extension().string());
  const int file = open(temporary_.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (file < 0) refuse(target, std::strerror(errno), "");
  note_temporary(temporary_);
  const int failure = posix_fallocate(file, 0, off_t(bytes));
  close(file);
  // Some file systems cannot reserve; then the write itself will tell.
  if (failure == ENOSPC || failure == EFBIG || failure == EDQUOT) {
    unlink(temporary_.c_str());
    the_temporary_exists = 0;
    refuse(target, std::strerror(failure), (std::to_string(bytes) + " free bytes").c_str());
  }
}

OutputFile::~OutputFile() {
  if (!committed_) unlink(temporary_.c_str());
  the_temporary_exists = 0;
}

void OutputFile::commit() {
  const int file = open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  const bool flushed = file >= 0 && fsync(file) == 0;
  const int failure = errno;
  if (file >= 0) close(file);
  if (!flushed) refuse(target_, std::strerror(failure), "");
  if (rename(temporary_.c_str(), target_.c_str()) != 0) refuse(target_, std::strerror(errno), "");
  committed_ = true;
}

void remove_output_on_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, on_signal);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace nepho
