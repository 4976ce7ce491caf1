#pragma once

#include <string>

namespace nepho::bench {

// For element content and attributes of XML and HTML.
std::string xml_text(const std::string& text);
// "1.2 %", "35 %", "0.003 %": two digits.
std::string percent_text(double share);
// "12 ms", "1.3 s": three digits at most.
std::string time_text(double seconds);
// RFC 4648, as data: URIs need it.
std::string base64(const std::string& bytes);

}  // namespace nepho::bench
