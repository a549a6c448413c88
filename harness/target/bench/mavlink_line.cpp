#include "harness/target/bench/mavlink_line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "harness/target/bench/turn_of_bytes.hpp"

namespace whirl::bench {
namespace {

constexpr double kBits = 10.0;  // 8N1

std::string number(std::uint64_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

std::string seconds(std::int64_t t_ns) {
  char text[40];
  std::snprintf(text, sizeof text, "%.1f s", static_cast<double>(t_ns) * 1e-9);
  return text;
}

}  // namespace

MavlinkLine::MavlinkLine(SerialLink link, double pace)
    : link_(std::move(link)),
      pace_(pace),
      parser_([this](const io::MavlinkFrame& frame, std::span<const std::uint8_t> raw) {
        on_frame(frame);
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
  if (time_.virtual_ns) now_ns_ = time_.virtual_ns(now_host_ns);
  if (const auto sent = send_due(now_host_ns); !sent) return sent;
  publish_delivered(now_host_ns, arrivals);
  const auto read = read_bytes();
  publish_frames(now_host_ns, arrivals);  // those before it was unplugged, too
  return read ? check_rate() : read;
}

Result<Done> MavlinkLine::send_due(std::int64_t now_host_ns) {
  if (safe_) return Done{};
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

void MavlinkLine::publish_delivered(std::int64_t now_host_ns, Arrivals& arrivals) {
  for (; !delivering_.empty() && delivering_.front().host_ns <= now_host_ns;
       delivering_.pop_front()) {
    arrivals.push_back({delivering_.front().host_ns, io::Kind::uart_delivered, link_.uart,
                        std::move(delivering_.front().bytes)});
  }
}

Result<Done> MavlinkLine::read_bytes() {
  const auto read = read_turn(*tty_, [this](std::span<const std::uint8_t> piece) {
    counts_.bytes += piece.size();
    for (const std::uint8_t byte : piece) parser_.add(byte);
  });
  if (!read) return read;
  if (!enough_ns_ && counts_.bytes > kLongest_frame_B) enough_ns_ = now_ns_;
  return Done{};
}

void MavlinkLine::publish_frames(std::int64_t now_host_ns, Arrivals& arrivals) {
  for (std::vector<std::uint8_t>& frame : frames_) {
    arrivals.push_back({now_host_ns, io::Kind::uart_received, link_.uart, std::move(frame)});
  }
  frames_.clear();
}

void MavlinkLine::on_frame(const io::MavlinkFrame& frame) {
  if (counts_.frames++ == 0) {
    before_first_B_ = parser_.counts().stray;
  } else if (const Stretch stretch = since_last_frame(); stretch.bytes > longest_.bytes) {
    longest_ = stretch;
  }
  before_last_B_ = parser_.counts().stray;
  last_frame_ns_ = now_ns_;
  const auto [last, first] = numbers_.try_emplace({frame.sysid, frame.compid}, frame.seq);
  if (!first) counts_.missing += static_cast<std::uint8_t>(frame.seq - last->second - 1);
  last->second = frame.seq;
}

MavlinkLine::Stretch MavlinkLine::since_last_frame() const {
  return {last_frame_ns_, now_ns_, parser_.counts().stray - before_last_B_};
}

Error MavlinkLine::no_frames(const std::string& within) const {
  const std::string rate = std::to_string(link_.baud) + " baud";
  return {
      ErrorKind::bad_input, link_.path,
      number(counts_.bytes, "byte") + " at " + rate + within + ", and no MAVLink frame among them",
      "is that the board's rate, and this the line of its telemetry?"};
}

Result<Done> MavlinkLine::check_rate() const {
  if (counts_.frames > 0 || !enough_ns_ || now_ns_ - *enough_ns_ < kNo_frame_ns) return Done{};
  return no_frames("");
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
  const Stretch last = since_last_frame();
  const bool to_the_end = last.bytes > longest_.bytes;
  const Stretch& most = to_the_end ? last : longest_;
  if (all.frames > 0 && most.bytes > kLongest_frame_B) {
    found.push_back("no frame from " + seconds(most.from_ns) + " to " +
                    (to_the_end ? "the end" : seconds(most.to_ns)) + ", and " +
                    number(most.bytes, "byte") + ": did the board change its rate?");
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
