#include "scene/object_reader.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "core/error.h"

namespace nepho {
namespace {

const char* expected_text(FieldKind kind) {
  switch (kind) {
    case FieldKind::kText:
      return "a text";
    case FieldKind::kChoice:
      return "one of ";
    case FieldKind::kNumber:
      return "a number";
    case FieldKind::kInteger:
      return "a whole number";
    case FieldKind::kVector:
      return "a list of three numbers";
    case FieldKind::kTextList:
      return "a text or a list of texts";
    case FieldKind::kObject:
    case FieldKind::kParameters:
      return "an object";
    case FieldKind::kObjectOrNone:
      return "an object, or \"none\"";
    case FieldKind::kObjectList:
      return "a list of objects";
  }
  return "?";
}

std::string short_number(double value) {
  std::ostringstream out;
  out.precision(9);
  out << value;
  return out.str();
}

std::string shown(const JsonValue& value) {
  if (value.kind == JsonValue::Kind::kNumber) return short_number(value.number);
  if (value.kind == JsonValue::Kind::kString) return "the text '" + value.text.substr(0, 40) + "'";
  if (value.kind == JsonValue::Kind::kArray)
    return "a list of " + std::to_string(value.items.size());
  return kind_name(value.kind);
}

std::string choices_text(std::string_view choices) {
  std::string text(choices);
  for (std::size_t at; (at = text.find('|')) != std::string::npos;) text.replace(at, 1, ", ");
  return text;
}

bool is_choice(std::string_view word, std::string_view choices) {
  while (!choices.empty()) {
    const std::size_t bar = choices.find('|');
    if (choices.substr(0, bar) == word) return true;
    choices.remove_prefix(bar == std::string_view::npos ? choices.size() : bar + 1);
  }
  return false;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row.back();
}

}  // namespace

std::string nearest_name(std::string_view wrong, const std::vector<std::string>& known) {
  // A forgotten unit is the likeliest mistake: "elevation" for "elevation_deg".
  for (const std::string& name : known)
    if (name.size() > wrong.size() && name.starts_with(wrong) && name[wrong.size()] == '_')
      return name;
  std::string best;
  std::size_t least = 1 + std::max<std::size_t>(2, wrong.size() / 3);
  for (const std::string& name : known)
    if (const std::size_t distance = edit_distance(wrong, name); distance < least) {
      least = distance;
      best = name;
    }
  return best;
}

ObjectReader::ObjectReader(const JsonValue& value, const ObjectGrammar& grammar,
                           std::string source_name, std::string path)
    : value_(&value),
      grammar_(&grammar),
      source_name_(std::move(source_name)),
      path_(std::move(path)) {
  if (value.kind != JsonValue::Kind::kObject)
    throw Error(
        {path_.empty() ? "not a scene" : "wrong type", where(), "an object", shown(value), ""});
  for (const JsonValue::Member& member : value.members) check(member);
}

const JsonValue* ObjectReader::find(std::string_view field) const {
  for (const JsonValue::Member& member : value_->members)
    if (member.key == field) return &member.value;
  return nullptr;
}

const FieldGrammar& ObjectReader::grammar_of(std::string_view field) const {
  for (const FieldGrammar& known : grammar_->fields)
    if (known.name == field) return known;
  throw std::logic_error("ObjectReader: no field " + std::string(field));
}

std::string ObjectReader::path_of(std::string_view field) const {
  return path_.empty() ? std::string(field) : path_ + "." + std::string(field);
}

std::string ObjectReader::where(std::string_view field) const {
  const JsonValue* value = field.empty() ? value_ : find(field);
  const std::string path = field.empty() ? path_ : path_of(field);
  const std::string position = at_position(source_name_, value ? value->at : value_->at);
  return path.empty() ? position : position + " (" + path + ")";
}

void ObjectReader::refuse_unknown(const JsonValue::Member& member) const {
  std::vector<std::string> known;
  std::string list;
  for (const FieldGrammar& field : grammar_->fields) {
    known.emplace_back(field.name);
    list += (list.empty() ? "" : ", ") + known.back();
  }
  const std::string near = nearest_name(member.key, known);
  const bool unit = near.starts_with(member.key + "_");
  throw Error({unit ? "missing unit" : "unknown field",
               at_position(source_name_, member.at) + " (" + path_of(member.key) + ")",
               "one of " + list, "'" + member.key + "'",
               near.empty() ? "" : "did you mean '" + near + "'?"});
}

void ObjectReader::refuse_type(const JsonValue& value, const FieldGrammar& field,
                               const std::string& path) const {
  std::string expected = expected_text(field.kind);
  if (field.kind == FieldKind::kChoice) expected += choices_text(field.choices);
  throw Error({"wrong type", at_position(source_name_, value.at) + " (" + path + ")", expected,
               shown(value), ""});
}

void ObjectReader::check_number(const JsonValue& value, const FieldGrammar& field,
                                const std::string& path) const {
  if (value.kind != JsonValue::Kind::kNumber) refuse_type(value, field, path);
  if (field.kind == FieldKind::kInteger && !value.is_integer) refuse_type(value, field, path);
  if (value.number < field.low || value.number > field.high)
    throw Error({"out of range", at_position(source_name_, value.at) + " (" + path + ")",
                 short_number(field.low) + " to " + short_number(field.high),
                 short_number(value.number), ""});
}

void ObjectReader::check(const JsonValue::Member& member) const {
  using Kind = JsonValue::Kind;
  const auto known = std::find_if(grammar_->fields.begin(), grammar_->fields.end(),
                                  [&](const FieldGrammar& f) { return f.name == member.key; });
  if (known == grammar_->fields.end()) refuse_unknown(member);
  const JsonValue& value = member.value;
  const std::string path = path_of(member.key);
  const auto must = [&](bool good) {
    if (!good) refuse_type(value, *known, path);
  };
  switch (known->kind) {
    case FieldKind::kText:
      return must(value.kind == Kind::kString);
    case FieldKind::kChoice:
      return must(value.kind == Kind::kString && is_choice(value.text, known->choices));
    case FieldKind::kNumber:
    case FieldKind::kInteger:
      return check_number(value, *known, path);
    case FieldKind::kVector:
      must(value.kind == Kind::kArray && value.items.size() == 3);
      for (std::size_t i = 0; i < 3; ++i)
        check_number(value.items[i], {known->name, FieldKind::kNumber, known->low, known->high},
                     path + "[" + std::to_string(i) + "]");
      return;
    case FieldKind::kTextList:
      must(value.kind == Kind::kString || value.kind == Kind::kArray);
      for (const JsonValue& item : value.items)
        if (item.kind != Kind::kString) refuse_type(item, *known, path);
      return;
    case FieldKind::kObject:  // its own reader checks the rest
    case FieldKind::kParameters:
      return must(value.kind == Kind::kObject);
    case FieldKind::kObjectOrNone:
      return must(value.kind == Kind::kObject ||
                  (value.kind == Kind::kString && value.text == "none"));
    case FieldKind::kObjectList:
      return must(value.kind == Kind::kArray);
  }
}

std::optional<double> ObjectReader::number(std::string_view field) const {
  const JsonValue* value = find(field);
  return value ? std::optional(value->number) : std::nullopt;
}

std::optional<int> ObjectReader::integer(std::string_view field) const {
  const JsonValue* value = find(field);
  return value ? std::optional(int(value->number)) : std::nullopt;
}

std::optional<std::string> ObjectReader::text(std::string_view field) const {
  const JsonValue* value = find(field);
  return value ? std::optional(value->text) : std::nullopt;
}

std::optional<glm::dvec3> ObjectReader::vector(std::string_view field) const {
  const JsonValue* value = find(field);
  if (!value) return std::nullopt;
  return glm::dvec3(value->items[0].number, value->items[1].number, value->items[2].number);
}

std::vector<std::string> ObjectReader::texts(std::string_view field) const {
  std::vector<std::string> result;
  const JsonValue* value = find(field);
  if (value && value->kind == JsonValue::Kind::kString) result.push_back(value->text);
  if (value)
    for (const JsonValue& item : value->items) result.push_back(item.text);
  return result;
}

std::optional<ObjectReader> ObjectReader::object(std::string_view field) const {
  const JsonValue* value = find(field);
  if (!value || is_none(field)) return std::nullopt;
  return ObjectReader(*value, *grammar_of(field).object, source_name_, path_of(field));
}

bool ObjectReader::is_none(std::string_view field) const {
  const JsonValue* value = find(field);
  return value && value->kind == JsonValue::Kind::kString && value->text == "none" &&
         grammar_of(field).kind == FieldKind::kObjectOrNone;
}

std::vector<ObjectReader> ObjectReader::objects(std::string_view field) const {
  std::vector<ObjectReader> result;
  const JsonValue* value = find(field);
  if (!value) return result;
  for (std::size_t i = 0; i < value->items.size(); ++i)
    result.emplace_back(value->items[i], *grammar_of(field).object, source_name_,
                        path_of(field) + "[" + std::to_string(i) + "]");
  return result;
}

void ObjectReader::require(std::string_view field) const {
  if (!find(field)) throw Error({"missing field", where(), "'" + std::string(field) + "'", "", ""});
}

void ObjectReader::at_most_one(std::initializer_list<std::string_view> fields) const {
  std::string_view first;
  for (const std::string_view field : fields) {
    if (!find(field)) continue;
    if (!first.empty())
      throw Error({"these exclude each other", where(field), "one of them",
                   "'" + std::string(first) + "' and '" + std::string(field) + "'", ""});
    first = field;
  }
}

void ObjectReader::all_or_none(std::initializer_list<std::string_view> fields) const {
  const bool any = std::any_of(fields.begin(), fields.end(), [&](auto f) { return has(f); });
  if (any)
    for (const std::string_view field : fields) require(field);
}

}  // namespace nepho
