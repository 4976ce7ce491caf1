#pragma once
// Lacks #include <vector>: compiles only where somebody else included it first.
struct Incomplete {
  std::vector<int> values;
};
