#pragma once

#include <stdexcept>
#include <string>

namespace nepho {

// What a user can cause, said once and in full. `where` names file, variable, index, line, column;
// `hint` says what to do.
class Error : public std::runtime_error {
 public:
  struct Parts {
    std::string what, where, expected, found, hint;
  };
  explicit Error(Parts parts);
  const Parts& parts() const noexcept { return parts_; }

 private:
  Parts parts_;
};

}  // namespace nepho
