// What every DroneCAN node owes its bus: NodeStatus each second, who it is when it is asked, and its
// parameters by param.GetSet. Over a concept, so that the image of each part and a test give it theirs.
//
//   Access  count(), name(index), is_whole(index), value, start, low, high (index), set(index, value)
//           -> bool; parameters that somebody may not set now keep their value: the answer tells it
//   Answers at most one request of each kind per call of on_frame(), one after the other
#pragma once
#include <string_view>
#include <tuple>

#include "firmware/dronecan/dronecan.hpp"

namespace fw::dronecan {

enum class Health : std::uint8_t { ok, warning, error, critical };

struct Identity {
  std::uint8_t node_id = 0;
  std::string_view name;
  std::array<std::uint8_t, 16> unique_id{};
};

template <typename Can, typename Access>
class Node {
 public:
  constexpr Node(Can& can, Access& access) : can_(can), access_(access) {}

  void be(const Identity& identity) { identity_ = identity; }
  std::uint8_t node_id() const { return identity_.node_id; }
  Status publish(std::uint32_t priority, const Type& type, std::uint8_t& transfer_id,
                 std::span<const std::uint8_t> payload) {
    return send_transfer(message_id(priority, type.id, identity_.node_id), transfer_id++, type,
                         payload, [this](const hal::CanFrame& f) { return can_.send(f); });
  }
  // Once a second.
  void publish_status(std::uint32_t uptime_s, Health health) {
    uptime_s_ = uptime_s;
    health_ = health;
    std::array<std::uint8_t, 7> bytes{};
    BitsOut out(bytes);
    put_status(out);
    std::ignore = publish(kLow, kNodeStatus, status_transfer_, bytes);
  }
  // A frame that is not for a service of this node is passed over.
  void on_frame(const hal::CanFrame& frame) {
    if (is_request_to(frame.id, kGetNodeInfo, identity_.node_id)) {
      if (info_.take(frame, kGetNodeInfo)) answer_info(source_of(frame.id));
    } else if (is_request_to(frame.id, kGetSet, identity_.node_id)) {
      if (get_set_.take(frame, kGetSet)) answer_get_set(source_of(frame.id));
    }
  }
  // What the hardware must let through, beside the messages that the application takes.
  static constexpr hal::CanFilter services_to(std::uint32_t node) {
    return {service_id(0, 0, true, node, 0), 1u << 15 | 0x7Fu << 8 | 1u << 7};
  }

 private:
  static constexpr std::uint32_t kLow = 24, kLowest = 30;
  enum Tag : std::uint32_t { empty, integer, real };

  void put_status(BitsOut& out) const {
    out.put(uptime_s_, 32).put(static_cast<std::uint32_t>(health_), 2).skip(3 + 3 + 16);
  }
  void respond(const Type& type, std::uint8_t to, std::uint8_t transfer_id,
               std::span<const std::uint8_t> payload) {
    std::ignore =
        send_transfer(service_id(kLowest, type.id, false, to, identity_.node_id), transfer_id, type,
                      payload, [this](const hal::CanFrame& f) { return can_.send(f); });
  }
  void answer_info(std::uint8_t to) {
    std::array<std::uint8_t, 41 + 32> bytes{};
    BitsOut out(bytes);
    put_status(out);
    out.put(1, 8).skip(8 + 8 + 32 + 64).skip(16);  // software 1.0, nothing said of the hardware
    for (const std::uint8_t byte : identity_.unique_id) out.put(byte, 8);
    out.skip(8);  // no certificate
    put_text(out, identity_.name.substr(0, 32));
    respond(kGetNodeInfo, to, info_.transfer_id(), std::span(bytes).first(out.bytes()));
  }
  static void put_text(BitsOut& out, std::string_view text) {
    for (const char c : text) out.put(static_cast<std::uint8_t>(c), 8);
  }

  void answer_get_set(std::uint8_t to) {
    BitsIn in(get_set_.payload());
    std::size_t index = in.get(13);
    const std::uint32_t tag = in.get(3);
    float value = 0.0f;
    if (tag == integer) {
      value = static_cast<float>(static_cast<std::int32_t>(in.get(32)));
      std::ignore = in.get(32);
    } else if (tag == real) {
      value = std::bit_cast<float>(in.get(32));
    }
    std::array<char, 16> name{};
    std::size_t length = 0;
    while (in.left() >= 8 && length < name.size()) name[length++] = static_cast<char>(in.get(8));
    if (!in.ok() || tag > real) return;
    if (length > 0) index = index_of({name.data(), length});
    if (index < access_.count() && tag != empty) std::ignore = access_.set(index, value);
    tell(index, to);
  }
  std::size_t index_of(std::string_view name) const {
    std::size_t i = 0;
    while (i < access_.count() && access_.name(i) != name) ++i;
    return i;
  }
  // An unknown one: all empty, and no name.
  void tell(std::size_t index, std::uint8_t to) {
    std::array<std::uint8_t, 4 * 9 + 16> bytes{};
    BitsOut out(bytes);
    const bool known = index < access_.count();
    const bool whole = known && access_.is_whole(index);
    put_value(out, 3, known, whole, known ? access_.value(index) : 0.0f);
    put_value(out, 3, known, whole, known ? access_.start(index) : 0.0f);
    put_value(out, 2, known, whole, known ? access_.high(index) : 0.0f);
    put_value(out, 2, known, whole, known ? access_.low(index) : 0.0f);
    if (known) put_text(out, access_.name(index));
    respond(kGetSet, to, get_set_.transfer_id(), std::span(bytes).first(out.bytes()));
  }
  static void put_value(BitsOut& out, unsigned tag_width, bool known, bool whole, float value) {
    out.skip(8 - tag_width).put(!known ? empty : whole ? integer : real, tag_width);
    if (!known) return;
    if (!whole) {
      out.put(std::bit_cast<std::uint32_t>(value), 32);
      return;
    }
    const auto number = static_cast<std::int32_t>(value);
    out.put(static_cast<std::uint32_t>(number), 32).put(number < 0 ? ~0u : 0u, 32);
  }

  Can& can_;
  Access& access_;
  Identity identity_;
  std::uint32_t uptime_s_ = 0;
  Health health_ = Health::ok;
  std::uint8_t status_transfer_ = 0;
  Reassembly<8> info_;
  Reassembly<40> get_set_;
};

}  // namespace fw::dronecan
