#include "harness/tests/fake.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "base/interruption.hpp"
#include "io_bridges/devices/faults.hpp"
#include "results/folder.hpp"

namespace whirl::test {
namespace {

namespace fs = std::filesystem;
constexpr std::int64_t kUs = 1'000, kMs = 1'000'000;

class FakeTarget final : public Target {
 public:
  explicit FakeTarget(const cli::Setup& setup) : image_(fs::path(setup.image).stem().string()) {
    static int runs = 0;
    ++runs;
    if (image_ == "drifting") salt_ = static_cast<std::uint8_t>(runs);
  }

  Result<Done> start() override { return Done{}; }
  void run(std::int64_t until_ns, const io::Batch& sensed) override {
    for (io::Reader r(sensed.bytes()); r.next();) {
      if (r.header().kind == io::Kind::fault) faults_.push_back(r.as<io::FaultCommand>());
    }
    until_ns_ = until_ns;
  }
  Result<TargetState> arrive(io::Batch& happened) override {
    const std::int64_t t = until_ns_ - kMs;
    if (image_ == "lost" && t == 50 * kMs)
      return Error{ErrorKind::internal, "board", "no answer", ""};
    if (image_ == "late" && t == 50 * kMs) return Error{ErrorKind::host, "host", "too late", ""};
    if (image_ == "throws" && t == 50 * kMs) throw std::runtime_error("a bug");
    if (image_ == "interrupted" && t == 50 * kMs) pretend_interruption(SIGTERM);
    if (image_ == "asleep") return TargetState::running;
    if (image_ == "crash" && t == 50 * kMs) crash(happened, t);
    if (image_ == "bitten" && t == 50 * kMs) {
      happened.add(io::Kind::board_reset, io::kResetByWindowWatchdog, t, nullptr, 0);
    }
    tasks(happened, t);
    if (t % (20 * kMs) == 0) talk_to_escs(happened, t, false);
    if (t % (50 * kMs) == 10 * kMs) talk_to_escs(happened, t, true);
    return TargetState::running;
  }
  void stop(io::Batch&) override {}
  Offers offers() const override {
    return image_ == "modest" ? Offers{Offer::virtual_time} : kAll_offers;
  }
  std::vector<std::pair<std::string, std::string>> versions() const override {
    return {{"target", "fake"}};
  }

 private:
  void tasks(io::Batch& out, std::int64_t t) {
    out.add(io::Kind::data_ready, 0, t + 100 * kUs, nullptr, 0);
    const io::BusTransaction spi{t + 150 * kUs, 0, 1, 1, 15};
    io::add_transaction(io::Kind::spi_transaction, 1, t + 170 * kUs, spi, {&salt_, 1}, {}, out);
    out.add(io::Kind::function_call, 0, t + 200 * kUs,
            io::FunctionCall{t + 140 * kUs, 40 * kUs, 6 * kUs});
    if (t % (5 * kMs) == 0) {
      out.add(io::Kind::function_call, 1, t + 500 * kUs,
              io::FunctionCall{t + 300 * kUs, 150 * kUs});
    }
    if (t % (100 * kMs) == 0 && t > 0) {
      out.add(io::Kind::busy_time, 0, t, io::BusyTime{t - 100 * kMs, 40 * kMs});
    }
  }
  void talk_to_escs(io::Batch& out, std::int64_t t, bool read) {
    for (std::uint16_t n = 0; n < 4; ++n) {
      const auto address = static_cast<std::uint16_t>(0x29 + n);
      const std::int64_t start = t + 600 * kUs + n * 90 * kUs;
      const bool acked = !refused(out, address, start);
      const io::BusTransaction head{start, address, static_cast<std::uint8_t>(read),
                                    static_cast<std::uint8_t>(acked), 3};
      const std::uint8_t bytes[] = {0x10, 0x02, salt_};
      io::add_transaction(io::Kind::i2c_transaction, 3, start + 80 * kUs, head, bytes, {}, out);
    }
  }
  bool refused(io::Batch& out, int address, std::int64_t t) const {
    for (const io::FaultCommand& f : faults_) {
      if (f.kind != static_cast<std::uint32_t>(io::FaultKind::i2c_nack)) continue;
      if (f.address != address || t < f.start_ns || t >= f.end_ns) continue;
      out.add(io::Kind::fault_applied, static_cast<std::uint16_t>(f.number), t, nullptr, 0);
      return true;
    }
    return false;
  }
  static void crash(io::Batch& out, std::int64_t t) {
    io::CpuFault fault;
    fault.exception = 3;
    fault.pc = 0x08001234;
    fault.cfsr = 1u << 9;
    const std::string trace = "fw::crash+0x4 at 0x08001234\nmain+0x20 at 0x08000120";
    out.add(io::Kind::cpu_fault, 0, t, fault, trace.data(),
            static_cast<std::uint32_t>(trace.size()));
  }

  std::string image_;
  std::uint8_t salt_ = 0;
  std::int64_t until_ns_ = 0;
  std::vector<io::FaultCommand> faults_;
};

class FakeWorld final : public World {
 public:
  const std::vector<Signal>& signals() const override { return signals_; }
  void read(std::span<double> values) const override {
    values[0] = height_m_;
    values[1] = east_m_;
    values[2] = thrust_N_;
    values[3] = 0.01;
  }
  void step(std::int64_t t_ns, const io::Batch&, io::Batch& sensed) override {
    if (t_ns > 0) {
      height_m_ += (commanded_height_m_ - height_m_) * -std::expm1(-0.001 / 0.2);
      thrust_N_ += (commanded_thrust_N_ - thrust_N_) * -std::expm1(-0.001 / 0.05);
      east_m_ += t_ns < gust_end_ns_ ? 0.0003 : -east_m_ * -std::expm1(-0.001 / 0.5);
    }
    sensed.add(io::Kind::body_motion, 0, t_ns, io::BodyMotion{});
  }
  Result<Done> command(const Command& command, std::int64_t now_ns) override {
    wire_ns_ = now_ns + 300 * kUs;
    if (const auto* up = std::get_if<request::TakeOff>(&command)) {
      commanded_height_m_ = up->height_m;
    } else if (const auto* set = std::get_if<request::SetPoint>(&command)) {
      commanded_thrust_N_ = set->value_SI;
    } else {
      return not_understood("a fake", word(command));
    }
    return Done{};
  }
  Result<Done> disturb(const Disturbance& disturbance, std::int64_t now_ns) override {
    gust_end_ns_ =
        now_ns + std::llround(1e9 * std::get<request::Wind>(disturbance).duration_s.value());
    return Done{};
  }
  Result<bool> take_fault(const FaultSpec& fault) override {
    if (fault.kind != "mocap_lost") return false;
    applied_.push_back(fault.number);
    return true;
  }
  std::vector<std::uint32_t> applied_faults() const override { return applied_; }
  std::int64_t command_on_wire_ns() const override { return wire_ns_; }
  std::string status() const override { return "fake"; }

 private:
  std::vector<Signal> signals_{{"height", Dimension::length, ""},
                               {"east", Dimension::length, ""},
                               {"thrust", Dimension::force, ""},
                               {"tilt", Dimension::angle, ""}};
  double height_m_ = 0, commanded_height_m_ = 0, east_m_ = 0, thrust_N_ = 2.0,
         commanded_thrust_N_ = 2.0;
  std::int64_t gust_end_ns_ = 0, wire_ns_ = -1;
  std::vector<std::uint32_t> applied_;
};

constexpr const char* kBoard = R"(return {
  board = "fake", mcu = "stm32f405rg", hse = "24 MHz",
  devices = {
    { name = "imu", type = "mpu6000", bus = "spi1", cs = "PB0", int = "PC5" },
    { name = "esc1", type = "esc_i2c", bus = "i2c3", address = 0x29, motor = 1 },
    { name = "esc2", type = "esc_i2c", bus = "i2c3", address = 0x2A, motor = 2 },
    { name = "radio", type = "mavlink_link", bus = "usart2", baud = "57600 baud",
      params = { uplink_loss = "5 %" } },
  },
  watch = { "fw::imu_task", "fw::attitude_task" },
})";

}  // namespace

FakeRoot::FakeRoot() {
  for (const char* image : {"flight", "crash", "asleep", "lost", "late", "drifting", "throws",
                            "interrupted", "bitten", "modest"}) {
    write(std::string("build/firmware/") + image + ".elf", "");
  }
  write("test_plans/boards/px4fmu_v1.lua", kBoard);
  write("test_plans/vehicles/hp_quad.lua", "return {}");
}

void FakeRoot::write(const std::string& relative, const std::string& text) const {
  const fs::path path = folder_.file(relative);
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

std::string FakeRoot::read(const std::string& relative) const {
  std::ifstream in(folder_.file(relative), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

cli::Composition fake_composition(const std::string& root) {
  return {[](const cli::Setup&) -> Result<std::unique_ptr<World>> {
            return std::unique_ptr<World>(std::make_unique<FakeWorld>());
          },
          [](const cli::Setup& setup) -> Result<std::unique_ptr<Target>> {
            return std::unique_ptr<Target>(std::make_unique<FakeTarget>(setup));
          },
          root, root + "/results"};
}

Outcome whirl(const FakeRoot& root, const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"whirl"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size());
  for (std::string& word : words) argv.push_back(word.data());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Outcome outcome;
  outcome.code =
      cli::run_program(static_cast<int>(argv.size()), argv.data(), fake_composition(root.path()));
  outcome.out = ::testing::internal::GetCapturedStdout();
  outcome.err = ::testing::internal::GetCapturedStderr();
  return outcome;
}

}  // namespace whirl::test
