#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "bricks/brick_source.h"
#include "common/brick_check.h"
#include "common/data_error.h"
#include "scene/scene.h"

namespace nepho {

struct OpenedScene;

// What `info` knows of a volume, as docs/info.schema.json has it; numbers that are not known are
// left out. Each function fills some members of one object.

using Json = nlohmann::ordered_json;

// Name, chart, lattice, channels, phase, files, facts and assumptions.
Json volume_json(const BrickSource& source, const VolumeSpec& volume);
// The times there are, and of which one the rest tells.
Json times_json(const VolumeInfo& info, double shown_s);
// Members `recognised`, `variables` and `columns`: by the data where they tell, else by bricks.
void add_data(Json& out, const BrickSource& source, double time_s);
// One row for each time, from the data alone; nothing where that would read too much.
Json states_json(const BrickSource& source, double time_s);
Json check_json(const BrickCheck& check, const DataError& error);
// The tree of the picture that `render` would draw with this request.

Json picture_json(const OpenedScene& opened);

// For people: one screen a volume.
void print_volume(const Json& volume);
void print_picture(const Json& picture);

}  // namespace nepho
