// A 24xx EEPROM on I2C: the part byte by byte (io_bridges/devices). Its contents begin as a copy of
// `image`, or all 0xFF, and are NAME.img in the run's folder while the run goes and after it.
#include "io_bridges/devices/eeprom_24xx.hpp"

#include <bit>
#include <cmath>

#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

Result<Done> check_sizes(const DeviceSlot& slot, std::uint64_t size, std::uint64_t page) {
  if (std::has_single_bit(size) && std::has_single_bit(page) && page <= size) return Done{};
  return Error{ErrorKind::bad_input, slot.place() + ".size, page",
               std::to_string(size) + " bytes in pages of " + std::to_string(page) +
                   " is no part: both are powers of two, the page the smaller",
               "a 24xx128 has 16 KiB and 64 B, a 24xx64 8 KiB and 32 B"};
}

Result<io::MemoryFile> eeprom_contents(DeviceSlot& slot) {
  const auto size = static_cast<std::uint64_t>(std::llround(slot.quantity("size")));
  const auto page = static_cast<std::uint64_t>(std::llround(slot.quantity("page")));
  if (const auto good = check_sizes(slot, size, page); !good) return good.error();
  auto contents = io::MemoryFile::create(slot.rack().file_to_leave(slot.name()),
                                         static_cast<std::int64_t>(size));
  if (!contents) return contents;
  contents.value().write(0, std::vector<std::uint8_t>(size, 0xFF));
  if (!slot.given("image")) return contents;
  const auto copied = contents.value().copy_from(slot.text("image"));
  if (!copied) return copied.error();
  return contents;
}

io::Eeprom24xx::Params eeprom_params(DeviceSlot& slot) {
  io::Eeprom24xx::Params params;
  params.name = slot.name();
  params.i2c_address = static_cast<std::uint8_t>(slot.whole("address"));
  params.page_bytes = static_cast<int>(std::lround(slot.quantity("page")));
  params.write_ns = std::llround(slot.quantity("params.write_time") * 1e9);
  params.seed = slot.rack().seed();
  params.bus = slot.bus_number();
  return params;
}

class Eeprom24xxDevice final : public RackDevice {
 public:
  Eeprom24xxDevice(DeviceSlot& slot, io::MemoryFile contents)
      : part_(slot.rack().events(), eeprom_params(slot), std::move(contents),
              slot.given("wp") ? &slot.pin("wp") : nullptr, &slot.rack().faults(),
              slot.rack().finding()) {
    slot.join_i2c(part_);
  }

 private:
  io::Eeprom24xx part_;
};

std::unique_ptr<RackDevice> make_eeprom(DeviceSlot& slot) {
  auto contents = eeprom_contents(slot);
  if (contents) return std::make_unique<Eeprom24xxDevice>(slot, std::move(contents.value()));
  slot.failed(contents.error());
  return nullptr;
}

}  // namespace

DeviceType eeprom_24xx_type() {
  const io::Eeprom24xx::Params usual;
  DeviceKey address = address_key();
  address.limits = {0x50, 0x57};
  return {"eeprom_24xx",
          "EEPROM with two address bytes on I2C; leaves NAME.img",
          {bus_key("i2c", "the bus").need(), address.need(),
           quantity_key("size", Dimension::data, "KiB", {1024.0, 65536.0}, "a power of two")
               .with(16384.0),
           quantity_key("page", Dimension::data, "B", {8.0, 256.0}, "a power of two").with(64.0),
           pin_key("wp", "write protect, active high; where none is given, low"),
           file_key("image", "what it starts as; where none is given, all 0xFF"),
           quantity_key("params.write_time", Dimension::time, "ms", {0.0, 0.1}, "of a page")
               .with(static_cast<double>(usual.write_ns) * 1e-9)},
          make_eeprom};
}

}  // namespace whirl::rack
