#include "io_bridges/protocols/ubx.hpp"

#include <algorithm>

#include "base/check.hpp"

namespace whirl::io {
namespace {

constexpr std::uint8_t kSync1 = 0xB5, kSync2 = 0x62;
constexpr std::size_t kHeader = 6, kOverhead = 8;

}  // namespace

std::vector<std::uint8_t> encode(const UbxFrame& frame) {
  WHIRL_CHECK(frame.payload.size() <= 0xFFFF, frame.payload.size());
  const std::size_t n = frame.payload.size();
  std::vector<std::uint8_t> bytes(kHeader + n);
  bytes[0] = kSync1;
  bytes[1] = kSync2;
  bytes[2] = frame.message_class;
  bytes[3] = frame.id;
  bytes[4] = static_cast<std::uint8_t>(n);
  bytes[5] = static_cast<std::uint8_t>(n >> 8);
  std::copy(frame.payload.begin(), frame.payload.end(), bytes.begin() + kHeader);
  UbxChecksum sum;
  for (std::size_t i = 2; i < bytes.size(); ++i) sum.add(bytes[i]);
  bytes.push_back(sum.a);
  bytes.push_back(sum.b);
  return bytes;
}

UbxPayload& UbxPayload::text(const char* words, std::size_t length) {
  const std::size_t end = bytes_.size() + length;
  for (; *words != '\0' && bytes_.size() < end; ++words) {
    bytes_.push_back(static_cast<std::uint8_t>(*words));
  }
  bytes_.resize(end);
  return *this;
}

void UbxParser::add(std::uint8_t byte) {
  buffer_.push_back(byte);
  while (!buffer_.empty()) {
    switch (examine()) {
      case Step::wait:
        return;
      case Step::drop:
        ++counts_.stray;
        buffer_.erase(buffer_.begin());
        break;
      case Step::done:
        break;
    }
  }
}

UbxParser::Step UbxParser::examine() {
  if (buffer_[0] != kSync1) return Step::drop;
  if (buffer_.size() > 1 && buffer_[1] != kSync2) return Step::drop;
  if (buffer_.size() < kHeader) return Step::wait;
  const std::size_t length = buffer_[4] | static_cast<std::size_t>(buffer_[5]) << 8;
  if (length > max_payload_) {
    ++counts_.too_long;
    return Step::drop;
  }
  return buffer_.size() < length + kOverhead ? Step::wait : examine_whole(length);
}

UbxParser::Step UbxParser::examine_whole(std::size_t length) {
  UbxChecksum sum;
  for (std::size_t i = 2; i < kHeader + length; ++i) sum.add(buffer_[i]);
  if (sum.a != buffer_[kHeader + length] || sum.b != buffer_[kHeader + length + 1]) {
    ++counts_.bad_checksum;
    return Step::drop;
  }
  const auto payload = buffer_.begin() + kHeader;
  const UbxFrame frame{
      buffer_[2], buffer_[3], {payload, payload + static_cast<std::ptrdiff_t>(length)}};
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(length + kOverhead));
  ++counts_.frames;
  on_frame_(frame);
  return Step::done;
}

}  // namespace whirl::io
