#include "io_bridges/rack/models/pwm_window.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "base/check.hpp"

namespace whirl::rack {

PwmWindow::PwmWindow(Nanoseconds period_ns) : period_ns_(period_ns), slack_ns_(period_ns / 50) {
  WHIRL_CHECK(period_ns > 0, period_ns);
}

bool PwmWindow::is_period(Mark from, Mark to) const {
  return std::abs(to.at_ns - from.at_ns - period_ns_) <= slack_ns_;
}

void PwmWindow::close(Mark end) {
  const double lasted_s = static_cast<double>(end.at_ns - start_.at_ns) * 1e-9;
  peak_A_ = std::max(peak_A_, (end.charge_C - start_.charge_C) / lasted_s);
  start_ = end;
  due_.reset();
}

void PwmWindow::flow(double charge_C, Nanoseconds now) {
  const Nanoseconds step_ns = now - now_.at_ns;
  WHIRL_CHECK(step_ns > 0 && step_ns <= period_ns_ / 2, now, now_.at_ns);
  const Mark before = now_;
  now_ = {now, before.charge_C + charge_C};
  const Nanoseconds end_ns = start_.at_ns + period_ns_;
  if (!due_ && now >= end_ns) {
    const double share = static_cast<double>(end_ns - before.at_ns) / static_cast<double>(step_ns);
    due_ = Mark{end_ns, before.charge_C + share * charge_C};
  }
  if (due_ && now > due_->at_ns + slack_ns_) close(*due_);
}

void PwmWindow::upper_switch_on() {
  if (is_period(start_, now_)) {
    close(now_);
  } else if (edge_ && is_period(*edge_, now_)) {
    start_ = *edge_;
    close(now_);
  }
  edge_ = now_;
}

double PwmWindow::take_peak_A() {
  return std::exchange(peak_A_, 0.0);
}

}  // namespace whirl::rack
