#include "harness/cli/bench_choice.hpp"

#include <algorithm>

#include "harness/catalogue/bench_file.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/cli/find_board.hpp"
#include "harness/cli/find_file.hpp"
#include "harness/cli/find_plans.hpp"
#include "harness/target/bench/serial_rack_link.hpp"
#include "io_bridges/board_description/line_part.hpp"

namespace whirl::cli {
namespace {

constexpr std::string_view kPrefix = "bench/";

Error refused(const std::string& place, const std::string& what, const std::string& cure = "") {
  return {ErrorKind::bad_input, place, what, cure};
}

// The CAN bus over which the plan commands, where it does.
Result<Done> check_can(const plan::Plan& plan, std::uint16_t can,
                       const bench::BenchDescription& bench) {
  const bool joined = std::any_of(bench.cans.begin(), bench.cans.end(),
                                  [&](const auto& link) { return link.bus == can; });
  if (joined) return Done{};
  const std::string bus = "can" + std::to_string(can);
  return refused(bench.file, "nothing joins " + bus + ", over which " + plan.name + " commands",
                 "links = { { bus = \"" + bus + "\", interface = \"can0\" } }");
}

// Of a stand this host is the allocator, as node 10; of a vehicle it is a node of its own where the file says which.
Result<Done> check_allocators(const plan::Plan& plan, const bench::BenchDescription& bench) {
  for (const bench::CanBusLink& link : bench.cans) {
    const bool asks = link.ids.lowest != 1 || link.ids.highest != 125 || !link.ids.kept.empty();
    if (plan.stand && link.allocator) {
      return refused(bench.file, link.name + ": allocation.node is of a vehicle's bus",
                     "leave it out: on a stand this host gives ids as node 10");
    }
    if (!plan.stand && asks && !link.allocator) {
      return refused(bench.file, link.name + ": allocation names no node that gives the ids",
                     "node = 11, where the flight controller gives none itself");
    }
  }
  return Done{};
}

// The world's end of each bus of the board, where the bench has something in its place.
Result<Done> check_links(const plan::Plan& plan, const BoardDescription& board,
                         const bench::BenchDescription& bench, const std::string& root) {
  const auto stand = catalogue::read_stand(*plan.stand, root + "/test_plans/propellers");
  if (!stand) return stand.error();
  if (stand.value().esc.can > 0) return check_can(plan, stand.value().esc.can, bench);
  for (const BoardDevice& device : board.devices) {
    const auto joins = [&](const std::string& kind, int number) {
      return device.bus == kind + std::to_string(number);
    };
    const bool joined =
        std::any_of(bench.bridges.begin(), bench.bridges.end(),
                    [&](const auto& link) { return joins("i2c", link.bus); }) ||
        std::any_of(bench.serials.begin(), bench.serials.end(), [&](const auto& link) {
          return joins("usart", link.uart) || joins("uart", link.uart);
        });
    // A line that nobody types on may be left open: a plan that asks gets no answer, and says so.
    if (device.type != "i2c_master" || joined) continue;
    return refused(
        bench.file,
        "nothing joins " + device.bus + ", over which " + plan.name + " commands " + board.name,
        "links = { { bus = \"" + device.bus + "\", bridge = ... } }");
  }
  return Done{};
}

bool serial_joins(const BoardDevice& device, const bench::BenchDescription& bench) {
  return std::any_of(bench.serials.begin(), bench.serials.end(),
                     [&](const auto& link) { return is_at_uart(device, link.uart); });
}

// Parts that are played on a line of their own as well.
bool has_own_line(const BoardDevice& device) {
  return is_receiver(device) || is_gps(device) || is_radio(device);
}

bool pod_plays(const BoardDevice& device, const bench::BenchDescription& bench) {
  return std::any_of(bench.pods.begin(), bench.pods.end(), [&](const bench::PodLink& link) {
    return pod_parts(link.parts).count(device.type) != 0;
  });
}

bool is_radio_at(const BoardDescription& board, const bench::SerialLink& link) {
  return bench::part_at(board, link, is_radio) != nullptr;
}

// Of a flight controller's board: what hangs on a bus that the bench joins is played by it, some parts by a pod; memories
// are the board's own, and so is its divider, on the bench's supply; on a receiver that nobody plays nothing is sent.
Result<Done> check_played(const BoardDevice& device, const BoardDescription& board,
                          const bench::BenchDescription& bench) {
  for (const char* own : {"sd_card", "eeprom_24xx", "cppm", "sbus", "battery_sense"}) {
    if (device.type == own) return Done{};
  }
  const bool played =
      std::any_of(bench.cans.begin(), bench.cans.end(),
                  [&](const auto& l) { return device.bus == "can" + std::to_string(l.bus); }) ||
      (has_own_line(device) && serial_joins(device, bench)) || pod_plays(device, bench);
  if (played) return Done{};
  const bool on_can = device.bus.starts_with("can");
  return refused(bench.file,
                 "nothing plays " + device.name + ", a " + device.type + " on " + device.bus +
                     " of " + board.name,
                 on_can ? "links = { { bus = \"" + device.bus + "\", interface = \"can0\" } }"
                 : has_own_line(device)
                     ? "links = { { bus = \"" + device.bus + "\", path = \"/dev/ttyUSB0\" } }"
                     : "links = { { pod = \"pod_with_receivers\", path = ... } } for what a pod "
                       "plays, or a board whose parts are nodes of CAN: px4fmu_v1_all_can");
}

Result<Done> check_flight_links(const BoardDescription& board,
                                const bench::BenchDescription& bench) {
  for (const BoardDevice& device : board.devices) {
    if (const auto played = check_played(device, board, bench); !played) return played;
    if (!has_own_line(device) || !serial_joins(device, bench) || !pod_plays(device, bench))
      continue;
    return refused(
        bench.file, "both a pod and a line play " + device.name,
        "one of the two, or a pod's board that does not play it: pod_with_parts plays no line");
  }
  if (!bench.safety.limits.empty()) {
    return refused(bench.file, "limits: of a flight controller's bench nothing is measured",
                   "leave them out: its vehicle is this host's, and nothing turns");
  }
  return Done{};
}

// A line that is said to carry MAVLink is that of a telemetry radio of the board's.
Result<Done> check_radios(const BoardDescription& board, const bench::BenchDescription& bench) {
  for (const bench::SerialLink& link : bench.serials) {
    if (!link.mavlink || is_radio_at(board, link)) continue;
    const auto radio = std::find_if(board.devices.begin(), board.devices.end(), is_radio);
    const std::string bus = "usart" + std::to_string(link.uart);
    return refused(
        bench.file,
        link.name + ": kind = \"mavlink\", and " + board.name + " has no telemetry radio on " + bus,
        radio == board.devices.end() ? "a board with a mavlink_link"
                                     : "bus = \"" + radio->bus + "\"");
  }
  return Done{};
}

// The boards of its pods.
Result<Done> read_pods(bench::BenchDescription& bench, const std::string& root) {
  for (bench::PodLink& link : bench.pods) {
    auto board = find_board(link.board, {bench.file, "links." + link.name}, root);
    if (!board) return board.error();
    link.parts = std::move(board.value());
    if (!plays_parts(link.parts)) {
      return refused(bench.file, link.parts.name + " has no pod_parts: it is no pod's board",
                     "pod_with_receivers, or pod_with_receivers_can");
    }
    const std::optional<int> can = can_of_host(link.parts);
    link.can.bus = static_cast<std::uint16_t>(can.value_or(0));
    if (can.has_value() == link.path.empty()) continue;
    return refused(bench.file,
                   "the host of " + link.parts.name + " is on " +
                       (can ? "can" + std::to_string(*can) : std::string("a serial line")),
                   can ? "interface = \"can0\"" : "path = \"/dev/ttyUSB0\"");
  }
  return Done{};
}

}  // namespace

Result<bench::BenchDescription> bench_named(const std::string& name, const char* command,
                                            const std::string& root) {
  const auto file = find_file(name, {".", command}, {root + "/test_plans/benches"}, ".lua");
  if (!file) return file.error();
  auto bench = read_bench(shown_path(file.value()));
  if (!bench) return bench;
  if (const auto read = read_pods(bench.value(), root); !read) return read.error();
  const auto board = find_board(bench.value().board, {bench.value().file, "board"}, root);
  if (!board) return board.error();
  if (const auto there = check_radios(board.value(), bench.value()); !there) return there.error();
  for (bench::SerialLink& link : bench.value().serials) {
    link.mavlink = is_radio_at(board.value(), link);
  }
  return bench;
}

Result<Done> check_copper_options(const RunOptions& options) {
  if (options.copper.empty()) return Done{};
  if (options.gdb) return refused("--copper", "is of another run than one that is held by gdb");
  if (options.jobs > 1 || options.seeds.size() > 1) {
    return refused("--copper", "is a capture of one run, and several are asked for");
  }
  return Done{};
}

Result<Done> check_bench_options(const RunOptions& options) {
  if (options.target.empty()) return Done{};
  if (!options.target.starts_with(kPrefix) || options.target.size() == kPrefix.size()) {
    return refused("--target", "'" + options.target + "' is no target", "bench/NAME");
  }
  if (options.gdb) return refused("--gdb", "a bench does not wait for a debugger");
  if (options.twice) return refused("--twice", "no two runs of metal are equal to the bit");
  if (!options.seeds.empty()) return refused("--seeds", "a bench runs a plan once", "--seed N");
  if (options.jobs > 1) return refused("--jobs", "a bench runs one plan at a time");
  return Done{};
}

Result<bench::BenchDescription> bench_for(const plan::Plan& plan, const std::vector<Node>& nodes,
                                          const RunOptions& options, const std::string& root) {
  if (const auto good = check_bench_options(options); !good) return good.error();
  if (nodes.size() != 1) return refused(plan.place, "a bench has one board");
  const std::string wanted = options.target.substr(kPrefix.size());
  const auto file =
      find_file(wanted, {plan.file, "--target"}, {root + "/test_plans/benches"}, ".lua");
  if (!file) return file.error();
  auto bench = read_bench(shown_path(file.value()));
  if (!bench) return bench.error();
  bench.value().late_ns = plan.late_ns.value_or(bench.value().late_ns);
  bench.value().late_share = plan.late_share.value_or(bench.value().late_share);
  if (const auto read = read_pods(bench.value(), root); !read) return read.error();
  const BoardDescription& board = nodes.front().board;
  if (bench.value().board != board.name) {
    return refused(plan.place, "the plan is for " + board.name + ", and on bench " +
                                   bench.value().name + " there is " + bench.value().board);
  }
  if (const auto there = check_radios(board, bench.value()); !there) return there.error();
  if (const auto good = check_allocators(plan, bench.value()); !good) return good.error();
  const auto joined = plan.stand ? check_links(plan, board, bench.value(), root)
                                 : check_flight_links(board, bench.value());
  if (!joined) return joined.error();
  if (options.arm != bench.value().safety.phrase) {
    return refused(bench.value().file,
                   options.arm.empty()
                       ? std::string(plan.stand ? "a rotor will turn" : "a vehicle will be armed") +
                             ": nobody has said that all is clear"
                       : "'" + options.arm + "' is not the bench's phrase",
                   "look, then add --arm \"" + bench.value().safety.phrase + "\"");
  }
  return bench;
}

}  // namespace whirl::cli
