// The thrust stand: the rotor in its air, the supply, the load cell and who commands the ESC. The
// motor itself is in the board's process, behind its bridge (io_bridges/rack/models/power_stage.hpp).
//
//   Step     takes speed and charge of the last millisecond, moves the rotor's inflow and the
//            supply by it, tells the torque coefficient, the supply and what goes over the bus
//   Command  those of esc_master.hpp, and Brake
//   Air      of the plan's density; Wind down the shaft, the flow generator's; without a duration for ever
//   Faults   supply_dip (value: volts below)
//   Meters   load cell, ammeter, voltmeter and anemometer as bought ones read; without a tolerance the truth
//   Left out the flow's own turbulence
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/stand/esc_master.hpp"
#include "harness/stand/stand_params.hpp"
#include "harness/world/world.hpp"
#include "plant/battery/battery.hpp"
#include "plant/rotor/rotor.hpp"
#include "plant/sensors/load_cell.hpp"

namespace whirl::stand {

class StandWorld : public World {
 public:
  StandWorld(const StandParams& params, std::uint64_t seed);

  const std::vector<Signal>& signals() const override { return signals_; }
  void read(std::span<double> values) const override;
  void step(std::int64_t t_ns, const io::Batch& happened, io::Batch& sensed) override;
  Result<Done> command(const Command& command, std::int64_t now_ns) override;
  Result<Done> disturb(const Disturbance& disturbance, std::int64_t now_ns) override;
  std::int64_t command_on_wire_ns() const override { return master_.on_wire_ns(); }
  Result<bool> take_fault(const FaultSpec& fault) override;
  std::vector<std::uint32_t> applied_faults() const override { return faults_.acted(); }
  const std::vector<DrawnPart>& drawn_parts() const override { return params_.drawn; }
  const std::vector<std::string>& doubts() const override { return params_.doubts; }
  Result<double> shortest_rise_s(double from_N, double to_N, double current_A) const override;
  std::string status() const override;
  Result<Done> say(const std::string& line) override { return master_.ask(line); }
  const std::vector<std::string>& heard() const override { return master_.heard(); }

 private:
  struct Flow {  // a ramp from one speed to another
    double from_mps = 0.0, to_mps = 0.0;
    std::int64_t start_ns = 0, edge_ns = 1;
    double at(std::int64_t t_ns) const;
  };

  void on_messages(const io::Batch& happened);
  void move(std::int64_t t_ns);
  void send(std::int64_t t_ns, io::Batch& sensed);
  void blow(double to_mps, std::int64_t start_ns, std::int64_t edge_ns);
  void add_signal(std::string name, Dimension dimension, std::string about,
                  std::function<double()> value);
  void name_signals();

  StandParams params_;
  plant::Rotor rotor_;
  plant::Battery battery_;
  plant::LoadCell cell_;
  EscMaster master_;
  io::ShaftState shaft_;
  plant::RotorLoads loads_;
  plant::LoadReading weighed_;
  Flow flow_;
  std::int64_t calm_from_ns_ = INT64_MAX, calm_edge_ns_ = 1;
  double wind_mps_ = 0.0, brake_Nm_ = 0.0;
  TimedFaults faults_;
  std::uint64_t shots_ = 0, resets_ = 0;
  double sensed_V() const;  // what the copy's divider and converter make of the bus voltage
  std::vector<Signal> signals_;
  std::vector<std::function<double()>> values_;
  std::int64_t now_ns_ = 0;
};

}  // namespace whirl::stand
