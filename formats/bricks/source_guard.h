#pragma once

#include <exception>
#include <type_traits>
#include <utility>

#include "bricks/brick_source.h"

namespace nepho {

// For sources: how a verb of the contract fails, with its text behind last_error().

inline Status refused(Status status) noexcept {
  set_last_error(to_string(status));
  return status;
}

// Runs a verb's body, which returns nothing or a status; an exception becomes kReadFailed.
template <class Body>
Status guarded(Body&& body) noexcept {
  try {
    if constexpr (std::is_same_v<std::invoke_result_t<Body>, Status>) {
      return std::forward<Body>(body)();
    } else {
      std::forward<Body>(body)();
      return Status::kOk;
    }
  } catch (const std::exception& e) {
    set_last_error(e.what());
  } catch (...) {
    set_last_error("an exception of unknown type");
  }
  return Status::kReadFailed;
}

}  // namespace nepho
