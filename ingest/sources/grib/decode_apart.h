#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

namespace nepho::grib {

// `decode` fills `count` numbers and returns a status, in a copy of this process: what damaged
// bytes do to it stays there (forecast/files/survives.h). Nothing where the copy came to no end.
// About 2 ms beside the decoding itself, more where this process holds gigabytes.
std::optional<int> decode_apart(std::size_t count, const std::function<int(double*)>& decode,
                                std::vector<double>& values);

}  // namespace nepho::grib
