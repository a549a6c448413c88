// A stick of our own make under the kernel's hid-generic, read through hidapi. Only inside the guest.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>

#include "base/near.hpp"
#include "io_bridges/hid/emulated/uhid_device.hpp"
#include "io_bridges/hid/game_controller.hpp"
#include "io_bridges/hid/hid_device.hpp"
#include "io_bridges/hid/tests/played_stick.hpp"

namespace whirl::io {
namespace {

TEST(Stick, AxesDeadZoneAndUnplugThroughHidraw) {
  EventQueue queue;
  PlayedStick stick;
  auto plug = UhidDevice::create(queue, stick);
  ASSERT_TRUE(plug.ok()) << plug.error().message();
  const HidQuery query{"stick", 0x1209, 0x0001, "S1"};
  auto port = open_hid(query);
  for (int i = 0; i < 200 && !port; ++i) {
    plug.value()->serve(10'000'000);
    port = open_hid(query);
  }
  ASSERT_TRUE(port.ok()) << port.error().message();
  auto controller = GameController::start(std::move(port.value()), {{0, 512, 1023, 32}});
  ASSERT_TRUE(controller.ok()) << controller.error().message();
  for (int i = 0; i < 10; ++i) plug.value()->serve(1'000'000);  // the kernel has opened it

  const auto moved = [&](std::uint64_t x) {
    stick.move(x, 512, -100, 1);
    plug.value()->serve(1'000'000);
    return controller.value().poll(1'000'000'000);
  };
  const auto kExact = stated(1e-12, "a quotient of small whole numbers");
  EXPECT_TRUE(near(moved(530).axes[0], 0.0, kExact));
  const StickState state = moved(1023);
  EXPECT_TRUE(near(state.axes[0], 1.0, kExact));
  EXPECT_TRUE(near(state.axes.at(2), -1.0, kExact));
  EXPECT_TRUE(state.buttons[0]);
  EXPECT_FALSE(state.buttons[1]);
  plug.value().reset();
  EXPECT_FALSE(controller.value().poll(1'000'000'000).present);
}

}  // namespace
}  // namespace whirl::io
