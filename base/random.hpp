// Counter-based random streams: the n-th number of a stream depends on (seed, stream, n) only, so
// adding a sensor or a draw in one stream disturbs no other.
//
//   Method  Philox4x32-10 [Salmon 2011, "Parallel random numbers: as easy as 1, 2, 3", sec. 4]
//   Stream  named by a string ("imu.gyro.x"); the name is hashed (FNV-1a) into the key
//   Error   Philox reproduces the published known-answer vectors (tests/random_test.cpp)
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

namespace whirl {

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  std::uint32_t bits();
  double uniform();  // in (0, 1), 53 bits
  double normal();   // mean 0, standard deviation 1 (Box-Muller)

 private:
  void refill();

  std::array<std::uint32_t, 2> key_;
  std::uint64_t stream_;
  std::uint64_t block_ = 0;
  std::array<std::uint32_t, 4> buffer_{};
  unsigned used_ = 4;
  bool has_spare_ = false;
  double spare_ = 0.0;
};

}  // namespace whirl
