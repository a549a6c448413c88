#include "plant/validation/rotor_proofs.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <sstream>

#include "base/check.hpp"
#include "plant/validation/left_out.hpp"

namespace whirl::plant {
namespace {

std::string read_data(const std::string& path) {
  std::ifstream in(std::string(WHIRL_DATA) + "/" + path);
  EXPECT_TRUE(in) << path;
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(RotorProofs, EveryFigureIsWithinItsLimit) {
  int figures = 0;
  for (const Proof& proof : rotor_proofs(read_data)) {
    for (const Figure& f : proof.figures) {
      ++figures;
      std::printf("%-40.40s %-62s %10.4g %s (limit %g)\n", proof.title.c_str(), f.name.c_str(),
                  f.measured, f.unit.c_str(), f.limit);
      EXPECT_TRUE(f.within()) << proof.title << ": " << f.name;
    }
    if (!proof.note.empty()) std::printf("%s\n", proof.note.c_str());
    for (const Curve& curve : proof.model) EXPECT_EQ(curve.x.size(), curve.y.size());
  }
  EXPECT_GT(figures, 30);
}

TEST(RotorProofs, APropellerThatIsKnownIsNoStranger) {
  const auto known = read_known(read_data("propellers/known.txt"), "known.txt").value();
  const auto blades = measured_blades(read_data, "propellers");
  base::set_check_handler(base::throw_check_failure);
  EXPECT_THROW(validate_outside({blades.front()}, known), base::CheckFailed);
  EXPECT_THROW(validate_strangers({blades.front()}, known), base::CheckFailed);
}

}  // namespace
}  // namespace whirl::plant
