#include "bench/text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace nepho::bench {

std::string xml_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    // Other control characters are no part of XML 1.0.
    if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') continue;
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string percent_text(double share) {
  const double value = 100 * share, size = std::abs(value);
  if (value == 0) return "0 %";
  char text[32];
  if (size < 1e-3)
    std::snprintf(text, sizeof text, "%.1e %%", value);
  else
    std::snprintf(text, sizeof text, "%.*f %%", std::max(0, 1 - int(std::floor(std::log10(size)))),
                  value);
  return text;
}

std::string time_text(double seconds) {
  char text[32];
  if (seconds < 1)
    std::snprintf(text, sizeof text, "%.3g ms", 1e3 * seconds);
  else
    std::snprintf(text, sizeof text, "%.3g s", seconds);
  return text;
}

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b)
      group = group << 8 | (b < n ? static_cast<unsigned char>(bytes[i + b]) : 0u);
    for (std::size_t d = 0; d < 4; ++d) out += d <= n ? kDigits[group >> (18 - 6 * d) & 63] : '=';
  }
  return out;
}

}  // namespace nepho::bench
