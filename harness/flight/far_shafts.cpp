#include "harness/flight/far_shafts.hpp"

#include <cmath>

#include "base/check.hpp"

namespace whirl::flight {

FarShafts::FarShafts(std::vector<FarShaft> shafts, plant::RemotePowertrain& powertrain)
    : shafts_(std::move(shafts)), powertrain_(powertrain), states_(shafts_.size()) {
  constexpr std::size_t kAge_steps = 2;
  WHIRL_CHECK(shafts_.size() == powertrain.count(), shafts_.size(), powertrain.count());
  powertrain_.set_age(kAge_steps);
}

bool FarShafts::hears(const io::Header& head) const {
  if (head.kind != io::Kind::shaft_state) return false;
  for (const FarShaft& shaft : shafts_) {
    if (shaft.board == head.board && shaft.stage == head.port) return true;
  }
  return false;
}

void FarShafts::on_message(const io::Reader& message) {
  const auto told = message.as<io::ShaftState>();
  for (std::size_t i = 0; i < shafts_.size(); ++i) {
    const io::Header& head = message.header();
    if (shafts_[i].board != head.board || shafts_[i].stage != head.port) continue;
    states_[i] = {.speed_radps = told.speed_radps,
                  .source_current_A = told.source_current_A,
                  .winding_peak_A = told.winding_peak_A,
                  .electrical_in_J = told.electrical_in_J,
                  .copper_J = told.copper_J,
                  .diode_J = told.diode_J,
                  .no_load_J = told.no_load_J,
                  .magnetic_J = told.magnetic_J,
                  .kinetic_J = told.kinetic_J,
                  .air_J = told.air_J,
                  .source_J = told.source_J,
                  .feed_J = told.feed_J,
                  .capacitor_J = told.capacitor_J};
  }
}

void FarShafts::before_step() {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const plant::RemoteShaftState& s = states_[i];
    gap_J_ += s.source_J - s.feed_J - s.capacitor_J - s.copper_J - s.diode_J - s.no_load_J -
              s.magnetic_J - s.kinetic_J - s.air_J;
    powertrain_.receive(i, s);
    states_[i] = {.speed_radps = s.speed_radps};  // each is of one step
  }
}

void FarShafts::after_step(const plant::EnergyBooks& books) {
  chemical_J_ += books.chemical_J;
  exchange_J_ += books.exchange_J;
}

void FarShafts::send(std::int64_t t_ns, io::Batch& sensed) const {
  for (std::size_t i = 0; i < shafts_.size(); ++i) {
    const plant::RemoteShaftLoad load = powertrain_.load(i);
    const io::ShaftLoad told{load.torque_Nm_s2, load.brake_Nm, load.source_V, load.source_ohm};
    const io::Header head{t_ns, io::Kind::shaft_load, shafts_[i].board, shafts_[i].stage, 0};
    sensed.add(head, {{reinterpret_cast<const std::uint8_t*>(&told), sizeof told}});
  }
}

double FarShafts::exchange_share() const {
  return chemical_J_ > 0.0 ? std::abs(exchange_J_) / chemical_J_ : 0.0;
}

double FarShafts::exchange_of_bound() const {
  const double bound_J = powertrain_.bound_J();
  return bound_J > 0.0 ? std::abs(exchange_J_) / bound_J : 0.0;
}

double FarShafts::gap_share() const {
  return chemical_J_ > 0.0 ? std::abs(gap_J_) / chemical_J_ : 0.0;
}

}  // namespace whirl::flight
