#include "io_bridges/devices/hmc5883l.hpp"

#include <algorithm>
#include <cmath>

#include "io_bridges/devices/oddity_text.hpp"

namespace whirl::io {
namespace {

constexpr double kCounts_per_Ga[] = {1370, 1090, 820, 660, 440, 390, 330, 230};
constexpr double kStraps_Ga[] = {1.16, 1.16, 1.08};
constexpr double kGa_T = 1e-4;

}  // namespace

Hmc5883l::Hmc5883l(EventQueue& queue, const Params& params, Sense sense, Wire* drdy,
                   FaultBook* faults, FindingSink findings)
    : queue_(queue),
      params_(params),
      sense_(std::move(sense)),
      drdy_(drdy),
      faults_(faults),
      findings_(std::move(findings)),
      noise_(params.seed, params.name + ".noise"),
      write_begins_(queue, [this] { part_.write_begins(); }),
      data_placed_(queue, [this] { place(); }),
      pulse_end_(queue, [this] { part_.pulse_over(queue_.now()); }),
      supply_(
          queue, faults, params.bus, params.device,
          [this](Nanoseconds now) { part_.supply(false, now); },
          [this](Nanoseconds now) { part_.supply(true, now); }) {
  if (drdy_ != nullptr) driver_ = drdy_->add_driver(params_.name);
  part_.supply(true, queue_.now());
}

// ---- What the registers ask for

void Hmc5883l::odd(core::Oddity what, std::uint32_t detail, Nanoseconds now) {
  findings_.report({now, params_.name, oddity_text(what, detail, &core::Hmc5883l::kMap)});
}

void Hmc5883l::drdy_pin(bool high, Nanoseconds now) {
  if (drdy_ != nullptr) drdy_->drive(driver_, high ? Drive::high : Drive::low, now);
}

void Hmc5883l::pulse_ends_at(Nanoseconds due) {
  due == kNever ? pulse_end_.cancel() : pulse_end_.at(due);
}

void Hmc5883l::data_due(Nanoseconds at) {
  if (at == kNever) {
    write_begins_.cancel();
    return data_placed_.cancel();
  }
  if (const Fault* late = fault(FaultKind::sensor_late, queue_.now())) {
    at += std::max(0LL, std::llround(late->value * 1e9));
  }
  data_placed_.at(at);
  write_begins_.at(at - core::Hmc5883l::kWriting_ns);
}

std::uint8_t Hmc5883l::identity(std::uint8_t id_a, Nanoseconds now) {
  const Fault* wrong = fault(FaultKind::sensor_wrong_identity, now);
  return wrong == nullptr ? id_a : static_cast<std::uint8_t>(wrong->value);
}

// ---- Measuring

void Hmc5883l::place() {
  const Nanoseconds now = queue_.now();
  const std::array<double, 3> field_T = sense_(now);
  const bool frozen = fault(FaultKind::sensor_frozen, now) != nullptr;
  std::array<std::int16_t, 3> counts{};
  for (std::size_t axis = 0; axis < 3; ++axis) counts[axis] = counts_of(axis, field_T[axis], now);
  if (part_.place(counts, frozen, now)) ++samples_;
}

std::int16_t Hmc5883l::counts_of(std::size_t axis, double field_T, Nanoseconds now) {
  const double noise_T = params_.noise_T / std::sqrt(part_.averages()) * noise_.normal();
  const int number = static_cast<int>(axis);
  field_T += added_by_faults(faults_, params_.bus, params_.device, now, number);
  if (fault(FaultKind::sensor_saturated, now, number) != nullptr) {
    return core::Hmc5883l::kOverflow_counts;
  }
  const double per_T = kCounts_per_Ga[part_.gain()] / kGa_T;
  const auto overflows = [](long counts) { return counts < -2048 || counts > 2047; };
  const int sign = part_.bias();
  const double straps_T = sign * kStraps_Ga[axis] * kGa_T;
  const long converted = std::lround((field_T + straps_T + noise_T) * per_T);
  const long counts = sign == 0 ? converted : std::lround((straps_T + noise_T) * per_T);
  const bool overflow = overflows(converted) || overflows(counts);
  return overflow ? core::Hmc5883l::kOverflow_counts : static_cast<std::int16_t>(counts);
}

}  // namespace whirl::io
