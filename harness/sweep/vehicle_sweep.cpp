#include <algorithm>
#include <cmath>
#include <limits>

#include "base/rpm.hpp"
#include "harness/flight/controllers.hpp"
#include "harness/sweep/steady_motor.hpp"
#include "harness/sweep/sweep.hpp"
#include "plant/battery/battery.hpp"
#include "plant/rotor/fitted_blade.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::sweep {
namespace {

using plant::AveragedMotor;
using results::Chart;
using results::ChartFigure;

constexpr double kGravity_mps2 = 9.80665;

plant::RotorLoads at_speed(const plant::Rotor& rotor, double omega_radps) {
  plant::RotorConditions c;
  c.omega_radps = omega_radps;
  return rotor.steady(c);
}

double full_pack_V(const flight::FlightParams& vehicle, const Options& options) {
  return options.bus_V > 0.0 ? options.bus_V
                             : vehicle.vehicle.battery.open_circuit.front().voltage_V;
}

Chart over_voltage(const std::vector<DrivePoint>& points, const std::string& title,
                   const std::string& y_label, double (*value)(const DrivePoint&)) {
  Chart chart{"Motor and propeller, over motor voltage",
              title,
              "motor voltage / V",
              y_label,
              "",
              "",
              {{"model", {}, {}, false}},
              {}};
  for (const DrivePoint& p : points) {
    chart.curves[0].x.push_back(p.voltage_V);
    chart.curves[0].y.push_back(value(p));
  }
  return chart;
}

Chart hover_chart(const flight::FlightParams& vehicle, const std::vector<DrivePoint>& points,
                  double bus_V) {
  Chart chart = over_voltage(points, "Efficiency", "thrust per electrical power / (N/W)",
                             [](const DrivePoint& p) { return p.thrust_N / p.electrical_W; });
  const auto found = hover_point(vehicle, bus_V);
  if (!found) {
    chart.note = found.error().message();
    return chart;
  }
  const DrivePoint& hover = found.value().each;
  const auto report = [&](const char* name, double x, const char* unit) {
    chart.figures.push_back({name, x, std::numeric_limits<double>::infinity(), unit, true});
  };
  report("hover: thrust of each motor", hover.thrust_N, "N");
  report("hover: speed", rpm_of(hover.speed_radps), "rpm");
  report("hover: bus voltage", found.value().bus_V, "V");
  report("hover: motor voltage", hover.voltage_V, "V");
  report("hover: winding current", hover.winding_A, "A");
  report("hover: bus current of each motor", hover.bus_A, "A");
  report("hover: shaft torque", hover.torque_Nm, "N m");
  report("hover: from the pack, all of it", found.value().total_A, "A");
  report("hover: time until the pack is empty", found.value().until_empty_s / 60.0, "min");
  if (const auto& band = found.value().band) {
    report("hover: from the pack, by the propeller's 90 % band at least", band->least_A, "A");
    report("hover: from the pack, by the propeller's 90 % band at most", band->most_A, "A");
    report("hover: time until empty, by that band at least", band->shortest_s / 60.0, "min");
    report("hover: time until empty, by that band at most", band->longest_s / 60.0, "min");
  }
  return chart;
}

plant::Drive drive_of(const flight::FlightParams& vehicle, double voltage_V, double bus_V) {
  const auto& type = flight::type_named(vehicle.controller, flight::controller_types());
  return {.bus_V = bus_V,
          .duty = voltage_V / bus_V,
          .diode = type.freewheel == plant::Freewheel::diode};
}

DrivePoint point_of(const plant::MotorBooks& books, double speed_radps,
                    const plant::RotorLoads& loads, double voltage_V, double bus_V) {
  const double time_s = kSubSteps * kSubStep_s;
  DrivePoint p{voltage_V, speed_radps, loads.thrust_N, loads.shaft_torque_Nm};
  p.winding_A = books.winding_charge_C / time_s;
  p.bus_A = books.bus_charge_C / time_s;
  p.shaft_W = p.torque_Nm * p.speed_radps;
  p.electrical_W = bus_V * p.bus_A;
  p.copper_W = books.copper_J / time_s;
  p.diode_W = books.diode_J / time_s;
  p.no_load_W = books.no_load_J / time_s;
  return p;
}

// The rotor at a thrust, whatever turns it, or at most_radps where that lifts less.
struct RotorPoint {
  double speed_radps = 0.0;
  plant::RotorLoads loads;
};
RotorPoint rotor_for(const flight::FlightParams& vehicle, double thrust_N, double most_radps) {
  const plant::Rotor rotor(vehicle.blade, +1);
  double low = 0.0, high = most_radps;
  for (int i = 0; i < 36; ++i) {
    const double middle = 0.5 * (low + high);
    (at_speed(rotor, middle).thrust_N < thrust_N ? low : high) = middle;
  }
  return {high, at_speed(rotor, high)};
}

// What a motor can turn at all on that bus.
double no_load_radps(const flight::FlightParams& vehicle, double bus_V) {
  return bus_V / vehicle.vehicle.motor.torque_constant_NmpA;
}

Result<DrivePoint> drive_rotor(const flight::FlightParams& vehicle, const RotorPoint& rotor,
                               double thrust_N, double bus_V) {
  const double speed_radps = rotor.speed_radps;
  const plant::ShaftLoad load{rotor.loads.shaft_torque_Nm / (speed_radps * speed_radps), 0.0};
  AveragedMotor motor(vehicle.vehicle.motor);
  // At that speed: the currents settle in the first piece, whether the shaft speeds up shows the second.
  const auto run = [&](double voltage_V) {
    const plant::Drive drive = drive_of(vehicle, voltage_V, bus_V);
    motor.set_speed(speed_radps);
    run_piece(motor, drive, load);
    motor.set_speed(speed_radps);
    return run_piece(motor, drive, load);
  };
  plant::MotorBooks books = run(bus_V);
  if (!(rotor.loads.thrust_N >= thrust_N && motor.speed_radps() >= speed_radps)) {
    return Error{ErrorKind::bad_input, vehicle.name,
                 "the drive cannot turn or lift that much at this voltage",
                 "a stronger motor, a larger propeller or more cells"};
  }
  double low = 0.0, high = bus_V;
  for (int i = 0; i < 22; ++i) {  // to a hundred thousandth of a volt
    const double middle = 0.5 * (low + high);
    books = run(middle);
    (motor.speed_radps() < speed_radps ? low : high) = middle;
  }
  return point_of(books, speed_radps, rotor.loads, high, bus_V);
}

plant::Battery rested(const plant::BatteryParams& pack, double depth) {
  plant::BatteryParams there = pack;
  there.initial_depth_of_discharge = depth;
  return plant::Battery(there);
}

double total_A(const flight::FlightParams& vehicle, const DrivePoint& each) {
  const auto motors = static_cast<double>(vehicle.vehicle.airframe.rotors.size());
  return motors * each.bus_A + vehicle.vehicle.avionics_current_A;
}

// The bus voltage falls with the current that it makes necessary: a contraction, for the drop is small.
Result<HoverPoint> hover_from(const flight::FlightParams& vehicle, const RotorPoint& rotor,
                              double thrust_N, double source_V, double ohm) {
  HoverPoint hover;
  hover.bus_V = source_V;
  for (int i = 0; i < 6; ++i) {
    const auto each = drive_rotor(vehicle, rotor, thrust_N, hover.bus_V);
    if (!each) return each.error();
    hover.each = each.value();
    hover.total_A = total_A(vehicle, hover.each);
    const double bus_V = std::max(0.1, source_V - ohm * hover.total_A);
    if (std::abs(bus_V - hover.bus_V) < 1e-3) break;
    hover.bus_V = bus_V;
  }
  return hover;
}

// Until a pack that hovers can no more, or is empty: ten equal shares of its charge, each at the current
// of its middle.
double until_empty_s(const flight::FlightParams& vehicle, const RotorPoint& rotor,
                     double thrust_N) {
  const plant::BatteryParams& pack = vehicle.vehicle.battery;
  constexpr int kShares = 10;
  double time_s = 0.0;
  for (int i = 0; i < kShares; ++i) {
    const plant::Battery there = rested(pack, (i + 0.5) / kShares);
    const auto hover = hover_from(vehicle, rotor, thrust_N, there.open_circuit_V(),
                                  there.settled_resistance_ohm());
    if (!hover) break;
    time_s += pack.capacity_C / kShares / hover.value().total_A;
  }
  return time_s;
}

}  // namespace

// The motor turns from rest at constant duty until nothing changes; the air's torque follows its
// speed from piece to piece.
DrivePoint drive_point(const flight::FlightParams& vehicle, double voltage_V, double bus_V) {
  const plant::Rotor rotor(vehicle.blade, +1);
  AveragedMotor motor(vehicle.vehicle.motor);
  plant::RotorLoads loads;
  const auto books =
      run_until_steady(motor, drive_of(vehicle, voltage_V, bus_V), [&](double speed_radps) {
        loads = at_speed(rotor, speed_radps);
        const double square = speed_radps * speed_radps;
        return plant::ShaftLoad{square > 1.0 ? loads.shaft_torque_Nm / square : 0.0, 0.0};
      });
  return point_of(books, motor.speed_radps(), loads, voltage_V, bus_V);
}

Result<DrivePoint> drive_for_thrust(const flight::FlightParams& vehicle, double thrust_N,
                                    double bus_V) {
  return drive_rotor(vehicle, rotor_for(vehicle, thrust_N, no_load_radps(vehicle, bus_V)), thrust_N,
                     bus_V);
}

Result<DrivePoint> drive_at_speed(const flight::FlightParams& drive, double speed_radps,
                                  double bus_V) {
  const plant::Rotor rotor(drive.blade, +1);
  const RotorPoint point{speed_radps, at_speed(rotor, speed_radps)};
  return drive_rotor(drive, point, point.loads.thrust_N, bus_V);
}

namespace {

// Of what is known of a rotor: more or less power for the same thrust.
RotorPoint at_power(RotorPoint rotor, double factor) {
  rotor.loads.shaft_torque_Nm *= factor;
  rotor.loads.shaft_power_W *= factor;
  return rotor;
}

}  // namespace

Result<HoverPoint> hover_point(const flight::FlightParams& vehicle, double bus_V) {
  const plant::Battery full = rested(vehicle.vehicle.battery, 0.0);
  const double source_V = bus_V > 0.0 ? bus_V : full.open_circuit_V();
  const double thrust_N = vehicle.vehicle.airframe.mass_kg * kGravity_mps2 /
                          static_cast<double>(vehicle.vehicle.airframe.rotors.size());
  const RotorPoint rotor = rotor_for(vehicle, thrust_N, no_load_radps(vehicle, source_V));
  const double ohm = bus_V > 0.0 ? 0.0 : full.series_resistance_ohm();
  const auto whole = [&](const RotorPoint& point) {
    auto hover = hover_from(vehicle, point, thrust_N, source_V, ohm);
    if (hover) hover.value().until_empty_s = until_empty_s(vehicle, point, thrust_N);
    return hover;
  };
  auto hover = whole(rotor);
  if (!hover || vehicle.fit == nullptr) return hover;
  const double half =
      plant::kNine_in_ten *
      plant::lifting_power_deviation(vehicle.fit->axial, vehicle.fit->belief, rotor.speed_radps);
  const auto less = whole(at_power(rotor, std::max(0.05, 1.0 - half)));
  const auto more = whole(at_power(rotor, 1.0 + half));
  HoverBand& band = hover.value().band.emplace();
  if (less) band.least_A = less.value().total_A, band.longest_s = less.value().until_empty_s;
  band.most_A = more ? more.value().total_A : std::numeric_limits<double>::infinity();
  if (more) band.shortest_s = more.value().until_empty_s;
  return hover;
}

std::vector<std::string> doubt_lines(const std::vector<std::string>& doubts) {
  std::vector<std::string> lines;
  lines.reserve(doubts.size());
  for (const std::string& doubt : doubts) lines.push_back("doubt: " + doubt);
  return lines;
}

namespace {

std::vector<Chart> over_voltage_and_propeller(const flight::FlightParams& drive,
                                              const Options& options,
                                              const std::vector<DrivePoint>& points) {
  std::vector<Chart> charts;
  charts.push_back(over_voltage(points, "Speed", "speed / rpm",
                                [](const DrivePoint& p) { return rpm_of(p.speed_radps); }));
  charts.push_back(
      over_voltage(points, "Thrust", "thrust / N", [](const DrivePoint& p) { return p.thrust_N; }));
  Chart currents = over_voltage(points, "Current", "current / A",
                                [](const DrivePoint& p) { return p.winding_A; });
  currents.curves[0].name = "winding";
  currents.curves.push_back({"bus", currents.curves[0].x, {}, false});
  for (const DrivePoint& p : points) currents.curves[1].y.push_back(p.bus_A);
  charts.push_back(currents);
  for (Chart& chart : propeller_sweep(drive.blade, options)) charts.push_back(std::move(chart));
  return charts;
}

std::vector<DrivePoint> over_all_voltages(const flight::FlightParams& drive, double bus_V) {
  std::vector<DrivePoint> points;
  points.reserve(15);
  for (int i = 2; i <= 16; ++i) points.push_back(drive_point(drive, bus_V * i / 16.0, bus_V));
  return points;
}

}  // namespace

std::vector<Chart> drive_sweep(const flight::FlightParams& drive, const Options& options) {
  return over_voltage_and_propeller(drive, options,
                                    over_all_voltages(drive, full_pack_V(drive, options)));
}

std::vector<Chart> vehicle_sweep(const flight::FlightParams& vehicle, const Options& options) {
  const double bus_V = full_pack_V(vehicle, options);
  const std::vector<DrivePoint> points = over_all_voltages(vehicle, bus_V);
  std::vector<Chart> charts = over_voltage_and_propeller(vehicle, options, points);
  charts.insert(charts.begin(), hover_chart(vehicle, points, options.bus_V));
  return charts;
}

}  // namespace whirl::sweep
