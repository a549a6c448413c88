#include "harness/flight/flight_world.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "harness/flight/teleoperation.hpp"
#include "plant/base/motor_count.hpp"

namespace whirl::flight {
namespace {

constexpr float kForce = 21196.0f;  // of MAV_CMD_COMPONENT_ARM_DISARM
constexpr std::uint16_t kArmDisarm = 400, kLand = 21, kTakeoff = 22;  // MAV_CMD
constexpr const char* kCapture_lost = "capture_lost";
constexpr double kStep_s = 1e-3;
constexpr std::int64_t kStep_ns = 1'000'000;

static_assert(io::kMostMotors == plant::kMostMotors);  // BodyMotion has room for each rotor

void copy(const Eigen::Vector3d& from, double (&to)[3]) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

}  // namespace

FlightWorld::FlightWorld(const FlightParams& params, std::uint64_t seed)
    : FlightWorld(params, plant::blade_element_rotors(params.blade, params.vehicle.airframe),
                  seed) {}

FlightWorld::FlightWorld(const FlightParams& params, plant::RotorSet rotors, std::uint64_t seed,
                         const ControllerTypes& types)
    : place_(params.place),
      has_load_(params.vehicle.load.has_value()),
      ears_(params.ears),
      far_parts_(params.sensing_boards, params.far_escs),
      vehicle_(make_vehicle(params, std::move(rotors), seed)),
      airframe_(params.vehicle.airframe),
      obstacles_(params.vehicle.obstacles),
      seed_(seed),
      drawn_(params.drawn),
      doubts_(params.doubts),
      capture_(params.capture, seed),
      drag_truth_(params.vehicle.airframe),
      transmitter_(params.ears.receivers_board) {
  for (const plant::RotorMount& mount : airframe_.rotors) {
    unbalance_m_.push_back(mount.unbalance_kgm / airframe_.mass_kg);
  }
  if (remote_ != nullptr) {
    far_.emplace(params.far_shafts, *remote_);
  } else {
    make_controllers(params, seed, types);
  }
  station_.on_frame([this](const io::MavlinkFrame& frame, std::int64_t at_ns) {
    estimates_.hear(frame, at_ns);
    receiver_.hear(frame);
  });
  if (place_.start) begin(*place_.start);
  name_signals();
}

plant::Vehicle FlightWorld::make_vehicle(const FlightParams& params, plant::RotorSet rotors,
                                         std::uint64_t seed) {
  const plant::VehicleParams& v = params.vehicle;
  if (params.far_shafts.empty()) return {v, std::move(rotors), seed};
  auto remote = std::make_unique<plant::RemotePowertrain>(
      v.airframe.rotors.size(), v.battery, v.avionics_current_A, v.motor.inertia_kgm2);
  remote_ = remote.get();
  return {v, std::move(rotors), std::move(remote), seed};
}

void FlightWorld::make_controllers(const FlightParams& params, std::uint64_t seed,
                                   const ControllerTypes& types) {
  const ControllerType& type = type_named(params.controller, types);
  for (std::size_t i = 0; i < airframe_.rotors.size(); ++i) {
    controllers_.push_back(type.make(params, seed, static_cast<int>(i) + 1));
  }
  shorts_A_.assign(controllers_.size(), 0.0);
}

void FlightWorld::begin(const Start& start) {
  vehicle_.place(start.p_WB_W_m, start.q_WB, start.v_WB_W_mps, start.w_WB_B_radps);
  for (std::size_t i = 0; i < controllers_.size(); ++i) {
    vehicle_.set_motor_speed(static_cast<int>(i), start.motor_speed_radps);
  }
}

void FlightWorld::read(std::span<double> values) const {
  WHIRL_CHECK(values.size() == values_.size(), values.size(), values_.size());
  for (std::size_t i = 0; i < values_.size(); ++i) values[i] = values_[i]();
}

void FlightWorld::step(std::int64_t t_ns, const io::Batch& happened, io::Batch& sensed) {
  on_messages(happened);
  if (t_ns > 0) move(t_ns);
  estimates_.remember(t_ns, vehicle_.state(), place_.field_W_T(vehicle_.state().p_WB_W_m, t_ns));
  now_ns_ = t_ns;
  send(t_ns, sensed);
}

void FlightWorld::on_messages(const io::Batch& happened) {
  io::Reader reader(happened.bytes());
  while (reader.next()) {
    const io::Header& header = reader.header();
    if (far_ && far_->hears(header)) {
      far_->on_message(reader);
    } else if (far_parts_.hears(header)) {
      far_parts_.on_message(reader);
    } else if (far_parts_.is_esc(header)) {
      WHIRL_CHECK(header.port >= 1 && header.port <= airframe_.rotors.size(), header.port);
      const auto setpoint = reader.as<io::EscSetpoint>();
      if (setpoint.valid != 0) {
        if (far_) continue;  // its board has it from the wire
        controllers_[header.port - 1u]->write(setpoint.value);
      } else {
        ++setpoints_refused_;
      }
    } else if (header.kind == io::Kind::gnss_solution) {
      receiver_.on_solution(reader.as<io::GnssSolution>(), header.t_ns);
    } else if (header.kind == io::Kind::uart_received && is_radio(header)) {
      station_.receive(reader.payload(), header.t_ns);
    } else if (header.kind == io::Kind::uart_delivered && is_radio(header)) {
      station_.delivered(reader.payload(), header.t_ns);
    }
  }
}

void FlightWorld::move(std::int64_t t_ns) {
  WHIRL_CHECK(t_ns == now_ns_ + kStep_ns, t_ns, now_ns_);
  apply_faults(now_ns_);
  const plant::VehicleState& before = vehicle_.state();
  for (std::size_t i = 0; i < controllers_.size(); ++i) {
    plant::MotorCommand command =
        controllers_[i]->step(now_ns_, before.motors[i], before.bus_voltage_V);
    command.short_A = shorts_A_[i];
    vehicle_.command(static_cast<int>(i), command);
  }
  carry(t_ns);
  if (far_) far_->before_step();
  vehicle_.step(kStep_s);
  if (far_) far_->after_step(vehicle_.state().energy);
  drag_truth_.step(vehicle_.state(), kStep_s);
}

void FlightWorld::send(std::int64_t t_ns, io::Batch& sensed) {
  const plant::VehicleState& s = vehicle_.state();
  io::BodyMotion motion;
  copy(s.specific_force_B_mps2, motion.specific_force_B_mps2);
  copy(s.w_WB_B_radps, motion.w_WB_B_radps);
  copy(s.alpha_WB_B_radps2, motion.alpha_WB_B_radps2);
  copy(s.q_WB.conjugate() * place_.field_W_T(s.p_WB_W_m, t_ns), motion.magnetic_field_B_T);
  for (std::size_t i = 0; i < s.motors.size(); ++i) {
    motion.rotor_speed_radps[i] = s.motors[i].speed_radps;
    motion.rotor_thrust_N[i] = s.motors[i].thrust_N;
    motion.rotor_unbalance_m[i] = unbalance_m_[i];
    motion.rotor_bus_current_A[i] = s.motors[i].bus_current_A;
  }
  motion.static_pressure_Pa = s.static_pressure_Pa;
  motion.air_temperature_K = s.air_temperature_K;
  motion.bus_voltage_V = s.bus_voltage_V;
  motion.battery_current_A = s.battery_current_A;
  copy(s.p_WB_W_m, motion.p_WB_W_m);
  copy(s.v_WB_W_mps, motion.v_WB_W_mps);
  copy(s.q_WB.conjugate() * (s.v_WB_W_mps - s.wind_W_mps), motion.v_AB_B_mps);
  const double q_WB[4] = {s.q_WB.w(), s.q_WB.x(), s.q_WB.y(), s.q_WB.z()};
  std::copy(std::begin(q_WB), std::end(q_WB), std::begin(motion.q_WB));
  sensed.add(io::Kind::body_motion, 0, t_ns, motion);
  far_parts_.send(t_ns, motion, sensed);

  for (std::size_t i = 0; i < controllers_.size(); ++i) {
    far_parts_.send_esc(t_ns, static_cast<std::uint16_t>(i + 1), controllers_[i]->status(), sensed);
  }
  if (far_) {
    dip_leads(t_ns);
    far_->send(t_ns, sensed);
  }
  transmitter_.step(t_ns, sensed);
  const auto send = [&](std::int64_t at_ns, std::span<const std::uint8_t> frame) {
    sensed.add({at_ns, io::Kind::uart_frame, ears_.radios_board, kRadioPort, 0}, {frame});
  };
  guest_.send(ears_.radios_board, kRadioPort, t_ns, sensed);
  const plant::Truth seen{.p_WB_W_m = s.p_WB_W_m, .v_WB_W_mps = s.v_WB_W_mps, .q_WB = s.q_WB};
  const auto hidden = [&] { return faults_.any(kCapture_lost, t_ns); };
  if (const auto pose = capture_.look(t_ns, seen, hidden)) {
    station_.send_pose(spoiled(*pose, t_ns), send);
  }
  station_.step(t_ns, send);
}

// ---- What a plan may ask

// A command that nobody on board can hear would be none, and a plan that shows nothing.
Result<Done> FlightWorld::must_be_heard(const Command& command) const {
  if (std::holds_alternative<request::Sticks>(command)) {
    if (ears_.receiver) return Done{};
    return refusal("rc", "the board has no receiver for it", "cppm or sbus, in the board file");
  }
  if (ears_.radio) return Done{};
  return refusal(word(command), "the board has no radio that hears it",
                 "mavlink_link, in the board file");
}

Result<Done> FlightWorld::command(const Command& command, std::int64_t /*now_ns*/) {
  if (const auto heard = must_be_heard(command); !heard) return heard.error();
  return std::visit(
      Match{
          [this](const request::Arm& c) -> Result<Done> { return arm(c), Done{}; },
          [this](const request::TakeOff& c) -> Result<Done> { return take_off(c), Done{}; },
          [this](const request::GoTo& c) -> Result<Done> { return go_to(c), Done{}; },
          [this](const request::Land&) -> Result<Done> { return land(), Done{}; },
          [this](const request::Figure8& c) -> Result<Done> { return fly_figure_8(c), Done{}; },
          [this](const request::Cruise& c) -> Result<Done> { return cruise(c), Done{}; },
          [this](const request::HoldAttitude& c) -> Result<Done> {
            return hold_attitude(c), Done{};
          },
          [this](const request::Waypoints& c) -> Result<Done> { return fly_waypoints(c), Done{}; },
          [this](const request::Teleoperation& c) -> Result<Done> {
            return teleoperate(c), Done{};
          },
          [this](const request::Radio& c) -> Result<Done> { return add_guest(c), Done{}; },
          [this](const request::Sticks& c) -> Result<Done> { return transmitter_.set(c), Done{}; },
          [this](const request::Calibrate& c) -> Result<Done> { return calibrate(c), Done{}; },
          [this](const request::SetParameter& c) -> Result<Done> {
            station_.request_parameter(
                c.name, c.value ? std::optional(static_cast<float>(*c.value)) : std::nullopt);
            return Done{};
          },
          [&](const auto&) -> Result<Done> { return not_understood("a flight", word(command)); }},
      command);
}

void FlightWorld::arm(const request::Arm& command) {
  if (!command.arm) station_.set_target(std::nullopt);
  station_.command(kArmDisarm, {command.arm ? 1.0f : 0.0f, command.force ? kForce : 0.0f});
}

void FlightWorld::take_off(const request::TakeOff& command) {
  const plant::VehicleState& s = vehicle_.state();
  station_.set_target(
      Target{{s.p_WB_W_m.x(), s.p_WB_W_m.y(), -command.height_m}, roll_pitch_yaw_rad(s.q_WB).z()});
  station_.command(kTakeoff, {0, 0, 0, 0, 0, 0, static_cast<float>(command.height_m)});
}

void FlightWorld::land() {
  station_.set_target(std::nullopt);
  station_.command(kLand, {});
}

Target FlightWorld::present_target() const {
  return station_.target().value_or(Target{vehicle_.state().p_WB_W_m, 0.0});
}

void FlightWorld::go_to(const request::GoTo& command) {
  Target target = present_target();
  target.yaw_rad = command.yaw_rad.value_or(target.yaw_rad);
  target.p_W_m = {command.north_m.value_or(target.p_W_m.x()),
                  command.east_m.value_or(target.p_W_m.y()),
                  -command.height_m.value_or(-target.p_W_m.z())};
  if (!command.speed_mps) return station_.set_target(target);
  station_.move_target(target, *command.speed_mps);
}

void FlightWorld::fly_figure_8(const request::Figure8& figure) {
  const double w = 2.0 * M_PI / figure.period_s;
  const double yaw_rad = station_.target() ? station_.target()->yaw_rad : 0.0;
  station_.follow(
      [figure, w](double t_s) -> PathPoint {
        const double c = std::cos(w * t_s), s = std::sin(w * t_s);
        const double c2 = std::cos(2.0 * w * t_s), s2 = std::sin(2.0 * w * t_s);
        const double n = figure.north_m, e = figure.east_m;
        return {{n * c, e * s2, -figure.height_m},
                {-n * w * s, 2.0 * e * w * c2, 0.0},
                {-n * w * w * c, -4.0 * e * w * w * s2, 0.0}};
      },
      yaw_rad);
}

void FlightWorld::cruise(const request::Cruise& command) {
  Target at = present_target();
  at.p_W_m.z() = -command.height_m.value_or(-at.p_W_m.z());
  station_.cruise({command.north_mps, command.east_mps, 0.0}, at);
}

void FlightWorld::hold_attitude(const request::HoldAttitude& command) {
  const Target now = present_target();
  const Target held{now.p_W_m, command.yaw_rad.value_or(now.yaw_rad)};
  station_.hold({.roll_rad = command.roll_rad,
                 .pitch_rad = command.pitch_rad,
                 .yaw_rad = held.yaw_rad,
                 .yaw_rate_radps = command.yaw_rate_radps,
                 .thrust = command.thrust},
                held);
}

void FlightWorld::fly_waypoints(const request::Waypoints& wanted) {
  waypoints_ = std::make_shared<WaypointFlight>(wanted, present_target(), now_ns_);
  station_.guide([this, flight = waypoints_](std::int64_t t_ns) {
    return flight->at(t_ns, station_.last_pose());
  });
}

void FlightWorld::teleoperate(const request::Teleoperation& wanted) {
  const auto hand = std::make_shared<Teleoperation>(wanted, present_target(), now_ns_);
  station_.guide([hand](std::int64_t t_ns) { return hand->at(t_ns); });
}

void FlightWorld::add_guest(const request::Radio& radio) {
  if (guest_.add(radio.bytes)) station_.set_target(std::nullopt);
}

Result<Done> FlightWorld::disturb(const Disturbance& disturbance, std::int64_t now_ns) {
  return std::visit(Match{[this](const request::Jet& jet) { return add_jet(jet); },
                          [&](const request::Wind& wind) { return blow(wind, now_ns); },
                          [&](const request::Magnet& m) { return add_magnet(m, now_ns); },
                          [&](const request::Hold& h) { return hold_in_hand(h, now_ns); },
                          [&](const request::Release& r) { return release(r, now_ns); }},
                    disturbance);
}

Result<Done> FlightWorld::add_magnet(const request::Magnet& wanted, std::int64_t now_ns) {
  FieldSource magnet{.field_W_T = {wanted.north_T, wanted.east_T, wanted.down_T},
                     .p_W_m = {wanted.at_north_m, wanted.at_east_m, -wanted.at_height_m}};
  if (wanted.radius_m) magnet.radius_m = *wanted.radius_m;
  if (wanted.duration_s) magnet.end_ns = now_ns + std::llround(*wanted.duration_s * 1e9);
  place_.magnets.push_back(magnet);
  return Done{};
}

Result<Done> FlightWorld::add_jet(const request::Jet& wanted) {
  plant::Jet jet;
  jet.upward_mps = wanted.up_mps;
  jet.north_m = wanted.north_m;
  jet.east_m = wanted.east_m;
  jet.radius_m = wanted.radius_m;
  jet.edge_m = wanted.edge_m.value_or(jet.edge_m);
  if (jet.edge_m > 2.0 * jet.radius_m) return refusal("jet.edge", "wider than the jet itself");
  vehicle_.add_jet(jet);
  return Done{};
}

Result<Done> FlightWorld::blow(const request::Wind& wind, std::int64_t now_ns) {
  if (!wind.duration_s) return refusal("duration", "is missing: a time is wanted");
  if (!(*wind.duration_s > 0.0)) return refusal("duration", "must be positive");
  plant::GustWindow gust;
  gust.wind_W_mps = {wind.north_mps.value_or(0.0), wind.east_mps.value_or(0.0),
                     wind.down_mps.value_or(0.0)};
  if (gust.wind_W_mps.isZero()) {
    return refusal("north", "a gust needs wind", "north, east or down");
  }
  gust.duration_s = *wind.duration_s;
  gust.edge_s = wind.edge_s.value_or(gust.edge_s);
  gust.start_s = static_cast<double>(now_ns) * 1e-9 + wind.after_s.value_or(0.0);
  vehicle_.add_gust(gust);
  return Done{};
}

}  // namespace whirl::flight
