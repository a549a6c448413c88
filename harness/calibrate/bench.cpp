#include "harness/calibrate/bench.hpp"

#include "base/check.hpp"

namespace whirl::calibrate {
namespace {

constexpr std::int64_t kStep_ns = 1'000'000;
constexpr int kAnswer_ms = 500;
constexpr double kFlow_ramp_s = 0.5;

Error failed(const std::string& what, const std::string& cure = "") {
  return {ErrorKind::bad_input, "stand", what, cure};
}

}  // namespace

Bench::Bench(World& world, Target& target, std::uint16_t serial)
    : world_(world),
      target_(target),
      serial_(serial),
      row_(world.signals().size()),
      thrust_(find("cell_thrust")),
      torque_(find("cell_torque")),
      current_(find("bus_current")),
      voltage_(find("bus_voltage")),
      wind_(find("wind")) {
  line_.on_line([this](const std::string& text) { answers_.push_back(text); });
}

Bench::~Bench() {
  io::Batch rest;
  target_.stop(rest);
}

std::size_t Bench::find(const std::string& signal) const {
  const auto& signals = world_.signals();
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (signals[i].name == signal) return i;
  }
  WHIRL_CHECK(false, signal);
  return 0;
}

Result<Done> Bench::start() {
  if (auto started = target_.start(); !started) return started;
  world_.step(0, happened_, sensed_);
  read();
  return Done{};
}

void Bench::read() {
  world_.read(row_);
  read_ = {row_[thrust_], row_[torque_], row_[current_], row_[voltage_], row_[wind_]};
}

Result<Done> Bench::step() {
  const std::int64_t next_ns = now_ns_ + kStep_ns;
  target_.run(next_ns, sensed_);
  sensed_.clear();
  world_.step(next_ns, happened_, sensed_);
  happened_.clear();
  const auto arrived = target_.arrive(happened_);
  if (!arrived) return arrived.error();
  now_ns_ = next_ns;
  read();
  if (arrived.value() != TargetState::running) return failed("the core locked up");
  if (auto good = take(); !good) return good;
  if (sink_) sink_(*this);
  return Done{};
}

Result<Done> Bench::take() {
  for (io::Reader reader(happened_.bytes()); reader.next();) {
    const io::Header& header = reader.header();
    if (header.kind == io::Kind::cpu_fault) {
      return failed("the firmware ended in a fault", "a plan on the same stand tells where");
    }
    if (header.kind == io::Kind::board_reset && header.t_ns > 0) {
      return failed("the board was reset in mid-measurement");
    }
    if (header.kind == io::Kind::uart_received && header.port == serial_) {
      line_.take(reader.payload());
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
  return world_.command(request::Silence{}, now_ns_);
}

Result<Done> Bench::type(const std::string& line) {
  return world_.command(request::Line{line}, now_ns_);
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
  if (auto good = world_.disturb(wind, now_ns_); !good) return good;
  return run(static_cast<std::int64_t>(1000.0 * kFlow_ramp_s));
}

}  // namespace whirl::calibrate
