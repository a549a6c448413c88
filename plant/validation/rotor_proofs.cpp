#include "plant/validation/rotor_proofs.hpp"

#include "plant/validation/blade_element_references.hpp"
#include "plant/validation/hobbyking_proof.hpp"
#include "plant/validation/left_out.hpp"
#include "plant/validation/momentum_limits.hpp"

namespace whirl::plant {

std::vector<Proof> rotor_proofs(const ReadData& read) {
  const auto reference = [&](const char* file) { return read(std::string("reference/") + file); };
  std::vector<Proof> all;
  const auto add = [&](const Report& report) {
    for (Proof& proof : proofs_of(report)) all.push_back(std::move(proof));
  };
  add(validate_momentum_limits());
  add(validate_ccblade_a(reference("ccblade_a.txt")));
  add(validate_ccblade_b(reference("ccblade_b_sections.txt"), reference("ccblade_b_sweep.txt"),
                         reference("ccblade_naca64.txt")));
  add(validate_ccblade_c(reference("ccblade_c.txt"), reference("ccblade_naca0012.txt")));
  add(validate_qprop(reference("qprop_cam6x3.txt")));
  const auto measured = measured_blades(read, "propellers");
  const KnownBlades known = know(measured);
  add(validate_known(known, read("propellers/known.txt")));
  add(validate_left_out(measured, known));
  add(validate_strangers(measured_blades(read, "unseen"), known));
  add(validate_outside(measured_blades(read, "outside"), known));
  add(validate_in_view(measured, known));
  add(validate_hobbyking(read));
  return all;
}

}  // namespace whirl::plant
