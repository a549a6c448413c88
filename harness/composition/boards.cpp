#include "harness/composition/boards.hpp"

#include <algorithm>
#include <cstdlib>
#include <set>

#include "base/check.hpp"
#include "harness/board/node.hpp"
#include "harness/catalogue/surroundings_table.hpp"
#include "harness/composition/bench_boards.hpp"
#include "harness/composition/copies.hpp"
#include "harness/composition/stand_in_command.hpp"
#include "harness/flight/flight_world.hpp"
#include "harness/flight/still_air.hpp"
#include "harness/pacing/host_clock.hpp"
#include "harness/plan/needs.hpp"
#include "harness/stand/bench_stand.hpp"
#include "harness/stand/stand_world.hpp"
#include "harness/target/bench/serial_rack_link.hpp"
#include "harness/target/copper_target.hpp"
#include "harness/target/virtual_board.hpp"
#include "io_bridges/board_description/line_part.hpp"

namespace whirl {
namespace {

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

// The ESC of a vehicle's motor that is a board, as this run's copy has it. params: with its copy drawn.
stand::VehiclesEsc esc_of(const BoardDescription& board, int motor, std::uint64_t seed,
                          const flight::FlightParams& params) {
  const BoardDevice* stage = power_stage(board);
  WHIRL_CHECK(stage != nullptr, board.name);
  return stand::draw_esc({.motor = motor,
                          .shaft = params.vehicle.motor_of(static_cast<std::size_t>(motor) - 1),
                          .shunt = params.esc.shunt,
                          .tolerance = params.tolerance},
                         board, stage->motor, seed);
}

// Boards in the place of motor controllers turn the vehicle's shafts: all of them, or none. What was drawn of them is told.
Result<std::vector<flight::FarShaft>> far_shafts(const cli::Setup& setup,
                                                 flight::FlightParams& params) {
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
    for (DrawnPart& part : esc_of(*far.board, far.motor, setup.seed, params).drawn) {
      params.drawn.push_back(std::move(part));
    }
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

// By a pod, or on a line of its own.
bool bench_plays_receiver(const bench::BenchDescription& bench, const BoardDescription& board) {
  return std::any_of(bench.pods.begin(), bench.pods.end(),
                     [](const bench::PodLink& link) { return plays_receiver(link.parts); }) ||
         std::any_of(bench.serials.begin(), bench.serials.end(), [&](const auto& link) {
           return bench::part_at(board, link, is_receiver) != nullptr;
         });
}

// What of the ground the first board hears, itself or by a board in a part's place.
flight::BoardEars ears_of(const cli::Setup& setup) {
  flight::BoardEars ears{.radio = false, .receiver = false};
  for (const BoardDevice& device : setup.board.devices) {
    const bool radio = device.type == "mavlink_link";
    if (!radio && device.type != "cppm" && device.type != "sbus") continue;
    bool& hears = radio ? ears.radio : ears.receiver;
    if (std::none_of(setup.wires.begin(), setup.wires.end(),
                     [&](const WireEnd& end) { return end.device == device.name; })) {
      hears = true;
      continue;
    }
    const char* type = radio ? "mavlink_link" : "sbus";
    const auto played = std::find_if(setup.far.begin(), setup.far.end(), [&](const auto& far) {
      return pod_parts(*far.board).count(type) != 0;
    });
    if (played == setup.far.end()) continue;
    hears = true;
    (radio ? ears.radios_board : ears.receivers_board) = static_cast<std::uint8_t>(played->node);
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
    params.value().ears.receiver = bench_plays_receiver(*setup.bench, setup.board);
  }
  auto far = far_shafts(setup, params.value());
  if (!far) return far.error();
  params.value().far_shafts = std::move(far.value());
  set_far_parts(setup, params.value());
  if (const auto told = flight::tell_still_air(params.value(), setup.seed); !told) {
    return told.error();
  }
  return std::unique_ptr<World>(std::make_unique<flight::FlightWorld>(params.value(), setup.seed));
}

pacing::MonotonicClock& host_clock() {
  static pacing::MonotonicClock clock;
  return clock;
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
  return stand::set_esc(board, stage->motor,
                        esc_of(setup.board, setup.motor, setup.seed, params.value()));
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
