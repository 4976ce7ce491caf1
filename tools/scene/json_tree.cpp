#include "scene/json_tree.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace nepho {
namespace {

constexpr int kDeepestNesting = 64;  // a scene needs 5; the reader below is recursive

// Counts what the parser has taken: its SAX events carry no positions of their own.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, const char** taken) : at_(at), taken_(taken) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    if (taken_) *taken_ = at_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) {
    return a.at_ == b.at_;
  }
  friend bool operator!=(const CountingIterator& a, const CountingIterator& b) { return !(a == b); }

 private:
  const char* at_;
  const char** taken_;
};

// Between two events lie only white space, commas, colons and one token: its start is found by
// skipping the former.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  TreeBuilder(std::string_view text, std::string source_name)
      : text_(text),
        taken_(text.data()),
        last_(text.data()),
        source_name_(std::move(source_name)) {}

  CountingIterator begin() { return {text_.data(), &taken_}; }
  CountingIterator end() { return {text_.data() + text_.size(), nullptr}; }
  JsonValue& root() { return root_; }

  bool null() override { return add({}); }
  bool boolean(bool value) override {
    JsonValue v;
    v.kind = JsonValue::Kind::kBool;
    v.boolean = value;
    return add(std::move(v));
  }
  bool number_integer(std::int64_t value) override { return number(double(value), true); }
  bool number_unsigned(std::uint64_t value) override { return number(double(value), true); }
  bool number_float(double value, const std::string&) override {
    return number(value, value == std::floor(value));
  }
  bool string(std::string& value) override {
    JsonValue v;
    v.kind = JsonValue::Kind::kString;
    v.text = value;
    return add(std::move(v));
  }
  bool binary(nlohmann::json::binary_t&) override { return false; }

  bool start_object(std::size_t) override { return open(JsonValue::Kind::kObject); }
  bool start_array(std::size_t) override { return open(JsonValue::Kind::kArray); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(std::string& name) override {
    const TextPosition at = token_start();
    for (const JsonValue::Member& member : open_.back()->members)
      if (member.key == name)
        throw Error({"field occurs twice", at_position(source_name_, at), "", "'" + name + "'",
                     "first at line " + std::to_string(member.at.line)});
    open_.back()->members.push_back({name, at, {}});
    return true;
  }
  bool parse_error(std::size_t byte, const std::string& last_token,
                   const nlohmann::json::exception& e) override {
    // "[json.exception.parse_error.101] parse error at line 3, column 4: what is wrong"
    std::string reason = e.what();
    const std::size_t bracket = reason.find("] "), colon = reason.find(": ");
    reason = reason.substr(colon != std::string::npos ? colon + 2 : bracket + 2);
    const std::size_t offset = byte == 0 ? 0 : std::min(byte - 1, text_.size());
    throw Error({"not valid JSON", at_position(source_name_, position(text_.data() + offset)), "",
                 printable(last_token), reason});
  }

 private:
  static std::string printable(const std::string& token) {
    std::string shown = "'";
    for (const char c : token.substr(0, 40)) shown += (c >= ' ' && c < 127) ? c : '.';
    return shown + "'";
  }
  bool number(double value, bool is_integer) {
    JsonValue v;
    v.kind = JsonValue::Kind::kNumber;
    v.number = value;
    v.is_integer = is_integer;
    return add(std::move(v));
  }
  bool open(JsonValue::Kind kind) {
    JsonValue v;
    v.kind = kind;
    v.at = token_start();
    if (open_.size() >= kDeepestNesting)
      throw Error({"nested too deeply", at_position(source_name_, v.at),
                   "at most " + std::to_string(kDeepestNesting) + " levels", "", ""});
    open_.push_back(&place(std::move(v)));
    return true;
  }
  bool close() {
    open_.pop_back();
    last_ = taken_;
    return true;
  }
  bool add(JsonValue value) {
    value.at = token_start();
    place(std::move(value));
    return true;
  }
  // Pointers in open_ stay valid: only the innermost container grows.
  JsonValue& place(JsonValue value) {
    if (open_.empty()) return root_ = std::move(value);
    JsonValue& parent = *open_.back();
    if (parent.kind == JsonValue::Kind::kArray) return parent.items.emplace_back(std::move(value));
    return parent.members.back().value = std::move(value);
  }
  TextPosition token_start() {
    const char* start = last_;
    const char* end = text_.data() + text_.size();
    const std::string_view skipped = " \t\r\n,:\xef\xbb\xbf";
    while (start != end && skipped.find(*start) != std::string_view::npos) ++start;
    last_ = taken_;
    return position(start);
  }
  TextPosition position(const char* at) const {
    const std::string_view before = text_.substr(0, std::size_t(at - text_.data()));
    const std::size_t newline = before.rfind('\n');
    const std::size_t line_start = newline == std::string_view::npos ? 0 : newline + 1;
    return {1 + int(std::count(before.begin(), before.end(), '\n')),
            1 + int(before.size() - line_start)};
  }

  std::string_view text_;
  const char* taken_;
  const char* last_;  // end of the last token
  std::string source_name_;
  JsonValue root_;
  std::vector<JsonValue*> open_;
};

}  // namespace

const char* kind_name(JsonValue::Kind kind) {
  switch (kind) {
    case JsonValue::Kind::kNull:
      return "null";
    case JsonValue::Kind::kBool:
      return "true or false";
    case JsonValue::Kind::kNumber:
      return "a number";
    case JsonValue::Kind::kString:
      return "a text";
    case JsonValue::Kind::kArray:
      return "a list";
    case JsonValue::Kind::kObject:
      return "an object";
  }
  return "?";
}

std::string at_position(const std::string& source_name, TextPosition position) {
  return source_name + ":" + std::to_string(position.line) + ":" + std::to_string(position.column);
}

JsonValue parse_json(std::string_view text, const std::string& source_name) {
  TreeBuilder builder(text, source_name);
  nlohmann::json::sax_parse(builder.begin(), builder.end(), &builder);
  return std::move(builder.root());
}

}  // namespace nepho
