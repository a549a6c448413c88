#include "harness/target/copper_target.hpp"

#include <algorithm>
#include <string_view>

#include "io_bridges/copper/decoding.hpp"
#include "io_bridges/sigrok/capture.hpp"

namespace whirl {

copper::BoardNames copper_names(const BoardDescription& board) {
  copper::BoardNames names;
  for (const BoardDevice& device : board.devices) names.devices.push_back(device.name);
  for (const BoardPin& pin : board.pins) names.pins.push_back(pin.name);
  names.bauds = board.bauds_Hz();
  return names;
}

CopperTarget::CopperTarget(CopperOptions options, std::unique_ptr<Target> target)
    : options_(std::move(options)), target_(std::move(target)) {}

Result<Done> CopperTarget::start() {
  copper::Decoding decoding(options_.names);
  const auto read = sigrok::read_capture(options_.file, options_.vcd_rate_Hz, {}, decoding);
  if (!read) return read.error();
  if (decoding.error()) {
    const Error& e = *decoding.error();
    return Error{e.kind, options_.file, e.place + " " + e.what, e.cure};
  }
  seen_ = decoding.in_order();
  for (const std::string& bus : decoding.buses()) buses_.insert(bus);
  pins_ = decoding.pins();
  ready_ = decoding.ready();
  end_ns_ = decoding.end_ns();
  if (buses_.empty() && pins_.empty()) {
    return Error{ErrorKind::bad_input, options_.file, "has no wire of this board's buses or pins",
                 "channels are named as i2c3_scl, spi1_cs_DEVICE, pin_NAME"};
  }
  next_ = std::make_unique<io::Reader>(seen_.bytes());
  more_ = next_->next();
  return target_->start();
}

void CopperTarget::run(std::int64_t until_ns, const io::Batch& sensed) {
  until_ns_ = until_ns;
  target_->run(until_ns, sensed);
}

bool CopperTarget::is_replaced(const io::Header& header) const {
  switch (header.kind) {
    case io::Kind::i2c_transaction:
      return buses_.count("i2c" + std::to_string(header.port)) != 0;
    case io::Kind::spi_transaction:
      return buses_.count("spi" + std::to_string(header.port)) != 0;
    case io::Kind::data_ready:
      return ready_.count(header.port) != 0;
    case io::Kind::pin_edge:
      return pins_.count(header.port) != 0;
    default:
      return false;
  }
}

void CopperTarget::replace(const io::Batch& own, io::Batch& happened) {
  for (io::Reader r(own.bytes()); r.next();) {
    if (!is_replaced(r.header())) happened.add(r.header(), r.payload());
  }
  for (; more_ && next_->header().t_ns <= until_ns_; more_ = next_->next()) {
    if (next_->header().kind == io::Kind::uart_received) continue;  // the board's own went on
    happened.add(next_->header(), next_->payload());
  }
}

Result<TargetState> CopperTarget::arrive(io::Batch& happened) {
  io::Batch own;
  const auto state = target_->arrive(own);
  replace(own, happened);
  return state;
}

// Within a step it ends with the run.
void CopperTarget::tell_end(io::Batch& happened) {
  constexpr std::int64_t kStep_ns = 1'000'000;
  constexpr std::string_view kWhy = "the capture ends here";
  if (end_ns_ + kStep_ns >= until_ns_) return;
  for (const std::string& bus : buses_) {
    const bool spi = bus.starts_with("spi");
    if (!spi && !bus.starts_with("i2c")) continue;
    const io::BusUnread rest{end_ns_, static_cast<std::uint8_t>(spi ? 1 : 0), {}};
    happened.add(io::Kind::bus_unread, static_cast<std::uint16_t>(std::stoi(bus.substr(3))),
                 until_ns_, rest, kWhy.data(), static_cast<std::uint32_t>(kWhy.size()));
  }
  end_ns_ = until_ns_;  // once
}

void CopperTarget::stop(io::Batch& happened) {
  io::Batch own;
  target_->stop(own);
  replace(own, happened);
  tell_end(happened);
}

std::vector<std::pair<std::string, std::string>> CopperTarget::versions() const {
  auto all = target_->versions();
  all.emplace_back("copper", options_.file);
  return all;
}

}  // namespace whirl
