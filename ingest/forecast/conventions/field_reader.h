#pragma once

#include <memory>
#include <vector>

#include "forecast/conventions/cell_window.h"
#include "forecast/files/data_file.h"

namespace nepho::forecast {

// Which dimension is which, and the reading of variables in one order whatever theirs is:
// [k][j][i], k from the ground up, j and i in the file's own direction.
struct FieldReader {
  std::shared_ptr<const DataFile> file;
  int time = -1, y = -1, x = -1;  // dimensions; without time, and without y (cells in a row): -1
  int nx = 0, ny = 0;             // columns used: nx leaves out a repeated column of a whole turn
  int x0 = 0, y0 = 0;             // the first of them
  int turn = 0;                   // columns after which the first follows; 0: never

  // Only the window's columns of a grid as wide as this reader's are read from now on.
  void restrict_to(const CellWindow& window, bool around);

  // Has `z`, y and x, and nothing else of more than one index but time.
  bool is_field(const FileVariable& variable, int z) const;
  bool is_surface(const FileVariable& variable) const;

  // Levels [first, first + count), counted from the ground; from_top: the file's first is the
  // highest. Times are indices of the file; variables without time are the same at all.
  std::vector<float> levels(const FileVariable& variable, int z, bool from_top,
                            std::size_t time_index, int first, int count) const;
  std::vector<float> field(const FileVariable& variable, int z, bool from_top,
                           std::size_t time_index) const;
  std::vector<float> surface(const FileVariable& variable, std::size_t time_index) const;

 private:
  std::vector<float> read(const FileVariable& variable, int z, bool from_top,
                          std::size_t time_index, int first, int count) const;
  std::vector<float> columns(const FileVariable& variable, int z, bool from_top,
                             std::size_t time_index, int first, int count, int x_from,
                             int x_count) const;
};

}  // namespace nepho::forecast
