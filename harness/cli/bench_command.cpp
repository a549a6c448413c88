#include "harness/cli/bench_command.hpp"

#include <algorithm>
#include <cstdio>

#include "base/output_file.hpp"
#include "base/whole_file.hpp"
#include "harness/cli/bench_choice.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_board.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/cli/probe_command.hpp"
#include "harness/pacing/pacer.hpp"
#include "harness/pacing/real_time.hpp"
#include "harness/target/bench/analyser_link.hpp"
#include "harness/target/bench/can_check.hpp"
#include "harness/target/bench/line_check.hpp"
#include "harness/target/bench/mavlink_check.hpp"
#include "harness/target/bench/pod_check.hpp"
#include "harness/target/bench/serial_links.hpp"
#include "harness/target/bench/serial_rack_link.hpp"
#include "harness/target/bench/spread.hpp"
#include "harness/target/bench/unproven.hpp"
#include "io_bridges/board_description/line_part.hpp"
#include "io_bridges/openocd/core_probe.hpp"
#include "io_bridges/protocols/esc_codec.hpp"
#include "results/parity.hpp"
#include "results/read_run.hpp"

namespace whirl::cli {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr int kTransfers = 200;

double ms(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-6;
}

void say(const std::string& name, const std::string& what) {
  std::printf("  %-12s %s\n", name.c_str(), what.c_str());
}

class Check {
 public:
  Check(const bench::BenchDescription& bench, const BoardDescription& board, double seconds,
        const Composition& composition)
      : bench_(bench),
        board_(board),
        seconds_(seconds),
        bridge_(composition.bridge),
        can_(composition.can) {}

  int all() {
    for (const auto& link : bench_.bridges) check(link);
    for (const auto& link : bench_.cans) check(link);
    for (const auto& link : bench_.pods) check(link);
    for (const auto& link : bench_.serials) check(link);
    for (const auto& instrument : bench_.instruments) check(instrument);
    if (bench_.analyser) check(*bench_.analyser);
    if (bench_.probe) check(*bench_.probe);
    check_pacer();
    std::printf("of what is here, nobody has proven without hardware:\n");
    for (const bench::Unproven& item : bench::unproven(bench_, ends_)) {
      std::printf("  - %s\n", item.text().c_str());
    }
    return missing_ == 0 ? 0 : 2;
  }

 private:
  void missing(const std::string& name, const Error& error) {
    ++missing_;
    say(name, "MISSING: " + error.message());
  }
  void tell(const std::string& name, const Result<std::vector<std::string>>& told) {
    if (!told) return missing(name, told.error());
    for (const std::string& line : told.value()) say(name, line);
  }

  // Status reads, as the ESC's protocol has them.
  void check(const bench::BridgeLink& link) {
    auto port = bridge_(link);
    if (!port) return missing(link.name, port.error());
    if (const auto opened = port.value()->open(); !opened) {
      return missing(link.name, opened.error());
    }
    std::vector<double> took_ms;
    int silent = 0, broken = 0;
    std::uint8_t found = 0;
    for (std::uint8_t address = io::esc_address(1); address < io::esc_address(9) && found == 0;
         ++address) {
      const auto got = port.value()->transfer({address, {}, 6});
      if (got && got.value().acked) found = address;
    }
    for (int i = 0; i < kTransfers; ++i) {
      const std::int64_t begin_ns = clock_.now_ns();
      const auto got = port.value()->transfer({found == 0 ? io::esc_address(1) : found, {}, 6});
      if (!got) return missing(link.name, got.error());
      took_ms.push_back(ms(clock_.now_ns() - begin_ns));
      silent += !got.value().acked;
      broken += got.value().acked && !io::unpack_status(found, got.value().bytes);
    }
    port.value()->close();
    const bench::Spread s = bench::spread_of(took_ms);
    char text[200];
    std::snprintf(text, sizeof text,
                  "%s: ESC %s; %d reads, %d unanswered, %d with a bad CRC; p50 %.2f, p99 %.2f, "
                  "most %.2f ms",
                  link.kind.c_str(), found == 0 ? "not found" : "answers", kTransfers, silent,
                  broken, s.p50_ms, s.p99_ms, s.most_ms);
    found == 0 ? missing(link.name, {ErrorKind::bad_input, "", text, "is the ESC powered?"})
               : say(link.name, text);
  }

  void check(const bench::CanBusLink& link) {
    const auto port = can_(link);
    if (!port) return missing(link.name, port.error());
    say(link.name, port.value()->version());
    tell(link.name, bench::check_can_bus(*port.value(), clock_,
                                         {.interface = link.interface,
                                          .bit_rate_bps = link.bit_rate_bps,
                                          .seconds = seconds_}));
  }

  // As in a run: a host that is late of its own accord would be counted by the pod.
  void check(const bench::PodLink& link) {
    pacing::take_real_time();
    const auto told =
        bench::check_pod({.link = link, .seconds = seconds_, .pace = bench_.pace}, can_, clock_);
    pacing::give_back_real_time();
    tell(link.name, told);
  }

  void check(const bench::SerialLink& link) {
    if (link.mavlink) return check_mavlink(link);
    bench::LineCheckOptions options{.link = link, .seconds = seconds_};
    options.answer_s /= std::min(bench_.pace, 1.0);
    const BoardDevice* gps = bench::part_at(board_, link, is_gps);
    if (gps != nullptr) {
      options.end = bench::LineEnd::gps;
      const auto baud = gps->value("baud");
      if (baud) options.gps_baud = static_cast<int>(std::get<double>(*baud));
      ends_.gps = true;
    } else if (bench::part_at(board_, link, is_receiver) != nullptr) {
      options.end = bench::LineEnd::receiver;
      ends_.receiver = true;
    } else {
      ends_.commands = true;
    }
    tell(link.name, bench::check_line(options, clock_));
  }

  // HEARTBEAT comes once a second: five of them, or more.
  void check_mavlink(const bench::SerialLink& link) {
    tell(link.name, bench::check_mavlink({.link = link,
                                          .seconds = std::max(5.0 / bench_.pace, seconds_),
                                          .answer_s = bench::MavlinkCheckOptions{}.answer_s /
                                                      std::min(bench_.pace, 1.0)},
                                         clock_));
  }

  void check(const bench::Instrument& instrument) {
    bench::InstrumentLine line(instrument, 0);
    if (const auto opened = line.open(); !opened) return missing(instrument.name, opened.error());
    std::vector<double> between_ms;
    std::int64_t last_ns = -1;
    const std::int64_t end_ns = clock_.now_ns() + static_cast<std::int64_t>(seconds_ * 1e9);
    while (clock_.now_ns() < end_ns) {
      pollfd file{line.file(), POLLIN, 0};
      clock_.wait_for({&file, 1}, end_ns);
      bench::Arrivals arrivals;
      const std::uint64_t before = line.lines();
      const std::int64_t now_ns = clock_.now_ns();
      if (const auto served = line.serve(now_ns, arrivals); !served) {
        return missing(instrument.name, served.error());
      }
      if (line.lines() == before) continue;
      if (last_ns >= 0) between_ms.push_back(ms(now_ns - last_ns));
      last_ns = now_ns;
    }
    if (between_ms.empty()) {
      return missing(instrument.name, {ErrorKind::bad_input, instrument.path, "says nothing",
                                       "its baud rate, or which line it is on?"});
    }
    const bench::Spread s = bench::spread_of(between_ms);
    char text[200];
    std::snprintf(text, sizeof text,
                  "%llu lines, %llu too short; between lines p50 %.2f, p99 %.2f, most %.2f ms",
                  static_cast<unsigned long long>(line.lines()),
                  static_cast<unsigned long long>(line.short_lines()), s.p50_ms, s.p99_ms,
                  s.most_ms);
    say(instrument.name, text);
  }

  void check(const bench::AnalyserClips& clips) {
    const auto source = bench::sigrok_source(clips);
    const auto opened = source->open();
    opened ? say("analyser", source->version()) : missing("analyser", opened.error());
    const auto marker = bench::rts_marker(clips.marker)->open();
    marker ? say("marker", clips.marker + " has RTS; the clip on it is seen in a run")
           : missing("marker", marker.error());
  }

  void check(const bench::DebugProbe& probe) {
    const auto server = connect_probe(probe);
    if (!server) return missing("probe", server.error());
    const auto pc = openocd::CoreProbe(server.value()->client()).sample_pc();
    pc ? say("probe", probe.interface + ", the core of " + probe.target + " answers")
       : missing("probe", pc.error());
  }

  // A kilohertz of nothing: what this host could hold at best, beside what the pacer makes of it.
  void check_pacer() {
    const pacing::RealTime got = pacing::take_real_time();
    const auto steps = static_cast<std::int64_t>(seconds_ * 1000.0);
    std::int64_t late = 0, worst_ns = 0;
    const std::int64_t zero_ns = clock_.now_ns();
    for (std::int64_t k = 1; k <= steps; ++k) {
      clock_.sleep_until(zero_ns + k * kMs);
      const std::int64_t behind_ns = clock_.now_ns() - (zero_ns + k * kMs);
      late += behind_ns > bench_.late_ns;
      worst_ns = std::max(worst_ns, behind_ns);
    }
    pacing::Pacer pacer(clock_, 1.0, bench_.late_ns);
    for (std::int64_t k = 0; k <= steps; ++k) pacer.wait_for(k * kMs);
    pacing::give_back_real_time();
    char text[300];
    std::snprintf(text, sizeof text,
                  "1 kHz for %g s each, later than %lld us: an empty loop %.3f %% (most %.2f ms), "
                  "the pacer %.3f %% (most %.2f ms); %s",
                  seconds_, static_cast<long long>(bench_.late_ns / 1000),
                  100.0 * static_cast<double>(late) / static_cast<double>(steps), ms(worst_ns),
                  100.0 * static_cast<double>(pacer.lateness().late_steps) /
                      static_cast<double>(pacer.lateness().steps),
                  ms(pacer.lateness().worst_ns), got.told.c_str());
    say("pacer", text);
  }

  const bench::BenchDescription& bench_;
  const BoardDescription& board_;
  double seconds_;
  const bench::BridgeMaker& bridge_;
  const bench::CanMaker& can_;
  pacing::MonotonicClock clock_;
  bench::LineEnds ends_;
  int missing_ = 0;
};

Result<results::Report> report_of(const std::string& run) {
  const std::string path = run + "/run.json";
  const auto text = read_whole_file(path);
  if (!text) return text.error();
  auto report = results::read_run(text.value());
  if (!report) return Error{ErrorKind::bad_input, path, report.error().what, ""};
  return report;
}

// Or the same flown another way: its name with what differs behind a comma.
bool one_plan(const std::string& a, const std::string& b) {
  return a == b || a.starts_with(b + ", ") || b.starts_with(a + ", ");
}

}  // namespace

int bench_check_command(const BenchOptions& options, const Composition& composition) {
  const auto bench = bench_named(options.name, "whirl bench check", composition.root);
  if (!bench) return complain(bench.error());
  const auto board =
      find_board(bench.value().board, {bench.value().file, "board"}, composition.root);
  if (!board) return complain(board.error());
  std::printf("%s: %s on %s\n", bench.value().file.c_str(), bench.value().name.c_str(),
              bench.value().board.c_str());
  return Check(bench.value(), board.value(), options.seconds, composition).all();
}

int parity_command(const ParityOptions& options) {
  const auto first = report_of(options.first);
  if (!first) return complain(first.error());
  const auto second = report_of(options.second);
  if (!second) return complain(second.error());
  if (!one_plan(first.value().plan, second.value().plan)) {
    return complain(
        {ErrorKind::bad_input, options.second,
         "is a run of " + second.value().plan + ", and the first of " + first.value().plan,
         "two runs of one plan are wanted, or of \"NAME\" and \"NAME, another way\""});
  }
  std::fputs(results::parity_text(first.value(), second.value()).c_str(), stdout);
  const std::string page = options.page.empty() ? options.second + "/parity.html" : options.page;
  const auto written = write_text(page, results::parity_page(first.value(), second.value()));
  if (!written) return complain(written.error());
  std::printf("  %s\n", shown_path(page).c_str());
  return 0;
}

}  // namespace whirl::cli
