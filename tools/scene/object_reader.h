#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/json_tree.h"
#include "scene/scene_grammar.h"

namespace nepho {

// One JSON object held against its grammar: construction throws Error (line, column, field) for an
// unknown field, a wrong type or a number out of range; what get() returns is then good.
class ObjectReader {
 public:
  // `path` is how errors call the object: "volumes[1].place"; "" is the whole scene.
  ObjectReader(const JsonValue& value, const ObjectGrammar& grammar, std::string source_name,
               std::string path = "");

  bool has(std::string_view field) const { return find(field) != nullptr; }
  std::optional<double> number(std::string_view field) const;
  std::optional<int> integer(std::string_view field) const;
  std::optional<std::string> text(std::string_view field) const;
  std::optional<glm::dvec3> vector(std::string_view field) const;
  std::vector<std::string> texts(std::string_view field) const;
  std::optional<ObjectReader> object(std::string_view field) const;
  bool is_none(std::string_view field) const;  // the text "none" in place of an object
  std::vector<ObjectReader> objects(std::string_view field) const;
  const JsonValue* raw(std::string_view field) const { return find(field); }

  // "scene.json:12:5 (volumes[1].place.lat_deg)"
  std::string where(std::string_view field = {}) const;
  // Of these fields at most one / exactly one / all or none may be there; throws Error otherwise.
  void require(std::string_view field) const;
  void at_most_one(std::initializer_list<std::string_view> fields) const;
  void all_or_none(std::initializer_list<std::string_view> fields) const;

 private:
  const JsonValue* find(std::string_view field) const;
  const FieldGrammar& grammar_of(std::string_view field) const;
  std::string path_of(std::string_view field) const;
  void check(const JsonValue::Member& member) const;
  void check_number(const JsonValue& value, const FieldGrammar& field,
                    const std::string& path) const;
  [[noreturn]] void refuse_unknown(const JsonValue::Member& member) const;
  [[noreturn]] void refuse_type(const JsonValue& value, const FieldGrammar& field,
                                const std::string& path) const;

  const JsonValue* value_;
  const ObjectGrammar* grammar_;
  std::string source_name_, path_;
};

// The known name nearest to a mistyped one, or "" where none is near.
std::string nearest_name(std::string_view wrong, const std::vector<std::string>& known);

}  // namespace nepho
