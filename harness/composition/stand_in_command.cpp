#include "harness/composition/stand_in_command.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "base/interruption.hpp"
#include "base/output_file.hpp"
#include "base/places.hpp"
#include "harness/board/node.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/cli/console.hpp"
#include "harness/cli/find_board.hpp"
#include "harness/cli/find_file.hpp"
#include "harness/pacing/host_clock.hpp"
#include "harness/stand/stand_world.hpp"
#include "harness/standin/bare_board.hpp"
#include "harness/standin/no_world.hpp"
#include "harness/standin/pod_beside.hpp"
#include "harness/standin/stand_in.hpp"
#include "harness/target/bench/can_link.hpp"
#include "harness/target/virtual_board.hpp"
#include "io_bridges/hid/emulated/mcp2221_chip.hpp"
#include "io_bridges/hid/emulated/uhid_device.hpp"

namespace whirl {
namespace {

constexpr std::int64_t kTurn_ns = 2'000'000;
constexpr std::int64_t kUsb_frame_ns = 1'000'000;  // of full speed

class CarrierOfStandIn final : public io::I2cCarrier {
 public:
  explicit CarrierOfStandIn(StandIn& stand_in) : stand_in_(stand_in) {}

  void begin(std::uint8_t address, std::vector<std::uint8_t> write, std::size_t read) override {
    open_ = stand_in_.begin({address, std::move(write), static_cast<std::uint16_t>(read)});
  }
  std::optional<io::CarriedOutcome> outcome() override {
    std::erase_if(abandoned_, [&](auto number) { return stand_in_.outcome(number).has_value(); });
    if (!open_) return std::nullopt;
    auto outcome = stand_in_.outcome(*open_);
    if (!outcome) return std::nullopt;
    open_.reset();
    return io::CarriedOutcome{outcome->acked, outcome->timed_out, std::move(outcome->bytes)};
  }
  void abandon() override {
    if (open_) abandoned_.push_back(*open_);
    open_.reset();
  }

 private:
  StandIn& stand_in_;
  std::optional<std::uint32_t> open_;
  std::vector<std::uint32_t> abandoned_;
};

// Its chip and its device live together: the kernel sees it as long as this does.
class PlayedBridge {
 public:
  PlayedBridge(StandIn& stand_in, const std::string& serial)
      : carrier_(stand_in), chip_(queue_, carrier_, serial) {}

  Result<Done> plug_in() {
    auto made = io::UhidDevice::create(queue_, chip_, kUsb_frame_ns);
    if (!made) return made.error();
    device_ = std::move(made.value());
    return Done{};
  }
  void serve() { device_->serve(kTurn_ns); }

 private:
  io::EventQueue queue_;
  CarrierOfStandIn carrier_;
  io::Mcp2221Chip chip_;
  std::unique_ptr<io::UhidDevice> device_;
};

constexpr const char *kPodBoard = "pod_with_receivers", *kPodBoardOnCan = "pod_with_receivers_can";
constexpr double kSupply_V = 16.0;  // that a flight controller's divider sees

struct Parts {
  BoardDescription board;  // as the bench knows it
  BoardDescription pod;    // beside it; without devices: none
  std::string pod_image;
  std::string image;
  bool flies = false;        // a flight controller: the bench plays its world
  stand::StandParams stand;  // of an ESC
  bool bridge = false;       // its I2C is played
  std::uint16_t can_bus = 1, uart = 1;
  std::uint8_t can_board = 0;  // whose the CAN is: 1, the pod's
  std::uint16_t sticks = 0;    // the UART of its receiver, that the bench plays; 0: none
};

bool has_type(const BoardDescription& board, const std::string& type) {
  return std::any_of(board.devices.begin(), board.devices.end(),
                     [&](const BoardDevice& device) { return device.type == type; });
}

// A bus or a line of the first device of that kind; 1 where there is none.
std::uint16_t number_of(const BoardDescription& board, const std::string& type_end) {
  for (const BoardDevice& device : board.devices) {
    if (!device.type.ends_with(type_end)) continue;
    return static_cast<std::uint16_t>(bus_number(device.bus).value_or(1));
  }
  return 1;
}

// Of its line there, as the board's file has it.
long baud_of_line(const Parts& parts) {
  for (const BoardDevice& device : bare_board(parts.board).devices) {
    if (device.type != "serial" || bus_number(device.bus) != parts.uart) continue;
    if (const auto baud = device.value("baud")) return std::lround(std::get<double>(*baud));
  }
  return 921'600;  // as the ESCs' boards have it
}

Result<Done> read_stand(const cli::StandInRequest& request, const std::string& root, Parts& parts) {
  const auto table = lua::read_text("return " + request.stand, "--stand");
  if (!table) return table.error();
  auto stand = catalogue::read_stand(table.value(), root + "/test_plans/propellers");
  if (!stand) return stand.error();
  parts.stand = stand.value();
  parts.stand.commands = false;
  parts.bridge = request.bridge && has_type(parts.board, "i2c_master");
  parts.can_bus = number_of(parts.board, "can_port");
  parts.uart = parts.stand.esc.serial;
  return Done{};
}

// What commands it must be there.
Result<Done> check_wires(const cli::StandInRequest& request, const Parts& parts) {
  const auto refused = [&](const std::string& what, const std::string& cure) {
    return Error{ErrorKind::bad_input, parts.board.file, what, cure};
  };
  if (parts.flies) {
    if (!request.can.empty() || request.pod) return Done{};
    return refused("is a flight controller's: its sensors and ESCs are played over CAN",
                   "--can INTERFACE, or px4fmu_v1_sbus --pod");
  }
  if (request.pod) {
    return refused("has nothing that a pod plays: no radio, or no ESCs on I2C", "px4fmu_v1_sbus");
  }
  if (has_type(parts.board, "mavlink_link") && has_type(parts.board, "esc_i2c")) {
    return refused("is a flight controller's with SPI and I2C: a pod plays its sensors and ESCs",
                   "px4fmu_v1_sbus --pod");
  }
  if (!has_type(parts.board, "i2c_master") && request.can.empty()) {
    return refused("has no i2c_master: nothing commands it",
                   "esc32v2; of a board with a can_port: --can INTERFACE");
  }
  if (!request.can.empty() && !has_type(parts.board, "can_port")) {
    return refused("has no can_port: nothing joins its CAN to " + request.can, "without --can");
  }
  return Done{};
}

Result<Done> read_pod(const cli::Asker& asker, const std::string& root, Parts& parts) {
  const bool on_can = parts.can_board == 1;
  auto board = cli::find_board(on_can ? kPodBoardOnCan : kPodBoard, asker, root);
  if (!board) return board.error();
  const auto image = cli::find_file("pod", asker, image_folders(root), ".elf");
  if (!image) return image.error();
  parts.pod = std::move(board.value());
  parts.pod_image = image.value();
  if (!on_can) return Done{};
  parts.can_bus = static_cast<std::uint16_t>(can_of_host(parts.pod).value_or(0));
  return Done{};
}

Result<Parts> read_parts(const cli::StandInRequest& request, const std::string& root) {
  const cli::Asker asker{".", "whirl standin"};
  auto board = cli::find_board(request.board, asker, root);
  if (!board) return board.error();
  Parts parts;
  parts.board = std::move(board.value());
  const char* esc = request.pod ? "esc_i2c" : "esc_dronecan";
  parts.flies = has_type(parts.board, "mavlink_link") && has_type(parts.board, esc);
  const std::string usual = parts.flies ? "flight" : "esc";
  const auto image = cli::find_file(request.image.empty() ? usual : request.image, asker,
                                    image_folders(root), ".elf");
  if (!image) return image.error();
  parts.image = image.value();
  if (parts.flies) {
    parts.can_bus = number_of(parts.board, "_dronecan");
    parts.uart = number_of(parts.board, "mavlink_link");
    if (!request.pod && has_type(parts.board, "sbus"))
      parts.sticks = number_of(parts.board, "sbus");
  } else if (const auto read = read_stand(request, root, parts); !read) {
    return read.error();
  }
  if (const auto joined = check_wires(request, parts); !joined) return joined.error();
  if (request.pod) {
    parts.can_board = request.can.empty() ? 0 : 1;
    if (const auto read = read_pod(asker, root, parts); !read) return read.error();
  }
  return parts;
}

std::string bench_file(const cli::StandInRequest& request, const Parts& parts) {
  const std::string folder = std::filesystem::absolute(request.folder);
  std::string text =
      "-- A stand-in at its own wires, as `whirl standin` left it: no metal turns.\n";
  text += "return {\n  bench = \"stand_in\", board = \"" + parts.board.name +
          "\", pace = " + std::to_string(request.pace) +
          ",\n  late = \"5 ms\", late_share = \"2 %\",\n  links = {\n";
  if (request.pod) {
    text += "    { name = \"pod\", pod = \"" + parts.pod.name + "\", " +
            (request.can.empty() ? "path = \"" + folder + "/pod" : "interface = \"" + request.can) +
            "\" },\n";
  } else if (!request.can.empty()) {
    text += "    { name = \"bus\", bus = \"can" + std::to_string(parts.can_bus) +
            "\", interface = \"" + request.can + "\" },\n";
  }
  if (parts.bridge) {
    text += "    { name = \"throttle\", bus = \"i2c" + std::to_string(parts.stand.esc.i2c) +
            "\", bridge = \"mcp2221a\", serial = \"" + request.serial + "\" },\n";
  }
  text += "    { name = \"terminal\", bus = \"usart" + std::to_string(parts.uart) +
          "\", path = \"" + folder + "/serial\", baud = \"" + std::to_string(baud_of_line(parts)) +
          " baud\" },\n";
  if (parts.sticks != 0) {
    text += "    { name = \"sticks\", bus = \"usart" + std::to_string(parts.sticks) +
            "\", path = \"" + folder + "/sticks\" },\n";
  }
  text += "  },\n";
  if (parts.flies) {
    return text +
           "  safety = { phrase = \"nothing turns\", longest = \"120 s\", heartbeat = \"1 s\" "
           "},\n}\n";
  }
  text +=
      "  instruments = { { name = \"cell\", path = \"" + folder + "/instruments\", readings = {\n";
  text +=
      "    { signal = \"thrust\", column = 1, scale = \"1 N\" },\n"
      "    { signal = \"bus_voltage\", column = 2, scale = \"1 V\" },\n"
      "    { signal = \"supply_current\", column = 3, scale = \"1 A\" } } } },\n"
      "  signals = { speed = \"told_speed\" },\n"
      "  safety = { phrase = \"nothing turns\", longest = \"60 s\", heartbeat = \"1 s\",\n"
      "    limits = { { signal = \"supply_current\", low = \"-5 A\", high = \"22 A\" } } },\n}\n";
  return text;
}

Result<StandInOptions> open_wires(const cli::StandInRequest& request, const Parts& parts) {
  std::error_code status;
  std::filesystem::create_directories(request.folder, status);
  StandInOptions wires;
  wires.pace = request.pace;
  wires.i2c = parts.stand.esc.i2c;
  auto serial = io::PseudoTerminal::open(request.folder + "/serial");
  if (!serial) return serial.error();
  wires.lines.push_back({parts.uart, std::move(serial.value())});
  if (request.pod && request.can.empty()) {
    auto host = io::PseudoTerminal::open(request.folder + "/pod");
    if (!host) return host.error();
    wires.lines.push_back({1, std::move(host.value()), 1});
  }
  if (parts.sticks != 0) {
    auto sticks = io::PseudoTerminal::open(request.folder + "/sticks");
    if (!sticks) return sticks.error();
    wires.lines.push_back({parts.sticks, std::move(sticks.value())});
  }
  if (!parts.flies) {
    auto instruments = io::PseudoTerminal::open(request.folder + "/instruments");
    if (!instruments) return instruments.error();
    wires.instruments.emplace(std::move(instruments.value()));
    wires.told = {"thrust", "bus_voltage", "supply_current"};
  }
  if (!request.can.empty()) {
    auto can = bench::socket_can_port({"bus", request.can});
    if (!can) return can.error();
    wires.can = std::move(can.value());
    wires.can_bus = parts.can_bus;
    wires.can_board = parts.can_board;
  }
  const auto written = write_text(request.folder + "/bench.lua", bench_file(request, parts));
  if (!written) return written.error();
  return wires;
}

// Until a signal, the end of the time, or the board's own end.
void wait(const cli::StandInRequest& request, PlayedBridge* bridge,
          const std::atomic<bool>& ended) {
  pacing::MonotonicClock clock;
  const std::int64_t begin_ns = clock.now_ns();
  const auto limit_ns = static_cast<std::int64_t>(request.seconds * 1e9);
  while (interrupted_by() == 0 && !ended) {
    if (request.seconds > 0.0 && clock.now_ns() - begin_ns > limit_ns) return;
    bridge != nullptr ? bridge->serve() : clock.sleep_until(clock.now_ns() + kTurn_ns);
  }
}

void say_lateness(const StandIn& stand_in, double pace) {
  const pacing::Lateness& late = stand_in.lateness();
  std::printf("%lld steps of 1 ms at pace %g; worst %.2f ms late, %.2f s given up\n",
              static_cast<long long>(late.steps), pace, static_cast<double>(late.worst_ns) * 1e-6,
              static_cast<double>(late.slipped_ns) * 1e-9);
}

std::unique_ptr<World> world_of(const Parts& parts) {
  if (parts.flies) return std::make_unique<NoWorld>(kSupply_V);
  return std::make_unique<stand::StandWorld>(parts.stand, 1);
}

Result<std::unique_ptr<Target>> boards_of(const cli::StandInRequest& request, const Parts& parts) {
  if (request.pod) return with_pod({parts.board, parts.pod, parts.image, parts.pod_image});
  VirtualBoardOptions options;
  options.board = {bare_board(parts.board), {.image = parts.image, .seed = 1}};
  return std::unique_ptr<Target>(std::make_unique<VirtualBoard>(std::move(options)));
}

}  // namespace

int stand_in_command(const cli::StandInRequest& request, const std::string& root) {
  const auto parts = read_parts(request, root);
  if (!parts) return cli::complain(parts.error());
  auto wires = open_wires(request, parts.value());
  if (!wires) return cli::complain(wires.error());
  const auto world = world_of(parts.value());
  const auto boards = boards_of(request, parts.value());
  if (!boards) return cli::complain(boards.error());
  pacing::MonotonicClock clock;
  StandIn stand_in(*world, *boards.value(), clock, std::move(wires.value()));
  PlayedBridge bridge(stand_in, request.serial);
  if (parts.value().bridge) {
    if (const auto plugged = bridge.plug_in(); !plugged) {
      Error refused = plugged.error();
      refused.cure += ", or --no-bridge";
      return cli::complain(refused);
    }
  }
  std::printf(
      "%s stands in; whirl run PLAN --target bench/%s/bench.lua --arm "
      "\"nothing turns\"\n",
      parts.value().board.name.c_str(), request.folder.c_str());
  std::fflush(stdout);
  std::optional<Error> failed;
  std::atomic<bool> ended = false;
  std::thread runner([&] {
    if (const auto ran = stand_in.run(); !ran) failed = ran.error();
    ended = true;
  });
  wait(request, parts.value().bridge ? &bridge : nullptr, ended);
  stand_in.end();
  runner.join();
  if (failed) return cli::complain(*failed);
  say_lateness(stand_in, request.pace);
  return 0;
}

}  // namespace whirl
