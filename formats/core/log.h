#pragma once

#include <string>

namespace nepho {

enum class LogLevel { kDebug, kInfo, kWarning };

// A plain function, so that it can cross a module boundary. Called from any thread.
using LogSink = void (*)(void* context, LogLevel level, const char* text);

// The process's one sink (none at first). Set it before threads start.
void set_log_sink(LogSink sink, void* context) noexcept;
void log(LogLevel level, const std::string& text) noexcept;

}  // namespace nepho
