#include "common/stop_request.h"

#include <csignal>

namespace nepho {
namespace {

volatile std::sig_atomic_t asked = 0;
void (*handler_before)(int) = SIG_DFL;

void on_interrupt(int signal) {
  asked = 1;
  std::signal(signal, handler_before);
}

}  // namespace

StopRequest::StopRequest() {
  asked = 0;
  before_ = std::signal(SIGINT, on_interrupt);
  handler_before = before_;
}

StopRequest::~StopRequest() {
  std::signal(SIGINT, before_);
}

bool StopRequest::made() const {
  return asked != 0;
}

}  // namespace nepho
