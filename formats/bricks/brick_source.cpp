#include "bricks/brick_source.h"

#include <algorithm>
#include <cstring>

namespace nepho {
namespace {

// A fixed buffer: reporting a failure must not be able to fail.
thread_local std::array<char, 1024> last_error_text{};

}  // namespace

const char* to_string(Status status) noexcept {
  switch (status) {
    case Status::kOk:
      return "ok";
    case Status::kNoSuchNode:
      return "no such node";
    case Status::kNoSuchTime:
      return "no such time";
    case Status::kNoSuchChannel:
      return "no such channel";
    case Status::kUnsupported:
      return "not supported by this source";
    case Status::kReadFailed:
      return "read failed";
  }
  return "unknown status";
}

Status check_request(const VolumeInfo& info, NodeKey key, double time_s) noexcept {
  if (key.level() > info.lattice.max_level() || key.root() >= info.chart->roots())
    return Status::kNoSuchNode;
  const Index3 nodes = info.lattice.nodes(key.level());
  if (key.i() >= nodes[0] || key.j() >= nodes[1] || key.k() >= nodes[2]) return Status::kNoSuchNode;
  return std::ranges::find(info.times_s, time_s) != info.times_s.end() ? Status::kOk
                                                                       : Status::kNoSuchTime;
}

void set_last_error(const char* text) noexcept {
  std::strncpy(last_error_text.data(), text, last_error_text.size() - 1);
}

std::size_t copy_last_error(char* buffer, std::size_t size) noexcept {
  const std::size_t length = std::strlen(last_error_text.data());
  if (size > 0) {
    const std::size_t kept = std::min(length, size - 1);
    std::memcpy(buffer, last_error_text.data(), kept);
    buffer[kept] = 0;
  }
  return length;
}

}  // namespace nepho
