// This host's end of a CAN bus, as all links that hang on one use it: opened by its maker, counted, logged.
//
//   Log      a file of candump's format of all good frames, ours too
//   Bus-off  an error of the host, as is a lost adapter: nothing gets through any more
//   Threads  send() and receive() may each be another's; send() is called by one at a time
#pragma once
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/target/bench/bench_description.hpp"
#include "io_bridges/socketcan/can_monitor.hpp"
#include "io_bridges/socketcan/can_port.hpp"

namespace whirl::bench {

// Opens it. Errors  bad_input: see io_bridges/socketcan/can_interface.hpp
using CanMaker = std::function<Result<std::unique_ptr<io::CanPort>>(const CanBusLink&)>;
Result<std::unique_ptr<io::CanPort>> socket_can_port(const CanBusLink& link);

class CanEnd {
 public:
  // log: its file; empty: none.
  CanEnd(CanBusLink link, CanMaker maker, std::string log);

  Result<Done> open();
  void close();
  bool is_open() const { return port_ != nullptr; }
  int file() const { return port_ ? port_->file() : -1; }
  // False: no room for it now.
  Result<bool> send(const io::CanFrame& frame);
  // A good frame that has come, ours once it has passed; nothing: none has.
  Result<std::optional<io::CanArrival>> receive();

  const CanBusLink& link() const { return link_; }
  const io::CanMonitor& monitor() const { return monitor_; }
  std::vector<std::pair<std::string, std::string>> versions() const;
  std::vector<std::string> findings() const;

 private:
  CanBusLink link_;
  CanMaker maker_;
  std::string log_file_;
  std::unique_ptr<io::CanPort> port_;
  io::CanMonitor monitor_;
  std::ofstream log_;
};

}  // namespace whirl::bench
