// What a logic analyser saw, through libsigrok: a file that one has written, or a device that hangs on this host.
//
//   Files    .sr (sigrok's own), .vcd and whatever else libsigrok reads by its contents. A VCD has no sample rate: it
//            is looked at `vcd_rate_Hz` times a second, and its edges are told to that; its x and z read as 0
//   Devices  by the driver's name and a connection ("usb 1.4", "0925.3881"), as sigrok-cli takes them
//   Errors   bad_input, one line with its cure: no such driver, nothing there, no permission, busy, another model, no
//            such channel, a rate that the device has not
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/copper/edge_sink.hpp"

namespace whirl::sigrok {

// Names of channels that are another one here: {"D0", "i2c2_scl"}. Of a file those that are not named keep theirs; of a
// device only those that are named are looked at.
using Renamed = std::map<std::string, std::string>;

// All of it, at once.
Result<Done> read_capture(const std::string& path, double vcd_rate_Hz, const Renamed& names,
                          copper::EdgeSink& sink);

struct DeviceOptions {
  std::string driver;      // "fx2lafw"
  std::string connection;  // empty: the first that is found
  std::string model;       // that it must be, or a part of its name; empty: any
  double rate_Hz = 0.0;
  Renamed names;
};

class Device {
 public:
  // Opens it, sets its rate and its channels.
  static Result<std::unique_ptr<Device>> open(const DeviceOptions& options);
  ~Device();

  std::string version() const;  // what it calls itself, and libsigrok's version
  // Samples until stop() is called, from another thread, or the device ends by itself.
  // Errors  host: it was unplugged, or lost samples
  Result<Done> run(copper::EdgeSink& sink);
  void stop();

 private:
  struct Inner;
  explicit Device(std::unique_ptr<Inner> inner);
  std::unique_ptr<Inner> inner_;
};

// Of what libsigrok and libusb say when a device cannot be opened.
Error no_device(const std::string& place, const std::string& said);

}  // namespace whirl::sigrok
