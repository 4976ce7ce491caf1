#pragma once

#include <string>

#include "scene/json_tree.h"
#include "scene/scene.h"

namespace nepho {

// A source parameter: a word, true/false, a number, or a number with its unit as one text
// ("0.02 1/m"). A name may end in its unit (radius_m, extinction_per_m): a plain number then has
// it, and a text must agree with it in dimension. Throws Error at `where`.
SourceParameter make_parameter(const std::string& name, const JsonValue& value,
                               const std::string& where);
// The same from a command line: `text` is whatever the user wrote.
SourceParameter make_parameter(const std::string& name, const std::string& text,
                               const std::string& where);
// As make_parameter reads it back to the same bits: a number, or "number SI-unit".
std::string parameter_text(const SourceParameter& parameter);

}  // namespace nepho
