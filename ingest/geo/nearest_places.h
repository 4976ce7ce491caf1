#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace nepho {

// Which of many places on a sphere are nearest to another: a tree of halves (Bentley 1975,
// doi:10.1145/361002.361007). Built in n log n; a question takes about 1 us.
class NearestPlaces {
 public:
  explicit NearestPlaces(std::vector<glm::dvec3> unit_vectors);
  // At most `count`, nearest first.
  std::vector<std::uint32_t> nearest(const glm::dvec3& to, std::size_t count) const;
  const glm::dvec3& operator[](std::size_t n) const { return places_[n]; }
  std::size_t size() const { return places_.size(); }

 private:
  struct Found;
  void order(std::size_t begin, std::size_t end, int axis);
  void search(std::size_t begin, std::size_t end, int axis, const glm::dvec3& to,
              Found& found) const;

  std::vector<glm::dvec3> places_;
  std::vector<std::uint32_t> tree_;  // places; the middle of each range halves it
};

}  // namespace nepho
