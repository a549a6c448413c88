// A propeller along its shaft over J: CT and CP with their 90 % band, measured points laid over.
//
//   Polars  a file that names its sections has no such band; where their drag is computed, what its stated error
//           leaves open is drawn instead, and no point is counted as inside of it
//   Judged  sum of |error| over sum of |measured| (WMAPE) and the mean of the errors with their sign over the mean of the
//           measured, per file and over all; points at J up to 0.1 as static, points that give no thrust
//           or take no power are drawn and not judged
//   Notes   on each chart: which points of a curve lie outside the model's stated validity; on the first, what is
//           doubted of the file
#pragma once
#include <memory>
#include <vector>

#include "harness/sweep/measured.hpp"
#include "harness/sweep/sweep.hpp"
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
// A propeller as its file was read: fitted on its traits, or of named polars.
struct SweptPropeller {
  std::shared_ptr<const plant::Blade> blade;
  const plant::FittedBlade* fit = nullptr;     // null where the file names polars
  const plant::TwistedBlade* twist = nullptr;  // null where it does not
};
// Over J at the options' speeds and those of the measured files; neither: at half, three quarters and all of the
// options' speed, or top speed. Over speed at the options' advance ratios.
ForwardSweep forward_sweep(const SweptPropeller& propeller,
                           const std::vector<MeasuredFile>& measured, const Options& options);

// What was chosen and what is doubted, for the terminal and the page.
std::vector<std::string> fit_lines(const plant::FittedBlade& fit);
std::vector<std::string> twist_lines(const plant::TwistedBlade& twist);

}  // namespace whirl::sweep
