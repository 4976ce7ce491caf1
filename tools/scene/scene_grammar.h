#pragma once

#include <limits>
#include <span>
#include <string_view>

namespace nepho {

// What a scene file may hold, as one table that the reader obeys and the published schema
// (docs/scene.schema.json) is tested against. Every dimensional field ends in its unit.

enum class FieldKind {
  kText,
  kChoice,        // one of `choices`
  kNumber,        // within [low, high]
  kInteger,       // the same
  kVector,        // three numbers within [low, high]
  kTextList,      // one text, or a list of them
  kObject,        // `object`
  kObjectOrNone,  // `object`, or the text "none"
  kObjectList,    // a list of `object`
  kParameters,    // free names: the source module knows them
};

struct ObjectGrammar;

struct FieldGrammar {
  std::string_view name;
  FieldKind kind = FieldKind::kText;
  double low = -std::numeric_limits<double>::max(), high = std::numeric_limits<double>::max();
  std::string_view choices = {};  // "filter|texels8"
  const ObjectGrammar* object = nullptr;
};

struct ObjectGrammar {
  std::string_view name;  // as in the schema's $defs; "scene" is the whole file
  std::span<const FieldGrammar> fields;
};

const ObjectGrammar& scene_grammar();

}  // namespace nepho
