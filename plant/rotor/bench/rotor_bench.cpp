// One rotor, 20 rings x 12 azimuths: nanoseconds of a step and of a steady solution.
#include <benchmark/benchmark.h>

#include <fstream>
#include <sstream>

#include "plant/rotor/hobbyking_10x4_5.hpp"
#include "plant/rotor/polar.hpp"
#include "plant/rotor/rotor.hpp"

namespace {

using namespace whirl::plant;

std::shared_ptr<const PolarFamily> section(const std::string& name) {
  std::ifstream in(std::string(WHIRL_DATA) + "/polars/" + name + ".polar");
  std::stringstream text;
  text << in.rdbuf();
  return std::make_shared<PolarFamily>(read_polar(text.str(), name).value());
}

Rotor hobbyking() {
  return Rotor(make_blade(hobbyking_10x4_5(section("bw3"), section("e63"))).value(), 1);
}

void step(benchmark::State& state) {
  Rotor rotor = hobbyking();
  RotorConditions c;
  c.omega_radps = 420.0;
  double t = 0.0;
  for (auto _ : state) {
    t += 1e-3;
    c.v_AP_P_mps = {3.0 + t - static_cast<int>(t), 1.0, -0.5};
    c.w_WP_P_radps = {0.3, -0.2, 0.1};
    benchmark::DoNotOptimize(rotor.step(c, 1e-3));
  }
}
BENCHMARK(step);

void steady(benchmark::State& state) {
  const Rotor rotor = hobbyking();
  RotorConditions c;
  c.omega_radps = 420.0;
  c.v_AP_P_mps.x() = static_cast<double>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(rotor.steady(c));
}
BENCHMARK(steady)->Arg(0)->Arg(5)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
