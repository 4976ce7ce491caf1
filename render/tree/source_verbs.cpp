#include "tree/source_verbs.h"

#include <algorithm>
#include <array>
#include <memory>
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

bool has_ice(const VolumeInfo& info) {
  return std::ranges::any_of(info.channels, [](const ChannelInfo& channel) {
    return channel.channel == Channel::kIceExtinction;
  });
}

void read_brick(const BrickSource& source, double time_s, NodeKey key, LeafBrick& brick) {
  const bool ice = has_ice(source.info());
  const auto ice_codes = ice ? std::make_shared<IceCodes>() : nullptr;
  std::array<ChannelView, 2> views = {
      ChannelView{.channel = Channel::kExtinction, .codes = brick.codes.data()},
      ChannelView{.channel = Channel::kIceExtinction,
                  .codes = ice ? ice_codes->codes.data() : nullptr}};
  throw_on_failure(source.read(key, time_s, {views.data(), ice ? 2u : 1u}), source, "read", key);
  brick.key = key;
  brick.scale = views[0].scale;
  brick.offset = views[0].offset;
  brick.max_abs_error = views[0].max_abs_error;
  brick.ice = nullptr;
  if (!ice) return;
  ice_codes->scale = views[1].scale;
  ice_codes->offset = views[1].offset;
  const bool none = views[1].offset == 0 &&
                    (views[1].scale == 0 ||
                     std::ranges::all_of(ice_codes->codes, [](std::uint16_t c) { return c == 0; }));
  if (!none) brick.ice = ice_codes;
}

}  // namespace nepho
