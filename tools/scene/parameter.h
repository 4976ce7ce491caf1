#pragma once

#include <string>

#include "scene/json_tree.h"
#include "scene/scene.h"

namespace nepho {

// A source parameter: a word, true/false, a number, or a number with its unit as one text
// ("0.02 1/m"). A name may end in its unit (radius_m, extinction_per_km): a plain number then has
// it, and a text must agree with it in dimension. Modules see SI only, and names that say so:
// "radius": "0.5 km" and "radius_km": 0.5 both become radius_m = 500. Throws Error at `where`.
SourceParameter make_parameter(const std::string& name, const JsonValue& value,
                               const std::string& where);
// The same from a command line: `text` is whatever the user wrote.
SourceParameter make_parameter(const std::string& name, const std::string& text,
                               const std::string& where);

}  // namespace nepho
