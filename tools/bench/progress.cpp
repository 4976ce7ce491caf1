#include "bench/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace nepho::bench {

Progress::Progress() : terminal_(isatty(STDERR_FILENO) != 0) {
  // Until a piece of a kind is done: what a small picture takes.
  at(Work::kRender).guess_s = 1;
  at(Work::kMarch).guess_s = 10;
  at(Work::kPaths).guess_s = 60;
}

Progress::~Progress() {
  if (terminal_) std::fprintf(stderr, "\r\033[K");
}

double Progress::left_s() const {
  double left = 0;
  for (const Kind& kind : kinds_) {
    const double pace_s = kind.done > 0 ? kind.spent_s / kind.done : kind.guess_s;
    left += pace_s * std::max(kind.planned - kind.done, 0.0);
  }
  return left;
}

void Progress::tell(double part) const {
  const double left = left_s();
  const char* end = terminal_ ? "" : "\n";
  if (terminal_) std::fprintf(stderr, "\r\033[K");
  if (part > 0 && part < 1)
    std::fprintf(stderr, "bench: %s (%.0f %%), about %.0f s left%s", what_.c_str(), 100 * part,
                 left, end);
  else
    std::fprintf(stderr, "bench: %s, about %.0f s left%s", what_.c_str(), left, end);
}

void Progress::begin(Work kind, const std::string& what) {
  now_ = kind;
  what_ = what;
  begun_ = std::chrono::steady_clock::now();
  if (terminal_) tell(0);
}

void Progress::within(double part) {
  if (terminal_) tell(part);
}

void Progress::end() {
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begun_;
  Kind& kind = at(now_);
  kind.done += 1;
  kind.spent_s += spent.count();
  if (!terminal_) tell(1);
}

}  // namespace nepho::bench
