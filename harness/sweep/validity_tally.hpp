// Which points of a curve lie outside what the rotor's model states of itself.
#pragma once
#include <array>
#include <string>

#include "plant/rotor/rotor.hpp"

namespace whirl::sweep {

class ValidityTally {
 public:
  void add(double x, const plant::RotorValidity& validity);
  // "" where all lie within; else how many, from which x to which, and why.
  std::string note() const;

 private:
  int points_ = 0, outside_ = 0;
  double first_ = 0.0, last_ = 0.0;
  std::array<int, 6> why_{};
};

}  // namespace whirl::sweep
