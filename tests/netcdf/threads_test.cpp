// Files through the module, from several threads at once.

#include <gtest/gtest.h>

#include <bit>
#include <thread>

#include "host/source_host.h"
#include "made_source.h"

namespace nepho::test {
namespace {

std::uint64_t hash_of(const BrickSource& source, NodeKey key, double time_s) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const double c : read_samples(source, key, time_s))
    hash = (hash ^ std::bit_cast<std::uint64_t>(c)) * 0x100000001b3u;
  return hash;
}

// Two sources through the module, four threads, more times than either keeps: files are read again
// and again under the one lock of the process.
TEST(NetcdfFiles, TwoSourcesFromFourThreads) {
  const SourceHost host({NEPHO_TEST_MODULES});
  VolumeSpec volume;
  volume.name = "nest";
  volume.files = {NEPHO_TEST_FILE};
  std::vector<std::pair<NodeKey, double>> work;
  std::vector<std::uint64_t> alone;
  {
    const auto source = host.open(volume);
    for (const double time_s : source->info().times_s) {
      const std::vector<NodeKey> nodes = finest_nodes(*source, time_s);
      for (std::size_t n = 0; n < nodes.size(); n += 4) {
        work.emplace_back(nodes[n], time_s);
        alone.push_back(hash_of(*source, nodes[n], time_s));
      }
    }
  }
  std::vector<std::unique_ptr<BrickSource>> sources;
  sources.push_back(host.open(volume));
  sources.push_back(host.open(volume));
  std::vector<std::vector<std::uint64_t>> hashes(4, std::vector<std::uint64_t>(work.size()));
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t n = 0; n < work.size(); ++n) {
        const std::size_t at = (n + t * work.size() / 4) % work.size();  // each its own time
        hashes[t][at] = hash_of(*sources[t % 2], work[at].first, work[at].second);
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_GT(work.size(), 20u);
  for (const auto& of_thread : hashes) EXPECT_EQ(of_thread, alone);
}

}  // namespace
}  // namespace nepho::test
