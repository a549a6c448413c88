// How long a step takes, one core: ./build/host/plant/plant_bench
#include <benchmark/benchmark.h>

#include <fstream>
#include <sstream>

#include "plant/rotor/hobbyking_10x4_5.hpp"
#include "plant/rotor/polar.hpp"
#include "plant/sensors/imu.hpp"
#include "plant/tests/quadratic_rotor.hpp"
#include "plant/vehicle.hpp"

namespace whirl::plant {
namespace {

std::shared_ptr<const PolarFamily> section(const std::string& file) {
  std::ifstream in(std::string(WHIRL_DATA) + "/polars/" + file);
  std::stringstream text;
  text << in.rdbuf();
  return std::make_shared<PolarFamily>(read_polar(text.str(), file).value());
}

RotorSet blade_elements(const AirframeParams& airframe) {
  const auto blade =
      make_blade(hobbyking_10x4_5(section("bw3.polar"), section("e63.polar"))).value();
  return blade_element_rotors(blade, airframe);
}

// Nobody holds the attitude: a flying vehicle is put back before it tumbles to the ground.
void step(benchmark::State& state, RotorSet (*rotors)(const AirframeParams&), double duty) {
  const VehicleParams params = hp_quad();
  Vehicle vehicle(params, rotors(params.airframe), 1);
  const bool flies = duty > 0.2;
  auto put_back = [&] {
    vehicle.place({0, 0, -50}, Eigen::Quaterniond::Identity(), {1, 0, 0}, {0, 0, 0});
  };
  if (flies) put_back();
  for (int i = 0; i < 4; ++i) {
    if (flies) vehicle.set_motor_speed(i, 413.0);
    vehicle.command(i, {duty, Freewheel::synchronous});
  }
  for (int k = 0; k < 500; ++k) vehicle.step(1e-3);
  int steps = 0;
  for (auto _ : state) {
    if (flies && ++steps % 500 == 0) put_back();
    vehicle.step(1e-3);
  }
}

void flying_without_rotors(benchmark::State& state) {
  step(state, quadratic_rotors, 0.3);
}
void standing_without_rotors(benchmark::State& state) {
  step(state, quadratic_rotors, 0.1);
}
void flying(benchmark::State& state) {
  step(state, blade_elements, 0.3);
}
BENCHMARK(flying_without_rotors);
BENCHMARK(standing_without_rotors);
BENCHMARK(flying);

void imu_sample(benchmark::State& state) {
  Imu imu(mpu6000_physics(), 1);
  ImuMotion motion;
  motion.rotor_speed_radps = {400, 410, 420, 430};
  double t_s = 0.0;
  for (auto _ : state) benchmark::DoNotOptimize(imu.sample(t_s += 1e-3, motion));
}
BENCHMARK(imu_sample);

}  // namespace
}  // namespace whirl::plant

BENCHMARK_MAIN();
