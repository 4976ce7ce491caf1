#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nepho {

// Line and column of the first character of a key or value, both from 1; columns count bytes.
struct TextPosition {
  int line = 1, column = 1;
};

// JSON text as a tree that still knows where each value stands, so that an error can name line,
// column and field. Strict RFC 8259; a key that occurs twice in one object is an error.
struct JsonValue {
  enum class Kind { kNull, kBool, kNumber, kString, kArray, kObject };
  struct Member;

  Kind kind = Kind::kNull;
  TextPosition at;
  double number = 0;
  bool is_integer = false, boolean = false;
  std::string text;
  std::vector<JsonValue> items;
  std::vector<Member> members;
};
struct JsonValue::Member {
  std::string key;
  TextPosition at;
  JsonValue value;
};

const char* kind_name(JsonValue::Kind kind);

// Throws Error whose `where` is "source_name:line:column".
JsonValue parse_json(std::string_view text, const std::string& source_name);
std::string at_position(const std::string& source_name, TextPosition position);

}  // namespace nepho
