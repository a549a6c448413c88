// A bought instrument of one reading: what it makes of the truth.
//
//   Units    of the quantity
//   Left out its own slowness (a millisecond's mean goes in, and it is shown within one) and noise: the
//            averages that people take of it have none
#pragma once

namespace whirl::plant {

struct MeterParams {
  double gain_error = 0.0;  // of this one, as a share
  double offset = 0.0;
};

inline double read_meter(const MeterParams& meter, double truth) {
  return (1.0 + meter.gain_error) * truth + meter.offset;
}

}  // namespace whirl::plant
