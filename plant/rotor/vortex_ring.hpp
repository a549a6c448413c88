// What fluctuates of a rotor's inflow in the vortex ring: the ring grows, breaks away and forms anew.
//
//   What     a speed of the air through the disc, to be added to what the hub meets; its mean is zero,
//            for the mean is momentum.hpp's. A first-order Gauss-Markov process of the given stream
//   Where    over descent / hover's induced velocity: begins at 0.3, is strongest at 1.3, over at 2,
//            where the flow is steady again [CastlesGray, figs. 18 to 23]; [Veismann] has its peak at
//            1.2 to 1.3. Flight across clears it: none where the speed in the disc's plane is that
//            induced velocity
//   Size     0.15 of hover's induced velocity (1 sigma) at the strongest, and a memory of five radii's way
//            at it. Both are set by hand: [ShettySelig] and [Veismann] say that the fluctuation is large
//            and where, but their figures' numbers were not at hand. A bound to fly against, no prediction
//   Valid    descents that last; each rotor has its own stream, though rings of neighbours may agree
#pragma once
#include <cstdint>
#include <string>

#include "base/random.hpp"

namespace whirl::plant {

struct Descent {
  double down_mps = 0.0;      // of the hub through the air, along the shaft
  double in_plane_mps = 0.0;  // and across it
  double hover_mps = 0.0;     // induced velocity in hover under that thrust
};

// 0 outside the vortex ring, 1 where it is strongest.
double vortex_ring_strength(const Descent& descent);

class VortexRing {
 public:
  VortexRing(std::uint64_t seed, const std::string& stream) : random_(seed, stream) {}

  // Air that comes up through the disc beyond the mean, over the next dt_s.
  double step(const Descent& descent, double radius_m, double dt_s);

 private:
  RandomStream random_;
  double state_ = 0.0;  // of variance 1
  bool inside_ = false;
};

}  // namespace whirl::plant
