// libsigrok's feed of packets, into the samples of the wires that are wanted.
#pragma once
#include <libsigrok/libsigrok.h>

#include <optional>
#include <string>

#include "base/result.hpp"
#include "io_bridges/sigrok/capture.hpp"
#include "io_bridges/sigrok/sample_reader.hpp"

namespace whirl::sigrok {

struct Feed {
  const Renamed& names;
  bool only_named = false;  // of a device
  copper::EdgeSink& sink;
  double rate_Hz = 0.0;  // as the packets or the device say; 0: not yet
  std::optional<SampleReader> reader = {};
  std::optional<Error> error = {};

  void on_packet(const sr_dev_inst* device, const sr_datafeed_packet* packet);

 private:
  void begin(const sr_dev_inst* device);
};

// For sr_session_datafeed_callback_add, with a Feed behind.
void feed_callback(const sr_dev_inst* device, const sr_datafeed_packet* packet, void* feed);

// The part behind the last dot: a VCD's wires carry the names of their scopes.
std::string own_name(const std::string& channel);

}  // namespace whirl::sigrok
