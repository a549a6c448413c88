// The flight log: from arming until some seconds after disarming, onto a log volume as ULog.
//
//   Rate     150 Hz: 3 of each 20 ticks of 1 ms, 7, 7 and 6 ms apart (schedule.hpp); set-points of position
//            50 Hz, what changes slowly 10 Hz
//   File     opened when the vehicle is armed, closed kAfter_us after it was disarmed; a card that was
//            pulled and put in again gets a new one. It begins with formats, information, parameters and
//            subscriptions, a message each tick; samples follow. So a log begins when the volume has
//            its file: 0.1 to 1 s after arming, by the size of the card's clusters
//   Slow     a card that does not keep up costs whole samples, never time: each gap is followed by a
//            dropout message that says how long it was
//   Contract step() once in each tick, after the tasks whose results are logged; never waits
//   Time     since the time base started, as telemetry has it
#pragma once
#include <cmath>
#include <concepts>
#include <cstdint>

#include "firmware/config/parameters.hpp"
#include "firmware/flight/flight.hpp"
#include "firmware/flight/schedule.hpp"
#include "firmware/log/log_topics.hpp"
#include "firmware/log/log_volume.hpp"
#include "firmware/log/ulog.hpp"

namespace fw {

// The worst of some ticks, microseconds; see the topic flight_timing.
struct TickTimes {
  std::uint16_t start_us = 0, setpoint_us = 0, tick_us = 0;

  static void keep_worst(std::uint16_t& worst, std::uint32_t now_us) {
    worst = static_cast<std::uint16_t>(std::clamp<std::uint32_t>(now_us, worst, 0xFFFF));
  }
};

template <typename V>
concept LogSink = requires(V volume, std::span<const std::uint8_t> record) {
  { volume.append(record) } -> std::same_as<bool>;
  { volume.room() } -> std::convertible_to<std::size_t>;
  { volume.state() } -> std::same_as<LogState>;
  { volume.files() } -> std::same_as<std::uint32_t>;
  volume.open();
  volume.close();
};

template <LogSink Volume>
class FlightLog {
 public:
  static constexpr std::uint32_t kAfter_us = 3'000'000;

  // The volume is closed until the vehicle is armed.
  FlightLog(Volume& volume, const Flight& flight) : volume_(volume), flight_(flight) {
    volume_.close();
  }

  // `times`: the worst since they were logged; set to nothing when they are.
  void step(std::uint32_t tick, std::uint32_t now_us, std::uint16_t load_permille,
            std::uint32_t deadlines_missed, TickTimes& times);

  std::uint32_t dropouts() const { return dropouts_; }
  bool wanted() const { return wanted_; }  // a file is, or shall be, open

 private:
  static constexpr std::size_t kMost_sample_bytes = 512, kResume_bytes = 4096;
  static constexpr std::uint32_t kSetpointEvery = 3, kSlowEvery = 15;  // samples
  static constexpr unsigned kFileHead = 0, kFlags = 1, kFormats = 2,
                            kInfos = kFormats + std::size(log::kFormats), kInfoCount = 4,
                            kParameters = kInfos + kInfoCount,
                            kSubscriptions = kParameters + kParameterCount,
                            kBegun = kSubscriptions + log::kTopics;

  void follow_flight(std::uint32_t now_us);
  void begin_file();
  bool append_head();
  static ulog::Message info(unsigned number);
  ulog::Message parameter(std::size_t index) const;
  void append_changes();
  bool may_sample();
  void sample(std::uint16_t load_permille, std::uint32_t deadlines_missed, TickTimes& times);
  void slow_sample(std::uint16_t load_permille, std::uint32_t deadlines_missed, TickTimes& times);
  ulog::Message data(log::Topic topic) const;
  static void put(ulog::Message& message, const Vector3& v, float scale = 1.0f);
  bool append(ulog::Message& message) { return message.ok() && volume_.append(message.bytes()); }
  bool append(ulog::Message&& message) { return append(message); }

  Volume& volume_;
  const Flight& flight_;
  std::uint64_t time_us_ = 0;
  std::uint32_t now_us_ = 0, disarmed_us_ = 0, lost_since_us_ = 0, samples_ = 0;
  bool wanted_ = false;
  std::uint32_t files_ = 0, dropouts_ = 0;
  unsigned next_ = 0;  // of what a file begins with
  std::uint32_t changes_ = 0, reasons_ = 0;
  std::size_t next_parameter_ = kParameterCount;
  bool losing_ = false;
};

}  // namespace fw

#include "firmware/log/flight_log_steps.hpp"
