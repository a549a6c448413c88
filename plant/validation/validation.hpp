// What a proof of the plant is made of: curves, the reference points they must meet, error figures
// with their limits. `whirl validate` draws them; the tests check them.
//
//   Rule  a reference comes from outside the plant: a table, a measurement, a closed form. A figure
//         without a reference is a report: its limit is infinite and its note says why.
#pragma once
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace whirl::plant {

class Blade;

struct Curve {
  std::string name;  // "model", "thesis, static fit"
  std::vector<double> x, y;
};

struct Figure {
  std::string name;  // "worst error of thrust"
  double measured = 0.0;
  double limit = std::numeric_limits<double>::infinity();  // on the magnitude
  std::string unit;
  bool within() const { return std::abs(measured) <= limit; }  // NaN is not
};

struct Proof {
  std::string title;
  std::string x_label, y_label;  // with units
  std::string source{};          // of the reference, a key of REFERENCES.md
  std::vector<Curve> model{}, reference{};
  std::vector<Figure> figures{};
  std::string note{};
};

// Motor, battery, airframe and sensors; `blade` is the 10 x 4.5 of the reference vehicle.
// Each takes seconds.
std::vector<Proof> motor_proofs(const std::shared_ptr<const Blade>& blade);
std::vector<Proof> battery_proofs(const std::shared_ptr<const Blade>& blade);
std::vector<Proof> airframe_proofs();
std::vector<Proof> sensor_proofs();
std::vector<Proof> flight_proofs(const std::shared_ptr<const Blade>& blade);

}  // namespace whirl::plant
