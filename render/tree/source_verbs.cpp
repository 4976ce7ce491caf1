#include "tree/source_verbs.h"

#include <algorithm>
#include <string>

#include "core/error.h"

namespace nepho {

void throw_on_failure(Status status, const BrickSource& source, const char* verb, NodeKey key) {
  if (status == Status::kOk) return;
  std::string text(512, '\0');
  text.resize(std::min(source.last_error(text.data(), text.size()), text.size() - 1));
  throw Error({.what = "a source failed to " + std::string(verb) + " a node: " + to_string(status),
               .where = source.info().name + ", level " + std::to_string(key.level()) + ", root " +
                        std::to_string(key.root()) + ", node " + std::to_string(key.i()) + " " +
                        std::to_string(key.j()) + " " + std::to_string(key.k()),
               .expected = "",
               .found = text,
               .hint = ""});
}

void read_brick(const BrickSource& source, double time_s, NodeKey key, LeafBrick& brick) {
  ChannelView view{.channel = Channel::kExtinction, .codes = brick.codes.data()};
  throw_on_failure(source.read(key, time_s, {&view, 1}), source, "read", key);
  brick.key = key;
  brick.scale = view.scale;
  brick.offset = view.offset;
  brick.max_abs_error = view.max_abs_error;
}

}  // namespace nepho
