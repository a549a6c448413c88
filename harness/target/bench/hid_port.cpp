#include "harness/target/bench/hid_port.hpp"

#include <cmath>

#include "base/check.hpp"

namespace whirl::bench {
namespace {

class HidBridgePort final : public I2cPort {
 public:
  HidBridgePort(const BridgeLink& link, BridgeOpener opener)
      : link_(link), opener_(std::move(opener)) {}

  Result<Done> open() override {
    const auto kind = link_.kind == "cp2112" ? io::BridgeKind::cp2112 : io::BridgeKind::mcp2221a;
    io::I2cBridgeSettings settings;
    settings.speed_Hz = static_cast<int>(std::lround(link_.rate_Hz));
    settings.timeout_ns = link_.timeout_ns;
    settings.urgent_timeout_ns = link_.urgent_timeout_ns;
    auto opened = opener_(kind, link_.serial, settings);
    if (!opened) return opened.error();
    bridge_ = std::move(opened.value());
    return Done{};
  }

  Result<TransferOutcome> transfer(const Transfer& transfer) override {
    WHIRL_CHECK(bridge_ != nullptr);
    io::I2cTransfer made =
        bridge_->transfer(transfer.address, transfer.write, transfer.read, transfer.urgent);
    if (made.outcome == io::I2cOutcome::unplugged) return made.error(link_.name);
    TransferOutcome outcome;
    outcome.acked = made.ok();
    outcome.timed_out = !made.ok() && made.outcome != io::I2cOutcome::address_nack &&
                        made.outcome != io::I2cOutcome::data_nack;
    outcome.bytes = std::move(made.bytes);
    outcome.end_host_ns = made.end_ns;
    return outcome;
  }

  void stop_when(std::function<bool()> stopped) override {
    WHIRL_CHECK(bridge_ != nullptr);
    bridge_->stop_when(std::move(stopped));
  }
  void close() override { bridge_.reset(); }
  std::string version() const override {
    return bridge_->label() + (link_.serial.empty() ? "" : " " + link_.serial);
  }

 private:
  BridgeLink link_;
  BridgeOpener opener_;
  std::unique_ptr<io::I2cBridge> bridge_;
};

}  // namespace

Result<std::unique_ptr<I2cPort>> hid_port(const BridgeLink& link) {
  return hid_port_over(link, io::open_i2c_bridge);
}

std::unique_ptr<I2cPort> hid_port_over(const BridgeLink& link, BridgeOpener opener) {
  return std::make_unique<HidBridgePort>(link, std::move(opener));
}

}  // namespace whirl::bench
