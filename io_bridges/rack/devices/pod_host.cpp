// The host of a pod, and what hangs on the pod's lines of GPS and receiver, for its proof: samples, an SBUS and a
// CPPM frame at the parts' own rates, a u-blox receiver's bytes.
//
//   GPS      a u-blox of generation 6 lives here; what it says leaves the pod, what the flight controller says to
//            the pod's line (uart_frame on params.gps, at `baud`) comes to it by the link. When it changes its rate, the
//            host tells the pod, and the flight controller's line follows
//   Judged   see pod_output_check.hpp; figures as of pod_replay, by their names, at any time
//   Out      each character on the two lines as a message of its own, with its time
#include <optional>
#include <utility>

#include "io_bridges/devices/sbus.hpp"
#include "io_bridges/devices/ublox.hpp"
#include "io_bridges/rack/devices/pod_line_end.hpp"
#include "io_bridges/rack/devices/pod_output_check.hpp"
#include "io_bridges/rack/devices/table.hpp"

namespace whirl::rack {
namespace {

constexpr Nanoseconds kMs = 1'000'000, kStart_ns = 20 * kMs;
constexpr double kRadius_deg = 57.29577951308232;
constexpr unsigned kCppmChannels = 8;

// The far end of one of the pod's lines.
class PodLine final : public io::UartPeer {
 public:
  using Heard = std::function<void(const io::UartByte&, const io::UartFormat&, Nanoseconds)>;

  PodLine(io::EventQueue& queue, double baud, Heard heard)
      : heard_(std::move(heard)),
        out_(queue, {.baud = baud}, [this](const io::UartByte& byte, const io::UartFormat& format) {
          UartPeer::send(byte, format);
        }) {}
  void receive(const io::UartByte& byte, const io::UartFormat& format, Nanoseconds now) override {
    heard_(byte, format, now);
  }
  void say(std::span<const std::uint8_t> bytes) { out_.add(bytes); }
  void speak_at(double baud) { out_.change_format({.baud = baud}); }

 private:
  Heard heard_;
  io::UartTransmitter out_;
};

io::GnssFix place(const io::Ublox::Query&) {
  io::GnssFix fix;
  fix.place = {47.3977 / kRadius_deg, 8.5456 / kRadius_deg, 488.0};
  fix.v_NED_mps = {1.25, -0.5, 0.25};
  fix.level_accuracy_m = 1.5;
  fix.down_accuracy_m = 2.5;
  fix.velocity_accuracy_mps = 0.2;
  return fix;
}

io::Ublox::Params receiver_of(DeviceSlot& slot) {
  io::Ublox::Params params;
  params.name = slot.name();
  params.baud = static_cast<std::uint32_t>(std::lround(slot.quantity("baud")));
  params.first_fix_ns = 1000 * kMs;
  return params;
}

class PodHostDevice final : public RackDevice {
 public:
  explicit PodHostDevice(DeviceSlot& slot)
      : queue_(slot.rack().events()),
        happened_(slot.rack().happened()),
        gps_uart_(slot.whole("params.gps")),
        sbus_uart_(slot.whole("params.sbus")),
        silent_ns_(std::llround(slot.quantity("params.silent") * 1e9)),
        reader_([this](const io::PodStatus& status) { status_ = status; }),
        link_(slot, reader_),
        gps_line_(queue_, slot.quantity("baud"),
                  [this](const io::UartByte& byte, const io::UartFormat& format, Nanoseconds now) {
                    gps_check_.add(byte.value, format.baud, now);
                    tell(gps_uart_, byte.value, now);
                  }),
        sbus_line_(queue_, core::receiver::kSbusBaud,
                   [this](const io::UartByte& byte, const io::UartFormat& format, Nanoseconds now) {
                     sbus_check_.add(byte, format, now);
                     tell(sbus_uart_, byte.value, now);
                   }),
        gps_(queue_, receiver_of(slot), place, nullptr, slot.rack().finding()),
        said_(
            queue_, io::PodEnd::gps, gps_, [this] { return gps_.baud(); }, reader_,
            {[this](const std::vector<std::uint8_t>& frame) { link_.send(frame); },
             [this](std::uint8_t byte, double baud) { gps_check_.given(byte, baud, queue_.now()); },
             [this](double baud) { gps_line_.speak_at(baud); }}),
        sample_(queue_, [this] { sample(); }),
        sbus_(queue_, [this] { sbus(); }),
        cppm_(queue_, [this] { cppm(); }) {
    if (!slot.rack().join_uart(gps_uart_, gps_line_)) return;
    if (!slot.rack().join_uart(sbus_uart_, sbus_line_)) return;
    slot.pin("cppm").watch([this](bool level, Nanoseconds now) { cppm_check_.edge(level, now); });
    reader_.on_setpoint([this](const io::PodSetpoint& setpoint) {
      ++setpoints_;
      setpoint_ = setpoint;
    });
    sample_.in(kStart_ns);
    sbus_.in(kStart_ns);
    cppm_.in(kStart_ns);
  }

  std::vector<Intake> intakes() const override {
    return {{io::Kind::uart_frame, link_.uart()}, {io::Kind::uart_frame, gps_uart_}};
  }
  void on_message(const io::Reader& message) override {
    if (message.header().port == gps_uart_) return gps_line_.say(message.payload());
    answer(PodHostLink::asked(message));
  }

 private:
  // ---- What the host tells

  void sample() {
    sample_.in(kMs);
    if (number_ == 0) said_.tell_rate();
    said_.flush();
    ++number_;
    std::array<std::int16_t, 7> counts{};
    for (unsigned i = 0; i < counts.size(); ++i) {
      counts[i] = static_cast<std::int16_t>(37u * number_ + 1000u * i);
    }
    link_.send_sample(static_cast<std::uint8_t>(number_), counts);
  }
  bool silent() const { return silent_ns_ != 0 && queue_.now() >= silent_ns_; }
  void sbus() {
    sbus_.in(core::receiver::kSbusPeriod_ns);
    if (silent()) return;
    io::SbusFrame frame;
    for (unsigned i = 0; i < frame.channels.size(); ++i) {
      frame.channels[i] = static_cast<std::uint16_t>(172 + (7 * ++sbus_step_ + 97 * i) % 1640);
    }
    sbus_check_.told(encode(frame));
    link_.send(io::pack_pod_sbus(sbus_number_++, frame));
  }
  void cppm() {
    cppm_.in(core::receiver::kCppmFrame_ns);
    if (silent()) return;
    std::vector<std::uint16_t> steps(kCppmChannels);
    for (unsigned i = 0; i < kCppmChannels; ++i) {
      steps[i] = static_cast<std::uint16_t>(1800 + (5 * ++cppm_step_ + 311 * i) % 2401);
    }
    cppm_check_.told(steps);
    link_.send(io::pack_pod_cppm(cppm_number_++, steps));
  }

  // ---- What is asked of it

  void answer(const std::string& name) {
    if (!link_.tell(name, figures()) && !link_.tell(name, figures_of(status_))) {
      link_.tell(name, -1);
    }
  }
  PodFigures figures() const {
    const auto whole = [](auto value) { return static_cast<std::int64_t>(value); };
    return {{"sbus_frames", whole(sbus_check_.frames)},
            {"sbus_wrong", whole(sbus_check_.wrong + sbus_check_.wrong_format)},
            {"sbus_period_least_ns", sbus_check_.period.least_ns},
            {"sbus_period_most_ns", sbus_check_.period.most_ns},
            {"sbus_character_least_ns", sbus_check_.character.least_ns},
            {"sbus_character_most_ns", sbus_check_.character.most_ns},
            {"cppm_frames", whole(cppm_check_.frames)},
            {"cppm_wrong", whole(cppm_check_.wrong)},
            {"cppm_off_ns", cppm_check_.most_off_ns},
            {"cppm_pulse_least_ns", cppm_check_.pulse.least_ns},
            {"cppm_pulse_most_ns", cppm_check_.pulse.most_ns},
            {"cppm_frame_least_ns", cppm_check_.frame.least_ns},
            {"cppm_frame_most_ns", cppm_check_.frame.most_ns},
            {"gps_bytes", whole(gps_check_.bytes)},
            {"gps_wrong", whole(gps_check_.wrong)},
            {"gps_off_rate", whole(gps_check_.off_rate)},
            {"gps_missing", whole(gps_check_.missing())},
            {"gps_delay_most_ns", gps_check_.delay.most_ns},
            {"samples", whole(number_)},
            {"setpoints", whole(setpoints_)},
            {"setpoint_esc", setpoint_.esc},
            {"setpoint_value", setpoint_.valid ? setpoint_.value : -1}};
  }
  void tell(std::uint16_t uart, std::uint8_t byte, Nanoseconds now) {
    happened_.add(io::Kind::uart_received, uart, now, &byte, 1);
  }

  io::EventQueue& queue_;
  io::Batch& happened_;
  std::uint16_t gps_uart_, sbus_uart_;
  Nanoseconds silent_ns_;
  io::PodLinkReader reader_;
  PodHostLink link_;
  io::PodStatus status_;
  SbusCheck sbus_check_;
  CppmCheck cppm_check_;
  GpsCheck gps_check_;
  PodLine gps_line_, sbus_line_;
  io::Ublox gps_;
  PodLineEnd said_;
  io::Event sample_, sbus_, cppm_;
  std::uint64_t number_ = 0, setpoints_ = 0;
  io::PodSetpoint setpoint_;
  unsigned sbus_step_ = 0, cppm_step_ = 0;
  std::uint8_t sbus_number_ = 0, cppm_number_ = 0;
};

}  // namespace

DeviceType pod_host_type() {
  const auto uart = [](const char* path, const char* about, double usual) {
    DeviceKey key = quantity_key(path, Dimension::none, "", {1.0, 6.0}, about);
    key.kind = KeyKind::whole;
    return key.with(usual);
  };
  std::vector<DeviceKey> keys = {
      pin_key("cppm", "the pod's sum signal").need(),
      quantity_key("baud", Dimension::baud, "baud", {4800.0, 115200.0},
                   "of the GPS as it is saved, and of the flight controller's line to it")
          .with(9600.0),
      uart("params.gps", "the pod's line of the GPS", 6.0),
      uart("params.sbus", "and of the receiver", 2.0),
      quantity_key("params.silent", Dimension::time, "s", {0.0, 1000.0},
                   "when the host stops telling of the receiver; 0: never")
          .with(0.0)};
  for (const DeviceKey& key : pod_link_keys()) keys.push_back(key);
  return {"pod_host", "the host of a pod, and what hangs on its lines of GPS and receiver",
          std::move(keys), make_device<PodHostDevice>};
}

}  // namespace whirl::rack
