// What a kernel says of an interface by netlink, laid out by hand as its headers have it.
#pragma once
#include <linux/can/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <net/if_arp.h>

#include <cstdint>
#include <cstring>
#include <vector>

namespace whirl::io {

using Bytes = std::vector<std::uint8_t>;

inline Bytes attribute(int type, const void* data, std::size_t size) {
  const rtattr head{static_cast<unsigned short>(sizeof head + size),
                    static_cast<unsigned short>(type)};
  Bytes bytes(RTA_ALIGN(head.rta_len));
  std::memcpy(bytes.data(), &head, sizeof head);
  std::memcpy(bytes.data() + sizeof head, data, size);
  return bytes;
}

template <typename T>
Bytes attribute(int type, const T& value) {
  return attribute(type, &value, sizeof value);
}
inline Bytes attribute(int type, const Bytes& nested) {
  return attribute(type, nested.data(), nested.size());
}
inline Bytes text_attribute(int type, const char* text) {
  return attribute(type, text, std::strlen(text) + 1);
}

inline void append(Bytes& to, const Bytes& more) {
  to.insert(to.end(), more.begin(), more.end());
}

inline Bytes link_message(unsigned short type, unsigned flags, const char* kind,
                          const Bytes& can_data) {
  ifinfomsg link{};
  link.ifi_type = type;
  link.ifi_index = 7;
  link.ifi_flags = flags;
  Bytes info = text_attribute(IFLA_INFO_KIND, kind);
  if (!can_data.empty()) append(info, attribute(IFLA_INFO_DATA, can_data));
  Bytes body(sizeof link);
  std::memcpy(body.data(), &link, sizeof link);
  append(body, text_attribute(IFLA_IFNAME, "can0"));
  append(body, attribute(IFLA_LINKINFO, info));
  nlmsghdr head{};
  head.nlmsg_len = static_cast<std::uint32_t>(sizeof head + body.size());
  head.nlmsg_type = RTM_NEWLINK;
  Bytes message(sizeof head);
  std::memcpy(message.data(), &head, sizeof head);
  append(message, body);
  return message;
}

inline Bytes controller_at(std::uint32_t bit_rate, std::uint32_t state) {
  can_bittiming timing{};
  timing.bitrate = bit_rate;
  Bytes data = attribute(IFLA_CAN_BITTIMING, timing);
  append(data, attribute(IFLA_CAN_STATE, state));
  append(data, attribute(IFLA_CAN_RESTART_MS, std::uint32_t{100}));
  append(data, attribute(IFLA_CAN_BERR_COUNTER, can_berr_counter{130, 4}));
  return data;
}

}  // namespace whirl::io
