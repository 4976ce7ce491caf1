#include "core/log.h"

namespace nepho {
namespace {

LogSink the_sink = nullptr;
void* the_context = nullptr;

}  // namespace

void set_log_sink(LogSink sink, void* context) noexcept {
  the_sink = sink;
  the_context = context;
}

void log(LogLevel level, const std::string& text) noexcept {
  if (the_sink) the_sink(the_context, level, text.c_str());
}

}  // namespace nepho
