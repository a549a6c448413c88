#include "harness/composition/boards.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "base/check.hpp"
#include "harness/board/node.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/catalogue/surroundings_table.hpp"
#include "harness/catalogue/vehicle_file.hpp"
#include "harness/composition/stand_in_command.hpp"
#include "harness/flight/flight_world.hpp"
#include "harness/flight/vehicle_parts.hpp"
#include "harness/pacing/host_clock.hpp"
#include "harness/plan/needs.hpp"
#include "harness/stand/bench_stand.hpp"
#include "harness/stand/stand_parts.hpp"
#include "harness/stand/stand_world.hpp"
#include "harness/target/bench/analyser_link.hpp"
#include "harness/target/bench/bench_target.hpp"
#include "harness/target/bench/bridge_link.hpp"
#include "harness/target/bench/node_link.hpp"
#include "harness/target/bench/pod_line.hpp"
#include "harness/target/bench/serial_links.hpp"
#include "harness/target/copper_target.hpp"
#include "harness/target/virtual_board.hpp"
#include "io_bridges/protocols/esc_codec.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl {
namespace {

Result<stand::StandParams> stand_of(const cli::Setup& setup) {
  auto params = catalogue::read_stand(*setup.plan.stand, setup.root + "/test_plans/propellers");
  if (params && setup.bench == nullptr) {
    stand::draw_parts(params.value(), setup.board, setup.seed);
  }
  return params;
}

Result<flight::FlightParams> vehicle_of(const cli::Setup& setup) {
  auto params = catalogue::read_vehicle(setup.vehicle_file, setup.settings);
  if (params) flight::draw_parts(params.value(), setup.seed);
  return params;
}

// Each motor has its ESC on the board, and each ESC its motor.
Result<Done> check_escs(const cli::Setup& setup, const flight::FlightParams& params) {
  const int motors = static_cast<int>(params.vehicle.airframe.rotors.size());
  std::set<int> driven;
  for (const BoardDevice& device : setup.board.devices) {
    if (device.type == "esc_i2c" || device.type == "esc_dronecan") driven.insert(device.motor);
  }
  const auto wrong = [&](const std::string& what) {
    return Error{ErrorKind::bad_input, setup.vehicle_file, what,
                 "the vehicle has " + std::to_string(motors) + " motors, " + setup.board.name +
                     " " + std::to_string(driven.size()) + " ESCs"};
  };
  for (const int motor : driven) {
    if (motor > motors) {
      return wrong("the board's ESC of motor " + std::to_string(motor) + " has no motor");
    }
  }
  for (int motor = 1; motor <= motors; ++motor) {
    if (driven.count(motor) == 0) return wrong("motor " + std::to_string(motor) + " has no ESC");
  }
  return Done{};
}

// A pod's rig is the world around its board: the stand that a plan names stays empty.
bool brings_its_world(const BoardDescription& board) {
  return std::any_of(board.devices.begin(), board.devices.end(),
                     [](const BoardDevice& device) { return device.type.starts_with("pod_"); });
}

// What the plan reads of the virtual stand and this bench does not measure is said before anything turns.
Result<std::unique_ptr<World>> bench_world(const cli::Setup& setup,
                                           const stand::StandParams& params) {
  const std::string& file = setup.bench->file;
  if (params.esc.pulse_rate_Hz > 0.0) {
    return Error{ErrorKind::bad_input, setup.plan.place,
                 "throttle = \"pwm\": no bench gives pulses yet", "throttle = \"i2c\""};
  }
  stand::BenchStandParams bench;
  bench.esc = params.esc;
  bench.aliases = setup.bench->signals;
  for (const bench::Reading& reading : setup.bench->readings()) {
    bench.readings.push_back({reading.signal, reading.dimension, "as the bench measures it"});
  }
  for (const bench::Limit& limit : setup.bench->safety.limits) {
    bench.limits.push_back({limit.signal, limit.dimension, limit.low, limit.high});
  }
  auto world = stand::BenchStand::make(std::move(bench));
  if (!world) return Error{ErrorKind::bad_input, file, world.error().what, world.error().cure};
  const stand::StandWorld elsewhere(params, setup.seed);
  const auto read = plan::check_signals(setup.plan, world.value()->signals(), elsewhere.signals());
  if (!read) return read.error();
  return std::unique_ptr<World>(std::move(world.value()));
}

const BoardDevice* power_stage(const BoardDescription& board) {
  for (const BoardDevice& device : board.devices) {
    if (device.type == "power_stage") return &device;
  }
  return nullptr;
}

// Boards in the place of motor controllers turn the vehicle's shafts: all of them, or none.
Result<std::vector<flight::FarShaft>> far_shafts(const cli::Setup& setup,
                                                 const flight::FlightParams& params) {
  const auto wrong = [&](const std::string& what, const std::string& cure) {
    return Error{ErrorKind::bad_input, setup.plan.place, what, cure};
  };
  std::vector<flight::FarShaft> shafts(params.vehicle.airframe.rotors.size());
  std::size_t found = 0;
  for (const cli::FarBoard& far : setup.far) {
    if (far.motor == 0 || plays_parts(*far.board)) continue;
    const BoardDevice* stage = power_stage(*far.board);
    if (stage == nullptr) {
      return wrong(far.board->name + " turns no motor", "esc32v2 has a power stage");
    }
    shafts.at(static_cast<std::size_t>(far.motor) - 1) = {static_cast<std::uint8_t>(far.node),
                                                          static_cast<std::uint16_t>(stage->motor)};
    ++found;
  }
  if (found == 0) return std::vector<flight::FarShaft>{};
  if (found != shafts.size()) {
    return wrong(std::to_string(found) + " of the vehicle's " + std::to_string(shafts.size()) +
                     " motors are turned by boards",
                 "give all of them a board, or none");
  }
  if (params.place.start && params.place.start->motor_speed_radps != 0.0) {
    return wrong("start: motors that boards turn begin at rest", "let it begin on the ground");
  }
  return shafts;
}

bool plays_receiver(const BoardDescription& board) {
  return pod_parts(board).count("sbus") != 0;
}

// What of the ground the first board hears, itself or by a board in a part's place.
flight::BoardEars ears_of(const cli::Setup& setup) {
  flight::BoardEars ears{.radio = false, .receiver = false};
  const auto played = std::find_if(setup.far.begin(), setup.far.end(),
                                   [](const auto& far) { return plays_receiver(*far.board); });
  for (const BoardDevice& device : setup.board.devices) {
    const bool here = std::none_of(setup.wires.begin(), setup.wires.end(),
                                   [&](const WireEnd& end) { return end.device == device.name; });
    const bool receiver = device.type == "cppm" || device.type == "sbus";
    if (device.type == "mavlink_link") ears.radio |= here;
    if (receiver && here) ears.receiver = true;
    if (!receiver || here || played == setup.far.end()) continue;
    ears.receiver = true;
    ears.receivers_board = static_cast<std::uint8_t>(played->node);
  }
  return ears;
}

// Parts that sense what the vehicle does are on the first board, or behind a board in the place of one; and so are its
// ESCs, where they are played.
void set_far_parts(const cli::Setup& setup, flight::FlightParams& params) {
  std::set<std::uint8_t> boards;
  for (const cli::FarBoard& far : setup.far) {
    if (!plays_parts(*far.board)) continue;
    const auto node = static_cast<std::uint8_t>(far.node);
    boards.insert(node);
    if (far.motor != 0) params.far_escs[far.motor] = node;
  }
  params.sensing_boards = {boards.begin(), boards.end()};
}

Result<std::unique_ptr<World>> make_world(const cli::Setup& setup) {
  if (setup.plan.stand) {
    const auto params = stand_of(setup);
    if (!params) return params.error();
    if (setup.bench != nullptr) return bench_world(setup, params.value());
    return std::unique_ptr<World>(std::make_unique<stand::StandWorld>(params.value(), setup.seed));
  }
  auto params = vehicle_of(setup);
  if (!params) return params.error();
  const auto around = catalogue::read_surroundings(*setup.plan.surroundings, params.value());
  if (!around) return around.error();
  if (const auto joined = check_escs(setup, params.value()); !joined) return joined.error();
  params.value().ears = ears_of(setup);
  if (setup.bench != nullptr) {
    const auto& pods = setup.bench->pods;
    params.value().ears.receiver =
        std::any_of(pods.begin(), pods.end(),
                    [](const bench::PodLink& link) { return plays_receiver(link.parts); });
  }
  auto far = far_shafts(setup, params.value());
  if (!far) return far.error();
  params.value().far_shafts = std::move(far.value());
  set_far_parts(setup, params.value());
  return std::unique_ptr<World>(std::make_unique<flight::FlightWorld>(params.value(), setup.seed));
}

pacing::MonotonicClock& host_clock() {
  static pacing::MonotonicClock clock;
  return clock;
}

// Enter, where a person sits at the terminal.
bool enter_pressed() {
  pollfd terminal{STDIN_FILENO, POLLIN, 0};
  return isatty(STDIN_FILENO) == 1 && poll(&terminal, 1, 0) == 1;
}

std::string log_of(const cli::Setup& setup, const bench::CanBusLink& link) {
  return setup.folder.empty() ? "" : setup.folder + "/" + link.name + ".log";
}

// Each board of a run is another copy of the hardware.
std::uint64_t seed_of(const cli::Setup& setup, std::size_t node) {
  return setup.seed + (static_cast<std::uint64_t>(node) << 32);
}

using Links = std::vector<std::unique_ptr<bench::Link>>;

// Of a thrust stand: what commands the ESC.
Result<Done> add_masters(const cli::Setup& setup, const bench::BridgeMaker& bridge,
                         const bench::CanMaker& can, Links& links) {
  const auto params = stand_of(setup);
  if (!params) return params.error();
  const bench::BenchDescription& bench = *setup.bench;
  for (const bench::BridgeLink& link : bench.bridges) {
    auto port = bridge(link);
    if (!port) return port.error();
    const auto zero = io::pack_setpoint(params.value().esc.address, 0);
    links.push_back(std::make_unique<bench::BridgeThread>(
        bench::BridgeOptions{.name = link.name,
                             .bus = link.bus,
                             .safe = {params.value().esc.address, {zero.begin(), zero.end()}, 0},
                             .heartbeat_ns = bench.safety.heartbeat_ns},
        std::move(port.value())));
  }
  for (const bench::CanBusLink& link : bench.cans) {
    links.push_back(std::make_unique<bench::CanLink>(
        bench::CanOptions{
            .link = link, .heartbeat_ns = bench.safety.heartbeat_ns, .log = log_of(setup, link)},
        can));
  }
  return Done{};
}

// A pod's board is another copy of the hardware than the flight controller's.
Result<Done> add_pods(const cli::Setup& setup, const bench::CanMaker& can, Links& links) {
  const std::uint64_t seed = seed_of(setup, 1);
  for (const bench::PodLink& link : setup.bench->pods) {
    const auto params = vehicle_of(setup);
    if (!params) return params.error();
    BoardDescription board = link.parts;
    flight::set_parts(board, params.value());
    if (link.path.empty()) {
      links.push_back(std::make_unique<bench::NodeLink>(
          bench::NodeOptions{link.can, board, rack::device_types(), seed, log_of(setup, link.can),
                             true},
          can));
    } else {
      links.push_back(std::make_unique<bench::PodLine>(
          bench::PodLineOptions{link, board, rack::device_types(), seed}));
    }
  }
  return Done{};
}

// Of a vehicle: its nodes, for the flight controller.
Result<Done> add_nodes(const cli::Setup& setup, const bench::CanMaker& can, Links& links) {
  for (const bench::CanBusLink& link : setup.bench->cans) {
    links.push_back(
        std::make_unique<bench::NodeLink>(bench::NodeOptions{.link = link,
                                                             .board = setup.board,
                                                             .types = rack::device_types(),
                                                             .seed = seed_of(setup, setup.node),
                                                             .log = log_of(setup, link)},
                                          can));
  }
  return add_pods(setup, can, links);
}

// Of a vehicle's nodes: what the plan may spoil.
std::set<std::string> played_parts(const cli::Setup& setup) {
  std::set<std::string> all;
  if (setup.plan.stand) return all;
  for (const bench::CanBusLink& link : setup.bench->cans) {
    const std::string bus = "can" + std::to_string(link.bus);
    all.insert(bus);
    for (const BoardDevice& device : setup.board.devices) {
      if (device.bus == bus) all.insert(device.name);
    }
  }
  return all;
}

Result<std::unique_ptr<Target>> bench_target(const cli::Setup& setup,
                                             const bench::BridgeMaker& bridge,
                                             const bench::CanMaker& can, pacing::HostClock& clock) {
  const bench::BenchDescription& bench = *setup.bench;
  Links links;
  const auto added =
      setup.plan.stand ? add_masters(setup, bridge, can, links) : add_nodes(setup, can, links);
  if (!added) return added.error();
  for (const bench::SerialLink& link : bench.serials) {
    links.push_back(std::make_unique<bench::BoardSerial>(link));
  }
  std::uint16_t port = 0;
  for (const bench::Instrument& instrument : bench.instruments) {
    links.push_back(std::make_unique<bench::InstrumentLine>(instrument, port));
    port = static_cast<std::uint16_t>(port + instrument.readings.size());
  }
  if (bench.analyser) {
    links.push_back(std::make_unique<bench::AnalyserLink>(
        "analyser", bench::sigrok_source(*bench.analyser),
        bench::rts_marker(bench.analyser->marker), copper_names(setup.board)));
  }
  return std::unique_ptr<Target>(std::make_unique<bench::BenchTarget>(
      bench::BenchOptions{
          .bench = bench, .operator_stops = enter_pressed, .played = played_parts(setup)},
      std::move(links), clock));
}

// What this run's copy of the hardware changes on the board: a stand's stage and instruments, a vehicle's IMU
// and clock, or the stage that turns one of the vehicle's shafts.
Result<Done> set_copy(const cli::Setup& setup, BoardDescription& board) {
  if (setup.plan.stand && setup.node == 0 && !brings_its_world(setup.board)) {
    const auto params = stand_of(setup);
    if (!params) return params.error();
    return stand::set_parts(board, params.value());
  }
  const bool flies = setup.node == 0 && !setup.vehicle_file.empty();
  const bool senses = !setup.vehicle_file.empty() && plays_parts(setup.board);
  if (!flies && !senses && setup.motor == 0) return Done{};
  auto params = vehicle_of(setup);
  if (!params) return params.error();
  if (!flies) params.value().hse_error = 0.0;  // of the flight controller's crystal
  if (flies || senses) flight::set_parts(board, params.value());
  if (setup.motor == 0) return Done{};
  const BoardDevice* stage = power_stage(setup.board);
  WHIRL_CHECK(stage != nullptr, setup.board.name);  // the world was made with it
  const plant::MotorParams& motor =
      params.value().vehicle.motor_of(static_cast<std::size_t>(setup.motor) - 1);
  return stand::set_stage(board, stage->motor, stand::stage_of(motor, params.value().esc.shunt));
}

Result<std::unique_ptr<Target>> make_target(const cli::Setup& setup,
                                            const bench::BridgeMaker& bridge,
                                            const bench::CanMaker& can, pacing::HostClock& clock) {
  if (setup.bench != nullptr) return bench_target(setup, bridge, can, clock);
  VirtualBoardOptions options;
  options.board = {setup.board,
                   {.image = setup.image,
                    .flashed = setup.flashed,
                    .wires = setup.wires,
                    .seed = seed_of(setup, setup.node),
                    .gdb_port = setup.gdb_port,
                    .folder = setup.folder,
                    .node = setup.plan.nodes[setup.node].name}};
  if (const auto set = set_copy(setup, options.board.board); !set) return set.error();
  if (setup.world_may_stand) options.silence_s = 0;
  options.any_qemu_version = std::getenv("WHIRL_ANY_QEMU") != nullptr;
  auto board = std::make_unique<VirtualBoard>(std::move(options));
  if (setup.copper.empty()) return std::unique_ptr<Target>(std::move(board));
  return std::unique_ptr<Target>(std::make_unique<CopperTarget>(
      CopperOptions{setup.copper, setup.copper_rate_Hz, copper_names(setup.board)},
      std::move(board)));
}

}  // namespace

cli::Composition boards_and_worlds(const std::string& root, const std::string& results,
                                   const bench::BridgeMaker& bridge, const bench::CanMaker& can,
                                   pacing::HostClock* clock) {
  pacing::HostClock* held_by = clock == nullptr ? &host_clock() : clock;
  return {make_world,
          [bridge, can, held_by](const cli::Setup& setup) {
            return make_target(setup, bridge, can, *held_by);
          },
          root,
          results,
          bridge,
          can,
          [root](const cli::StandInRequest& request) { return stand_in_command(request, root); }};
}

}  // namespace whirl
