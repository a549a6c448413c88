#include "harness/live/live_flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "harness/live/datagram_pieces.hpp"

namespace whirl::live {
namespace {

constexpr std::int64_t kShowEvery_ns = 1'000'000'000, kStickPeriod_ns = 20'000'000;
constexpr double kLine_Bpstep = 5.76, kLineHolds_B = 1024.0;  // 57600 baud, 8N1, 1 ms
constexpr double kForFrames_B = kLineHolds_B / 2.0;           // that other bytes may not fill
constexpr std::size_t kLongestDatagram_B = 1500;              // as a network carries in one piece
constexpr std::size_t kMostDatagrams = 64;                    // of one step

// The flight image's HEARTBEAT.custom_mode.
std::string mode_name(double state) {
  constexpr std::array kNames{"disarmed", "armed", "flying", "landing", "failsafe"};
  if (std::isnan(state)) return "silent";
  const auto i = static_cast<std::size_t>(std::max(0.0, state));
  return i < kNames.size() ? kNames[i] : "mode " + std::to_string(i);
}

// To the step in which they are read.
bool alike(const request::Sticks& a, const request::Sticks& b) {
  const auto step = [](const std::optional<double>& share) {
    return share ? std::optional(std::lround(1000.0 * *share)) : std::nullopt;
  };
  return step(a.roll) == step(b.roll) && step(a.pitch) == step(b.pitch) &&
         step(a.yaw) == step(b.yaw) && step(a.thrust) == step(b.thrust) && a.mode == b.mode &&
         a.arm == b.arm && a.transmitter_on == b.transmitter_on;
}

double ms(std::int64_t ns) {
  return static_cast<double>(ns) * 1e-6;
}

}  // namespace

LiveFlight::LiveFlight(pacing::HostClock& clock, UdpPort port, LiveOptions options)
    : clock_(clock),
      pacer_(clock, options.pace),
      port_(std::move(port)),
      options_(std::move(options)),
      line_free_B_(kLineHolds_B) {}

Result<bool> LiveFlight::turn(std::int64_t t_ns, World& world) {
  ended_ns_ = t_ns;
  if (options_.end_ns && t_ns >= *options_.end_ns) return false;
  if (options_.waits) pacer_.wait_for(t_ns);
  if (options_.wants_end()) return false;
  if (const auto taken = take_in(t_ns, world); !taken) return taken.error();
  if (const auto looked = look_at_sticks(t_ns, world); !looked) return looked.error();
  return true;
}

Result<Done> LiveFlight::look_at_sticks(std::int64_t t_ns, World& world) {
  if (!options_.sticks || t_ns < next_sticks_ns_) return Done{};
  next_sticks_ns_ = t_ns + kStickPeriod_ns;
  const request::Sticks now = options_.sticks();
  if (sticks_ && alike(*sticks_, now)) return Done{};
  sticks_ = now;
  recording_.add(t_ns, now);
  return world.command(now, t_ns);
}

Result<Done> LiveFlight::take_in(std::int64_t t_ns, World& world) {
  line_free_B_ = std::min(kLineHolds_B, line_free_B_ + kLine_Bpstep);
  for (std::size_t i = 0; i < kMostDatagrams; ++i) {
    const auto datagram = port_.receive();
    if (!datagram) break;
    ++datagrams_;
    if (options_.client_only && !port_.from_peer()) {
      ++of_others_;
      continue;
    }
    if (datagram->size() > kLongestDatagram_B) {
      dropped_B_ += datagram->size();
      continue;
    }
    for (const auto piece : pieces_of(*datagram)) {
      const auto size_B = static_cast<double>(piece.size());
      if (size_B > line_free_B_ - (is_frame(piece) ? 0.0 : kForFrames_B)) {
        dropped_B_ += piece.size();
        continue;
      }
      line_free_B_ -= size_B;
      recording_.add(t_ns, piece);
      const auto given = world.command(request::Radio{{piece.begin(), piece.end()}}, t_ns);
      if (!given) return given;
    }
  }
  return Done{};
}

void LiveFlight::on_happened(std::int64_t t_ns, const io::Batch& happened, const World& world) {
  for (io::Reader r(happened.bytes()); r.next();) {
    const bool frame = r.header().board == 0 && r.header().kind == io::Kind::uart_received &&
                       !r.payload().empty() && is_frame(r.payload());
    if (frame) port_.send(r.payload());
  }
  show_state(t_ns, world);
}

void LiveFlight::show_state(std::int64_t t_ns, const World& world) {
  if (names_.empty()) {
    for (const Signal& signal : world.signals()) names_.push_back(signal.name);
    values_.resize(names_.size());
  }
  world.read(values_);
  if (!options_.show || clock_.now_ns() < next_shown_ns_) return;
  next_shown_ns_ = clock_.now_ns() + kShowEvery_ns;
  options_.show(state_line(t_ns));
}

double LiveFlight::last(const std::string& signal) const {
  const auto it = std::find(names_.begin(), names_.end(), signal);
  return it == names_.end() ? std::nan("") : values_[static_cast<std::size_t>(it - names_.begin())];
}

std::string LiveFlight::state_line(std::int64_t t_ns) const {
  char text[160], late[60];
  std::snprintf(text, sizeof text,
                "%8.3f s  %-8s  %-8s  north %6.2f m  east %6.2f m  height %5.2f m",
                static_cast<double>(t_ns) * 1e-9, last("told_armed") == 1.0 ? "armed" : "unarmed",
                mode_name(last("told_state")).c_str(), last("north"), last("east"), last("height"));
  if (!options_.waits) return text;
  std::snprintf(late, sizeof late, "  late %.1f ms, slipped %.2f s", ms(lateness().latest_ns),
                ms(lateness().slipped_ns) * 1e-3);
  return std::string(text) + late;
}

std::vector<std::string> LiveFlight::summary() const {
  const pacing::Lateness& late = lateness();
  char pace[240], udp[240];
  std::snprintf(
      pace, sizeof pace,
      "paced at %g x real time: %lld of %lld steps later than 1 ms, %.1f ms at worst, %.3f s "
      "given up%s",
      options_.pace, static_cast<long long>(late.late_steps), static_cast<long long>(late.steps),
      ms(late.worst_ns), ms(late.slipped_ns) * 1e-3,
      late.slipped_ns > 0 ? ": the host could not keep up" : "");
  std::snprintf(
      udp, sizeof udp,
      "UDP: %llu frames out (%llu not taken), %llu datagrams in, %zu pieces to the radio, %llu "
      "B dropped",
      static_cast<unsigned long long>(port_.sent()),
      static_cast<unsigned long long>(port_.not_sent()),
      static_cast<unsigned long long>(datagrams_), recording_.pieces(),
      static_cast<unsigned long long>(dropped_B_));
  std::vector<std::string> all{udp};
  if (options_.waits) all.insert(all.begin(), pace);
  if (of_others_ > 0) {
    all.push_back("UDP: " + std::to_string(of_others_) +
                  " datagrams of another host than the client's were left out");
  }
  return all;
}

}  // namespace whirl::live
