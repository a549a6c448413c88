#include "harness/target/bench/mavlink_line.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace whirl::bench {
namespace {

constexpr double kBits = 10.0;   // 8N1
constexpr int kMost_pieces = 8;  // of a turn: who floods a line must not hold the loop

std::string number(std::uint64_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

}  // namespace

MavlinkLine::MavlinkLine(SerialLink link, double pace)
    : link_(std::move(link)),
      pace_(pace),
      parser_([this](const io::MavlinkFrame& frame, std::span<const std::uint8_t> raw) {
        hear(frame);
        frames_.emplace_back(raw.begin(), raw.end());
      }) {}

Result<Done> MavlinkLine::open() {
  auto tty = io::Tty::open(link_.path, link_.baud);
  if (!tty) return tty.error();
  tty_ = std::move(tty.value());
  return Done{};
}

bool MavlinkLine::take(const io::Reader& order, std::int64_t due_host_ns) {
  if (order.header().kind != io::Kind::uart_frame || order.header().port != link_.uart) {
    return false;
  }
  if (safe_) return true;
  const auto later = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&](const Frame& frame) { return frame.host_ns > due_host_ns; });
  waiting_.insert(later, {due_host_ns, {order.payload().begin(), order.payload().end()}});
  return true;
}

Result<Done> MavlinkLine::serve(std::int64_t now_host_ns, Arrivals& arrivals) {
  if (const auto sent = send_due(now_host_ns); !sent) return sent;
  tell_delivered(now_host_ns, arrivals);
  if (const auto taken = take_in(now_host_ns, arrivals); !taken) return taken;
  return check_heard(now_host_ns);
}

Result<Done> MavlinkLine::send_due(std::int64_t now_host_ns) {
  for (; !waiting_.empty() && waiting_.front().host_ns <= now_host_ns; waiting_.pop_front()) {
    std::vector<std::uint8_t>& bytes = waiting_.front().bytes;
    const std::int64_t begin_ns = std::max(now_host_ns, free_host_ns_);
    if (static_cast<double>(begin_ns - now_host_ns) * pace_ > kMost_wait_ns) {
      ++counts_.dropped;
      continue;
    }
    if (const auto written = tty_->write(bytes); !written) return written;
    const double line_s = static_cast<double>(bytes.size()) * kBits / (link_.baud * pace_);
    free_host_ns_ = begin_ns + std::llround(line_s * 1e9);
    delivering_.push_back({free_host_ns_, std::move(bytes)});
  }
  return tty_->flush();
}

void MavlinkLine::tell_delivered(std::int64_t now_host_ns, Arrivals& arrivals) {
  for (; !delivering_.empty() && delivering_.front().host_ns <= now_host_ns;
       delivering_.pop_front()) {
    arrivals.push_back({delivering_.front().host_ns, io::Kind::uart_delivered, link_.uart,
                        std::move(delivering_.front().bytes)});
  }
}

Result<Done> MavlinkLine::take_in(std::int64_t now_host_ns, Arrivals& arrivals) {
  std::array<std::uint8_t, 1024> piece;
  for (int i = 0; i < kMost_pieces; ++i) {
    const auto got = tty_->read(piece);
    if (!got) return got.error();
    if (got.value() == 0) break;
    counts_.bytes += got.value();
    for (const std::uint8_t byte : std::span(piece).first(got.value())) parser_.add(byte);
  }
  for (std::vector<std::uint8_t>& frame : frames_) {
    arrivals.push_back({now_host_ns, io::Kind::uart_received, link_.uart, std::move(frame)});
  }
  frames_.clear();
  return Done{};
}

void MavlinkLine::hear(const io::MavlinkFrame& frame) {
  if (counts_.frames++ == 0) before_first_B_ = parser_.counts().stray;
  const auto [last, first] = numbers_.try_emplace({frame.sysid, frame.compid}, frame.seq);
  if (!first) counts_.missing += static_cast<std::uint8_t>(frame.seq - last->second - 1);
  last->second = frame.seq;
}

Error MavlinkLine::deaf(const std::string& within) const {
  const std::string rate = std::to_string(link_.baud) + " baud";
  return {ErrorKind::bad_input, link_.path,
          std::to_string(counts_.bytes) + " bytes at " + rate + within +
              ", and no MAVLink frame among them",
          "is that the board's rate, and this the line of its telemetry?"};
}

Result<Done> MavlinkLine::check_heard(std::int64_t now_host_ns) {
  const bool soon = !time_.virtual_ns || time_.virtual_ns(now_host_ns) < kDeaf_ns;
  if (soon || counts_.frames > 0 || counts_.bytes <= kLongest_frame_B) return Done{};
  return deaf(" in " + std::to_string(kDeaf_ns / 1'000'000'000) + " s");
}

std::int64_t MavlinkLine::next_due_host_ns() const {
  const std::int64_t due_ns = waiting_.empty() ? kNever_ns : waiting_.front().host_ns;
  return delivering_.empty() ? due_ns : std::min(due_ns, delivering_.front().host_ns);
}

void MavlinkLine::make_safe() {
  safe_ = true;
  waiting_.clear();
}

MavlinkLine::Counts MavlinkLine::counts() const {
  Counts all = counts_;
  if (all.frames > 0) all.outside_B = parser_.counts().stray - before_first_B_;
  return all;
}

std::vector<std::pair<std::string, std::string>> MavlinkLine::versions() const {
  return {
      {"link " + link_.name, link_.path + " at " + std::to_string(link_.baud) + " baud, MAVLink"}};
}

std::vector<std::string> MavlinkLine::findings() const {
  const Counts all = counts();
  std::vector<std::string> found;
  const std::string of_all = " (" + number(all.frames, "frame") + " came whole)";
  if (all.frames == 0) {
    found.push_back("no MAVLink frame was heard, " + number(all.bytes, "byte") + " at " +
                    std::to_string(link_.baud) +
                    " baud: is the board on, its TX on this RX, a radio paired?");
  }
  if (all.outside_B > 0) {
    found.push_back(number(all.outside_B, "byte") + " outside of MAVLink frames" + of_all);
  }
  if (all.missing > 0) {
    found.push_back(number(all.missing, "frame") + " of the board missing by their numbers" +
                    of_all);
  }
  if (all.dropped > 0) {
    found.push_back(number(all.dropped, "frame") + " for the board found the line full: " +
                    std::to_string(link_.baud) + " baud carry less than the plan sends");
  }
  return found;
}

}  // namespace whirl::bench
