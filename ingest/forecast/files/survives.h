#pragma once

#include <functional>

namespace nepho::forecast {

// Does a copy of this process come to the action's end? False where it is ended by a signal, or
// takes longer than `patience_s`. What it prints on the error stream is dropped, and nothing that
// it changes comes back. HDF5 trusts a file's headers, ecCodes what a field's second order packing
// says of itself: some damaged ones end the process that reads them. Only the calling thread lives
// on in the copy: no other may hold what the action needs. True where no copy can be made. About 2
// ms.
bool survives(const std::function<void()>& action, unsigned patience_s = 10);

}  // namespace nepho::forecast
