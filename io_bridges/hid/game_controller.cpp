#include "io_bridges/hid/game_controller.hpp"

#include <algorithm>
#include <utility>

namespace whirl::io {
namespace {

constexpr std::uint32_t kButtons = 9;

bool is_axis(const HidField& field) {
  if (field.array || field.relative) return false;
  const std::uint32_t page = field.usage >> 16, usage = field.usage & 0xFFFF;
  return (page == 1 && usage >= 0x30 && usage <= 0x38) ||
         (page == 2 && (usage == 0xBA || usage == 0xBB));
}

bool is_buttons(const HidField& field) {
  return field.usage >> 16 == kButtons && (field.usage & 0xFFFF) != 0;
}

}  // namespace

double AxisCalibration::value_of(double counts) const {
  const double sign = reversed ? -1.0 : 1.0;
  if (!has_middle) {
    const double share = std::clamp((counts - min) / (max - min), 0.0, 1.0);
    return reversed ? 1.0 - share : share;
  }
  const double away = counts - centre;
  const double beyond = away > 0.0 ? away - dead_zone : -away - dead_zone;
  const double way = (away > 0.0 ? max - centre : centre - min) - dead_zone;
  if (beyond <= 0.0 || way <= 0.0) return 0.0;
  return sign * (away > 0.0 ? 1.0 : -1.0) * std::min(beyond / way, 1.0);
}

Result<GameController> GameController::start(std::unique_ptr<HidPort> port,
                                             std::vector<AxisCalibration> calibrations,
                                             std::int64_t silence_ns) {
  const auto descriptor = port->report_descriptor();
  if (!descriptor) return descriptor.error();
  auto layout = parse_report_descriptor(descriptor.value());
  if (!layout) return layout.error();
  GameController controller(std::move(port), std::move(layout.value()));
  std::size_t buttons = 0;
  for (const HidField& field : controller.layout_.fields) {
    if (is_axis(field)) {
      controller.axes_.push_back(field);
      const double middle = 0.5 * (double(field.min) + double(field.max));
      controller.calibrations_.push_back({double(field.min), middle, double(field.max)});
      controller.counts_.push_back(static_cast<std::int32_t>(middle));
    } else if (is_buttons(field)) {
      const std::uint32_t last =
          (field.usage & 0xFFFF) +
          (field.array ? static_cast<std::uint32_t>(field.max - field.min) : 0);
      buttons = std::max<std::size_t>(buttons, std::min(last, 1024u));
    }
  }
  if (controller.axes_.empty()) {
    return Error{ErrorKind::bad_input, "game controller", "it reports no axis",
                 "is it a stick or a pad?"};
  }
  if (calibrations.size() > controller.axes_.size()) {
    return Error{ErrorKind::bad_input, "game controller", "calibrations for more axes than it has",
                 "it has " + std::to_string(controller.axes_.size())};
  }
  for (std::size_t i = 0; i < calibrations.size(); ++i) {
    if (!calibrations[i].rises()) {
      return Error{ErrorKind::bad_input, "axis " + std::to_string(i + 1),
                   "min, centre and max do not rise", ""};
    }
    controller.calibrations_[i] = calibrations[i];
  }
  controller.state_.axes.resize(controller.axes_.size());
  controller.state_.buttons.resize(buttons);
  controller.silence_ns_ = silence_ns;
  controller.state_.t_ns = 0;
  return controller;
}

const StickState& GameController::poll(std::int64_t timeout_ns) {
  constexpr int kMost = 64;  // a stick reports once a millisecond
  for (int i = 0; i < kMost && state_.present; ++i) {
    const auto report = port_->read(i == 0 ? timeout_ns : 0);
    if (!report) {
      lose(report.error().message());
    } else if (report.value().empty()) {
      break;
    } else {
      take(report.value(), port_->now_ns());
    }
  }
  if (state_.present && silence_ns_ > 0 && state_.t_ns != 0 &&
      port_->now_ns() - state_.t_ns > silence_ns_) {
    lose("no report for " + std::to_string(silence_ns_ / 1'000'000) + " ms");
  }
  return state_;
}

void GameController::lose(std::string why) {
  state_.present = false;
  state_.why_lost = std::move(why);
}

void GameController::take(const HidReport& report, std::int64_t now_ns) {
  bool array_cleared = false;
  state_.t_ns = now_ns;
  for (const HidField& field : layout_.fields) {
    const auto value = value_in(report, field, layout_.numbered);
    if (!value || !is_buttons(field)) continue;
    std::size_t button = (field.usage & 0xFFFF) - 1;
    if (field.array) {
      if (!std::exchange(array_cleared, true)) state_.buttons.assign(state_.buttons.size(), false);
      if (*value < field.min || *value > field.max) continue;  // out of range: none is pressed
      button += static_cast<std::size_t>(*value - field.min);
    }
    if (button < state_.buttons.size()) state_.buttons[button] = field.array || *value != 0;
  }
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    const auto value = value_in(report, axes_[i], layout_.numbered);
    if (!value || *value < axes_[i].min || *value > axes_[i].max)
      continue;  // out of range: the null state
    counts_[i] = *value;
    state_.axes[i] = calibrations_[i].value_of(*value);
  }
}

}  // namespace whirl::io
