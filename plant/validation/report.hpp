// How the rotor's proofs are gathered before they become panels (validation.hpp).
//
//   No I/O here and below: texts come in, numbers go out. `whirl validate` reads, prints and draws.
#pragma once
#include <string>
#include <vector>

#include "plant/validation/validation.hpp"

namespace whirl::plant {

struct Series {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  bool reference = false;  // points of somebody else; drawn as marks, not as a line
};

struct Plot {
  std::string title;
  std::string x_label;  // with its unit
  std::string y_label;
  std::vector<Series> series;
};

// One number that must not exceed its limit.
struct Bound {
  std::string name;
  std::string unit;
  double value = 0.0;
  double limit = 0.0;
};

// Several plots that one set of bounds judges; the rotor's proofs are gathered so.
struct Report {
  std::string title;
  std::string source;
  std::vector<Plot> plots;
  std::vector<Bound> figures;
  std::vector<std::string> notes;
};

// A panel per plot; the first carries the figures and the notes.
std::vector<Proof> proofs_of(const Report& report);

// Reference data: rows of numbers; '#' and lines that do not start with a number are passed over.
using Rows = std::vector<std::vector<double>>;
Rows read_rows(const std::string& text, std::size_t columns);

}  // namespace whirl::plant
