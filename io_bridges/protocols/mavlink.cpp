#include "io_bridges/protocols/mavlink.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "io_bridges/protocols/crc.hpp"

namespace whirl::io {
namespace {

constexpr std::uint8_t kStx2 = 0xFD;
constexpr std::uint8_t kStx1 = 0xFE;
constexpr std::size_t kHeader2 = 10;
constexpr std::size_t kHeader1 = 6;

std::uint16_t frame_crc(std::span<const std::uint8_t> without_stx, std::uint8_t crc_extra) {
  return crc16_add(crc16(without_stx), crc_extra);
}

std::size_t sent_length(const MavlinkFrame& frame) {
  std::size_t n = frame.length;
  while (n > 1 && frame.payload[n - 1] == 0) --n;
  return n;
}

}  // namespace

std::vector<std::uint8_t> encode(const MavlinkFrame& frame) {
  const MavlinkInfo* info = mavlink_info(frame.msgid);
  WHIRL_CHECK(info != nullptr, frame.msgid);
  const std::size_t n = sent_length(frame);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(kHeader2 + n + 2);
  for (const std::size_t field : {std::size_t{kStx2}, n, std::size_t{0}, std::size_t{0}}) {
    bytes.push_back(static_cast<std::uint8_t>(field));
  }
  for (const std::uint8_t field : {frame.seq, frame.sysid, frame.compid}) bytes.push_back(field);
  for (int shift = 0; shift < 24; shift += 8) {
    bytes.push_back(static_cast<std::uint8_t>(frame.msgid >> shift));
  }
  for (std::size_t i = 0; i < n; ++i) bytes.push_back(frame.payload[i]);
  const std::uint16_t crc = frame_crc(std::span(bytes).subspan(1), info->crc_extra);
  bytes.push_back(static_cast<std::uint8_t>(crc));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  return bytes;
}

void MavlinkParser::add(std::uint8_t byte) {
  buffer_.push_back(byte);
  while (!buffer_.empty()) {
    const Step step = examine();
    if (step == Step::wait) return;
    if (step == Step::drop) {
      buffer_.erase(buffer_.begin());
      ++counts_.stray;
    }
  }
}

// Looks at what starts at the front of the buffer.
MavlinkParser::Step MavlinkParser::examine() {
  if (buffer_[0] != kStx2 && buffer_[0] != kStx1) return Step::drop;
  const bool v1 = buffer_[0] == kStx1;
  const std::size_t header = v1 ? kHeader1 : kHeader2;
  if (buffer_.size() < 3) return Step::wait;
  if (!v1 && buffer_[2] != 0) return Step::drop;  // signed, or something newer than we are
  if (buffer_.size() < header + buffer_[1] + 2) return Step::wait;
  return examine_whole(v1, header, buffer_[1]);
}

MavlinkParser::Step MavlinkParser::examine_whole(bool v1, std::size_t header, std::size_t length) {
  const std::uint32_t id = v1 ? buffer_[5]
                              : buffer_[7] | static_cast<std::uint32_t>(buffer_[8]) << 8 |
                                    static_cast<std::uint32_t>(buffer_[9]) << 16;
  const MavlinkInfo* info = mavlink_info(id);
  if (info == nullptr) {
    ++counts_.unknown;
    return Step::drop;
  }
  const std::size_t end = header + length;
  const std::uint16_t crc = frame_crc(std::span(buffer_).subspan(1, end - 1), info->crc_extra);
  if (crc != (buffer_[end] | buffer_[end + 1] << 8) || length > info->max_length) {
    ++counts_.bad_crc;
    return Step::drop;
  }
  deliver(v1, header, length);
  return Step::done;
}

void MavlinkParser::deliver(bool v1, std::size_t header, std::size_t length) {
  MavlinkFrame frame;
  const std::size_t seq = v1 ? 2 : 4;
  frame.seq = buffer_[seq];
  frame.sysid = buffer_[seq + 1];
  frame.compid = buffer_[seq + 2];
  frame.msgid = buffer_[seq + 3];
  if (!v1) frame.msgid |= static_cast<std::uint32_t>(buffer_[8] | buffer_[9] << 8) << 8;
  frame.length = static_cast<std::uint8_t>(length);
  std::copy_n(buffer_.begin() + static_cast<long>(header), length, frame.payload.begin());
  ++counts_.frames;
  if (last_seq_) counts_.lost += static_cast<std::uint8_t>(frame.seq - *last_seq_ - 1);
  last_seq_ = frame.seq;

  const std::vector<std::uint8_t> raw(buffer_.begin(),
                                      buffer_.begin() + static_cast<long>(header + length + 2));
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<long>(raw.size()));
  if (on_frame_) on_frame_(frame, raw);
}

}  // namespace whirl::io
