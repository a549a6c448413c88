// The stand as a technician has it: the ESC's serial line, the instruments, the flow generator.
//
//   Instruments  load cell (thrust, torque), ammeter and voltmeter in the supply's lead, an anemometer in
//                the flow, each with the errors of the stand's copy; nothing else of the world is read
//   ESC          typed commands and the binary stream; set-points on the bus are silent
//   Errors       a fault of the core, a reset, an answer that does not come, a motor that gave up:
//                one sentence each, and the calibration ends
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "harness/lockstep/lockstep.hpp"
#include "io_bridges/protocols/esc_stream.hpp"

namespace whirl::calibrate {

struct Instruments {
  double thrust_N = 0.0, torque_Nm = 0.0;   // load cell
  double current_A = 0.0, voltage_V = 0.0;  // meters
  double wind_mps = 0.0;                    // of the anemometer
};

class Bench {
 public:
  Bench(World& world, Target& target, std::uint16_t serial);
  ~Bench();
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  Result<Done> start();
  Result<Done> run(std::int64_t duration_ms);  // ms by ms; on_step sees each
  // Types a line and waits for the answer to it.
  Result<std::string> ask(const std::string& line);
  Result<Done> must(const std::string& line);  // as ask(); anything but "ok" is an error
  Result<Done> type(const std::string& line);  // without waiting for its answer
  // The flow goes to this speed along a ramp and is waited for.
  Result<Done> blow(double down_mps);
  Result<Done> silence();  // no more set-points on the bus

  const Instruments& instruments() const { return read_; }
  std::int64_t now_ns() const { return lockstep_.now_ns(); }
  void on_step(std::function<void(const Bench&)> sink) { sink_ = std::move(sink); }
  void on_sample(std::function<void(const io::EscSample&)> sink);

 private:
  Result<Done> step();
  Result<Done> on_messages();
  void read();

  World& world_;
  Lockstep lockstep_;
  std::uint16_t serial_;
  io::EscStreamDecoder line_;
  std::deque<std::string> answers_;  // not yet looked at
  std::size_t thrust_, torque_, current_, voltage_, wind_;
  Instruments read_;
  std::function<void(const Bench&)> sink_;
};

}  // namespace whirl::calibrate
