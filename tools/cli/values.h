#pragma once

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace nepho {

// Words of the command line as numbers; each throws Error that names the option.

double number_value(const std::string& option, const std::string& text);
// Within the range that the scene's grammar gives the field: "render", "budget_mib".
double number_value(const std::string& option, const std::string& text, const char* object,
                    const char* field);
// The same, where "1%" is 0.01.
double share_value(const std::string& option, const std::string& text, const char* object,
                   const char* field);
int integer_value(const std::string& option, const std::string& text, const char* object,
                  const char* field);
// One of the grammar's choices.
std::string choice_value(const std::string& option, const std::string& text, const char* object,
                         const char* field);
// --tone-map, and back.
ToneMap tone_map_value(const std::string& text);
const char* tone_map_name(ToneMap tone_map);
// "1,2,3" with exactly `count` numbers; `shape` says what was expected: "x,y,z".
std::vector<double> list_value(const std::string& option, const std::string& text,
                               std::size_t count, const char* shape);
// "640x360".
glm::ivec2 size_value(const std::string& option, const std::string& text);

}  // namespace nepho
