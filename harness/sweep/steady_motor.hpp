// A motor at a constant drive, run until its speed stays.
#pragma once
#include <cmath>

#include "plant/motor/averaged_motor.hpp"

namespace whirl::sweep {

inline constexpr double kSubStep_s = 2e-4;
inline constexpr int kSubSteps = 50;

inline plant::MotorBooks run_piece(plant::AveragedMotor& motor, const plant::Drive& drive,
                                   const plant::ShaftLoad& load) {
  plant::MotorBooks books;
  for (int i = 0; i < kSubSteps; ++i) books += motor.step(drive, load, kSubStep_s);
  return books;
}

// In pieces of 10 ms; `load_at` says what is taken of the shaft at a speed. The books are those of the
// last piece.
template <typename LoadAt>
plant::MotorBooks run_until_steady(plant::AveragedMotor& motor, const plant::Drive& drive,
                                   const LoadAt& load_at) {
  plant::MotorBooks books;
  for (int piece = 0; piece < 400; ++piece) {
    const double before = motor.speed_radps();
    books = run_piece(motor, drive, load_at(before));
    if (std::abs(motor.speed_radps() - before) <= 1e-7 * (1.0 + before)) break;
  }
  return books;
}

}  // namespace whirl::sweep
