#include "harness/flight/flight_world.hpp"

#include <cmath>
#include <cstdio>

#include "base/check.hpp"
#include "harness/lua/table.hpp"

namespace whirl::flight {
namespace {

constexpr std::uint16_t kArmDisarm = 400, kLand = 21, kTakeoff = 22;  // MAV_CMD
constexpr double kStep_s = 1e-3;
constexpr std::int64_t kStep_ns = 1'000'000;
// Earth's field at Canberra in W (north, east, down).
const Eigen::Vector3d kMagneticField_W_T(23.0e-6, 5.1e-6, -52.9e-6);

void copy(const Eigen::Vector3d& from, double (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

int motor_of(const FaultSpec& fault) {  // "esc2": 2; 0: not named so
  if (fault.device.size() == 4 && fault.device.starts_with("esc")) return fault.device[3] - '0';
  return fault.address;
}

}  // namespace

FlightWorld::FlightWorld(const FlightParams& params, std::uint64_t seed)
    : FlightWorld(params, plant::blade_element_rotors(params.blade, params.vehicle.airframe),
                  seed) {}

FlightWorld::FlightWorld(const FlightParams& params, plant::RotorSet rotors, std::uint64_t seed)
    : vehicle_(params.vehicle, std::move(rotors), seed), capture_(params.capture, seed) {
  for (int motor = 1; motor <= 4; ++motor) escs_.emplace_back(params.esc, seed, motor);
  name_signals();
}

void FlightWorld::read(std::span<double> values) const {
  WHIRL_CHECK(values.size() == values_.size(), values.size(), values_.size());
  for (std::size_t i = 0; i < values_.size(); ++i) values[i] = values_[i]();
}

void FlightWorld::step(std::int64_t t_ns, const io::Batch& happened, io::Batch& sensed) {
  take(happened);
  if (t_ns > 0) move(t_ns);
  now_ns_ = t_ns;
  tell(t_ns, sensed);
}

void FlightWorld::take(const io::Batch& happened) {
  io::Reader reader(happened.bytes());
  while (reader.next()) {
    const io::Header& header = reader.header();
    if (header.kind == io::Kind::esc_setpoint) {
      WHIRL_CHECK(header.port >= 1 && header.port <= 4, header.port);
      const auto setpoint = reader.as<io::EscSetpoint>();
      if (setpoint.valid != 0) {
        escs_[header.port - 1u].write(setpoint.value);
      } else {
        ++setpoints_refused_;
      }
    } else if (header.kind == io::Kind::uart_received && header.port == kRadioPort) {
      station_.receive(reader.payload(), header.t_ns);
    } else if (header.kind == io::Kind::uart_delivered && header.port == kRadioPort) {
      station_.delivered(reader.payload(), header.t_ns);
    }
  }
}

void FlightWorld::move(std::int64_t t_ns) {
  WHIRL_CHECK(t_ns == now_ns_ + kStep_ns, t_ns, now_ns_);
  apply_faults(now_ns_);
  const plant::VehicleState& before = vehicle_.state();
  for (int i = 0; i < 4; ++i) {
    const auto n = static_cast<std::size_t>(i);
    vehicle_.command(i, escs_[n].step(now_ns_, before.motors[n], before.bus_voltage_V));
  }
  vehicle_.step(kStep_s);
}

void FlightWorld::tell(std::int64_t t_ns, io::Batch& sensed) {
  const plant::VehicleState& s = vehicle_.state();
  io::BodyMotion motion;
  copy(s.specific_force_B_mps2, motion.specific_force_B_mps2);
  copy(s.w_WB_B_radps, motion.w_WB_B_radps);
  copy(s.alpha_WB_B_radps2, motion.alpha_WB_B_radps2);
  copy(s.q_WB.conjugate() * kMagneticField_W_T, motion.magnetic_field_B_T);
  for (std::size_t i = 0; i < 4; ++i) motion.rotor_speed_radps[i] = s.motors[i].speed_radps;
  motion.static_pressure_Pa = s.static_pressure_Pa;
  motion.air_temperature_K = s.air_temperature_K;
  motion.bus_voltage_V = s.bus_voltage_V;
  sensed.add(io::Kind::body_motion, 0, t_ns, motion);

  for (std::size_t i = 0; i < 4; ++i) {
    sensed.add(io::Kind::esc_state, static_cast<std::uint16_t>(i + 1), t_ns, escs_[i].status());
  }
  const auto send = [&sensed](std::int64_t at_ns, std::span<const std::uint8_t> frame) {
    sensed.add(io::Kind::uart_frame, kRadioPort, at_ns, frame.data(),
               static_cast<std::uint32_t>(frame.size()));
  };
  const plant::Truth seen{.p_WB_W_m = s.p_WB_W_m, .v_WB_W_mps = s.v_WB_W_mps, .q_WB = s.q_WB};
  if (const auto pose = capture_.look(t_ns, seen)) station_.send_pose(*pose, send);
  station_.step(t_ns, send);
}

// ---- What a plan may ask

Result<Done> FlightWorld::command(const lua::Table& wish, std::int64_t /*now_ns*/) {
  if (wish.has("arm")) {
    const bool arm = wish.flag_or("arm", true);
    if (!arm) station_.set_target(std::nullopt);
    station_.command(kArmDisarm, {arm ? 1.0f : 0.0f});
  }
  if (wish.has("takeoff")) {
    const double height_m = wish.quantity("takeoff", Dimension::length, lua::above(0.0));
    if (height_m > 0.0) command_takeoff(height_m);
  }
  if (wish.has("position") || wish.has("yaw")) command_target(wish);
  if (wish.has("land") && wish.flag_or("land", true)) {
    station_.set_target(std::nullopt);
    station_.command(kLand, {});
  }
  return wish.finish();
}

void FlightWorld::command_takeoff(double height_m) {
  const plant::VehicleState& s = vehicle_.state();
  station_.set_target(
      Target{{s.p_WB_W_m.x(), s.p_WB_W_m.y(), -height_m}, roll_pitch_yaw_rad(s.q_WB).z()});
  station_.command(kTakeoff, {0, 0, 0, 0, 0, 0, static_cast<float>(height_m)});
}

void FlightWorld::command_target(const lua::Table& wish) {
  Target target = station_.target().value_or(Target{vehicle_.state().p_WB_W_m, 0.0});
  target.yaw_rad = wish.quantity_or("yaw", Dimension::angle, target.yaw_rad);
  if (wish.has("position")) {
    const lua::Table p = wish.table("position");
    target.p_W_m = {p.quantity_or("north", Dimension::length, target.p_W_m.x()),
                    p.quantity_or("east", Dimension::length, target.p_W_m.y()),
                    -p.quantity_or("height", Dimension::length, -target.p_W_m.z())};
  }
  if (!wish.has("speed")) return station_.set_target(target);
  station_.move_target(target, wish.quantity("speed", Dimension::speed, lua::above(0.0)));
}

Result<Done> FlightWorld::add_jet(const lua::Table& wish) {
  const lua::Table t = wish.table("jet");
  plant::Jet jet;
  jet.upward_mps = t.quantity("up", Dimension::speed);
  jet.north_m = t.quantity_or("north", Dimension::length, 0.0);
  jet.east_m = t.quantity_or("east", Dimension::length, 0.0);
  jet.radius_m = t.quantity("radius", Dimension::length, lua::above(0.0));
  jet.edge_m = t.quantity_or("edge", Dimension::length, jet.edge_m, lua::above(0.0));
  if (jet.edge_m > 2.0 * jet.radius_m) t.refuse("edge", "wider than the jet itself");
  if (auto good = wish.finish(); !good) return good;
  vehicle_.add_jet(jet);
  return Done{};
}

Result<Done> FlightWorld::gust(const lua::Table& wish, std::int64_t now_ns) {
  if (wish.has("jet")) return add_jet(wish);
  plant::GustWindow gust;
  gust.wind_W_mps = {wish.quantity_or("north", Dimension::speed, 0.0),
                     wish.quantity_or("east", Dimension::speed, 0.0),
                     wish.quantity_or("down", Dimension::speed, 0.0)};
  gust.duration_s = wish.quantity("duration", Dimension::time, lua::above(0.0));
  gust.edge_s = wish.quantity_or("edge", Dimension::time, gust.edge_s, lua::at_least(0.0));
  gust.start_s = static_cast<double>(now_ns) * 1e-9 +
                 wish.quantity_or("after", Dimension::time, 0.0, lua::at_least(0.0));
  if (gust.wind_W_mps.isZero()) wish.refuse("north", "a gust needs wind", "north, east or down");
  if (auto good = wish.finish(); !good) return good;
  vehicle_.add_gust(gust);
  return Done{};
}

bool FlightWorld::take_fault(const FaultSpec& fault) {
  if (fault.kind == "capture_lost") {
    capture_.occlude({fault.number, fault.start_ns, fault.end_ns});
    return true;
  }
  const int motor = motor_of(fault);
  const bool stops_esc = fault.kind == "esc_stopped" && motor >= 1 && motor <= 4;
  if (!stops_esc && fault.kind != "supply_dip") return false;
  faults_.push_back({fault});
  if (fault.kind == "supply_dip") {
    const double start_s = static_cast<double>(fault.start_ns) * 1e-9;
    vehicle_.dip_supply(fault.value, start_s, static_cast<double>(fault.end_ns) * 1e-9 - start_s);
  }
  return true;
}

void FlightWorld::apply_faults(std::int64_t t_ns) {
  for (WorldFault& fault : faults_) {
    if (t_ns < fault.spec.start_ns || t_ns >= fault.spec.end_ns) continue;
    fault.applied = true;
    if (fault.spec.kind == "esc_stopped") {
      escs_[static_cast<std::size_t>(motor_of(fault.spec)) - 1].cut();
    }
  }
}

std::vector<std::uint32_t> FlightWorld::applied_faults() const {
  std::vector<std::uint32_t> numbers;
  for (const WorldFault& fault : faults_) {
    if (fault.applied) numbers.push_back(fault.spec.number);
  }
  for (const Occlusion& occlusion : capture_.occlusions()) {
    if (occlusion.acted) numbers.push_back(occlusion.fault);
  }
  return numbers;
}

std::string FlightWorld::status() const {
  const Telemetry told = station_.telemetry(now_ns_);
  const plant::VehicleState& s = vehicle_.state();
  const char* state = s.on_ground ? "on the ground" : "in the air";
  if (!(told.frames > 0)) state = "silent";
  char text[80];
  std::snprintf(text, sizeof text, "%s, %.2f m", state, -s.p_WB_W_m.z());
  return text;
}

}  // namespace whirl::flight
