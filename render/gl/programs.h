#pragma once

#include <map>
#include <string>

#include "gl/object.h"

namespace nepho::gl {

// Compiled once for each text: drivers take up to seconds for one.
class Programs {
 public:
  // As compile(); lives as long as this does.
  const Program& get(const std::string& name, const char* source, const std::string& switches) {
    const auto found = programs_.find({name, switches});
    if (found != programs_.end()) return found->second;
    return programs_.emplace(std::pair{name, switches}, compile(name, source, switches))
        .first->second;
  }
  std::size_t size() const { return programs_.size(); }

 private:
  std::map<std::pair<std::string, std::string>, Program> programs_;
};

}  // namespace nepho::gl
