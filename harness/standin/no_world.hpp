// Nothing around a board: for one whose world is played to it from elsewhere. No signals; refuses all that is asked.
#pragma once
#include "harness/world/world.hpp"

namespace whirl {

class NoWorld final : public World {
 public:
  const std::vector<Signal>& signals() const override {
    static const std::vector<Signal> none;
    return none;
  }
  void read(std::span<double> /*values*/) const override {}
  void step(std::int64_t, const io::Batch&, io::Batch&) override {}
  Result<Done> command(const Command& command, std::int64_t /*now_ns*/) override {
    return not_understood("a board alone", word(command));
  }
  Result<Done> disturb(const Disturbance& disturbance, std::int64_t /*now_ns*/) override {
    return not_understood("a board alone", word(disturbance));
  }
  Result<bool> take_fault(const FaultSpec& /*fault*/) override { return false; }
  std::vector<std::uint32_t> applied_faults() const override { return {}; }
  std::string status() const override { return "alone"; }
};

}  // namespace whirl
