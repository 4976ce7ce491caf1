#pragma once

#include <span>
#include <string>
#include <vector>

#include "cases.h"

namespace nepho::test {

// Runs rows through tests/parity/table.comp on the current OpenGL 4.5 context. Throws
// std::runtime_error with the driver's text where the shader does not compile or link.
std::vector<Outputs> evaluate_on_gpu(int which, std::span<const Row> rows);

}  // namespace nepho::test
