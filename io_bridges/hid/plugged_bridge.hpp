// A bridge that may be unplugged and plugged in again, known by its kind and serial number.
//
//   Unplug   the transfer under way ends as unplugged; so does each one until it is back, without waiting
//   Replug   tried by the next transfer, at most once each retry_ns; the bridge gets its settings again
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "io_bridges/hid/i2c_bridge.hpp"

namespace whirl::io {

class PluggedBridge {
 public:
  using Open = std::function<Result<std::unique_ptr<I2cBridge>>()>;
  using Clock = std::function<std::int64_t()>;

  PluggedBridge(Open open, Clock now_ns, std::int64_t retry_ns = 100'000'000)
      : open_(std::move(open)), now_ns_(std::move(now_ns)), retry_ns_(retry_ns) {}

  bool plugged() const { return bridge_ != nullptr; }
  std::uint64_t times_opened() const { return times_opened_; }

  I2cTransfer transfer(std::uint8_t address, std::span<const std::uint8_t> write,
                       std::size_t read) {
    I2cTransfer transfer;
    transfer.begin_ns = transfer.end_ns = now_ns_();
    if (!plugged()) open(transfer.begin_ns);
    if (!plugged()) {
      transfer.outcome = I2cOutcome::unplugged;
      transfer.told = why_not_;
      return transfer;
    }
    transfer = bridge_->transfer(address, write, read);
    if (transfer.outcome == I2cOutcome::unplugged) bridge_.reset();
    return transfer;
  }

 private:
  void open(std::int64_t now) {
    if (times_tried_ > 0 && now < next_try_ns_) return;
    ++times_tried_;
    next_try_ns_ = now + retry_ns_;
    auto opened = open_();
    if (!opened) {
      why_not_ = opened.error().message();
      return;
    }
    bridge_ = std::move(opened.value());
    ++times_opened_;
  }

  Open open_;
  Clock now_ns_;
  std::int64_t retry_ns_;
  std::int64_t next_try_ns_ = 0;
  std::uint64_t times_tried_ = 0, times_opened_ = 0;
  std::string why_not_;
  std::unique_ptr<I2cBridge> bridge_;
};

}  // namespace whirl::io
