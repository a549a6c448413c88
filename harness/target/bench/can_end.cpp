#include "harness/target/bench/can_end.hpp"

#include "io_bridges/socketcan/candump_log.hpp"
#include "io_bridges/socketcan/socket_can.hpp"

namespace whirl::bench {

Result<std::unique_ptr<io::CanPort>> socket_can_port(const CanBusLink& link) {
  auto port = io::SocketCan::open(link.interface, link.bit_rate_bps);
  if (!port) return port.error();
  return std::unique_ptr<io::CanPort>(std::make_unique<io::SocketCan>(std::move(port.value())));
}

CanEnd::CanEnd(CanBusLink link, CanMaker maker, std::string log)
    : link_(std::move(link)),
      maker_(std::move(maker)),
      log_file_(std::move(log)),
      monitor_(link_.bit_rate_bps) {}

Result<Done> CanEnd::open() {
  auto port = maker_(link_);
  if (!port) return port.error();
  port_ = std::move(port.value());
  if (!log_file_.empty()) log_.open(log_file_);
  return Done{};
}

void CanEnd::close() {
  port_.reset();
  log_.close();
}

Result<bool> CanEnd::send(const io::CanFrame& frame) {
  const auto sent = port_->send(frame);
  if (sent && !sent.value()) monitor_.on_queue_full();
  return sent;
}

Result<std::optional<io::CanArrival>> CanEnd::receive() {
  for (;;) {
    auto got = port_->receive();
    if (!got || !got.value()) return got;
    const io::CanArrival& arrival = *got.value();
    monitor_.on_arrival(arrival);
    if (arrival.trouble) {
      if (!arrival.trouble->bus_off) continue;
      return Error{ErrorKind::host, link_.interface,
                   "is bus-off: too many of its frames were not understood",
                   "bit rates, terminators and wires, then whirl bench check"};
    }
    if (log_) log_ << io::candump_line(arrival.host_ns, link_.interface, arrival.frame) << '\n';
    return got;
  }
}

std::vector<std::pair<std::string, std::string>> CanEnd::versions() const {
  return {{"link " + link_.name, port_ ? port_->version() : ""}};
}

std::vector<std::string> CanEnd::findings() const {
  const io::CanCounts& c = monitor_.counts();
  const bool quiet = c.dropped == 0 && c.error_frames == 0 && c.queue_full == 0;
  if (quiet) return {};
  return {link_.interface + ": " + monitor_.text()};
}

}  // namespace whirl::bench
