// A USB bridge as an I2C master: one transfer at a time, each with its outcome and its times.
//
//   Transfer write, read, or write then read with a repeated START; 7-bit addresses
//   Times    begin_ns, end_ns: monotonic, around all reports of the transfer (with USB's share, so an
//            upper bound of the time on the wires)
//   Outcome  told by the bridge itself. After any but done and the NACKs' clean end the bridge is brought
//            back by recover() before transfer() returns. unplugged: this object serves no more
//            (plugged_bridge.hpp opens the next one)
//   Stop     a caller that may have to stop at any time says so by stop_when(): asked after each report, true ends what is
//            open, and the bridge is brought back without the pauses of a bus that has time. An urgent transfer, that
//            of the stop itself, goes on, with a time-out of its own
//   Threads  none; one caller
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/hid/hid_port.hpp"

namespace whirl::io {

enum class I2cOutcome : std::uint8_t {
  done,
  address_nack,      // nobody answers at this address
  data_nack,         // the target refused a byte
  bus_stuck,         // SDA or SCL stays low
  lost_arbitration,  // another master was faster (CP2112 only; the MCP2221A does not tell)
  busy,              // the bridge's engine does not take the transfer
  timed_out,         // no end within the settings' time, or no answer from the bridge
  unplugged,         // the bridge is gone
  refused,           // the bridge cannot do that: too long, speed out of range
};
const char* words_of(I2cOutcome outcome);

struct I2cTransfer {
  I2cOutcome outcome = I2cOutcome::done;
  std::vector<std::uint8_t> bytes;  // read; none unless done
  std::int64_t begin_ns = 0, end_ns = 0;
  std::string told;  // what the bridge said, where it says more than the outcome

  bool ok() const { return outcome == I2cOutcome::done; }
  Error error(const std::string& place) const;  // pre: !ok()
};

struct I2cBridgeSettings {
  int speed_Hz = 400'000;
  std::int64_t timeout_ns = 200'000'000;  // of a transfer, beyond its bytes' time
  std::int64_t urgent_timeout_ns =
      8'000'000;  // of an urgent one: two questions by full-speed USB, twice
};

class I2cBridge {
 public:
  virtual ~I2cBridge() = default;

  // Pre: address < 128, and something to write or to read.
  I2cTransfer transfer(std::uint8_t address, std::span<const std::uint8_t> write, std::size_t read,
                       bool urgent = false);
  I2cTransfer write(std::uint8_t address, std::span<const std::uint8_t> bytes) {
    return transfer(address, bytes, 0);
  }
  I2cTransfer read(std::uint8_t address, std::size_t count) { return transfer(address, {}, count); }
  // The addresses from 0x08 to 0x77 that acknowledge a read of one byte, which may have its effect there.
  // An error: what ended it.
  Result<std::vector<std::uint8_t>> scan();

  void stop_when(std::function<bool()> stopped) { stopped_ = std::move(stopped); }

  virtual Result<Done> set_speed(int speed_Hz) = 0;
  // Ends what runs; done when the engine is idle and both lines are high.
  virtual I2cOutcome recover() = 0;
  virtual std::string label() const = 0;  // "MCP2221A"

 protected:
  explicit I2cBridge(const I2cBridgeSettings& settings) : settings_(settings) {}

  // Fills in bytes, outcome and told.
  virtual void run(std::uint8_t address, std::span<const std::uint8_t> write, std::size_t read,
                   I2cTransfer& transfer) = 0;
  virtual std::int64_t now_ns() const = 0;

  // For run(): the transfer ends so. Returns false, for `return fail(...)`.
  static bool fail(I2cTransfer& transfer, I2cOutcome outcome, std::string told = {});
  // For run(), after each report that did not end the transfer: it has no time left, or is not wanted any more.
  bool late() const { return now_ns() > deadline_ns_ || given_up(); }
  bool given_up() const { return !urgent_ && stopped(); }
  // For recover(): between two cancels. EasyMCP2221 leaves 10 ms, Linux's driver 1 ms between reports.
  std::int64_t pause_after_cancel_ns() const {
    return urgent_ || stopped() ? 1'000'000 : 10'000'000;
  }

  I2cBridgeSettings settings_;

 private:
  bool stopped() const { return stopped_ && stopped_(); }

  std::function<bool()> stopped_;
  std::int64_t deadline_ns_ = 0;
  bool urgent_ = false;
};

enum class BridgeKind : std::uint8_t { mcp2221a, cp2112 };

// An empty serial number: the only one of its kind.
Result<std::unique_ptr<I2cBridge>> open_i2c_bridge(BridgeKind kind, const std::string& serial,
                                                   const I2cBridgeSettings& settings);
// The same over a port that is open already.
Result<std::unique_ptr<I2cBridge>> start_i2c_bridge(BridgeKind kind, std::unique_ptr<HidPort> port,
                                                    const I2cBridgeSettings& settings);

}  // namespace whirl::io
