// I2C of the board by a bridge whose transfers take milliseconds: they are made in a thread of their own.
//
//   Orders     i2c_order messages, in order, each not before its time; i2c_reply back, of the time at which the
//              transfer had ended
//   Late       an order that waits behind a slow one is not dropped: how late it was, its reply's time tells
//   Heartbeat  without a turn of the bench's loop for so long the thread makes safe by itself
//   Safe       `safe` goes out at once and then every 10 ms, for the far end's watchdog asks for set-points;
//              and once more when the link is closed. A transfer that is open then is ended: nobody waits for a target
//              that does not answer
#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/link.hpp"

namespace whirl::bench {

struct Transfer {
  std::uint8_t address = 0;
  std::vector<std::uint8_t> write;
  std::uint16_t read = 0;
  bool urgent = false;  // it is not ended by stop_when(), and has a short time-out
};

struct TransferOutcome {
  bool acked = false, timed_out = false;
  std::vector<std::uint8_t> bytes;
  std::int64_t end_host_ns = 0;
};

// A master that waits for its transfers; used by one thread at a time.
class I2cPort {
 public:
  virtual ~I2cPort() = default;
  virtual Result<Done> open() = 0;
  // Errors  host: the bridge was unplugged, or does not answer
  virtual Result<TransferOutcome> transfer(const Transfer& transfer) = 0;
  // Once, when it is open. Asked while a transfer is: true ends it as timed out, unless it is urgent.
  virtual void stop_when(std::function<bool()> /*stopped*/) {}
  virtual void close() = 0;
  virtual std::string version() const = 0;  // "MCP2221A 0002137245, firmware 1.2"
};

using BridgeMaker = std::function<Result<std::unique_ptr<I2cPort>>(const BridgeLink&)>;

struct BridgeOptions {
  std::string name;
  std::uint16_t bus = 2;
  Transfer safe;                  // the zero set-point
  std::int64_t heartbeat_ns = 0;  // of the host; 0: none
};

class BridgeThread final : public Link {
 public:
  BridgeThread(BridgeOptions options, std::unique_ptr<I2cPort> port);
  ~BridgeThread() override;

  std::string name() const override { return options_.name; }
  Result<Done> open() override;
  bool take(const io::Reader& order, std::int64_t due_host_ns) override;
  Result<Done> serve(std::int64_t now_host_ns, Arrivals& arrivals) override;
  int file() const override { return woken_; }
  void make_safe() override;
  void close() override;
  std::vector<std::pair<std::string, std::string>> versions() const override;
  bool heartbeat_lost() const override;

 private:
  struct Order {
    std::int64_t due_host_ns;
    std::uint32_t number;
    Transfer transfer;
  };
  void work();
  // Waits for the next thing to do; none: the end.
  bool next(std::unique_lock<std::mutex>& lock, Order& order);
  void answer(const Order& order, const Result<TransferOutcome>& outcome);
  // Pre: the mutex is held. True: it is safe, or has just become so, for nobody has turned the loop.
  bool is_safe(std::int64_t now_host_ns);

  BridgeOptions options_;
  std::unique_ptr<I2cPort> port_;
  std::string version_;
  int woken_ = -1;  // an eventfd
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Order> orders_;
  Arrivals answers_;
  std::optional<Error> error_;
  std::int64_t heard_host_ns_ = 0, next_safe_ns_ = 0;
  bool safe_ = false, alone_ = false, ending_ = false;
  std::thread thread_;
};

}  // namespace whirl::bench
