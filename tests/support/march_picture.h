#pragma once

#include "reference/march_picture.h"

namespace nepho::test {

using nepho::march_picture;

}  // namespace nepho::test
