// The HID devices of this machine, by hidapi over hidraw.
//
//   Chosen   by vendor, product and serial number; choose() says why none fits: none there, another
//            kind, several, another serial number
//   Refused  no permission (with the udev rule to copy), in use by another whirl (an advisory lock on
//            the node), held by a kernel driver that leaves no node. All ErrorKind::bad_input, one line
//   Left out hidapi's libusb side: a hidraw node works beside the kernel's other drivers
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/hid/hid_port.hpp"

namespace whirl::io {

struct HidEntry {
  std::string path;  // "/dev/hidraw0"
  std::uint16_t vendor = 0, product = 0;
  std::string serial;
  std::string name;
};

struct HidQuery {
  std::string kind;  // "MCP2221A", for messages
  std::uint16_t vendor = 0, product = 0;
  std::string serial;  // empty: whichever, if there is one only
};

std::vector<HidEntry> list_hid();
Result<HidEntry> choose(std::span<const HidEntry> here, const HidQuery& query);
// For /etc/udev/rules.d/70-whirl.rules: who sits at the machine may use such a device, and group plugdev.
std::string udev_rule(std::uint16_t vendor, std::uint16_t product);

Result<std::unique_ptr<HidPort>> open_hid(const HidQuery& query);
Result<std::unique_ptr<HidPort>> open_hid(const HidEntry& entry);

}  // namespace whirl::io
