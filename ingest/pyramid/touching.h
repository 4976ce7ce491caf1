#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

#include "bricks/chart.h"

namespace nepho {

// Which nodes of one level share a sample: up to 8, within a root, across the cube's edges and
// around a periodic box.

// Calls visit(node) for the one or two nodes on an axis that hold global sample g.
template <class Visit>
void for_each_holder(std::uint32_t g, std::uint32_t cells, Visit&& visit) {
  if (g % kBrickCells == 0 && g > 0) visit(g / kBrickCells - 1);
  if (g < cells) visit(g / kBrickCells);
}

// Calls visit(key) for every node that shares a sample with `key`, itself included; some often.
template <class Visit>
void for_each_touching(const Chart& chart, const Lattice& lattice, NodeKey key, Visit&& visit) {
  const Index3& cells = lattice.cells(key.level());
  const Index3 g = Lattice::global_sample(key, {0, 0, 0});
  for (const std::uint32_t i : {g[0], g[0] + kBrickCells})
    for (const std::uint32_t j : {g[1], g[1] + kBrickCells})
      for (const Column& name : chart.names({key.root(), i, j}, cells))
        for (const std::uint32_t k : {g[2], g[2] + kBrickCells})
          for_each_holder(name.i, cells[0], [&](std::uint32_t a) {
            for_each_holder(name.j, cells[1], [&](std::uint32_t b) {
              for_each_holder(k, cells[2], [&](std::uint32_t c) {
                visit(NodeKey(name.root, key.level(), a, b, c));
              });
            });
          });
}

struct Touch {
  NodeKey key;
  std::optional<std::size_t> node;  // its place among the stored, if it is
  std::size_t offset;               // of the sample in its brick
};

// Ascending by name and key; no heap.
class TouchList {
 public:
  void push_back(const Touch& touch) { touches_[size_++] = touch; }
  Touch* begin() { return touches_.data(); }
  Touch* end() { return touches_.data() + size_; }
  const Touch* begin() const { return touches_.data(); }
  const Touch* end() const { return touches_.data() + size_; }
  template <class Predicate>
  void keep(Predicate&& predicate) {
    size_ = std::size_t(std::stable_partition(begin(), end(), predicate) - begin());
  }

 private:
  std::array<Touch, 8> touches_{};
  std::size_t size_ = 0;
};

// All holders of each sample of one node. `find` gives a key's place; the 27 neighbours of the same
// root are looked up once.
template <class Find>
class Touching {
 public:
  Touching(const Chart& chart, const Lattice& lattice, NodeKey key, Find find)
      : chart_(chart), cells_(lattice.cells(key.level())), key_(key), find_(find) {
    const Index3 count = lattice.nodes(key.level());
    for (int n = 0; n < 27; ++n) {
      const std::array<int, 3> step = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      Index3 at = key.ijk();
      bool inside = true;
      for (std::size_t a = 0; a < 3; ++a) {
        at[a] += std::uint32_t(step[a]);
        inside = inside && at[a] < count[a];
      }
      if (inside)
        near_[std::size_t(n)] = find(NodeKey(key.root(), key.level(), at[0], at[1], at[2]));
    }
  }

  TouchList places(Index3 s) const {
    const Index3 g = Lattice::global_sample(key_, s);
    TouchList list;
    const auto add = [&](const Column& name) {
      for_each_holder(name.i, cells_[0], [&](std::uint32_t a) {
        for_each_holder(name.j, cells_[1], [&](std::uint32_t b) {
          for_each_holder(g[2], cells_[2], [&](std::uint32_t c) {
            const NodeKey key(name.root, key_.level(), a, b, c);
            list.push_back({key, place(key),
                            offset(name.i, a) + kBrickSamples * (offset(name.j, b) +
                                                                 kBrickSamples * offset(g[2], c))});
          });
        });
      });
    };
    const bool edge = g[0] == 0 || g[0] == cells_[0] || g[1] == 0 || g[1] == cells_[1];
    if (!edge) {
      add({key_.root(), g[0], g[1]});
    } else {
      for (const Column& name : chart_.names({key_.root(), g[0], g[1]}, cells_)) add(name);
    }
    return list;
  }

 private:
  static std::size_t offset(std::uint32_t g, std::uint32_t node) { return g - kBrickCells * node; }
  std::optional<std::size_t> place(NodeKey key) const {
    if (key.root() == key_.root()) {
      const std::uint32_t i = key.i() - key_.i() + 1, j = key.j() - key_.j() + 1,
                          k = key.k() - key_.k() + 1;
      if (i < 3 && j < 3 && k < 3) return near_[i + 3 * (j + 3 * k)];
    }
    return find_(key);
  }

  const Chart& chart_;
  const Index3& cells_;
  NodeKey key_;
  Find find_;
  std::array<std::optional<std::size_t>, 27> near_{};
};

}  // namespace nepho
