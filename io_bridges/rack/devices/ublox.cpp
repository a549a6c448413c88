// u-blox receivers on a UART, or in a DroneCAN node: the part message by message (io_bridges/devices), its errors by the
// plant's GPS. The plan's world lies flat on the ellipsoid at a place of the board file's choice.
#include <cmath>

#include "io_bridges/devices/gnss_node.hpp"
#include "io_bridges/rack/devices/can_node_keys.hpp"
#include "io_bridges/rack/devices/gnss_place.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

Nanoseconds time_ns(const DeviceSlot& slot, const char* path) {
  return std::llround(slot.quantity(path) * 1e9);
}

io::Ublox::Params ublox_params(DeviceSlot& slot, io::UbloxModel model, double baud) {
  io::Ublox::Params params;
  params.name = slot.name();
  params.model = model;
  params.baud = static_cast<std::uint32_t>(std::lround(baud));
  params.first_fix_ns = time_ns(slot, "params.first_fix");
  params.latency_ns = time_ns(slot, "params.latency");
  params.satellites = slot.whole("params.satellites");
  params.dropout_chance = slot.quantity("params.dropout");
  params.seed = slot.rack().seed();
  params.bus = slot.bus_number();
  params.device = slot.number();
  return params;
}

template <io::UbloxModel kModel>
class UbloxDevice final : public RackDevice {
 public:
  explicit UbloxDevice(DeviceSlot& slot)
      : place_(slot, place_of(slot)),
        part_(
            slot.rack().events(), ublox_params(slot, kModel, slot.quantity("baud")),
            [this](const io::Ublox::Query& query) { return place_.fix(query); },
            &slot.rack().faults(), slot.rack().finding()) {
    slot.join_uart(part_);
  }

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override { place_.set(message.as<io::BodyMotion>()); }

 private:
  SensedPlace place_;
  io::Ublox part_;
};

class GnssNodeDevice final : public RackDevice {
 public:
  explicit GnssNodeDevice(DeviceSlot& slot)
      : place_(slot, place_of(slot)),
        node_(
            slot.rack().events(), slot.can(), can_node_of(slot, "org.whirlstand.gnss", kNode),
            ublox_params(slot, io::UbloxModel::m8, io::GnssNode::kBaud),
            [this](const io::Ublox::Query& query) { return place_.fix(query); },
            &slot.rack().faults(), slot.rack().finding()) {}

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override { place_.set(message.as<io::BodyMotion>()); }

 private:
  static constexpr int kNode = 53;
  SensedPlace place_;
  io::GnssNode node_;
};

void add_ublox_keys(std::vector<DeviceKey>& keys) {
  const io::Ublox::Params usual;
  DeviceKey satellites = quantity_key("params.satellites", Dimension::none, "", {4.0, 12.0},
                                      "that it tracks once it has settled");
  satellites.kind = KeyKind::whole;
  satellites.fallback = static_cast<double>(usual.satellites);
  const auto time = [](const char* path, const char* unit, double most_s, const char* about) {
    return quantity_key(path, Dimension::time, unit, {0.0, most_s}, about);
  };
  keys.push_back(time("params.first_fix", "s", 3600.0, "from power-up, cold")
                     .with(static_cast<double>(usual.first_fix_ns) * 1e-9));
  keys.push_back(time("params.latency", "ms", 10.0, "from a measurement to its first bit")
                     .with(static_cast<double>(usual.latency_ns) * 1e-9));
  keys.push_back(satellites);
  keys.push_back(quantity_key("params.dropout", Dimension::ratio, "%", {0.0, 1.0},
                              "share of the solutions that do not come out")
                     .with(0.0));
  add_place_keys(keys);
}

const std::vector<std::string> kUbloxSenses = {"north",          "east",          "down",
                                               "velocity_north", "velocity_east", "velocity_down"};

template <io::UbloxModel kModel>
DeviceType type_of(const char* name, const char* about) {
  std::vector<DeviceKey> keys = {
      bus_key("usart", "the UART").need().own(),
      quantity_key("baud", Dimension::baud, "baud", {4800.0, 460800.0}, "as saved in the part")
          .with(static_cast<double>(io::Ublox::Params{}.baud))};
  add_ublox_keys(keys);
  return {name, about, std::move(keys), make_device<UbloxDevice<kModel>>, {}, kUbloxSenses};
}

}  // namespace

DeviceType ublox_6_type() {
  return type_of<io::UbloxModel::six>("ublox_6", "GPS receiver LEA-6 on a UART");
}

DeviceType ublox_m8_type() {
  return type_of<io::UbloxModel::m8>("ublox_m8", "GPS receiver NEO-M8 on a UART");
}

DeviceType ublox_m8_dronecan_type() {
  std::vector<DeviceKey> keys = can_node_keys("53");
  add_ublox_keys(keys);
  return {"ublox_m8_dronecan",
          "GPS receiver NEO-M8 on CAN, by DroneCAN",
          std::move(keys),
          make_device<GnssNodeDevice>,
          {},
          kUbloxSenses};
}

}  // namespace whirl::rack
