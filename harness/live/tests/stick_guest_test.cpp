// A person's pad under the kernel's hid-generic, read as `whirl fly --stick` reads it: its file, hidapi, hidraw. The kernel reads
// the same reports by the same descriptor for its own input layer, and both have to agree. Only inside the guest.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "base/near.hpp"
#include "base/scratch_folder.hpp"
#include "harness/live/pilot_stick.hpp"
#include "io_bridges/hid/emulated/uhid_device.hpp"
#include "io_bridges/hid/tests/played_pad.hpp"

namespace whirl::live {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFile = R"(return {
  stick = "pad", vendor = 0x1209, product = 0x0002, serial = "P1",
  axes = {
    yaw = { axis = 1, min = 0, centre = 128, max = 255, dead_zone = 6 },
    thrust = { axis = 2, min = 0, max = 255, reversed = true },
    roll = { axis = 3, min = 5, centre = 128, max = 250, dead_zone = 6 },
    pitch = { axis = 4, min = 0, centre = 128, max = 255, dead_zone = 6, reversed = true },
  },
  arm = 9, modes = { 1, 2, 12 },
})";

// What the kernel's own input layer has of the pad.
class KernelsPad {
 public:
  ~KernelsPad() {
    if (file_ >= 0) close(file_);
  }
  bool open() {
    std::error_code none;
    for (const auto& node : fs::directory_iterator("/dev/input", none)) {
      if (!node.path().filename().string().starts_with("event")) continue;
      const int file = ::open(node.path().c_str(), O_RDONLY | O_NONBLOCK);
      input_id id{};
      if (ioctl(file, EVIOCGID, &id) == 0 && id.vendor == io::PlayedPad::kVendor &&
          id.product == io::PlayedPad::kProduct) {
        file_ = file;
        return true;
      }
      close(file);
    }
    return false;
  }
  int axis(unsigned code) const {
    input_absinfo info{};
    return ioctl(file_, EVIOCGABS(code), &info) == 0 ? info.value : -1;
  }
  // Which of the keys from BTN_GAMEPAD on are down, the first of which is the pad's button 1.
  unsigned buttons() const {
    std::array<std::uint8_t, KEY_MAX / 8 + 1> keys{};
    if (ioctl(file_, EVIOCGKEY(keys.size()), keys.data()) < 0) return ~0u;
    unsigned down = 0;
    for (unsigned i = 0; i < 12; ++i) {
      const unsigned key = BTN_GAMEPAD + i;
      down |= (keys[key / 8] >> (key % 8) & 1u) << i;
    }
    return down;
  }

 private:
  int file_ = -1;
};

struct Desk {
  Desk() { std::ofstream(file) << kFile; }
  // What is missing; empty: all is there.
  std::string plug_in() {
    auto made = io::UhidDevice::create(queue, pad);
    if (!made) return made.error().message();
    plug = std::move(made.value());
    if (!serve_until([&] { return kernels.emplace().open(); })) return "no node in /dev/input";
    std::string missing;
    serve_until([&] {
      auto map = read_stick(file);
      if (!map) return missing = map.error().message(), false;
      auto port = io::open_hid(map.value().device);
      if (!port) return missing = port.error().message(), false;
      auto started = PilotStick::start(std::move(port.value()), std::move(map.value()));
      if (!started) return missing = started.error().message(), false;
      stick.emplace(std::move(started.value()));
      return missing.clear(), true;
    });
    return missing;
  }
  bool serve_until(const std::function<bool()>& done) {
    for (int i = 0; i < 500; ++i) {
      if (done()) return true;
      plug->serve(10'000'000);
    }
    return false;
  }
  // Its report has come to the kernel and to us.
  request::Sticks move(const std::array<std::uint8_t, 4>& axes, unsigned buttons = 0) {
    pad.move(axes, buttons);
    EXPECT_TRUE(serve_until([&] {
      return kernels->axis(ABS_X) == axes[0] && kernels->axis(ABS_RZ) == axes[3] &&
             kernels->buttons() == buttons;
    }));
    EXPECT_EQ(kernels->axis(ABS_Y), axes[1]);
    EXPECT_EQ(kernels->axis(ABS_Z), axes[2]);
    return stick->read();
  }

  const ScratchFolder folder;
  const std::string file = folder.file("pad.lua");
  io::EventQueue queue;
  io::PlayedPad pad;
  std::unique_ptr<io::UhidDevice> plug;
  std::optional<KernelsPad> kernels;
  std::optional<PilotStick> stick;
};

const auto kStep = stated(0.0005, "half of the step of 0.1 % in which travel is told");

TEST(PadOfAPilot, TheKernelBindsItAndBothReadTheSame) {
  Desk desk;
  ASSERT_EQ(desk.plug_in(), "");
  const fs::path node = fs::directory_iterator("/sys/class/hidraw")->path();
  EXPECT_EQ(fs::read_symlink(node / "device/driver").filename(), "hid-generic");
  EXPECT_TRUE(desk.stick->read().transmitter_on);

  const request::Sticks ends = desk.move({255, 0, 250, 255});
  EXPECT_TRUE(near(*ends.yaw, 1.0, kStep));
  EXPECT_TRUE(near(*ends.thrust, 1.0, kStep));  // reversed: its stop is far from the pilot
  EXPECT_TRUE(near(*ends.roll, 1.0, kStep));
  EXPECT_TRUE(near(*ends.pitch, -1.0, kStep));

  // From the dead zone's edge at 134 to 250 are 116 counts, from 122 to 5 are 117.
  const request::Sticks between = desk.move({134, 255, 192, 122});
  EXPECT_TRUE(near(*between.yaw, 0.0, kStep));
  EXPECT_TRUE(near(*between.thrust, 0.0, kStep));
  EXPECT_TRUE(near(*between.roll, 58.0 / 116.0, kStep));
  EXPECT_TRUE(near(*between.pitch, 0.0, kStep));
  const request::Sticks left = desk.move({121, 51, 83, 121});
  EXPECT_TRUE(near(*left.yaw, -1.0 / 122.0, kStep));
  EXPECT_TRUE(near(*left.thrust, 0.8, kStep));
  EXPECT_TRUE(near(*left.roll, -39.0 / 117.0, kStep));
  EXPECT_TRUE(near(*left.pitch, 1.0 / 122.0, kStep));
}

TEST(PadOfAPilot, ItsButtonsTurnTheSwitches) {
  Desk desk;
  ASSERT_EQ(desk.plug_in(), "");
  constexpr std::array<std::uint8_t, 4> kAt_rest{128, 255, 128, 128};
  constexpr unsigned kArm = 1u << 8, kSecond = 1u << 1, kThird = 1u << 11;
  EXPECT_EQ(desk.move(kAt_rest).arm, false);
  EXPECT_EQ(desk.move(kAt_rest, kArm).arm, true);
  const request::Sticks third = desk.move(kAt_rest, kThird);
  EXPECT_EQ(third.arm, true);  // it stays when the button is let go
  EXPECT_EQ(third.mode, 3);
  const request::Sticks off = desk.move(kAt_rest, kArm | kSecond);
  EXPECT_EQ(off.arm, false);
  EXPECT_EQ(off.mode, 2);
}

TEST(PadOfAPilot, UnpluggedTheTransmitterIsOffAndPluggedInAgainItIsFound) {
  Desk desk;
  ASSERT_EQ(desk.plug_in(), "");
  EXPECT_TRUE(desk.move({200, 255, 128, 128}).transmitter_on);
  desk.plug.reset();
  EXPECT_FALSE(desk.stick->read().transmitter_on);
  EXPECT_FALSE(io::open_hid(read_stick(desk.file).value().device).ok());
  PilotStick old = std::move(*desk.stick);
  ASSERT_EQ(desk.plug_in(), "");
  const request::Sticks again = desk.move({201, 255, 128, 128});
  EXPECT_TRUE(again.transmitter_on);
  EXPECT_TRUE(near(*again.yaw, 67.0 / 121.0, kStep));
  EXPECT_FALSE(old.read().transmitter_on);  // the one that was pulled stays so
}

}  // namespace
}  // namespace whirl::live
