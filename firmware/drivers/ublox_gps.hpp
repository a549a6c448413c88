// Driver for u-blox GPS receivers of generation 6 and later on a UART.
//
//   Contract  tick() every few milliseconds; push() with each byte and its time, from a task or, where
//             tick() cannot interrupt it, an interrupt. Neither blocks. A UART that only queues is meant
//   Setup     finds the receiver at any of its baud rates and tells it 57600 baud, UBX alone; 200 ms per
//             solution; airborne model, 3D; then PVT each solution. A generation 6 refuses that one, and
//             is told POSLLH, VELNED and SOL in its place. Each step must be acknowledged within 250 ms and
//             is tried three times; then the search begins anew, and asks again what it talks to
//   Output    a Fix from PVT, or when the three messages of one solution are there, once; its time is that
//             of the solution's first byte: the receiver measured a fixed latency before
//   Verified  each 2 s one setting is polled, right behind a solution, so that the answer delays none: rate,
//             model, then each message, so each every 10 s at most. If one is not as it was told, all are told
//             again, the port first. No answer is no loss: the line may have spoilt it
//   Faults    2 s without a whole solution: the receiver has lost its settings, the search begins anew
//   Source    PX4-GPSDrivers src/ubx.{h,cpp}, ArduPilot AP_GPS_UBLOX; acknowledge of a new baud rate may
//             come at the old or the new one: it is not waited for
#pragma once
#include <array>
#include <concepts>
#include <cstdint>
#include <span>
#include <tuple>

#include "firmware/drivers/ubx_frame.hpp"
#include "firmware/status.hpp"

namespace fw {

template <typename U>
concept BaudUart = requires(U uart, std::uint32_t baud, std::span<const std::uint8_t> bytes) {
  uart.set_baud(baud);
  { uart.send(bytes) } -> std::same_as<Status>;
};

struct GpsFix {
  std::uint32_t received_us = 0;  // first byte of the solution
  std::uint32_t itow_ms = 0;
  std::int32_t latitude_e7_deg = 0, longitude_e7_deg = 0;
  std::int32_t height_mm = 0, height_sea_mm = 0;  // over the ellipsoid, above the sea
  std::uint32_t level_accuracy_mm = 0, down_accuracy_mm = 0;
  std::int32_t v_north_mmps = 0, v_east_mmps = 0, v_down_mmps = 0;
  std::uint32_t speed_accuracy_mmps = 0;
  std::uint8_t fix_type = 0, flags = 0, satellites = 0;

  bool usable() const {
    return fix_type == 3 && (flags & 1) != 0;
  }  // 3D, within the receiver's limits
  std::uint32_t age_us(std::uint32_t now_us) const { return now_us - received_us; }
};

template <BaudUart Uart>
class UbloxGps {
 public:
  explicit constexpr UbloxGps(Uart& uart) : uart_(uart) {}

  void tick(std::uint32_t now_us);
  void push(std::uint8_t byte, std::uint32_t now_us);

  bool running() const { return phase_ == Phase::run; }
  bool takes_pvt() const { return pvt_; }  // once it runs
  // True: a new fix since the last call.
  bool take(GpsFix& out) {
    if (!fresh_) return false;
    fresh_ = false;
    out = fix_;
    return true;
  }
  std::uint32_t searches() const { return searches_; }  // beside the first
  std::uint32_t restored() const { return restored_; }  // times that a lost setting was found
  std::uint32_t bad_frames() const { return parser_.bad_frames(); }
  std::uint32_t refused() const { return refused_; }  // settings answered with NAK

 private:
  enum class Phase : std::uint8_t { knock, retune, confirm, configure, run };
  enum Part : std::uint8_t { posllh = 1, velned = 2, sol = 4, whole = 7 };

  static constexpr std::uint32_t kBaud = 57600;
  static constexpr std::array<std::uint32_t, 6> kBauds{kBaud, 9600, 38400, 115200, 19200, 4800};
  static constexpr std::uint32_t kAnswer_us = 250'000, kSilence_us = 2'000'000;
  static constexpr std::uint32_t kVerify_us = 2'000'000, kBehind_us = 20'000;
  static constexpr std::uint16_t kPeriod_ms = 200;
  static constexpr std::uint8_t kAirborne = 6, k3D = 2;  // below 1 g
  static constexpr unsigned kTries = 3;
  static constexpr std::uint8_t kCfg = 0x06;

  // UART1, 8N1, kBaud, UBX in and out.
  static constexpr auto kPort = ubx::frame<20>(
      kCfg, 0x00,
      {1, 0, 0, 0, 0xD0, 0x08, 0, 0, kBaud & 0xFF, kBaud >> 8 & 0xFF, kBaud >> 16, 0, 1, 0, 1, 0});
  static constexpr auto kRate = ubx::frame<6>(kCfg, 0x08, {kPeriod_ms, 0, 1, 0, 1, 0});
  static constexpr auto kNav5 = ubx::frame<36>(kCfg, 0x24, {0x05, 0, kAirborne, k3D});
  static constexpr auto kPvt = ubx::frame<3>(kCfg, 0x01, {0x01, 0x07, 1});
  static constexpr auto kPosllh = ubx::frame<3>(kCfg, 0x01, {0x01, 0x02, 1});
  static constexpr auto kVelned = ubx::frame<3>(kCfg, 0x01, {0x01, 0x12, 1});
  static constexpr auto kSol = ubx::frame<3>(kCfg, 0x01, {0x01, 0x06, 1});
  static constexpr std::array<std::span<const std::uint8_t>, 6> kSettings{kRate,   kNav5,   kPvt,
                                                                          kPosllh, kVelned, kSol};
  static constexpr std::size_t kPvtSetting = 2;  // taken: those behind it are not needed
  // How each is asked for: without a payload; of a message by its class and id.
  static constexpr auto kPollRate = ubx::frame<0>(kCfg, 0x08, {});
  static constexpr auto kPollNav5 = ubx::frame<0>(kCfg, 0x24, {});
  static constexpr auto kPollPvt = ubx::frame<2>(kCfg, 0x01, {0x01, 0x07});
  static constexpr auto kPollPosllh = ubx::frame<2>(kCfg, 0x01, {0x01, 0x02});
  static constexpr auto kPollVelned = ubx::frame<2>(kCfg, 0x01, {0x01, 0x12});
  static constexpr auto kPollSol = ubx::frame<2>(kCfg, 0x01, {0x01, 0x06});
  static constexpr std::array<std::span<const std::uint8_t>, kSettings.size()> kPolls{
      kPollRate, kPollNav5, kPollPvt, kPollPosllh, kPollVelned, kPollSol};

  void begin(Phase phase, std::uint32_t now_us) {
    phase_ = phase;
    since_us_ = now_us;
    tries_ = 0;
    asked_ = answered_ = false;
  }
  void search(std::uint32_t now_us) {
    searches_ = searches_ + 1;
    begin(Phase::knock, now_us);
  }
  void knock(std::uint32_t now_us);
  // Sends what is to be acknowledged, again where it was not; false: given up.
  bool ask(std::span<const std::uint8_t> request, std::uint32_t now_us);
  void configure(std::uint32_t now_us);
  void verify(std::uint32_t now_us);
  void on_setting();
  void on_frame(std::uint32_t now_us);
  void on_answer(bool nak);
  void on_pvt(std::uint32_t now_us);
  void on_message_of_three(std::uint32_t now_us);
  void on_part(Part part, std::uint32_t now_us);

  Uart& uart_;
  ubx::Parser parser_;
  Phase phase_ = Phase::knock;
  std::size_t baud_ = 0, setting_ = 0;
  std::uint32_t since_us_ = 0;  // this phase, or the newest question, or solution
  std::uint32_t frame_us_ = 0;  // the first byte of the newest frame
  unsigned tries_ = 0;
  bool asked_ = false, answered_ = false, fresh_ = false, pvt_ = false;
  std::uint8_t awaited_ = 0;  // id of the CFG message
  std::uint8_t parts_ = 0;
  GpsFix next_, fix_;
  std::uint32_t searches_ = 0, refused_ = 0, restored_ = 0;
  std::size_t poll_ = 0;  // the next of kPolls
  std::uint32_t polled_us_ = 0;
  bool lost_ = false;  // one setting is not as it was told
};

template <BaudUart Uart>
void UbloxGps<Uart>::tick(std::uint32_t now_us) {
  switch (phase_) {
    case Phase::knock:
      return knock(now_us);
    case Phase::retune:  // 28 bytes last 58 ms at 4800 baud
      if (now_us - since_us_ < 100'000) return;
      uart_.set_baud(kBaud);
      return begin(Phase::confirm, now_us);
    case Phase::confirm:
      if (answered_) {
        setting_ = 0;
        return begin(Phase::configure, now_us);
      }
      if (ask(kPort, now_us)) return;
      baud_ = (baud_ + 1) % kBauds.size();
      return search(now_us);
    case Phase::configure:
      return configure(now_us);
    case Phase::run:
      if (now_us - since_us_ > kSilence_us) return search(now_us);
      return verify(now_us);
  }
}

template <BaudUart Uart>
void UbloxGps<Uart>::knock(std::uint32_t now_us) {
  uart_.set_baud(kBauds[baud_]);
  if (uart_.send(kPort) == Status::ok) begin(Phase::retune, now_us);
}

template <BaudUart Uart>
bool UbloxGps<Uart>::ask(std::span<const std::uint8_t> request, std::uint32_t now_us) {
  if (asked_ && now_us - since_us_ < kAnswer_us) return true;
  if (tries_ == kTries) return false;
  awaited_ = request[3];
  since_us_ = now_us;
  asked_ = uart_.send(request) == Status::ok;
  if (asked_) ++tries_;
  return true;
}

template <BaudUart Uart>
void UbloxGps<Uart>::configure(std::uint32_t now_us) {
  if (answered_) {
    setting_ = setting_ == kPvtSetting && pvt_ ? kSettings.size() : setting_ + 1;
    begin(Phase::configure, now_us);
  }
  if (setting_ == kSettings.size()) return begin(Phase::run, now_us);
  if (!ask(kSettings[setting_], now_us)) search(now_us);
}

// What was polled last has been answered by now, and its acknowledge is taken for none of a setting.
template <BaudUart Uart>
void UbloxGps<Uart>::verify(std::uint32_t now_us) {
  if (now_us - polled_us_ < kVerify_us || now_us - since_us_ > kBehind_us) return;
  polled_us_ = now_us;
  if (lost_) {
    lost_ = false;
    restored_ = restored_ + 1;
    return begin(Phase::confirm, now_us);
  }
  if (uart_.send(kPolls[poll_]) != Status::ok) return;
  // Of the messages PVT, or the three behind it.
  ++poll_;
  if (poll_ == kPvtSetting && !pvt_) ++poll_;
  if (poll_ == kPolls.size() || (poll_ > kPvtSetting && pvt_)) poll_ = 0;
}

// Of a message the rates at six ports, UART1's the second.
template <BaudUart Uart>
void UbloxGps<Uart>::on_setting() {
  bool holds = true;
  if (parser_.is(kCfg, 0x08, 6)) holds = parser_.get<std::uint16_t>(0) == kPeriod_ms;
  if (parser_.is(kCfg, 0x24, 36)) {
    holds = parser_.get<std::uint8_t>(2) == kAirborne && parser_.get<std::uint8_t>(3) == k3D;
  }
  if (parser_.is(kCfg, 0x01, 8)) holds = parser_.get<std::uint8_t>(3) == 1;
  lost_ = lost_ || !holds;
}

template <BaudUart Uart>
void UbloxGps<Uart>::push(std::uint8_t byte, std::uint32_t now_us) {
  if (parser_.between_frames()) frame_us_ = now_us;
  if (parser_.push(byte)) on_frame(now_us);
}

template <BaudUart Uart>
void UbloxGps<Uart>::on_frame(std::uint32_t now_us) {
  constexpr std::size_t kPvtOf7 = 84, kPvtOf8 = 92;
  const bool nak = parser_.is(0x05, 0x00, 2);
  if (nak || parser_.is(0x05, 0x01, 2)) return on_answer(nak);
  if (phase_ == Phase::run) on_setting();
  if (!pvt_) return on_message_of_three(now_us);
  if (parser_.is(0x01, 0x07, kPvtOf8) || parser_.is(0x01, 0x07, kPvtOf7)) on_pvt(now_us);
}

// That PVT is refused is an answer, too: which generation it is.
template <BaudUart Uart>
void UbloxGps<Uart>::on_answer(bool nak) {
  if (parser_.get<std::uint8_t>(0) != kCfg || parser_.get<std::uint8_t>(1) != awaited_) return;
  const bool of_pvt = phase_ == Phase::configure && setting_ == kPvtSetting;
  if (nak && !of_pvt) refused_ = refused_ + 1;
  if (of_pvt) pvt_ = !nak;
  answered_ = asked_ && (!nak || of_pvt);
}

template <BaudUart Uart>
void UbloxGps<Uart>::on_pvt(std::uint32_t now_us) {
  fix_.received_us = frame_us_;
  fix_.itow_ms = parser_.get<std::uint32_t>(0);
  fix_.fix_type = parser_.get<std::uint8_t>(20);
  fix_.flags = parser_.get<std::uint8_t>(21);
  fix_.satellites = parser_.get<std::uint8_t>(23);
  fix_.longitude_e7_deg = parser_.get<std::int32_t>(24);
  fix_.latitude_e7_deg = parser_.get<std::int32_t>(28);
  fix_.height_mm = parser_.get<std::int32_t>(32);
  fix_.height_sea_mm = parser_.get<std::int32_t>(36);
  fix_.level_accuracy_mm = parser_.get<std::uint32_t>(40);
  fix_.down_accuracy_mm = parser_.get<std::uint32_t>(44);
  fix_.v_north_mmps = parser_.get<std::int32_t>(48);
  fix_.v_east_mmps = parser_.get<std::int32_t>(52);
  fix_.v_down_mmps = parser_.get<std::int32_t>(56);
  fix_.speed_accuracy_mmps = parser_.get<std::uint32_t>(68);
  fresh_ = true;
  if (phase_ == Phase::run) since_us_ = now_us;
}

template <BaudUart Uart>
void UbloxGps<Uart>::on_message_of_three(std::uint32_t now_us) {
  if (parser_.is(0x01, 0x02, 28)) {
    on_part(posllh, now_us);
    next_.longitude_e7_deg = parser_.get<std::int32_t>(4);
    next_.latitude_e7_deg = parser_.get<std::int32_t>(8);
    next_.height_mm = parser_.get<std::int32_t>(12);
    next_.height_sea_mm = parser_.get<std::int32_t>(16);
    next_.level_accuracy_mm = parser_.get<std::uint32_t>(20);
    next_.down_accuracy_mm = parser_.get<std::uint32_t>(24);
  } else if (parser_.is(0x01, 0x12, 36)) {
    on_part(velned, now_us);
    next_.v_north_mmps = 10 * parser_.get<std::int32_t>(4);
    next_.v_east_mmps = 10 * parser_.get<std::int32_t>(8);
    next_.v_down_mmps = 10 * parser_.get<std::int32_t>(12);
    next_.speed_accuracy_mmps = 10 * parser_.get<std::uint32_t>(28);
  } else if (parser_.is(0x01, 0x06, 52)) {
    on_part(sol, now_us);
    next_.fix_type = parser_.get<std::uint8_t>(10);
    next_.flags = parser_.get<std::uint8_t>(11);
    next_.satellites = parser_.get<std::uint8_t>(47);
  }
  if (parts_ != whole) return;
  parts_ = 0;
  fix_ = next_;
  fresh_ = true;
}

// The parts of a solution share its time of week: another time begins another solution.
template <BaudUart Uart>
void UbloxGps<Uart>::on_part(Part part, std::uint32_t now_us) {
  const auto itow_ms = parser_.get<std::uint32_t>(0);
  if (parts_ == 0 || itow_ms != next_.itow_ms) {
    parts_ = 0;
    next_.itow_ms = itow_ms;
    next_.received_us = frame_us_;
  }
  parts_ = static_cast<std::uint8_t>(parts_ | part);
  if (phase_ == Phase::run && parts_ == whole) since_us_ = now_us;
}

}  // namespace fw
