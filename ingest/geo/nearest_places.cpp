#include "geo/nearest_places.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace nepho {
namespace {
constexpr double kAnyDistance = std::numeric_limits<double>::max();
}

// A heap, the farthest first.
struct NearestPlaces::Found {
  struct Place {
    double squared;
    std::uint32_t n;
    friend bool operator<(const Place& a, const Place& b) { return a.squared < b.squared; }
  };
  std::size_t most;
  std::vector<Place> heap;

  double reach() const { return heap.size() < most ? kAnyDistance : heap.front().squared; }
  void add(Place place) {
    if (place.squared >= reach()) return;
    if (heap.size() == most) {
      std::pop_heap(heap.begin(), heap.end());
      heap.pop_back();
    }
    heap.push_back(place);
    std::push_heap(heap.begin(), heap.end());
  }
};

NearestPlaces::NearestPlaces(std::vector<glm::dvec3> unit_vectors)
    : places_(std::move(unit_vectors)), tree_(places_.size()) {
  std::iota(tree_.begin(), tree_.end(), 0u);
  order(0, tree_.size(), 0);
}

void NearestPlaces::order(std::size_t begin, std::size_t end, int axis) {
  if (end - begin < 2) return;
  const std::size_t middle = (begin + end) / 2;
  const auto at = [&](std::size_t n) { return tree_.begin() + std::ptrdiff_t(n); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    return places_[a][axis] < places_[b][axis];
  });
  order(begin, middle, (axis + 1) % 3);
  order(middle + 1, end, (axis + 1) % 3);
}

void NearestPlaces::search(std::size_t begin, std::size_t end, int axis, const glm::dvec3& to,
                           Found& found) const {
  if (begin == end) return;
  const std::size_t middle = (begin + end) / 2;
  const std::uint32_t here = tree_[middle];
  const glm::dvec3 gap = places_[here] - to;
  found.add({glm::dot(gap, gap), here});
  const bool low_first = gap[axis] > 0;
  for (const bool low : {low_first, !low_first}) {
    if (low != low_first && gap[axis] * gap[axis] >= found.reach()) continue;
    if (low)
      search(begin, middle, (axis + 1) % 3, to, found);
    else
      search(middle + 1, end, (axis + 1) % 3, to, found);
  }
}

std::vector<std::uint32_t> NearestPlaces::nearest(const glm::dvec3& to, std::size_t count) const {
  Found found{std::min(count, places_.size()), {}};
  if (found.most > 0) search(0, tree_.size(), 0, to, found);
  std::sort_heap(found.heap.begin(), found.heap.end());
  std::vector<std::uint32_t> list;
  for (const Found::Place& place : found.heap) list.push_back(place.n);
  return list;
}

}  // namespace nepho
