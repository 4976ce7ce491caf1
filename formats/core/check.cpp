#include "core/check.h"

#include <cstdlib>

namespace nepho::detail {

void check_failed(const char* file, int line, const char* expression, const std::string& left,
                  const std::string& right) noexcept {
  std::fprintf(stderr, "%s:%d: check failed: %s: %s against %s\n", file, line, expression,
               left.c_str(), right.c_str());
  std::abort();
}

}  // namespace nepho::detail
