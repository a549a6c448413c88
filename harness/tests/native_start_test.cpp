// The native ESC's start beside that of the real image, both from the same set-point, with the same
// propeller, supply and motor: the image on the virtual stand, the native ESC around the averaged motor.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "harness/catalogue/stand_table.hpp"
#include "harness/flight/native_esc.hpp"
#include "harness/stand/stand_world.hpp"
#include "plant/motor/averaged_motor.hpp"

namespace whirl {
namespace {

constexpr const char* kStand = R"({ prop = "hk_10x4.5", supply = "16.4 V" })";
constexpr double kThrust_N = 2.0;
constexpr std::int64_t kMs = 1'000'000;

// What the expectations of that plan measured whose names begin with "start".
std::vector<double> starts_s(const std::string& lines) {
  const ScratchFolder folder;
  std::ofstream(folder.file("starts.lua")) << R"(plan "starts" {
    image = "esc", board = "esc32v2", timeout = "30 s", stand = )"
                                           << kStand << R"(,
    run = function(t)
      t:within("3 s", function(s) return s.armed == 1 end, "armed")
)" << lines << " end }";
  const std::string line = std::string(WHIRL_PROGRAM) + " run --out " + folder.path() + " " +
                           folder.file("starts.lua") + " >/dev/null";
  EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 0);
  std::ifstream in(folder.file("runs/latest/run.json"));
  const nlohmann::json run = nlohmann::json::parse(in, nullptr, false);
  std::vector<double> found;
  if (!run.is_object()) return found;
  for (const auto& e : run["expectations"]) {
    if (e["name"].get<std::string>().starts_with("start"))
      found.push_back(e["measured"].get<double>());
  }
  return found;
}

// From the set-point's STOP to 90 % of its thrust, of six starts: each from where the rotor came to
// rest, which decides how far the alignment turns it, and that is a draw: twelve starts of two images took 317 to 358 ms.
std::vector<double> starts_of_the_image_s() {
  return starts_s(R"(for n = 1, 6 do
    t:expect(t:value "speed", "at rest"):equal "0 rad/s"
    local start = t:record("thrust", "1.5 s", function() t:command { thrust = "2 N" } end)
    t:expect(start:response_time(), "start"):at_most "1.5 s"
    t:expect(start:final(), "turns"):within("1.95 N", "2.05 N")
    t:command { stop = true }
    t:wait "3.013 s"
  end)");
}

// The same of a rotor that is driven backward, by as much torque as its friction takes.
std::vector<double> starts_of_the_image_from_s(int backward_radps) {
  return starts_s("local speed = " + std::to_string(backward_radps) + R"(
    t:command { brake = "-20 mN m" }
    t:within("2 s", function(s) return s.speed_radps < -speed end, "turns backward")
    t:command { brake = "-10 mN m" }
    local start = t:record("thrust", "1.5 s", function() t:command { thrust = "2 N" } end)
    t:expect(start:response_time(), "start"):at_most "1.5 s")");
}

// The board's part on the stand: bytes in, bridge and shaft out, each millisecond.
struct NativeBoard {
  flight::NativeEsc esc{{}, 1, 1};
  plant::AveragedMotor motor{plant::MotorParams{}};
  plant::MotorState state;
  std::uint8_t address = 0;

  io::Batch step(std::int64_t t_ns, const io::Batch& sensed) {
    io::Batch happened;
    io::ShaftLoad load;
    for (io::Reader r(sensed.bytes()); r.next();) {
      if (r.header().kind == io::Kind::shaft_load) load = r.as<io::ShaftLoad>();
      if (r.header().kind != io::Kind::i2c_order) continue;
      const auto order = r.as<io::I2cOrder>();
      const auto setpoint = io::unpack_setpoint(address, r.tail_after(sizeof order));
      if (setpoint) esc.write(*setpoint);
      happened.add(io::Kind::i2c_reply, 2, t_ns, io::I2cReplyHead{order.number, 1, 0, {}, 0});
    }
    const double bus_V = load.source_V - load.source_ohm * state.bus_current_A;
    const plant::MotorCommand command = esc.step(t_ns, state, bus_V);
    const bool diode = command.freewheel == plant::Freewheel::diode;
    double charge_C = 0.0;
    for (int i = 0; i < 8; ++i) {
      charge_C +=
          motor.step({bus_V, command.duty, diode}, {load.torque_Nm_s2, -load.brake_Nm}, 1.25e-4)
              .bus_charge_C;
    }
    state.speed_radps = motor.speed_radps();
    state.bus_current_A = charge_C / 1e-3;
    io::ShaftState shaft;
    shaft.speed_radps = state.speed_radps;
    shaft.source_current_A = state.bus_current_A;
    happened.add(io::Kind::shaft_state, 1, t_ns + kMs, shaft);
    return happened;
  }
};

// Until the thrust is there, or a second is over.
double start_of_the_native_esc_s(double backward_radps = 0.0) {
  const auto table = lua::read_text(std::string("return ") + kStand, "stand.lua");
  auto params =
      catalogue::read_stand(table.value(), std::string(WHIRL_ROOT) + "/test_plans/propellers");
  if (!params) ADD_FAILURE() << params.error().message();
  stand::StandWorld world(params.value(), 1);
  NativeBoard board;
  board.address = params.value().esc.address;
  io::Batch happened;
  std::vector<double> values(world.signals().size());
  std::int64_t t_ns = 0;
  for (; t_ns < 2000 * kMs; t_ns += kMs) {
    io::Batch sensed;
    world.step(t_ns, happened, sensed);
    world.read(values);
    if (values[0] >= 0.9 * kThrust_N) break;  // the first signal is thrust
    happened = board.step(t_ns, sensed);
    if (t_ns == 999 * kMs) {
      EXPECT_TRUE(board.esc.armed());
      if (backward_radps > 0.0) {
        EXPECT_TRUE(world.command(request::Brake{-0.010}, t_ns));
      }
      board.motor.set_speed(-backward_radps);
      EXPECT_TRUE(world.command(request::SetPoint{request::SetPointKind::thrust, kThrust_N}, t_ns));
    }
  }
  return static_cast<double>(t_ns - world.command_on_wire_ns()) * 1e-9;
}

// A master writes set-points every 20 ms and cannot know its ESC better than that, in the mean.
TEST(NativeStart, TakesAsLongAsTheImagesOnTheStand) {
  const std::vector<double> image_s = starts_of_the_image_s();
  ASSERT_EQ(image_s.size(), 6u);
  const double native_s = start_of_the_native_esc_s();
  const double mean_s = std::accumulate(image_s.begin(), image_s.end(), 0.0) / 6.0;
  EXPECT_TRUE(near(native_s, mean_s, stated(0.020, "one period of the set-points")));
  for (const double one_s : image_s) {
    EXPECT_TRUE(near(native_s, one_s, stated(0.050, "a period, and where the rotor rested")));
  }
}

// The image aligns a rotor longer that turns backward, for its field has to brake it first.
TEST(NativeStart, TurnsABackwardRotorRoundAsTheImageDoes) {
  for (const int speed_radps : {50, 100, 200}) {
    const std::vector<double> image_s = starts_of_the_image_from_s(speed_radps);
    ASSERT_EQ(image_s.size(), 1u);
    const double native_s = start_of_the_native_esc_s(speed_radps);
    EXPECT_TRUE(near(native_s, image_s[0], stated(0.020, "one period of the set-points")))
        << speed_radps;
  }
}

}  // namespace
}  // namespace whirl
