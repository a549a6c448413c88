// A DroneCAN node with an MS5611: its program converts, compensates by the sheet and sends on CAN.
//
//   Part     command by command, on an I2C of the node's own, with its faults (ms5611.hpp)
//   Sends    StaticPressure of three conversions, then StaticTemperature of one, each of 10 ms at OSR 4096;
//            variance as the sheet's RMS. An ADC of 0 (no conversion, or cut short) sends nothing
//   Silence  five of those in a row: the part is reset
//   Source   MS5611-01BA03 data sheet: commands, compensation of second order
#pragma once
#include "io_bridges/devices/dronecan_node.hpp"
#include "io_bridges/devices/ms5611.hpp"

namespace whirl::io {

class AirNode {
 public:
  AirNode(EventQueue& queue, CanBus& bus, const DroneCanNode::Setup& node,
          const Ms5611::Params& part, Ms5611::Sense sense, FaultBook* faults, FindingSink findings);

 private:
  enum class Next : std::uint8_t { reset, read_prom, convert };
  void step();
  void command(std::uint8_t code);
  std::uint32_t ask(std::uint8_t code, int bytes);
  void collect();
  void publish();

  EventQueue& queue_;
  std::uint8_t address_;
  DroneCanNode node_;
  Ms5611 part_;
  Event due_;
  Next next_ = Next::reset;
  ms5611::Prom prom_{};
  unsigned slot_ = 0, bad_ = 0;
  bool converting_ = false, of_pressure_ = false;
  double pressure_counts_ = 0.0, temperature_counts_ = 0.0;
};

}  // namespace whirl::io
