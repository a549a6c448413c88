#include "harness/sweep/motor_constants.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/rpm.hpp"
#include "plant/motor/commutation.hpp"

namespace whirl::sweep {
namespace {

using regression::Coefficient;
using regression::Problem;

constexpr std::size_t kFewest = 4;
constexpr double kGuess_of_R = 0.5;  // share by which a file's R may be off

std::vector<DriveRow> at_full_throttle(const std::vector<DriveFile>& files) {
  std::vector<DriveRow> rows;
  for (const DriveFile& file : files) {
    for (const DriveRow& row : file.rows) {
      if (row.duty >= kFull_throttle) rows.push_back(row);
    }
  }
  return rows;
}

struct Winding {  // of a row: what its pair of phases sees
  double volts = 0.0, amps = 0.0;
};

// As the input shows it: no commutation.
std::vector<Winding> as_seen(const std::vector<DriveRow>& rows) {
  std::vector<Winding> seen;
  seen.reserve(rows.size());
  for (const DriveRow& row : rows) seen.push_back({row.bus_V, row.bus_A});
  return seen;
}

// The pair's current beside a bus current, by the books of the averaged motor: each commutation hands a
// part of it back to the bus. What commutation takes of the voltage is taken out of it.
Winding behind_commutation(const DriveRow& row, const plant::MotorParams& motor) {
  Winding w{row.bus_V, row.bus_A};
  const double emf_V = motor.torque_constant_NmpA * row.speed_radps, R = motor.resistance_ohm;
  plant::Commutation c;
  for (int round = 0; round < 6; ++round) {
    c = plant::commutate(motor, {.bus_V = row.bus_V,
                                 .duty = 1.0,
                                 .resistance_ohm = R,
                                 .speed_radps = row.speed_radps,
                                 .pair_A = w.amps});
    const double fed_W = emf_V * (w.amps + c.push_A) +
                         R * (w.amps * w.amps + c.wobble_A2 + 0.75 * c.third_A2) +
                         motor.diode_drop_V * c.diode_A;
    w.amps *= row.bus_V * row.bus_A / fed_W;
  }
  w.volts = row.bus_V - c.ohm * w.amps - c.volts;
  return w;
}

Problem voltage_problem(const std::vector<DriveRow>& rows, const std::vector<Winding>& windings) {
  Problem p{"motor voltage", "voltage", "V", {}, {{"ke", "V s/rad", {}}, {"R", "ohm", {}}}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    p.y.push_back(windings[i].volts);
    p.columns[0].x.push_back(rows[i].speed_radps);
    p.columns[1].x.push_back(windings[i].amps);
    p.weights.push_back(1.0 / rows[i].bus_V);
  }
  return p;
}

// What commutation does hangs on the constants that are sought: from those that the input shows, until
// they stay.
Result<regression::Fit> fit_behind_commutation(const std::vector<DriveRow>& rows,
                                               plant::MotorParams motor,
                                               const regression::Fit& seen) {
  regression::Fit fit = seen;
  for (int round = 0; round < 12; ++round) {
    motor.torque_constant_NmpA = fit["ke"].value;
    motor.resistance_ohm = std::max(fit["R"].value, 0.05 * seen["R"].value);
    std::vector<Winding> windings;
    windings.reserve(rows.size());
    for (const DriveRow& row : rows) windings.push_back(behind_commutation(row, motor));
    const auto next = solve(voltage_problem(rows, windings));
    if (!next) return next;
    const double moved = std::abs(next.value()["R"].value - fit["R"].value);
    fit = next.value();
    if (moved < 1e-5 * seen["R"].value) break;
  }
  return fit;
}

// Rows do not err alike: amperes err by a share of themselves, and where they are many it shows. What the
// fit does without each row in turn (jackknife) tells that; the larger interval counts.
template <typename Solve>
Result<regression::Fit> with_honest_intervals(const std::vector<DriveRow>& rows,
                                              const Solve& solve_rows) {
  auto all = solve_rows(rows);
  if (!all) return all;
  auto& coefficients = all.value().coefficients;
  std::vector<double> square(coefficients.size(), 0.0);
  for (std::size_t gone = 0; gone < rows.size(); ++gone) {
    std::vector<DriveRow> rest = rows;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(gone));
    const auto fit = solve_rows(rest);
    if (!fit) return fit.error();  // it hangs on a single row
    for (std::size_t i = 0; i < square.size(); ++i) {
      const double moved = fit.value().coefficients[i].value - coefficients[i].value;
      square[i] += moved * moved;
    }
  }
  const auto n = static_cast<double>(rows.size());
  for (std::size_t i = 0; i < square.size(); ++i) {
    coefficients[i].error = std::max(coefficients[i].error, std::sqrt((n - 1.0) / n * square[i]));
    coefficients[i].half_width = all.value().t95 * coefficients[i].error;
  }
  return all;
}

Coefficient kv_of(const Coefficient& ke) {
  const double kv = rpm_of(1.0 / ke.value);
  return {"Kv", "rpm/V", kv, kv * ke.error / ke.value, kv * ke.half_width / ke.value};
}

// Rows that do not tell R may tell Kv all the same, for R takes a small share of the voltage.
void kv_by_the_files_ohm(const std::vector<DriveRow>& rows, const plant::MotorParams& motor,
                         MotorConstants& found) {
  Problem p = voltage_problem(rows, as_seen(rows));
  double share = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double ohm =
        motor.resistance_ohm + commutation_ohm_per_radps(motor) * rows[i].speed_radps;
    p.y[i] -= ohm * rows[i].bus_A;
    share += ohm * rows[i].bus_A / p.y[i] / static_cast<double>(rows.size());
  }
  p.columns.pop_back();
  const auto fit = solve(p);
  if (!fit || !(fit.value()["ke"].value > 0.0)) {
    found.untold.emplace_back("Kv: no positive one fits these rows");
    return;
  }
  Coefficient kv = kv_of(fit.value()["ke"]);
  kv.half_width = std::hypot(kv.half_width, kGuess_of_R * share * kv.value);
  found.kv_rpm_per_V = kv;
  found.notes.emplace_back("Kv by the file's R, which its interval lets be off by half");
}

Coefficient less(Coefficient c, double ohm, const char* name) {
  c.name = name;
  c.value -= ohm;
  return c;
}

bool tells_R(const Result<regression::Fit>& fit) {
  return fit && fit.value()["R"].half_width < std::abs(fit.value()["R"].value) &&
         fit.value()["ke"].half_width < fit.value()["ke"].value;
}

void fit_voltage(const std::vector<DriveRow>& rows, const plant::MotorParams& motor,
                 MotorConstants& found) {
  const auto by_input = [](const std::vector<DriveRow>& some) {
    return solve(voltage_problem(some, as_seen(some)));
  };
  const auto seen = with_honest_intervals(rows, by_input);
  if (!tells_R(seen)) {
    found.untold.emplace_back(
        "R: these rows do not tell it from Kv, for current and speed hardly vary against each "
        "other; "
        "measure at several voltages, or with several propellers");
    return kv_by_the_files_ohm(rows, motor, found);
  }
  found.seen_ohm = seen.value()["R"];
  const auto own = with_honest_intervals(rows, [&](const std::vector<DriveRow>& some) {
    return fit_behind_commutation(some, motor, seen.value());
  });
  if (!own || !(own.value()["R"].value > 0.0)) {
    found.untold.emplace_back(
        "R by ohmmeter: the file's inductance and pole pairs alone would look like more than what "
        "is seen; one of them is too large");
    found.kv_rpm_per_V = kv_of(seen.value()["ke"]);
    return;
  }
  found.kv_rpm_per_V = kv_of(own.value()["ke"]);
  found.ohmmeter_ohm = less(own.value()["R"], 0.0, "R by ohmmeter");
  const double bridge_ohm = motor.resistance_ohm - motor.winding_resistance_ohm;
  if (found.ohmmeter_ohm->value > bridge_ohm) {
    found.winding_ohm = less(own.value()["R"], bridge_ohm, "R of the winding");
  } else {
    found.untold.emplace_back("R of the winding: the file's bridge and leads have more than all");
  }
}

Result<Coefficient> no_load_by_torque(const std::vector<DriveRow>& rows) {
  Problem p{
      "no-load current", "current", "A", {}, {{"I0", "A", {}}, {"per torque", "A/(N m)", {}}}};
  for (const DriveRow& row : rows) {
    p.y.push_back(row.bus_A);
    p.columns[0].x.push_back(1.0);
    p.columns[1].x.push_back(row.torque_Nm);
  }
  const auto fit = solve(p);
  if (!fit) return fit.error();
  return fit.value()["I0"];
}

// Each propeller takes its own share of speed^power; none of a bare shaft.
Result<Coefficient> no_load_by_load(const std::vector<DriveRow>& rows, double power) {
  Problem p{"no-load current", "current", "A", {}, {{"I0", "A", {}}}};
  std::vector<std::string> props;
  for (const DriveRow& row : rows) {
    if (row.prop == kNothing_on_the_shaft) continue;
    if (std::find(props.begin(), props.end(), row.prop) == props.end()) props.push_back(row.prop);
  }
  for (const std::string& prop : props) p.columns.push_back({"load " + prop, "A", {}});
  for (const DriveRow& row : rows) {
    p.y.push_back(row.bus_A);
    p.columns[0].x.push_back(1.0);
    for (std::size_t i = 0; i < props.size(); ++i) {
      const double load = row.prop == props[i] ? std::pow(row.speed_radps / 1000.0, power) : 0.0;
      p.columns[i + 1].x.push_back(load);
    }
    p.weights.push_back(1.0 / row.bus_A);
  }
  const auto fit = solve(p);
  if (!fit) return fit.error();
  return fit.value()["I0"];
}

Result<Coefficient> no_load(const std::vector<DriveRow>& rows, MotorConstants& found) {
  if (std::all_of(rows.begin(), rows.end(), [](const DriveRow& r) { return r.torque_Nm > 0.0; })) {
    return no_load_by_torque(rows);
  }
  auto middle = no_load_by_load(rows, 2.0);
  if (!middle) return middle;
  double beside = 0.0;
  for (const double power : {1.85, 2.05}) {
    const auto side = no_load_by_load(rows, power);
    if (side) beside = std::max(beside, std::abs(side.value().value - middle.value().value));
  }
  middle.value().half_width += beside;
  if (beside > 0.0) {
    found.notes.emplace_back("I0 by the law of the load; rows of a bare shaft tell it better");
  }
  return middle;
}

void fit_no_load(const std::vector<DriveRow>& rows, MotorConstants& found) {
  const auto fit = no_load(rows, found);
  if (fit && fit.value().half_width < std::abs(fit.value().value) && fit.value().value > 0.0) {
    found.no_load_A = fit.value();
    return;
  }
  std::string why = "I0: these rows do not tell it from the load";
  if (fit) {
    char text[80];
    std::snprintf(text, sizeof text, " (%.2g +- %.2g A)", fit.value().value,
                  fit.value().half_width);
    why += text;
  }
  found.untold.push_back(why + "; add rows of a bare shaft (prop none), or a column Nm");
}

}  // namespace

double commutation_ohm_per_radps(const plant::MotorParams& motor) {
  return 1.5 / std::numbers::pi * motor.pole_pairs * motor.inductance_H;
}

double speed_at(const DriveRow& row, const plant::MotorParams& motor) {
  const Winding w = behind_commutation(row, motor);
  return (w.volts - motor.resistance_ohm * w.amps) / motor.torque_constant_NmpA;
}

Result<MotorConstants> motor_constants(const std::vector<DriveFile>& files,
                                       const plant::MotorParams& motor) {
  for (const DriveFile& file : files) {
    if (file.volts) continue;
    return Error{ErrorKind::bad_input, file.name, "no column V: without it no row tells Kv or R",
                 "measure the voltage at the ESC's input"};
  }
  const auto rows = at_full_throttle(files);
  if (rows.size() < kFewest) {
    return Error{ErrorKind::bad_input, files.empty() ? "" : files.front().name,
                 std::to_string(rows.size()) + " rows at full throttle are too few",
                 "4 or more, at several voltages or with several propellers"};
  }
  MotorConstants found;
  found.rows = static_cast<int>(rows.size());
  double speed = 0.0;
  std::size_t all = 0;
  for (const DriveRow& row : rows) speed += row.speed_radps / static_cast<double>(rows.size());
  for (const DriveFile& file : files) all += file.rows.size();
  if (all > rows.size()) {
    found.notes.push_back(std::to_string(all - rows.size()) +
                          " rows below full throttle were passed over");
  }
  found.commutation_ohm = commutation_ohm_per_radps(motor) * speed;
  fit_voltage(rows, motor, found);
  fit_no_load(rows, found);
  if (!found.kv_rpm_per_V && !found.no_load_A) {
    return Error{ErrorKind::bad_input, files.front().name, found.untold.front(), ""};
  }
  return found;
}

}  // namespace whirl::sweep
