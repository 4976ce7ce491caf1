// One mistake for each sanitizer to find: awake asan|tsan.
#include <cstring>
#include <thread>
#include <vector>

namespace {

int read_past_the_end(std::size_t count) {
  const std::vector<int> values(count);
  return values.data()[count];
}

int write_from_two_threads() {
  int shared = 0;
  std::thread other([&] { ++shared; });
  ++shared;
  other.join();
  return shared;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const bool races = std::strcmp(argv[1], "tsan") == 0;
  const volatile int result =
      races ? write_from_two_threads() : read_past_the_end(std::size_t(argc));
  return result < 0 ? 3 : 0;
}
