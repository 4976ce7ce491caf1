#include "sources/grib/decode_apart.h"

#include <sys/mman.h>

#include "forecast/files/survives.h"

namespace nepho::grib {
namespace {

constexpr unsigned kPatience_s = 120;  // for fields of many millions of points

// Doubles that a copy of this process writes and this one reads.
class SharedNumbers {
 public:
  explicit SharedNumbers(std::size_t count) : bytes_(count * sizeof(double)) {
    void* at = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    numbers_ = at == MAP_FAILED ? nullptr : static_cast<double*>(at);
  }
  ~SharedNumbers() {
    if (numbers_) munmap(numbers_, bytes_);
  }
  SharedNumbers(const SharedNumbers&) = delete;
  SharedNumbers& operator=(const SharedNumbers&) = delete;
  double* numbers() const { return numbers_; }

 private:
  std::size_t bytes_;
  double* numbers_;
};

}  // namespace

std::optional<int> decode_apart(std::size_t count, const std::function<int(double*)>& decode,
                                std::vector<double>& values) {
  // Two more: whether it came to its end, and the status.
  const SharedNumbers shared(count + 2);
  double* const numbers = shared.numbers();
  if (!numbers) return {};
  const bool alive = forecast::survives(
      [&] {
        numbers[1] = decode(numbers + 2);
        numbers[0] = 1;
      },
      kPatience_s);
  if (!alive || numbers[0] != 1) return {};
  values.assign(numbers + 2, numbers + 2 + count);
  return int(numbers[1]);
}

}  // namespace nepho::grib
