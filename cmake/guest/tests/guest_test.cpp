// The guest has what its tests build on: virtual CAN, two SJA1000s (can0, can1) on one emulated bus, uhid. What a module brings is asked for, not the module's name.
#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

#include <gtest/gtest.h>

namespace {

TEST(Guest, HasSocketCanWithVirtualAndEmulatedBuses) {
  const int raw = socket(PF_CAN, SOCK_RAW, CAN_RAW);
  EXPECT_GE(raw, 0);
  close(raw);
  for (const char* bus : {"vcan0", "vcan1", "can0", "can1"})
    EXPECT_NE(if_nametoindex(bus), 0u) << bus;
}

TEST(Guest, HasUserSpaceHid) {
  const int uhid = open("/dev/uhid", O_RDWR | O_CLOEXEC);
  EXPECT_GE(uhid, 0);
  close(uhid);
}

TEST(Guest, NoNetworkLeadsOut) {
  struct if_nameindex* names = if_nameindex();
  ASSERT_NE(names, nullptr);
  int others = 0;
  for (struct if_nameindex* i = names; i->if_index != 0; ++i) {
    const std::string name = i->if_name;
    if (name != "lo" && name.find("can") == std::string::npos) ++others;
  }
  if_freenameindex(names);
  EXPECT_EQ(others, 0);
}

}  // namespace
