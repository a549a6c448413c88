// A world: all that surrounds the firmware in one run (vehicle and ground station, or a stand).
//
//   Time     step(t) moves the world to t with what the target did until the step's start; the first
//            call is step(0), which only fills `sensed`. Steps are 1 ms. No clock, no thread, no file.
//   Signals  truth by name, in SI, read after each step. Names are lower case without the unit
//            ("height", "tilt", "thrust_1"); logs append the unit of the dimension ("height_m").
//   Input    commands, disturbances (request.hpp) and faults; what it does not understand it refuses
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "harness/world/drawn_part.hpp"
#include "harness/world/fault.hpp"
#include "harness/world/request.hpp"
#include "harness/world/signal_table.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl {

class World {
 public:
  virtual ~World() = default;

  virtual const std::vector<Signal>& signals() const = 0;
  virtual void read(std::span<double> values) const = 0;  // in the order of signals()
  // How old each of these values is, where an instrument gives one now and then; empty: all are of the step's time.
  virtual std::span<const std::int64_t> ages_ns() const { return {}; }

  // Which messages it wants beside those of the first board, which it surrounds.
  virtual bool hears(const io::Header& /*of_another_board*/) const { return false; }
  virtual void step(std::int64_t t_ns, const io::Batch& happened, io::Batch& sensed) = 0;

  // At now_ns. Errors  bad_input, the place being the key that it is about: not understood, or out of
  //                    the range of this world
  virtual Result<Done> command(const Command& command, std::int64_t now_ns) = 0;
  virtual Result<Done> disturb(const Disturbance& disturbance, std::int64_t now_ns) = 0;

  // Text lines for t:ask: one to the firmware, and all that came from it so far.
  // Errors  bad_input: no such line here; the question before is not answered yet, and its late answer
  //         could not be told from that to this one
  virtual Result<Done> say(const std::string& /*line*/) {
    return Error{ErrorKind::bad_input, "", "nobody listens to lines here", "t:ask is for stands"};
  }
  virtual const std::vector<std::string>& heard() const {
    static const std::vector<std::string> nothing;
    return nothing;
  }

  // In what this copy of the hardware differs from the drawing; empty: in nothing.
  virtual const std::vector<DrawnPart>& drawn_parts() const {
    static const std::vector<DrawnPart> nothing;
    return nothing;
  }

  // What speaks against a part's file, and so against what is simulated with it; empty: nothing.
  virtual const std::vector<std::string>& doubts() const {
    static const std::vector<std::string> nothing;
    return nothing;
  }

  // How fast the thrust of this copy could rise, 10 to 90 %, in the air that there is, were this current in its
  // windings throughout.
  // Errors  bad_input: no rise, or beyond that current; not one rotor's world
  virtual Result<double> shortest_rise_s(double /*from_N*/, double /*to_N*/,
                                         double /*current_A*/) const {
    return Error{ErrorKind::bad_input, "", "has no rotor of its own here",
                 "t:shortest_rise is for stands"};
  }

  // What the firmware told of itself in words, all so far: STATUSTEXT of a flight.
  virtual const std::vector<std::string>& told_texts() const {
    static const std::vector<std::string> nothing;
    return nothing;
  }

  // When the last bit of the latest command had passed the wire; negative: not known (yet).
  virtual std::int64_t command_on_wire_ns() const { return -1; }

  // True: this kind is the world's to apply (capture lost, supply dip), and it will report its
  // number in applied_faults() once it has acted. False: it is the board's.
  // Errors  bad_input: it is the world's, but not at this place (a motor that is not there)
  virtual Result<bool> take_fault(const FaultSpec& fault) = 0;
  virtual std::vector<std::uint32_t> applied_faults() const = 0;

  virtual std::string status() const = 0;  // a few words for the progress line: "flying, 1.08 m"
};

}  // namespace whirl
