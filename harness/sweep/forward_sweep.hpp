// A propeller along its shaft over J: CT and CP with their 90 % band, measured points laid over.
//
//   Judged  sum of |error| over sum of |measured| (WMAPE) and the mean of the errors with their sign over the mean of the
//           measured, per file and over all; points at J up to 0.1 as static, points that give no thrust
//           or take no power are drawn and not judged
#pragma once
#include <memory>
#include <vector>

#include "harness/sweep/measured.hpp"
#include "plant/rotor/fitted_blade.hpp"
#include "results/charts.hpp"

namespace whirl::sweep {

struct ForwardJudged {
  double CT_percent = 0, CP_percent = 0;                // WMAPE
  double CT_mean_percent = 0, CP_mean_percent = 0;      // signed
  double CT_inside_percent = 0, CP_inside_percent = 0;  // of the band; 0 where there is none
  int points = 0;
};
struct ForwardSweep {
  std::vector<results::Chart> charts;
  ForwardJudged flight, at_rest;
};
// `fit`: null where the file names polars. Speeds: of the measured files, else speed_radps.
ForwardSweep forward_sweep(const std::shared_ptr<const plant::Blade>& blade,
                           const plant::FittedBlade* fit, const std::vector<MeasuredFile>& measured,
                           double speed_radps);

// What was chosen and what is doubted, for the terminal and the page.
std::vector<std::string> fit_lines(const plant::FittedBlade& fit);

}  // namespace whirl::sweep
