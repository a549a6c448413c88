#include "io_bridges/protocols/dronecan/transfer.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "io_bridges/protocols/dronecan/bits.hpp"

namespace whirl::io::dronecan {
namespace {

constexpr std::size_t kIn_frame = 7;  // beside the tail byte

std::uint16_t crc_add(std::uint16_t crc, std::uint8_t byte) {
  crc = static_cast<std::uint16_t>(crc ^ byte << 8);
  for (int bit = 0; bit < 8; ++bit) {
    crc = static_cast<std::uint16_t>((crc & 0x8000) != 0 ? crc << 1 ^ 0x1021 : crc << 1);
  }
  return crc;
}

}  // namespace

std::uint16_t transfer_crc(std::uint64_t signature, std::span<const std::uint8_t> payload) {
  std::uint16_t crc = 0xFFFF;
  for (int shift = 0; shift < 64; shift += 8) {
    crc = crc_add(crc, static_cast<std::uint8_t>(signature >> shift));
  }
  for (const std::uint8_t byte : payload) crc = crc_add(crc, byte);
  return crc;
}

std::uint32_t can_id(const Header& h, std::span<const std::uint8_t> payload) {
  const std::uint32_t id = static_cast<std::uint32_t>(h.priority & 0x1F) << 24 | h.source;
  if (h.kind != Kind::message) {
    const std::uint32_t request = h.kind == Kind::request ? 1u << 15 : 0;
    const std::uint32_t way = request | static_cast<std::uint32_t>(h.destination) << 8 | 1u << 7;
    return id | way | static_cast<std::uint32_t>(h.type_id & 0xFF) << 16;
  }
  if (h.source != 0) return id | static_cast<std::uint32_t>(h.type_id) << 8;
  const std::uint32_t discriminator = transfer_crc(0, payload) & 0x3FFF;
  return id | discriminator << 10 | static_cast<std::uint32_t>(h.type_id & 3) << 8;
}

std::optional<Header> parse_can_id(std::uint32_t id) {
  Header h;
  h.priority = static_cast<std::uint8_t>(id >> 24 & 0x1F);
  h.source = static_cast<std::uint8_t>(id & 0x7F);
  if ((id & 1u << 7) == 0) {
    h.type_id = static_cast<std::uint16_t>(h.source == 0 ? id >> 8 & 3 : id >> 8);
    return h;
  }
  h.kind = (id & 1u << 15) != 0 ? Kind::request : Kind::response;
  h.type_id = static_cast<std::uint16_t>(id >> 16 & 0xFF);
  h.destination = static_cast<std::uint8_t>(id >> 8 & 0x7F);
  if (h.source == 0 || h.destination == 0 || h.source == h.destination) return std::nullopt;
  return h;
}

TransferFrames::TransferFrames(const Header& header, std::uint64_t signature,
                               std::span<const std::uint8_t> payload)
    : payload_(payload),
      id_(can_id(header, payload)),
      transfer_id_(header.transfer_id & tail::kTransfer_id),
      many_(payload.size() > kIn_frame) {
  WHIRL_CHECK(payload.size() <= kMost_payload, payload.size());
  WHIRL_CHECK(header.source != 0 || (header.kind == Kind::message && !many_ && header.type_id <= 3),
              header.type_id);
  if (many_) crc_ = transfer_crc(signature, payload);
}

bool TransferFrames::next(CanFrame& frame) {
  const std::size_t all = payload_.size() + (many_ ? 2 : 0);
  if (at_ > all || (at_ == all && all > 0)) return false;
  const std::size_t here = std::min(all - at_, kIn_frame);
  frame = {.id = id_, .extended = true, .length = static_cast<std::uint8_t>(here + 1)};
  for (std::size_t n = 0; n < here; ++n) {
    const std::size_t from = at_ + n;
    if (!many_) {
      frame.data[n] = payload_[from];
    } else {
      frame.data[n] = from < 2 ? static_cast<std::uint8_t>(crc_ >> 8 * from) : payload_[from - 2];
    }
  }
  const int start = at_ == 0 ? tail::kStart : 0;
  const int end = at_ + here == all ? tail::kEnd : 0;
  const int toggle = toggle_ ? tail::kToggle : 0;
  frame.data[here] = static_cast<std::uint8_t>(start | end | toggle | transfer_id_);
  toggle_ = !toggle_;
  at_ += here;
  if (all == 0) at_ = 1;  // one frame went, without a byte
  return true;
}

std::vector<CanFrame> frames_of(const Header& header, std::uint64_t signature,
                                std::span<const std::uint8_t> payload) {
  std::vector<CanFrame> frames;
  TransferFrames rest(header, signature, payload);
  for (CanFrame frame; rest.next(frame);) frames.push_back(frame);
  return frames;
}

std::uint8_t TransferIds::next(Kind kind, std::uint16_t type_id, std::uint8_t destination) {
  const auto same = [&](const Count& c) {
    return c.kind == kind && c.type_id == type_id && c.destination == destination;
  };
  const auto found = std::find_if(counts_.begin(), counts_.end(), same);
  if (found == counts_.end()) {
    counts_.push_back({kind, type_id, destination, 1});
    return 0;
  }
  const std::uint8_t id = found->next;
  found->next = (id + 1) & tail::kTransfer_id;
  return id;
}

}  // namespace whirl::io::dronecan
