#pragma once

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace nepho::test {

// A CSV file of numbers with one line of names.
class TruthTable {
 public:
  explicit TruthTable(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    if (!std::getline(file, line)) throw std::runtime_error("no truth table at " + path);
    names_ = split(line);
    while (std::getline(file, line)) {
      std::vector<double> row;
      for (const std::string& cell : split(line)) row.push_back(std::stod(cell));
      if (row.size() != names_.size()) throw std::runtime_error("ragged row in " + path);
      rows_.push_back(std::move(row));
    }
  }

  std::size_t rows() const { return rows_.size(); }
  double at(std::size_t row, const std::string& name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) throw std::runtime_error("no column " + name);
    return rows_.at(row)[std::size_t(found - names_.begin())];
  }

 private:
  static std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
    return cells;
  }

  std::vector<std::string> names_;
  std::vector<std::vector<double>> rows_;
};

}  // namespace nepho::test
