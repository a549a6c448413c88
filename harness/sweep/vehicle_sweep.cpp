#include <cmath>

#include "base/rpm.hpp"
#include "harness/sweep/sweep.hpp"
#include "plant/motor/averaged_motor.hpp"
#include "plant/rotor/rotor.hpp"

namespace whirl::sweep {
namespace {

using plant::AveragedMotor;
using results::Chart;
using results::ChartFigure;

constexpr double kSubStep_s = 2e-4;
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
  const double weight_N = vehicle.vehicle.airframe.mass_kg * kGravity_mps2;
  const auto motors = static_cast<double>(vehicle.vehicle.airframe.rotors.size());
  const auto found = drive_for_thrust(vehicle, weight_N / motors, bus_V);
  if (!found) {
    chart.note = found.error().message();
    return chart;
  }
  const DrivePoint& hover = found.value();
  const double total_A = motors * hover.bus_A + vehicle.vehicle.avionics_current_A;
  const auto report = [&](const char* name, double x, const char* unit) {
    chart.figures.push_back({name, x, std::numeric_limits<double>::infinity(), unit, true});
  };
  report("hover: thrust of each motor", hover.thrust_N, "N");
  report("hover: speed", rpm_of(hover.speed_radps), "rpm");
  report("hover: motor voltage", hover.voltage_V, "V");
  report("hover: winding current", hover.winding_A, "A");
  report("hover: bus current of each motor", hover.bus_A, "A");
  report("hover: shaft torque", hover.torque_Nm, "N m");
  report("hover: from the pack, all of it", total_A, "A");
  report("hover: time until the pack is empty", vehicle.vehicle.battery.capacity_C / total_A / 60.0,
         "min");
  return chart;
}

}  // namespace

// The motor turns from rest at constant duty until nothing changes; the air's torque follows its
// speed in pieces of 10 ms.
DrivePoint drive_point(const flight::FlightParams& vehicle, double voltage_V, double bus_V) {
  const plant::Rotor rotor(vehicle.blade, +1);
  AveragedMotor motor(vehicle.vehicle.motor);
  const plant::Drive drive{.bus_V = bus_V, .duty = voltage_V / bus_V};
  plant::RotorLoads loads;
  plant::MotorBooks books;
  constexpr int kSubSteps = 50;
  for (int piece = 0; piece < 400; ++piece) {
    const double before = motor.speed_radps();
    loads = at_speed(rotor, before);
    const double square = before * before;
    const plant::ShaftLoad load{square > 1.0 ? loads.shaft_torque_Nm / square : 0.0, 0.0};
    books = {};
    for (int i = 0; i < kSubSteps; ++i) books += motor.step(drive, load, kSubStep_s);
    if (std::abs(motor.speed_radps() - before) <= 1e-7 * (1.0 + before)) break;
  }
  const double time_s = kSubSteps * kSubStep_s;
  DrivePoint p{voltage_V, motor.speed_radps(), loads.thrust_N, loads.shaft_torque_Nm};
  p.winding_A = books.winding_charge_C / time_s;
  p.bus_A = books.bus_charge_C / time_s;
  p.shaft_W = p.torque_Nm * p.speed_radps;
  p.electrical_W = bus_V * p.bus_A;
  p.copper_W = books.copper_J / time_s;
  p.diode_W = books.diode_J / time_s;
  p.no_load_W = books.no_load_J / time_s;
  return p;
}

Result<DrivePoint> drive_for_thrust(const flight::FlightParams& vehicle, double thrust_N,
                                    double bus_V) {
  double low = 0.0, high = bus_V;
  DrivePoint best = drive_point(vehicle, high, bus_V);
  if (!(best.thrust_N >= thrust_N)) {
    return Error{ErrorKind::bad_input, vehicle.name,
                 "the drive cannot lift the vehicle at this voltage",
                 "a stronger motor, a larger propeller or more cells"};
  }
  for (int i = 0; i < 18; ++i) {  // to a ten thousandth of a volt
    const double middle = 0.5 * (low + high);
    const DrivePoint p = drive_point(vehicle, middle, bus_V);
    (p.thrust_N < thrust_N ? low : high) = middle;
    if (p.thrust_N >= thrust_N) best = p;
  }
  return best;
}

std::vector<Chart> vehicle_sweep(const flight::FlightParams& vehicle, const Options& options) {
  const double bus_V = full_pack_V(vehicle, options);
  std::vector<DrivePoint> points;
  for (int i = 2; i <= 16; ++i) points.push_back(drive_point(vehicle, bus_V * i / 16.0, bus_V));
  std::vector<Chart> charts;
  charts.push_back(hover_chart(vehicle, points, bus_V));
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
  for (Chart& chart : propeller_sweep(vehicle.blade, options)) charts.push_back(std::move(chart));
  return charts;
}

}  // namespace whirl::sweep
