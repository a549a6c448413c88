// u-blox receivers on a UART, or in a DroneCAN node: the part message by message (io_bridges/devices), its errors by the
// plant's GPS. The plan's world lies flat on the ellipsoid at a place of the board file's choice.
#include <cmath>

#include "io_bridges/devices/gnss_node.hpp"
#include "io_bridges/rack/devices/can_node_keys.hpp"
#include "io_bridges/rack/devices/table.hpp"
#include "plant/sensors/gps.hpp"

namespace whirl::rack {
namespace {

plant::GpsParams physics_of(const DeviceSlot& slot) {
  plant::GpsParams params;
  params.wander_level_m = slot.quantity("params.wander_level");
  params.wander_down_m = slot.quantity("params.wander_down");
  params.wander_time_s = slot.quantity("params.wander_time");
  params.velocity_level_mps = slot.quantity("params.velocity_noise");
  params.velocity_down_mps = slot.quantity("params.velocity_noise_down");
  return params;
}

Nanoseconds time_ns(const DeviceSlot& slot, const char* path) {
  return std::llround(slot.quantity(path) * 1e9);
}

io::Ublox::Params part_of(DeviceSlot& slot, io::UbloxModel model, double baud) {
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

// What the receiver finds, by the plant's errors.
class SensedPlace {
 public:
  explicit SensedPlace(DeviceSlot& slot)
      : gps_(physics_of(slot), slot.rack().seed(), slot.name()),
        origin_{slot.quantity("params.latitude"), slot.quantity("params.longitude"),
                slot.quantity("params.height")},
        geoid_m_(slot.quantity("params.geoid")),
        happened_(slot.rack().happened()),
        number_(slot.number()) {}

  void set(const io::BodyMotion& motion) {
    for (int i = 0; i < 3; ++i) {
      truth_.p_WB_W_m[i] = motion.p_WB_W_m[i];
      truth_.v_WB_W_mps[i] = motion.v_WB_W_mps[i];
    }
  }
  io::GnssFix fix(const io::Ublox::Query& query) {
    const plant::GpsFix seen =
        gps_.measure(static_cast<double>(query.now) * 1e-9, truth_, query.error_scale);
    std::array<double, 3> p_m{};
    io::GnssFix out;
    for (unsigned i = 0; i < 3; ++i) {
      p_m[i] = seen.p_WB_W_m[i] + query.offset_NED_m[i];
      out.v_NED_mps[i] = seen.v_WB_W_mps[i] + query.offset_NED_mps[i];
    }
    out.place = geodetic_of_ned(origin_, p_m);
    out.geoid_m = geoid_m_;
    out.level_accuracy_m = std::sqrt(2.0) * seen.level_accuracy_m;  // of two axes
    out.down_accuracy_m = seen.down_accuracy_m;
    out.velocity_accuracy_mps = std::sqrt(2.0) * seen.velocity_accuracy_mps;
    tell(query.now, out, p_m);
    return out;
  }

 private:
  void tell(Nanoseconds now, const io::GnssFix& fix, const std::array<double, 3>& p_m) {
    io::GnssSolution told{.latitude_rad = fix.place.latitude_rad,
                          .longitude_rad = fix.place.longitude_rad,
                          .height_m = fix.place.height_m};
    for (unsigned i = 0; i < 3; ++i) {
      told.p_WB_W_m[i] = p_m[i];
      told.p_error_W_m[i] = p_m[i] - truth_.p_WB_W_m[i];
      told.v_error_W_mps[i] = fix.v_NED_mps[i] - truth_.v_WB_W_mps[i];
    }
    happened_.add(io::Kind::gnss_solution, number_, now, told);
  }

  plant::Gps gps_;
  plant::Truth truth_;
  Geodetic origin_;
  double geoid_m_;
  io::Batch& happened_;
  std::uint16_t number_;
};

template <io::UbloxModel kModel>
class UbloxDevice final : public RackDevice {
 public:
  explicit UbloxDevice(DeviceSlot& slot)
      : place_(slot),
        part_(
            slot.rack().events(), part_of(slot, kModel, slot.quantity("baud")),
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
      : place_(slot),
        node_(
            slot.rack().events(), slot.can(), can_node_of(slot, "org.whirlstand.gnss", kNode),
            part_of(slot, io::UbloxModel::m8, io::GnssNode::kBaud),
            [this](const io::Ublox::Query& query) { return place_.fix(query); },
            &slot.rack().faults(), slot.rack().finding()) {}

  std::vector<Intake> intakes() const override { return {{io::Kind::body_motion}}; }
  void on_message(const io::Reader& message) override { place_.set(message.as<io::BodyMotion>()); }

 private:
  static constexpr int kNode = 53;
  SensedPlace place_;
  io::GnssNode node_;
};

void add_place(std::vector<DeviceKey>& keys) {
  const auto angle = [](const char* path, double limit_deg, const char* about) {
    const double limit = limit_deg * M_PI / 180.0;
    return quantity_key(path, Dimension::angle, "deg", {-limit, limit}, about);
  };
  const auto metres = [](const char* path, const char* about) {
    return quantity_key(path, Dimension::length, "m", {-500.0, 10000.0}, about);
  };
  // Canberra, as the magnetic field of a flight.
  keys.push_back(
      angle("params.latitude", 90.0, "of the world's origin").with(-35.28 * M_PI / 180.0));
  keys.push_back(angle("params.longitude", 180.0, "of the same").with(149.13 * M_PI / 180.0));
  keys.push_back(metres("params.height", "of the same, over the ellipsoid").with(600.0));
  keys.push_back(metres("params.geoid", "sea level over the ellipsoid").with(19.0));
}

void add_physics(std::vector<DeviceKey>& keys) {
  const plant::GpsParams usual;
  const auto metres = [](const char* path, const char* about) {
    return quantity_key(path, Dimension::length, "m", {0.0, 1000.0}, about);
  };
  const auto speed = [](const char* path, const char* about) {
    return quantity_key(path, Dimension::speed, "m/s", {0.0, 100.0}, about);
  };
  keys.push_back(metres("params.wander_level", "standard deviation of position, north and east")
                     .with(usual.wander_level_m));
  keys.push_back(metres("params.wander_down", "and down").with(usual.wander_down_m));
  keys.push_back(
      quantity_key("params.wander_time", Dimension::time, "s", {0.1, 1e5}, "how slow it is")
          .with(usual.wander_time_s));
  keys.push_back(speed("params.velocity_noise", "standard deviation of velocity, north and east")
                     .with(usual.velocity_level_mps));
  keys.push_back(speed("params.velocity_noise_down", "and down").with(usual.velocity_down_mps));
}

void add_part(std::vector<DeviceKey>& keys) {
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
  add_place(keys);
  add_physics(keys);
}

const std::vector<std::string> kSenses = {"north",          "east",          "down",
                                          "velocity_north", "velocity_east", "velocity_down"};

template <io::UbloxModel kModel>
DeviceType type_of(const char* name, const char* about) {
  std::vector<DeviceKey> keys = {
      bus_key("usart", "the UART").need().own(),
      quantity_key("baud", Dimension::baud, "baud", {4800.0, 460800.0}, "as saved in the part")
          .with(static_cast<double>(io::Ublox::Params{}.baud))};
  add_part(keys);
  return {name, about, std::move(keys), make_device<UbloxDevice<kModel>>, {}, kSenses};
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
  add_part(keys);
  return {"ublox_m8_dronecan",
          "GPS receiver NEO-M8 on CAN, by DroneCAN",
          std::move(keys),
          make_device<GnssNodeDevice>,
          {},
          kSenses};
}

}  // namespace whirl::rack
