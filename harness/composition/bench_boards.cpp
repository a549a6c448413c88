#include "harness/composition/bench_boards.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <map>

#include "harness/board/node.hpp"
#include "harness/composition/copies.hpp"
#include "harness/plan/needs.hpp"
#include "harness/target/bench/analyser_link.hpp"
#include "harness/target/bench/bench_target.hpp"
#include "harness/target/bench/bridge_link.hpp"
#include "harness/target/bench/gps_line.hpp"
#include "harness/target/bench/mavlink_line.hpp"
#include "harness/target/bench/node_link.hpp"
#include "harness/target/bench/pod_line.hpp"
#include "harness/target/bench/receiver_line.hpp"
#include "harness/target/bench/serial_links.hpp"
#include "harness/target/copper_target.hpp"
#include "io_bridges/board_description/bus_name.hpp"
#include "io_bridges/board_description/line_part.hpp"
#include "io_bridges/protocols/esc_codec.hpp"
#include "io_bridges/rack/devices/pod_faults.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl {
namespace {

// Enter, where a person sits at the terminal.
bool enter_pressed() {
  pollfd terminal{STDIN_FILENO, POLLIN, 0};
  return isatty(STDIN_FILENO) == 1 && poll(&terminal, 1, 0) == 1;
}

std::string log_of(const cli::Setup& setup, const bench::CanBusLink& link) {
  return setup.folder.empty() ? "" : setup.folder + "/" + link.name + ".log";
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

// Which part behind the pod is meant by a fault of one on the flight controller's board.
bench::PodPlaces places_of(const BoardDescription& flight, const BoardDescription& pod) {
  bench::PodPlaces places;
  const auto played = pod_parts(pod);
  for (const BoardDevice& device : flight.devices) {
    const auto address = rack::pod_address(device.type);
    if (!address || played.count(device.type) == 0) continue;
    const std::pair at{bus_number(device.bus).value_or(-1),
                       device.address != -1 ? device.address : flight.number(device.name)};
    places[at] = {rack::kPodBus, *address};
  }
  return places;
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
                             places_of(setup.board, link.parts)},
          can));
    } else {
      links.push_back(std::make_unique<bench::PodLine>(bench::PodLineOptions{
          link, board, rack::device_types(), seed, places_of(setup.board, link.parts)}));
    }
  }
  return Done{};
}

// Of a vehicle: its nodes, for the flight controller.
Result<Done> add_nodes(const cli::Setup& setup, const bench::CanMaker& can, Links& links) {
  const auto params = vehicle_of(setup);
  if (!params) return params.error();
  BoardDescription board = setup.board;
  flight::set_parts(board, params.value());
  for (const bench::CanBusLink& link : setup.bench->cans) {
    links.push_back(
        std::make_unique<bench::NodeLink>(bench::NodeOptions{.link = link,
                                                             .board = board,
                                                             .types = rack::device_types(),
                                                             .seed = seed_of(setup, setup.node),
                                                             .log = log_of(setup, link)},
                                          can));
  }
  return add_pods(setup, can, links);
}

// Of a vehicle, a line may be the receiver's, the GPS's, or its telemetry.
std::unique_ptr<bench::Link> serial_link(const cli::Setup& setup, const bench::SerialLink& link) {
  const auto plays = [&](bench::LinePart kind) {
    return !setup.plan.stand && bench::part_at(setup.board, link, kind) != nullptr;
  };
  const auto options = [&] {
    return bench::LinePartOptions{link, setup.board, rack::device_types(),
                                  seed_of(setup, setup.node)};
  };
  if (plays(is_receiver)) return std::make_unique<bench::ReceiverLine>(options());
  if (plays(is_gps)) return std::make_unique<bench::GpsLine>(options());
  if (link.mavlink || plays(is_radio)) {
    return std::make_unique<bench::MavlinkLine>(link, setup.bench->pace);
  }
  return std::make_unique<bench::BoardSerial>(link);
}

using Kinds = std::function<bool(const std::string& kind)>;

// Of a vehicle's nodes, and of what a pod plays: what the plan may spoil.
std::map<std::string, Kinds> played_parts(const cli::Setup& setup) {
  std::map<std::string, Kinds> all;
  if (setup.plan.stand) return all;
  const Kinds any = [](const std::string&) { return true; };
  for (const bench::CanBusLink& link : setup.bench->cans) {
    const std::string bus = "can" + std::to_string(link.bus);
    all[bus] = any;
    for (const BoardDevice& device : setup.board.devices) {
      if (device.bus == bus) all[device.name] = any;
    }
  }
  const auto data_of = [](const std::string& type) -> Kinds {
    return [type](const std::string& word) {
      const auto kind = io::fault_kind(word);
      return kind && rack::acts_in_data(type, *kind);
    };
  };
  for (const bench::PodLink& link : setup.bench->pods) {
    const auto played = pod_parts(link.parts);
    for (const BoardDevice& device : setup.board.devices) {
      if (played.count(device.type) != 0) all[device.name] = data_of(device.type);
    }
  }
  for (const bench::SerialLink& link : setup.bench->serials) {
    for (const bench::LinePart kind : {is_receiver, is_gps}) {
      const BoardDevice* part = bench::part_at(setup.board, link, kind);
      if (part != nullptr) all[part->name] = data_of(part->type);
    }
  }
  return all;
}

// Of supply, cameras and motors, and none of a board's.
bool is_of_the_world(io::FaultKind kind) {
  using Kind = io::FaultKind;
  constexpr Kind kAll[] = {Kind::supply_dip,    Kind::capture_lost,  Kind::capture_frozen,
                           Kind::esc_stopped,   Kind::winding_short, Kind::capture_moved,
                           Kind::capture_turned};
  return std::find(std::begin(kAll), std::end(kAll), kind) != std::end(kAll);
}

// A kind that only parts and wires of a board have is that of a part which is played here.
Result<Done> check_faults(const cli::Setup& setup, const std::map<std::string, Kinds>& played) {
  return plan::check_faults(setup.plan, [&](const std::string& word) {
    const auto kind = io::fault_kind(word);
    if (!kind || is_of_the_world(*kind)) return true;
    return std::any_of(played.begin(), played.end(),
                       [&](const auto& part) { return part.second(word); });
  });
}

}  // namespace

Result<std::unique_ptr<Target>> bench_target(const cli::Setup& setup,
                                             const bench::BridgeMaker& bridge,
                                             const bench::CanMaker& can, pacing::HostClock& clock) {
  const bench::BenchDescription& bench = *setup.bench;
  auto played = played_parts(setup);
  if (const auto good = check_faults(setup, played); !good) return good.error();
  Links links;
  const auto added =
      setup.plan.stand ? add_masters(setup, bridge, can, links) : add_nodes(setup, can, links);
  if (!added) return added.error();
  for (const bench::SerialLink& link : bench.serials) links.push_back(serial_link(setup, link));
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
          .bench = bench, .operator_stops = enter_pressed, .played = std::move(played)},
      std::move(links), clock));
}

}  // namespace whirl
