#include "io_bridges/hid/hid_device.hpp"

#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

namespace whirl::io {
namespace {

std::string narrow(const wchar_t* text) {
  std::string out;
  for (; text != nullptr && *text != 0; ++text) {
    out += *text < 0x80 ? static_cast<char>(*text) : '?';
  }
  return out;
}

std::string hex4(std::uint16_t number) {
  char text[8];
  std::snprintf(text, sizeof text, "%04x", static_cast<unsigned>(number));
  return text;
}

std::string kind_and_id(const HidQuery& query) {
  return query.kind + " (" + hex4(query.vendor) + ":" + hex4(query.product) + ")";
}

Error refused(std::string place, std::string what, std::string cure) {
  return {ErrorKind::bad_input, std::move(place), std::move(what), std::move(cure)};
}

// A kernel driver that holds such a device and leaves no hidraw node for it.
std::string driver_without_node(const HidQuery& query) {
  namespace fs = std::filesystem;
  std::string wanted = ":" + hex4(query.vendor) + ":" + hex4(query.product) + ".";
  std::transform(wanted.begin(), wanted.end(), wanted.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  std::error_code ignored;
  for (const auto& device : fs::directory_iterator("/sys/bus/hid/devices", ignored)) {
    if (device.path().filename().string().find(wanted) == std::string::npos) continue;
    if (fs::exists(device.path() / "hidraw", ignored)) continue;
    const fs::path driver = fs::read_symlink(device.path() / "driver", ignored);
    if (!driver.empty()) return driver.filename().string();
  }
  return {};
}

class HidDevice : public HidPort {
 public:
  HidDevice(hid_device* device, int lock, HidEntry entry)
      : device_(device), lock_(lock), entry_(std::move(entry)) {}
  ~HidDevice() override {
    hid_close(device_);
    close(lock_);
  }
  HidDevice(const HidDevice&) = delete;
  HidDevice& operator=(const HidDevice&) = delete;

  Result<Done> write(std::span<const std::uint8_t> report) override {
    if (hid_write(device_, report.data(), report.size()) < 0) return gone("a report out");
    return Done{};
  }
  Result<HidReport> read(std::int64_t timeout_ns) override {
    HidReport report(kLongest);
    const int milliseconds = static_cast<int>((timeout_ns + 999'999) / 1'000'000);
    const int length = hid_read_timeout(device_, report.data(), report.size(), milliseconds);
    if (length < 0) return gone("a report in");
    report.resize(static_cast<std::size_t>(length));
    return report;
  }
  Result<HidReport> get_feature(std::uint8_t number, std::size_t length) override {
    HidReport report(length);
    report[0] = number;
    const int got = hid_get_feature_report(device_, report.data(), report.size());
    if (got < 0) return gone("a feature report in");
    report.resize(static_cast<std::size_t>(got));
    return report;
  }
  Result<Done> set_feature(std::span<const std::uint8_t> report) override {
    if (hid_send_feature_report(device_, report.data(), report.size()) < 0)
      return gone("a feature report out");
    return Done{};
  }
  Result<HidReport> report_descriptor() override {
    // hidapi 0.13 has no call for it; the kernel shows it beside the node.
    const std::string node = std::filesystem::path(entry_.path).filename().string();
    std::ifstream file("/sys/class/hidraw/" + node + "/device/report_descriptor", std::ios::binary);
    HidReport bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (bytes.empty()) return gone("the report descriptor");
    return bytes;
  }

  std::int64_t now_ns() const override {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
  }
  void pause_ns(std::int64_t duration_ns) override {
    const timespec duration{duration_ns / 1'000'000'000, duration_ns % 1'000'000'000};
    nanosleep(&duration, nullptr);
  }

 private:
  static constexpr std::size_t kLongest =
      4096;  // HID_MAX_BUFFER_SIZE of the kernel is 16 KiB; USB full speed needs less

  Error gone(const char* what) const {
    return {ErrorKind::host, entry_.path,
            std::string(what) + " failed: " + narrow(hid_error(device_)),
            "is " + entry_.name + " still plugged in?"};
  }

  hid_device* device_;
  int lock_;
  HidEntry entry_;
};

}  // namespace

std::string udev_rule(std::uint16_t vendor, std::uint16_t product) {
  return R"(KERNEL=="hidraw*", KERNELS=="*:)" +
         [](std::string id) {
           std::transform(id.begin(), id.end(), id.begin(),
                          [](unsigned char c) { return std::toupper(c); });
           return id;
         }(hex4(vendor) + ":" + hex4(product)) +
         R"(.*", MODE="0660", GROUP="plugdev", TAG+="uaccess")";
}

std::vector<HidEntry> list_hid() {
  std::vector<HidEntry> entries;
  hid_device_info* const all = hid_enumerate(0, 0);
  for (const hid_device_info* i = all; i != nullptr; i = i->next) {
    // hidapi lists a node once for each of its usages.
    if (!entries.empty() && entries.back().path == i->path) continue;
    entries.push_back({i->path, i->vendor_id, i->product_id, narrow(i->serial_number),
                       narrow(i->product_string)});
  }
  hid_free_enumeration(all);
  return entries;
}

Result<HidEntry> choose(std::span<const HidEntry> here, const HidQuery& query) {
  std::vector<HidEntry> fitting;
  std::string serials;
  for (const HidEntry& entry : here) {
    const bool same = entry.vendor == query.vendor && entry.product == query.product;
    if (!same && !query.serial.empty() && entry.serial == query.serial) {
      return refused(query.serial,
                     "the device of this serial number is a '" + entry.name + "' (" +
                         hex4(entry.vendor) + ":" + hex4(entry.product) + "), no " +
                         kind_and_id(query),
                     "name its kind");
    }
    if (!same) continue;
    serials += (serials.empty() ? "" : ", ") + entry.serial;
    if (query.serial.empty() || entry.serial == query.serial) fitting.push_back(entry);
  }
  if (fitting.size() == 1) return fitting.front();
  if (serials.empty()) {
    return refused("", "no " + kind_and_id(query) + " on this machine",
                   "plug it in; lsusb lists what the host sees");
  }
  if (fitting.empty()) {
    return refused(query.serial, "no " + query.kind + " of this serial number",
                   "there are: " + serials);
  }
  return refused("", "several " + query.kind + " fit", "name one by its serial number: " + serials);
}

Result<std::unique_ptr<HidPort>> open_hid(const HidEntry& entry) {
  const int lock = ::open(entry.path.c_str(), O_RDWR | O_CLOEXEC);
  if (lock < 0 && (errno == EACCES || errno == EPERM)) {
    return refused(
        entry.path, "no permission to use '" + entry.name + "'",
        "as root: echo '" + udev_rule(entry.vendor, entry.product) +
            "' >/etc/udev/rules.d/70-whirl.rules; udevadm control --reload; then plug it in again");
  }
  if (lock < 0)
    return refused(entry.path, std::string("cannot be opened: ") + std::strerror(errno), "");
  if (flock(lock, LOCK_EX | LOCK_NB) != 0) {
    close(lock);
    return refused(entry.path, "'" + entry.name + "' is busy: another whirl uses it",
                   "end that one first");
  }
  hid_device* const device = hid_open_path(entry.path.c_str());
  if (device == nullptr) {
    close(lock);
    return refused(entry.path, "cannot be opened: " + narrow(hid_error(nullptr)), "");
  }
  return std::unique_ptr<HidPort>(new HidDevice(device, lock, entry));
}

Result<std::unique_ptr<HidPort>> open_hid(const HidQuery& query) {
  const std::vector<HidEntry> here = list_hid();
  const Result<HidEntry> chosen = choose(here, query);
  if (chosen) return open_hid(chosen.value());
  if (const std::string driver = driver_without_node(query); !driver.empty()) {
    return refused("",
                   kind_and_id(query) + " is busy: the kernel's driver '" + driver + "' holds it",
                   "as root: modprobe -r hid_" + driver);
  }
  return chosen.error();
}

}  // namespace whirl::io
