// Samples of all wires at once, as an analyser delivers them, turned into edges.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "io_bridges/copper/edge_sink.hpp"

namespace whirl::sigrok {

class SampleReader {
 public:
  // bits: of each wire, its place in a sample. Pre: rate above 0.
  SampleReader(std::vector<int> bits, double rate_Hz, copper::EdgeSink& sink)
      : bits_(std::move(bits)), rate_Hz_(rate_Hz), sink_(sink) {}

  // unit: bytes of a sample, 1 to 64; least significant byte first.
  void add(std::span<const std::uint8_t> data, std::size_t unit);
  // Beyond what a live device lost: it says so, and nothing can be told of the time behind.
  std::uint64_t samples() const { return samples_; }

 private:
  std::int64_t now_ns() const;
  void compare(std::span<const std::uint8_t> sample);

  std::vector<int> bits_;
  double rate_Hz_;
  copper::EdgeSink& sink_;
  std::vector<std::uint8_t> last_;
  std::uint64_t samples_ = 0;
};

}  // namespace whirl::sigrok
