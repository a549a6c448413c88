// Nothing around a board but a supply: for one whose world is played to it from elsewhere. No signals; refuses all that
// is asked.
#pragma once
#include "harness/world/world.hpp"

namespace whirl {

class NoWorld final : public World {
 public:
  // supply_V: that the board's divider sees; 0: nobody tells it.
  explicit NoWorld(double supply_V = 0.0) : supply_V_(supply_V) {}

  const std::vector<Signal>& signals() const override {
    static const std::vector<Signal> none;
    return none;
  }
  void read(std::span<double> /*values*/) const override {}
  void step(std::int64_t t_ns, const io::Batch&, io::Batch& sensed) override {
    if (supply_V_ == 0.0) return;
    io::BodyMotion rest;  // in free fall: only what sees the supply is to be left on the board
    rest.bus_voltage_V = supply_V_;
    sensed.add(io::Kind::body_motion, 0, t_ns, rest);
  }
  Result<Done> command(const Command& command, std::int64_t /*now_ns*/) override {
    return not_understood("a board alone", word(command));
  }
  Result<Done> disturb(const Disturbance& disturbance, std::int64_t /*now_ns*/) override {
    return not_understood("a board alone", word(disturbance));
  }
  Result<bool> take_fault(const FaultSpec& /*fault*/) override { return false; }
  std::vector<std::uint32_t> applied_faults() const override { return {}; }
  std::string status() const override { return "alone"; }

 private:
  double supply_V_;
};

}  // namespace whirl
