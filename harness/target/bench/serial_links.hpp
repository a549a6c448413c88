// The board's serial line, and instruments that tell what they measure in lines of text.
#pragma once
#include <deque>
#include <optional>

#include "harness/target/bench/bench_description.hpp"
#include "harness/target/bench/link.hpp"
#include "io_bridges/serial/line_cutter.hpp"
#include "io_bridges/serial/tty.hpp"

namespace whirl::bench {

// uart_frame messages out, uart_received back: one for what has come by a turn, at its time.
class BoardSerial final : public Link {
 public:
  explicit BoardSerial(SerialLink link) : link_(std::move(link)) {}

  std::string name() const override { return link_.name; }
  Result<Done> open() override;
  bool take(const io::Reader& order, std::int64_t due_host_ns) override;
  Result<Done> serve(std::int64_t now_host_ns, Arrivals& arrivals) override;
  std::int64_t next_due_host_ns() const override;
  int file() const override { return tty_ ? tty_->file() : -1; }
  void close() override { tty_.reset(); }
  std::vector<std::pair<std::string, std::string>> versions() const override;

 private:
  struct Waiting {
    std::int64_t due_host_ns;
    std::vector<std::uint8_t> bytes;
  };
  SerialLink link_;
  std::optional<io::Tty> tty_;
  std::deque<Waiting> waiting_;
};

// instrument_reading messages, a number each, of the time at which it was measured.
class InstrumentLine final : public Link {
 public:
  // first_port: of its first reading among those of the bench.
  InstrumentLine(Instrument instrument, std::uint16_t first_port)
      : instrument_(std::move(instrument)), first_port_(first_port) {}

  std::string name() const override { return instrument_.name; }
  Result<Done> open() override;
  bool take(const io::Reader&, std::int64_t) override { return false; }
  Result<Done> serve(std::int64_t now_host_ns, Arrivals& arrivals) override;
  int file() const override { return tty_ ? tty_->file() : -1; }
  void close() override { tty_.reset(); }
  std::vector<std::pair<std::string, std::string>> versions() const override;

  std::uint64_t lines() const { return lines_; }
  std::uint64_t short_lines() const { return short_; }  // with fewer numbers than are read

 private:
  void read_line(std::string_view line, std::int64_t now_host_ns, Arrivals& arrivals);

  Instrument instrument_;
  std::uint16_t first_port_;
  std::optional<io::Tty> tty_;
  io::LineCutter cutter_;
  std::uint64_t lines_ = 0, short_ = 0;
};

}  // namespace whirl::bench
