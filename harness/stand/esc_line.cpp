#include "harness/stand/esc_line.hpp"

#include <algorithm>
#include <cmath>

namespace whirl::stand {
namespace {

constexpr std::int64_t kTick_ns = 1'000'000, kStale_ns = 100'000'000;

}  // namespace

EscLine::EscLine(std::uint16_t port) : port_(port) {
  decoder_.on_line([this](const std::string& line) { hear(line); });
  decoder_.on_sample([this](const io::EscSample& sample) {
    if (sample_) period_ns_ = static_cast<std::int64_t>(sample.tick - sample_->tick) * kTick_ns;
    sample_ = sample;
    sample_ns_ = now_ns_;
  });
}

void EscLine::say(const std::string& line) {
  to_send_ += line + "\r\n";
  echo_ = line;
  open_.push_back(line);
}

Result<Done> EscLine::ask(const std::string& line) {
  if (!open_.empty()) {
    return Error{ErrorKind::bad_input, "",
                 "'" + open_.front() +
                     "' is not answered yet: what it says late could not be told " +
                     "from the answer to '" + line + "'",
                 "give the first one a longer limit"};
  }
  say(line);
  return Done{};
}

// A terminal may echo what it was told, behind its prompt: that is no answer.
void EscLine::hear(const std::string& line) {
  const std::size_t text = line.find_first_not_of("#$%>: ");
  if (!echo_.empty() && text != std::string::npos && line.compare(text, line.npos, echo_) == 0) {
    echo_.clear();
    return;
  }
  if (!to_send_.empty()) return;  // it cannot be about what has not been sent
  heard_.push_back(line);
  if (!open_.empty()) open_.erase(open_.begin());
}

void EscLine::send(std::int64_t t_ns, io::Batch& sensed) {
  now_ns_ = t_ns;
  if (to_send_.empty()) return;
  sensed.add(io::Kind::uart_frame, port_, t_ns, to_send_.data(),
             static_cast<std::uint32_t>(to_send_.size()));
  to_send_.clear();
}

void EscLine::on_message(const io::Reader& message) {
  if (message.header().kind != io::Kind::uart_received || message.header().port != port_) return;
  decoder_.decode(message.payload());
}

double EscLine::value(Field field) const {
  const std::int64_t age_ns = now_ns_ - sample_ns_;
  if (!sample_ || age_ns > std::max(kStale_ns, 3 * std::min(period_ns_, 1000 * kTick_ns))) {
    return std::nan("");
  }
  return field(*sample_);
}

std::vector<EscLine::Named> EscLine::signals() const {
  using D = Dimension;
  using S = const io::EscSample&;
  std::vector<Named> all;
  const auto add = [&](const char* name, D dimension, const char* about, Field field) {
    all.push_back({{name, dimension, std::string("the ESC's stream: ") + about},
                   [this, field] { return value(field); }});
  };
  const char* const converged = "of the stream through the disc over tip speed; NaN: not known";
  add("esc_bus_voltage", D::voltage, "measured", [](S s) -> double { return s.bus_voltage_V; });
  add("esc_raw_current", D::current, "of the bus, uncalibrated, 1 ms mean",
      [](S s) -> double { return s.raw_current_A; });
  add("esc_zero_current", D::current, "found at rest, taken off the raw one",
      [](S s) -> double { return s.zero_current_A; });
  add("esc_bus_current", D::current, "calibrated, 1 ms mean",
      [](S s) -> double { return s.bus_current_A; });
  add("esc_winding_current", D::current, "estimate",
      [](S s) -> double { return s.winding_current_A; });
  add("esc_duty", D::ratio, "of the bus voltage", [](S s) -> double { return s.duty; });
  add("esc_speed", D::angular_rate, "measured", [](S s) -> double { return s.speed_radps; });
  add("esc_wanted_speed", D::angular_rate, "set-point of the speed loop",
      [](S s) -> double { return s.wanted_speed_radps; });
  add("esc_acceleration", D::none, "estimate, rad/s2",
      [](S s) -> double { return s.acceleration_radps2; });
  add("esc_power", D::power, "aerodynamic, estimate", [](S s) -> double { return s.power_W; });
  add("esc_CP", D::none, "power over speed cubed, W s3", [](S s) -> double { return s.CP; });
  add("esc_CT", D::none, "thrust over speed squared, N s2", [](S s) -> double { return s.CT; });
  add("esc_thrust", D::force, "estimate", [](S s) -> double { return s.thrust_N; });
  add("esc_inflow", D::none, converged, [](S s) -> double {
    return s.solver == io::EscSolver::converged ? s.inflow_ratio : std::nan("");
  });
  add("esc_observable", D::none, "1: power determines inflow",
      [](S s) -> double { return s.solver == io::EscSolver::converged ? 1.0 : 0.0; });
  add("esc_solver", D::none, "0 converged, 1 not observable, 2 out of model, 3 no convergence",
      [](S s) { return static_cast<double>(static_cast<int>(s.solver)); });
  add("esc_iterations", D::none, "of the solver",
      [](S s) { return static_cast<double>(s.iterations); });
  add("esc_stream_flags", D::none, "status byte", [](S s) { return static_cast<double>(s.flags); });
  add("esc_mode", D::none, "control mode", [](S s) { return static_cast<double>(s.mode); });
  all.push_back(
      {{"esc_frames_lost", D::none, "of the stream: gaps of the sequence, bad CRCs"}, [this] {
         const auto& counts = decoder_.counts();
         return static_cast<double>(counts.lost_frames + counts.bad_crc);
       }});
  return all;
}

}  // namespace whirl::stand
