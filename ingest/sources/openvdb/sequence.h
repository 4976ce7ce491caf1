#pragma once

#include <string>
#include <vector>

namespace nepho::vdb {

// The frames of "name.####.vdb": first to last number found on disk. A number without a file is a
// gap, and shows the frame before it.
struct Frame {
  long number = 0;
  std::size_t file = 0;  // which of Sequence::files it shows
};
struct Sequence {
  std::vector<std::string> files;  // those that exist, ascending
  std::vector<Frame> frames;       // ascending, no number left out
  std::vector<long> gaps;
  bool is_pattern = false;
};

// A name without '#' is a sequence of one, whether or not the file exists. A run of k '#' stands
// for a number of at least k digits. Throws Error where nothing matches, where two files have one
// number (0001, 00001), or where the numbers span more than a million frames.
Sequence find_sequence(const std::string& file);

}  // namespace nepho::vdb
