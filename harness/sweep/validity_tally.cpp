#include "harness/sweep/validity_tally.hpp"

#include <cstdio>

namespace whirl::sweep {
namespace {

struct Flag {
  bool plant::RotorValidity::*is;
  const char* word;
};
constexpr Flag kFlags[] = {
    {&plant::RotorValidity::vortex_ring, "vortex ring"},
    {&plant::RotorValidity::beyond_advance_ratio, "advance ratio"},
    {&plant::RotorValidity::stalled, "stall"},
    {&plant::RotorValidity::not_converged, "not converged"},
    {&plant::RotorValidity::backward, "turned backward"},
    {&plant::RotorValidity::out_of_range, "beyond what is physical"},
};

}  // namespace

void ValidityTally::add(double x, const plant::RotorValidity& validity) {
  static_assert(std::size(kFlags) == std::tuple_size_v<decltype(why_)>);
  ++points_;
  if (validity.ok()) return;
  if (outside_ == 0) first_ = x;
  last_ = x;
  ++outside_;
  for (std::size_t i = 0; i < why_.size(); ++i) why_[i] += validity.*kFlags[i].is ? 1 : 0;
}

std::string ValidityTally::note() const {
  if (outside_ == 0) return "";
  char text[160];
  std::snprintf(text, sizeof text,
                "%d of %d points, from %.4g to %.4g, lie outside the model's stated validity:",
                outside_, points_, first_, last_);
  std::string all = text, apart = " ";
  for (std::size_t i = 0; i < why_.size(); ++i) {
    if (why_[i] == 0) continue;
    all += apart + kFlags[i].word + " (" + std::to_string(why_[i]) + ")";
    apart = ", ";
  }
  return all;
}

}  // namespace whirl::sweep
