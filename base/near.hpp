// near(got, want, tolerance): the only comparison of reals that tests use.
#pragma once
#include <gtest/gtest.h>

#include <cmath>

#include "base/tolerance.hpp"

namespace whirl {

inline ::testing::AssertionResult near(double got, double want, const Tolerance& tolerance) {
  const double diff = std::abs(got - want);
  if (!(diff <= tolerance.limit)) {
    return ::testing::AssertionFailure()
           << "got " << got << ", want " << want << ", off by " << diff << " > " << tolerance.limit
           << " (" << tolerance.why << ")";
  }
  return ::testing::AssertionSuccess();
}

}  // namespace whirl
