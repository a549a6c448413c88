#include "harness/cli/scope_command.hpp"

#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <deque>
#include <memory>

#include "base/interruption.hpp"
#include "harness/cli/bench_choice.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/spark_line.hpp"
#include "harness/pacing/host_clock.hpp"
#include "harness/target/bench/serial_links.hpp"
#include "io_bridges/protocols/esc_codec.hpp"

namespace whirl::cli {
namespace {

constexpr std::size_t kMost_columns = 200;
constexpr std::int64_t kStatus_every_ns = 50'000'000;  // as the protocol asks for it

struct Row {
  std::string name, unit;
  double now = std::nan("");
  double low = std::nan(""), high = std::nan("");
  double sum = 0.0;  // of this column
  int count = 0;
  std::deque<double> columns = {};

  void on_value(double x) {
    now = x;
    low = std::fmin(low, x);  // fmin and fmax leave a NaN aside
    high = std::fmax(high, x);
    sum += x;
    ++count;
  }
  void end_column() {
    columns.push_back(count == 0 ? std::nan("") : sum / count);
    if (columns.size() > kMost_columns) columns.pop_front();
    sum = 0.0;
    count = 0;
  }
};

// What a terminal is set to while keys are read one by one, and back.
class Keys {
 public:
  Keys() : is_terminal_(isatty(STDIN_FILENO) == 1 && tcgetattr(STDIN_FILENO, &before_) == 0) {
    if (!is_terminal_) return;
    termios raw = before_;
    raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    raw.c_cc[VMIN] = 0;
    raw.c_cc[VTIME] = 0;
    tcsetattr(STDIN_FILENO, TCSANOW, &raw);
  }
  ~Keys() {
    if (is_terminal_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;
  char pressed() const {  // 0: none
    char key = 0;
    return is_terminal_ && read(STDIN_FILENO, &key, 1) == 1 ? key : '\0';
  }

 private:
  bool is_terminal_;
  termios before_{};
};

class Scope {
 public:
  Scope(const bench::BenchDescription& bench, const ScopeOptions& options)
      : bench_(bench),
        options_(options),
        column_s_(options.column_s),
        terminal_(isatty(STDOUT_FILENO) == 1) {}

  Result<Done> open(const bench::BridgeMaker& bridge) {
    std::uint16_t port = 0;
    for (const bench::Instrument& instrument : bench_.instruments) {
      for (const bench::Reading& r : instrument.readings)
        rows_.push_back({r.signal, si_symbol(r.dimension)});
      lines_.push_back(std::make_unique<bench::InstrumentLine>(instrument, port));
      port = static_cast<std::uint16_t>(port + instrument.readings.size());
      if (const auto opened = lines_.back()->open(); !opened) return opened;
    }
    for (const bench::BridgeLink& link : bench_.bridges) {
      auto made = bridge(link);
      if (!made) return made.error();
      if (const auto opened = made.value()->open(); !opened) return opened;
      const std::uint8_t address = find_esc(*made.value());
      if (address == 0)
        return Error{ErrorKind::bad_input, link.name, "no ESC answers", "is it powered?"};
      escs_.push_back({std::move(made.value()), address, rows_.size()});
      rows_.push_back({link.name + " speed", "rpm"});
      rows_.push_back({link.name + " current", "A"});
      rows_.push_back({link.name + " unanswered", ""});
    }
    if (!rows_.empty()) return Done{};
    return Error{ErrorKind::bad_input, bench_.file, "has nothing that a scope can show",
                 "instruments or bridges"};
  }

  int run() {
    const Keys keys;
    const std::int64_t zero_ns = clock_.now_ns();
    std::int64_t column_ns = zero_ns;
    if (terminal_) std::fputs("\x1b[2J", stdout);
    for (;;) {
      const std::int64_t now_ns = clock_.now_ns();
      if (const auto served = serve(now_ns); !served) return leave(complain(served.error()));
      if (static_cast<double>(now_ns - column_ns) >= column_s_ * 1e9) {
        column_ns = now_ns;
        for (Row& row : rows_) row.end_column();
        if (!held_) show(static_cast<double>(now_ns - zero_ns) * 1e-9);
      }
      const bool over =
          options_.seconds > 0.0 && static_cast<double>(now_ns - zero_ns) >= options_.seconds * 1e9;
      if (over || interrupted_by() != 0 || !act_on(keys.pressed())) return leave(0);
      wait(now_ns);
    }
  }

 private:
  struct Esc {
    std::unique_ptr<bench::I2cPort> port;
    std::uint8_t address;
    std::size_t row;
    std::int64_t next_ns = 0;
    int unanswered = 0;
  };

  static std::uint8_t find_esc(bench::I2cPort& port) {
    for (std::uint8_t address = io::esc_address(1); address < io::esc_address(9); ++address) {
      const auto got = port.transfer({address, {}, 6});
      if (got && got.value().acked) return address;
    }
    return 0;
  }

  Result<Done> serve(std::int64_t now_ns) {
    bench::Arrivals arrivals;
    for (const auto& line : lines_) {
      if (const auto served = line->serve(now_ns, arrivals); !served) return served;
    }
    for (const bench::Arrival& arrival : arrivals) {
      io::InstrumentReading reading;
      std::memcpy(&reading, arrival.payload.data(), sizeof reading);
      rows_[arrival.port].on_value(reading.value);
    }
    for (Esc& esc : escs_) {
      if (now_ns < esc.next_ns) continue;
      esc.next_ns = now_ns + kStatus_every_ns;
      const auto got = esc.port->transfer({esc.address, {}, 6});
      if (!got) return got.error();
      const auto status = io::unpack_status(esc.address, got.value().bytes);
      if (!got.value().acked || !status) ++esc.unanswered;
      rows_[esc.row + 2].on_value(esc.unanswered);
      if (!got.value().acked || !status) continue;
      rows_[esc.row].on_value(status->speed_rpm);
      rows_[esc.row + 1].on_value(status->bus_current_A);
    }
    return Done{};
  }

  void wait(std::int64_t now_ns) {
    constexpr std::int64_t kTurn_ns = 5'000'000;
    std::vector<pollfd> files;
    for (const auto& line : lines_) files.push_back({line->file(), POLLIN, 0});
    if (isatty(STDIN_FILENO) == 1) files.push_back({STDIN_FILENO, POLLIN, 0});
    clock_.wait_for(files, now_ns + kTurn_ns);
  }

  bool act_on(char key) {
    switch (key) {
      case 'q':
        return false;
      case ' ':
        held_ = !held_;
        break;
      case '+':
        column_s_ = std::max(0.01, column_s_ / 2);
        break;
      case '-':
        column_s_ = std::min(10.0, column_s_ * 2);
        break;
      case 'r':
        for (Row& row : rows_) row.low = row.high = row.now;
        break;
      default:
        break;
    }
    return true;
  }

  void show(double t_s) const {
    if (!terminal_) {
      for (const Row& row : rows_)
        std::printf("%.3f %s %.6g %s\n", t_s, row.name.c_str(), row.now, row.unit.c_str());
      std::fflush(stdout);
      return;
    }
    winsize size{};
    ioctl(STDOUT_FILENO, TIOCGWINSZ, &size);
    constexpr int kText = 72;  // beside the line of blocks
    const std::size_t width = size.ws_col > kText + 10 ? size.ws_col - kText - 1u : 20u;
    std::printf(
        "\x1b[H%s  %.1f s, %.3g s a column%s  (q ends, space holds, + - time, r range)\x1b[K\n",
        bench_.name.c_str(), t_s, column_s_, held_ ? ", held" : "");
    for (const Row& row : rows_) {
      const std::vector<double> all(row.columns.begin(), row.columns.end());
      const std::size_t shown = std::min(width, all.size());
      std::printf("%-20.20s %11.5g %-6s %11.5g .. %-11.5g %s\x1b[K\n", row.name.c_str(), row.now,
                  row.unit.c_str(), row.low, row.high,
                  spark_line(std::span(all).last(shown)).c_str());
    }
    std::fputs("\x1b[J", stdout);
    std::fflush(stdout);
  }

  int leave(int code) {
    for (const auto& line : lines_) line->close();
    for (const Esc& esc : escs_) esc.port->close();
    return code;
  }

  const bench::BenchDescription& bench_;
  const ScopeOptions& options_;
  double column_s_;
  bool terminal_, held_ = false;
  pacing::MonotonicClock clock_;
  std::vector<Row> rows_;
  std::vector<std::unique_ptr<bench::InstrumentLine>> lines_;
  std::vector<Esc> escs_;
};

}  // namespace

int bench_scope_command(const ScopeOptions& options, const Composition& composition) {
  const auto bench = bench_named(options.name, "whirl bench scope", composition.root);
  if (!bench) return complain(bench.error());
  Scope scope(bench.value(), options);
  if (const auto opened = scope.open(composition.bridge); !opened) return complain(opened.error());
  return scope.run();
}

}  // namespace whirl::cli
