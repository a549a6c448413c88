#include "harness/calibrate/bench.hpp"

#include "base/check.hpp"

namespace whirl::calibrate {
namespace {

constexpr int kAnswer_ms = 500;
constexpr double kFlow_ramp_s = 0.5;

Error failed(const std::string& what, const std::string& cure = "") {
  return {ErrorKind::bad_input, "stand", what, cure};
}

std::size_t column(const World& world, const char* signal) {
  const auto found = SignalTable(world.signals()).find(signal);
  WHIRL_CHECK(found.has_value(), signal);
  return *found;
}

}  // namespace

Bench::Bench(World& world, Target& target, std::uint16_t serial)
    : world_(world),
      lockstep_(world, target),
      serial_(serial),
      thrust_(column(world, "cell_thrust")),
      torque_(column(world, "cell_torque")),
      current_(column(world, "meter_current")),
      voltage_(column(world, "meter_voltage")),
      wind_(column(world, "meter_wind")) {
  line_.on_line([this](const std::string& text) { answers_.push_back(text); });
}

Bench::~Bench() {
  lockstep_.stop();
}

Result<Done> Bench::start() {
  if (auto started = lockstep_.start(); !started) return started;
  read();
  return Done{};
}

void Bench::read() {
  const std::vector<double>& row = lockstep_.row();
  read_ = {row[thrust_], row[torque_], row[current_], row[voltage_], row[wind_]};
}

Result<Done> Bench::step() {
  const auto arrived = lockstep_.step();
  if (!arrived) return arrived.error();
  read();
  if (arrived.value() != TargetState::running) return failed("the core locked up");
  if (auto good = on_messages(); !good) return good;
  if (sink_) sink_(*this);
  return Done{};
}

Result<Done> Bench::on_messages() {
  for (io::Reader reader(lockstep_.happened().bytes()); reader.next();) {
    const io::Header& header = reader.header();
    if (header.kind == io::Kind::cpu_fault) {
      return failed("the firmware ended in a fault", "a plan on the same stand tells where");
    }
    if (header.kind == io::Kind::board_reset && header.t_ns > 0) {
      return failed("the board was reset in mid-measurement");
    }
    if (header.kind == io::Kind::uart_received && header.port == serial_) {
      line_.decode(reader.payload());
    }
  }
  return Done{};
}

Result<Done> Bench::run(std::int64_t duration_ms) {
  for (std::int64_t i = 0; i < duration_ms; ++i) {
    if (auto good = step(); !good) return good;
  }
  return Done{};
}

Result<Done> Bench::silence() {
  return world_.command(request::Silence{}, lockstep_.now_ns());
}

Result<Done> Bench::type(const std::string& line) {
  return world_.command(request::Line{line}, lockstep_.now_ns());
}

Result<std::string> Bench::ask(const std::string& line) {
  answers_.clear();
  if (auto typed = type(line); !typed) return typed.error();
  for (int ms = 0; ms < kAnswer_ms; ++ms) {
    if (auto good = step(); !good) return good.error();
    if (!answers_.empty()) return answers_.front();
  }
  return failed("no answer to '" + line + "' on the serial line");
}

void Bench::on_sample(std::function<void(const io::EscSample&)> sink) {
  line_.on_sample(std::move(sink));
}

Result<Done> Bench::must(const std::string& line) {
  const auto answer = ask(line);
  if (!answer) return answer.error();
  if (answer.value() == "ok") return Done{};
  return failed("the ESC answers '" + answer.value() + "' to '" + line + "'");
}

Result<Done> Bench::blow(double down_mps) {
  const request::Wind wind{.down_mps = down_mps, .edge_s = kFlow_ramp_s};
  if (auto good = world_.disturb(wind, lockstep_.now_ns()); !good) return good;
  return run(static_cast<std::int64_t>(1000.0 * kFlow_ramp_s));
}

}  // namespace whirl::calibrate
