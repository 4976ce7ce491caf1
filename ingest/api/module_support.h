#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/source_module.h"
#include "core/error.h"

namespace nepho {

// For authors of source modules: the request's parameters with their types checked, and a wall that
// no exception passes.
//
//   extern "C" const nepho::SourceModule* nepho_source_module() {
//     static const nepho::SourceModule module = {nepho::this_abi(), [](auto* request, auto* error)
//     {
//       return nepho::open_guarded(error, [&] { return open_my_source(*request); });
//     }};
//     return &module;
//   }

// The parameters of one request. Each look-up notes the name, so that finish() can refuse what
// nobody asked for and name what exists.
class Parameters {
 public:
  explicit Parameters(const SourceRequest& request);

  // Throws Error where the parameter is a word. SI, converted by the host.
  std::optional<double> number(const std::string& name);
  double number(const std::string& name, double otherwise);
  // As number(), and within [low, high], or Error. NaN is refused.
  double number_in(const std::string& name, double otherwise, double low, double high);
  // Greater than 0 and finite, or Error.
  std::optional<double> positive(const std::string& name);
  double positive(const std::string& name, double otherwise);
  // A whole number in [low, high].
  int integer(const std::string& name, int otherwise, int low, int high);
  // Throws Error where the parameter is a number.
  std::string word(const std::string& name, const std::string& otherwise);
  // One of `choices`, the first being the default.
  std::string choice(const std::string& name, const std::vector<std::string>& choices);
  // Throws Error on a parameter that no look-up named.
  void finish() const;

  // "volume 'name', parameter 'x'": for errors.
  std::string where(const std::string& name) const;

 private:
  const RequestParameter* find(const std::string& name);

  const SourceRequest& request_;
  std::vector<std::string> known_;
};

// Nearest of `known` by edit distance, if it is near enough to be a slip of the pen.
std::optional<std::string> did_you_mean(const std::string& word,
                                        const std::vector<std::string>& known);

// Runs `open`; an exception becomes `error` and null.
BrickSource* open_guarded(ModuleError* error,
                          const std::function<std::unique_ptr<BrickSource>()>& open) noexcept;

// The host's I/O lock as a scope.
class IoGuard {
 public:
  explicit IoGuard(const IoLock& lock) : lock_(lock) {
    if (lock_.lock) lock_.lock(lock_.context);
  }
  ~IoGuard() {
    if (lock_.unlock) lock_.unlock(lock_.context);
  }
  IoGuard(const IoGuard&) = delete;
  IoGuard& operator=(const IoGuard&) = delete;

 private:
  IoLock lock_;
};

}  // namespace nepho
