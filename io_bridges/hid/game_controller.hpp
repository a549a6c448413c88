// A game controller or RC trainer stick on USB: axes and buttons by its own report descriptor.
//
//   Axes     usages X, Y, Z, Rx, Ry, Rz, slider, dial, wheel of the generic desktop page, and rudder and throttle of
//            the simulation page, in the order of the descriptor; -1 to 1, or 0 to 1 where there is no middle
//   Middle   within the dead zone it is 0; beyond, the rest of the way is spread over the whole range, so that
//            nothing jumps at the zone's edge
//   Buttons  by number from 1 (usage page 9), variable or array
//   Lost     unplugged, or no report for `silence_ns` where that is set (many send only on change: 0 is off):
//            present is false and stays so; the axes keep what they were, for who wants to see it
//   Errors   no axis in the descriptor, a calibration that does not rise: bad_input
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/hid/hid_port.hpp"
#include "io_bridges/hid/hid_report_descriptor.hpp"

namespace whirl::io {

// Pre: min < max, min <= centre <= max, dead zone at least 0. In counts, as the device reports them.
struct AxisCalibration {
  double min = 0.0, centre = 0.0, max = 0.0;
  double dead_zone = 0.0;  // to either side of the centre
  bool has_middle = true;  // false: from 0 at min to 1 at max
  bool reversed = false;

  bool rises() const { return min < max && min <= centre && centre <= max && dead_zone >= 0.0; }
  double value_of(double counts) const;
};

struct StickState {
  bool present = true;
  std::string why_lost;
  std::int64_t t_ns = 0;  // of the newest report, monotonic; 0: none yet
  std::vector<double> axes;
  std::vector<bool> buttons;  // [0] is button 1
};

class GameController {
 public:
  // The calibration of an axis for which none is given is its logical range, the middle of it and no dead zone.
  static Result<GameController> start(std::unique_ptr<HidPort> port,
                                      std::vector<AxisCalibration> calibrations,
                                      std::int64_t silence_ns = 0);

  // Takes in what has come; waits for a report at most so long.
  const StickState& poll(std::int64_t timeout_ns);
  std::size_t axes() const { return axes_.size(); }
  std::uint32_t usage_of_axis(std::size_t i) const { return axes_[i].usage; }
  std::int32_t counts_of_axis(std::size_t i) const { return counts_[i]; }  // for who calibrates

 private:
  GameController(std::unique_ptr<HidPort> port, HidLayout layout)
      : port_(std::move(port)), layout_(std::move(layout)) {}
  void take(const HidReport& report, std::int64_t now_ns);
  void lose(std::string why);

  std::unique_ptr<HidPort> port_;
  HidLayout layout_;
  std::vector<HidField> axes_;
  std::vector<AxisCalibration> calibrations_;
  std::vector<std::int32_t> counts_;
  StickState state_;
  std::int64_t silence_ns_ = 0;
};

}  // namespace whirl::io
