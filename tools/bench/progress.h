#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace nepho::bench {

// What a bench spends its time on; each kind has a pace of its own.
enum class Work : std::uint8_t { kRender, kMarch, kPaths };

// Lines on standard error with the time that is left: written over on a terminal, elsewhere one for
// each piece of work that was finished. The pace of a kind is what its finished pieces took.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void plan(Work kind, double pieces) { at(kind).planned += pieces; }
  // From here on it is this that is worked on: "cumulus: step 0.5".
  void begin(Work kind, const std::string& what);
  // Of the piece that was begun, 0 .. 1; on a terminal only.
  void within(double part);
  void end();
  double left_s() const;

 private:
  struct Kind {
    double planned = 0, done = 0, spent_s = 0, guess_s = 1;
  };
  Kind& at(Work kind) { return kinds_[std::size_t(kind)]; }
  void tell(double part) const;

  std::array<Kind, 3> kinds_{};
  Work now_ = Work::kRender;
  std::string what_;
  bool terminal_;
  std::chrono::steady_clock::time_point begun_;
};

}  // namespace nepho::bench
