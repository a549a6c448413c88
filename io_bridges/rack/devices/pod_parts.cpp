// The host of a pod, and behind it the parts that the pod plays: an MPU-6000, an MS5611 and an HMC5883L, each the
// model that a board of the house carries, in the plant's motion, air and field; the four ESCs (pod_escs.hpp), receivers
// (pod_receivers.hpp), the radio (pod_radio.hpp) and the battery (pod_battery.hpp).
//
//   IMU     as it is set, which the pod's status tells; each of its samples is sent as it is ready
//   Air     PROM at the start and once a second, then pressure and temperature by turns, at the finest oversampling
//   Field   75 Hz at 1.3 Ga, each measurement as it is placed; the pod does not tell how the part is set
//   Line    a sample goes at once; what is slow follows the next one, so that no sample waits for it
//   Asked   figures by their names, as of pod_replay; `pod_flagged` are samples that a status has marked as lost or late,
//           `pod_untold` those that came between two statuses and stand in neither's 32; `spi_*` are of how long
//           answers on the pod's SPI had stood in DR when their first bit went out, by byte: the first of a transfer, and the others
//   Faults  of the parts, by their data (pod_faults.hpp); an IMU's other identity and its loss of supply the pod itself plays,
//           told at most 10 ms later. Those of a wire are the controller's side's
#include <optional>
#include <utility>

#include "io_bridges/devices/hmc5883l.hpp"
#include "io_bridges/devices/ms5611.hpp"
#include "io_bridges/rack/devices/imu_keys.hpp"
#include "io_bridges/rack/devices/pod_battery.hpp"
#include "io_bridges/rack/devices/pod_escs.hpp"
#include "io_bridges/rack/devices/pod_faults.hpp"
#include "io_bridges/rack/devices/pod_radio.hpp"
#include "io_bridges/rack/devices/pod_receivers.hpp"
#include "io_bridges/rack/devices/table.hpp"
#include "io_bridges/rack/models/inertial_sensor.hpp"
#include "io_bridges/rack/models/sensed_air.hpp"
#include "io_bridges/rack/models/sensed_field.hpp"

namespace whirl::rack {
namespace {

namespace mpu = core::mpu;

constexpr Nanoseconds kMs = 1'000'000, kStart_ns = 60 * kMs;  // all three have powered up
constexpr Nanoseconds kReload_ns = 3 * kMs, kConversion_ns = 9'500'000;
constexpr Nanoseconds kSampling_ns =
    10 * kMs;                     // two samples are no further apart, while it samples
constexpr int kProm_every = 100;  // conversions
constexpr std::uint8_t kReset = 0x1E, kPressure = 0x48, kTemperature = 0x58, kResult = 0x00,
                       kProm = 0xA0;
constexpr std::uint8_t kRead = 0x80, kAll_samples = mpu::ACCEL_XOUT_H | kRead;
constexpr std::uint32_t kBurst_Hz = 10'000'000, kRegister_Hz = 1'000'000;
constexpr int kMode = 3;
// In the order of PodStatus::settings; those after them say how the part tells, which here is a wire of its own.
constexpr std::array<std::uint8_t, 5> kSettings = {mpu::PWR_MGMT_1, mpu::CONFIG, mpu::SMPLRT_DIV,
                                                   mpu::GYRO_CONFIG, mpu::ACCEL_CONFIG};

io::Mpu6000::Params imu_of(DeviceSlot& slot) {
  io::Mpu6000::Params params;
  params.name = slot.name() + ".imu";
  params.bus = kPodBus;
  params.device = kPodImu;
  return params;
}

plant::BarometerParams air_of() {
  plant::BarometerParams params;
  params.noise_density_Pa = 0.0;  // the part's own
  return params;
}

io::Ms5611::Params barometer_of(DeviceSlot& slot) {
  io::Ms5611::Params params;
  params.name = slot.name() + ".baro";
  params.bus = kPodBus;
  params.device = kPodBarometer;
  params.seed = slot.rack().seed();
  return params;
}

io::Hmc5883l::Params magnetometer_of(DeviceSlot& slot) {
  io::Hmc5883l::Params params;
  params.name = slot.name() + ".mag";
  params.bus = kPodBus;
  params.device = kPodMagnetometer;
  params.seed = slot.rack().seed();
  return params;
}

class PodPartsDevice final : public RackDevice {
 public:
  PodPartsDevice(DeviceSlot& slot, const plant::ImuParams& physics)
      : queue_(slot.rack().events()),
        faults_(slot.rack().faults()),
        reader_([this](const io::PodStatus& status) { told(status); }),
        link_(slot, reader_),
        receivers_(slot, reader_,
                   [this](std::vector<std::uint8_t> frame) { send_slow(std::move(frame)); }),
        radio_(slot, reader_,
               [this](std::vector<std::uint8_t> frame) { send_slow(std::move(frame)); }),
        battery_(slot),
        slave_(slot.rack().spi_slave(slot.whole("params.spi"))),
        motion_(physics, mounting_of(slot.axes("axes")), slot.rack().seed(), slot.name()),
        air_(air_of(), slot.rack().seed(), slot.name()),
        field_({.mounting = mounting_of(slot.axes("params.field_axes")),
                .per_ampere_T = usual_motor_fields_T()}),
        imu_(
            queue_, imu_of(slot), [this](Nanoseconds now) { return motion_.sample(now); }, &sample_,
            &faults_, slot.rack().finding()),
        baro_(
            queue_, barometer_of(slot), [this](Nanoseconds now) { return air_.sense(now); },
            &faults_, slot.rack().finding()),
        mag_(
            queue_, magnetometer_of(slot), [this](Nanoseconds) { return field_.along_part_T(); },
            &placed_, &faults_, slot.rack().finding()),
        escs_(slot.rack(),
              [this](std::vector<std::uint8_t> frame) { send_slow(std::move(frame)); }),
        start_(queue_, [this] { start(); }),
        next_(queue_, [this] { convert(); }) {
    sample_.watch([this](bool level, Nanoseconds now) {
      if (level) send_sample(now);
    });
    placed_.watch([this](bool level, Nanoseconds now) {
      if (!level) send_field(now);
    });
    reader_.on_setpoint([this](const io::PodSetpoint& setpoint) { escs_.told(setpoint); });
    start_.at(kStart_ns);
  }

  std::vector<Intake> intakes() const override {
    std::vector<Intake> all = PodEscs::intakes();
    all.push_back({io::Kind::body_motion});
    all.push_back({io::Kind::rc_channels});
    all.push_back({io::Kind::uart_frame, link_.uart()});
    all.push_back({io::Kind::uart_frame, kPodRadioPort});
    return all;
  }
  void on_message(const io::Reader& message) override {
    if (message.header().kind == io::Kind::uart_frame) {
      if (message.header().port == kPodRadioPort) return radio_.on_message(message);
      return answer(PodHostLink::asked(message));
    }
    if (message.header().kind == io::Kind::esc_state) return escs_.on_message(message);
    if (message.header().kind == io::Kind::rc_channels) return receivers_.on_sticks(message);
    const auto motion = message.as<io::BodyMotion>();
    motion_.set_motion(motion, message.header().t_ns);
    air_.set(motion);
    field_.set(motion);
    receivers_.set(motion);
    battery_.set(motion.bus_voltage_V);
  }

 private:
  void start() {
    const Nanoseconds now = queue_.now();
    set(mpu::INT_ENABLE, 1, now);
    tell_part(mag_, {0x00, 6 << 2}, now);  // CONF_A: 75 Hz, one measurement each
    tell_part(mag_, {0x01, 1 << 5}, now);  // CONF_B: 1.3 Ga
    tell_part(mag_, {0x02, 0x00}, now);    // MODE: continuous
    tell_part(baro_, {kReset}, now);
    next_.in(kReload_ns);
    receivers_.start();
    radio_.start();
    started_ = true;
  }

  // ---- IMU

  void told(const io::PodStatus& status) {
    status_ = status;
    flags_.add(status);
    if (!started_) return;
    for (std::size_t i = 0; i < kSettings.size(); ++i) {
      if (settings_[i] == status.settings[i]) continue;
      settings_[i] = status.settings[i];
      set(kSettings[i], status.settings[i], queue_.now());
      // A part that was reset has forgotten how it tells.
      if (i == 0) set(mpu::INT_ENABLE, 1, queue_.now());
    }
  }
  void set(std::uint8_t address, std::uint8_t value, Nanoseconds now) {
    imu_.select(true, now);
    imu_.transfer(address, kRegister_Hz, kMode, now);
    imu_.transfer(value, kRegister_Hz, kMode, now);
    imu_.select(false, now);
  }
  void send_sample(Nanoseconds now) {
    std::array<std::int16_t, 7> counts{};
    imu_.select(true, now);
    imu_.transfer(kAll_samples, kBurst_Hz, kMode, now);
    for (std::int16_t& count : counts) {
      const std::uint8_t high = imu_.transfer(0, kBurst_Hz, kMode, now);
      count = static_cast<std::int16_t>(high << 8 | imu_.transfer(0, kBurst_Hz, kMode, now));
    }
    imu_.select(false, now);
    ++samples_;
    link_.send_sample(number_++, counts);
    sampled_ns_ = now;
    send_waiting();
  }
  void send_slow(std::vector<std::uint8_t> frame) {
    slow_.push_back(std::move(frame));
    if (queue_.now() - sampled_ns_ >= kSampling_ns) send_waiting();
  }
  void send_waiting() {
    for (const auto& frame : slow_) link_.send(frame);
    slow_.clear();
  }

  // What the pod is to play by itself; told as it changes.
  void tell_faults(Nanoseconds now) {
    const auto at = [&](io::FaultKind kind) { return faults_.apply(kind, kPodBus, kPodImu, now); };
    const io::Fault* other = at(io::FaultKind::sensor_wrong_identity);
    const PlayedFaults faults{
        at(io::FaultKind::sensor_brown_out) != nullptr,
        other == nullptr ? std::uint8_t{0} : static_cast<std::uint8_t>(other->value)};
    if (faults == played_) return;
    played_ = faults;
    send_slow(io::pack_pod_faults(fault_number_++, false, faults.no_supply, faults.identity));
  }

  // ---- Barometer and magnetometer

  void tell_part(io::I2cTarget& part, std::initializer_list<std::uint8_t> bytes, Nanoseconds now) {
    part.start(0, false, now);
    for (const std::uint8_t byte : bytes) part.write(byte, now);
    part.stop(now);
  }
  // Its high byte first.
  std::uint32_t ask_part(io::I2cTarget& part, std::uint8_t what, int bytes, Nanoseconds now) {
    tell_part(part, {what}, now);
    part.start(0, true, now);
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i) value = value << 8 | next_byte(part, i + 1 < bytes, now);
    part.stop(now);
    return value;
  }
  std::uint8_t next_byte(io::I2cTarget& part, bool more, Nanoseconds now) {
    const std::uint8_t byte = part.read(now);
    part.acked(more, now);
    return byte;
  }
  void convert() {
    const Nanoseconds now = queue_.now();
    tell_faults(now);
    if (auto news = battery_.news(now)) send_slow(std::move(*news));
    if (converting_) {
      send_slow(io::pack_pod_barometer(air_number_++, temperature_ ? 1 : 0,
                                       ask_part(baro_, kResult, 3, now)));
    }
    if (conversions_++ % kProm_every == 0) send_prom(now);
    temperature_ = converting_ && !temperature_;
    converting_ = true;
    tell_part(baro_, {temperature_ ? kTemperature : kPressure}, now);
    next_.in(kConversion_ns);
  }
  void send_prom(Nanoseconds now) {
    std::array<std::uint16_t, 8> words{};
    for (std::size_t i = 0; i < words.size(); ++i) {
      const auto command = static_cast<std::uint8_t>(kProm + 2 * i);
      words[i] = static_cast<std::uint16_t>(ask_part(baro_, command, 2, now));
    }
    send_slow(io::pack_pod_prom(prom_number_++, words));
  }
  void send_field(Nanoseconds now) {
    if (!started_) return;
    tell_part(mag_, {0x03}, now);
    mag_.start(0, true, now);
    std::array<std::int16_t, 3> in_order{};  // X, Z, Y
    for (std::size_t i = 0; i < in_order.size(); ++i) {
      const std::uint8_t high = next_byte(mag_, true, now);
      in_order[i] = static_cast<std::int16_t>(high << 8 | next_byte(mag_, i + 1 < 3, now));
    }
    mag_.stop(now);
    send_slow(io::pack_pod_magnetometer(field_number_++, {in_order[0], in_order[2], in_order[1]}));
  }

  // ---- What is asked of it

  void answer(const std::string& name) {
    if (!link_.tell(name, figures()) && !link_.tell(name, figures_of(status_))) {
      link_.tell(name, -1);
    }
  }
  PodFigures figures() const {
    const auto whole = [](auto value) { return static_cast<std::int64_t>(value); };
    const io::SpiSlack slack = slave_ == nullptr ? io::SpiSlack{} : slave_->slack();
    return {{"samples", whole(samples_)},
            {"pod_flagged", whole(flags_.flagged())},
            {"pod_untold", whole(flags_.untold())},
            {"setpoints", whole(escs_.setpoints())},
            {"setpoints_refused", whole(escs_.refused())},
            {"spi_first_bytes", whole(slack.first.bytes)},
            {"spi_first_late", whole(slack.first.late)},
            {"spi_first_least_wait_ns", slack.first.least_ns},
            {"spi_other_bytes", whole(slack.others.bytes)},
            {"spi_other_late", whole(slack.others.late)},
            {"spi_other_least_wait_ns", slack.others.least_ns}};
  }

  io::EventQueue& queue_;
  io::FaultBook& faults_;
  io::PodLinkReader reader_;
  PodHostLink link_;
  PodReceivers receivers_;
  PodRadio radio_;
  PodBattery battery_;
  const io::SpiSlave* slave_;
  io::PodStatus status_;
  io::PodFlags flags_;
  InertialSensor motion_;
  SensedAir air_;
  SensedField field_;
  io::Wire sample_{"data-ready", false}, placed_{"placed"};
  io::Mpu6000 imu_;
  io::Ms5611 baro_;
  io::Hmc5883l mag_;
  PodEscs escs_;
  io::Event start_, next_;
  std::array<std::uint8_t, kSettings.size()> settings_{};
  Nanoseconds sampled_ns_ = -kSampling_ns;
  std::vector<std::vector<std::uint8_t>> slow_;
  struct PlayedFaults {
    bool no_supply = false;
    std::uint8_t identity = 0;  // 0: its own
    bool operator==(const PlayedFaults&) const = default;
  } played_;
  bool started_ = false, converting_ = false, temperature_ = false;
  std::uint64_t samples_ = 0, conversions_ = 0;
  std::uint8_t number_ = 0, air_number_ = 0, prom_number_ = 0, field_number_ = 0, fault_number_ = 0;
};

std::unique_ptr<RackDevice> make(DeviceSlot& slot) {
  const plant::ImuParams physics = imu_physics_of(slot);
  if (slot.failed(plant::validate(physics, slot.place()))) return nullptr;
  return std::make_unique<PodPartsDevice>(slot, physics);
}

}  // namespace

DeviceType pod_parts_type() {
  DeviceKey spi = quantity_key("params.spi", Dimension::none, "", {1.0, 3.0},
                               "on which the pod answers as the IMU, for the figures");
  spi.kind = KeyKind::whole;
  std::vector<DeviceKey> keys = {spi.with(1.0),
                                 axes_key("params.field_axes", "the magnetometer's, in the body")
                                     .with(std::vector<std::string>{"+y", "-x", "+z"})};
  add_imu_keys(keys);
  for (const auto& more :
       {pod_link_keys(), pod_receiver_keys(), pod_radio_keys(), pod_battery_keys()}) {
    keys.insert(keys.end(), more.begin(), more.end());
  }
  return {"pod_parts", "the host of a pod, and the sensors, ESCs and receivers that it plays",
          std::move(keys), make};
}

}  // namespace whirl::rack
