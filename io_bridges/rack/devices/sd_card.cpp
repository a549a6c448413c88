// An SD card on SPI: the part command by command (io_bridges/devices). Its contents begin as a copy of
// `image`, or freshly formatted, and are NAME.img in the run's folder while the run goes and after it.
#include "io_bridges/devices/sd_card.hpp"

#include <cmath>

#include "io_bridges/devices/fresh_volume.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

constexpr double kMiB = 1048576.0;
constexpr double kLeast_bytes = static_cast<double>(io::kLeast_volume_bytes);

io::SdCard::Params card_params(DeviceSlot& slot) {
  const auto ns = [&slot](const char* path) { return std::llround(slot.quantity(path) * 1e9); };
  io::SdCard::Params params;
  params.name = slot.name();
  params.seed = slot.rack().seed();
  params.high_capacity = slot.flag("params.high_capacity");
  params.init_ns = ns("params.init_time");
  params.read_ns = ns("params.read_time");
  params.write_ns = ns("params.write_time");
  params.longest_stall_ns = ns("params.longest_stall");
  params.stall_every = slot.quantity("params.stall_every");
  params.bus = slot.bus_number();
  params.device = slot.number();
  return params;
}

// Of the card: what the key says, or the whole units that the image takes.
Result<std::int64_t> size_bytes(const DeviceSlot& slot) {
  const bool high_capacity = slot.flag("params.high_capacity");
  const std::int64_t unit = high_capacity ? io::sd::kUnit_high_bytes : io::sd::kUnit_standard_bytes;
  std::int64_t size = std::llround(slot.quantity("size"));
  if (slot.given("image") && !slot.given("size")) {
    const auto of_file = io::file_size_bytes(slot.text("image"));
    if (!of_file) return of_file.error();
    size = std::max<std::int64_t>((of_file.value() + unit - 1) / unit * unit, unit);
  }
  const auto wrong = [&slot](const std::string& what, const std::string& cure) {
    return Error{ErrorKind::bad_input, slot.place() + ".size", what, cure};
  };
  if (size % unit != 0) {
    return wrong(std::to_string(size) + " bytes are no whole number of the card's units",
                 "give a multiple of 512 KiB");
  }
  if (!high_capacity && size > io::sd::kMost_standard_bytes) {
    return wrong("a standard card has at most 1024 MiB", "set params.high_capacity = true");
  }
  if (slot.given("free") && (slot.given("image") || size > io::kMost_filled_bytes)) {
    return Error{ErrorKind::bad_input, slot.place() + ".free",
                 "is of a fresh volume of at most 4096 MiB", "leave it out"};
  }
  return size;
}

Result<io::MemoryFile> card_contents(DeviceSlot& slot) {
  const auto size = size_bytes(slot);
  if (!size) return size.error();
  auto contents = io::MemoryFile::create(slot.rack().file_to_leave(slot.name()), size.value());
  if (!contents) return contents;
  if (slot.given("image")) {
    const auto copied = contents.value().copy_from(slot.text("image"));
    if (!copied) return copied.error();
  } else {
    RandomStream serial(slot.rack().seed(), slot.name() + ".volume");
    io::write_fresh_volume(contents.value(), serial.bits());
    if (slot.given("free")) {
      io::fill_fresh_volume(contents.value(), std::llround(slot.quantity("free")));
    }
  }
  return contents;
}

class SdCardDevice final : public RackDevice {
 public:
  SdCardDevice(DeviceSlot& slot, io::MemoryFile contents)
      : part_(slot.rack().events(), card_params(slot), std::move(contents), &slot.rack().faults(),
              slot.rack().finding()) {
    slot.join_spi(part_);
  }

 private:
  io::SdCard part_;
};

std::unique_ptr<RackDevice> make_card(DeviceSlot& slot) {
  auto contents = card_contents(slot);
  if (contents) return std::make_unique<SdCardDevice>(slot, std::move(contents.value()));
  slot.failed(contents.error());
  return nullptr;
}

}  // namespace

DeviceType sd_card_type() {
  const io::SdCard::Params usual;
  const auto time = [](const char* path, double most_s, Nanoseconds usual_ns, const char* about) {
    return quantity_key(path, Dimension::time, "ms", {0.0, most_s}, about)
        .with(static_cast<double>(usual_ns) * 1e-9);
  };
  return {"sd_card",
          "SD card in SPI mode; leaves NAME.img",
          {bus_key("spi", "the bus").need(), pin_key("cs", "chip select, active low").need(),
           quantity_key("size", Dimension::data, "MiB", {kLeast_bytes, 32768.0 * kMiB},
                        "of the card, a multiple of 512 KiB; with an image, what that takes")
               .with(1024.0 * kMiB),
           file_key("image", "what the card starts as; where none is given, a fresh FAT32 volume"),
           quantity_key("free", Dimension::data, "MiB", {0.0, 4096.0 * kMiB},
                        "of a fresh volume; a file FULL.BIN has the rest. Where not given, all"),
           flag_key("params.high_capacity", "SDHC, by blocks; else SDSC, by bytes").with(true),
           time("params.init_time", 0.9, usual.init_ns, "from the first ACMD41 to ready"),
           time("params.read_time", 0.1, usual.read_ns, "to the first block of a read"),
           time("params.write_time", 0.25, usual.write_ns, "usual busy time of a block, +-50 %"),
           time("params.longest_stall", 0.5, usual.longest_stall_ns, "of its busy times"),
           quantity_key("params.stall_every", Dimension::none, "blocks", {0.0, 1e9},
                        "mean between stalls of 20 ms to the longest; 0: never")
               .with(usual.stall_every)},
          make_card};
}

}  // namespace whirl::rack
