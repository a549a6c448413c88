// A GPS receiver that is scripted byte by byte, and its driver at the other end of the line.
#pragma once
#include <deque>
#include <vector>

#include "firmware/drivers/ublox_gps.hpp"

namespace fw::gps_rig {

using Bytes = std::vector<std::uint8_t>;

inline const Bytes kPvt_on = {0xB5, 0x62, 0x06, 0x01, 0x03, 0x00, 0x01, 0x07, 0x01, 0x13, 0x51};
inline const Bytes kNak_msg = {0xB5, 0x62, 0x05, 0x00, 0x02, 0x00, 0x06, 0x01, 0x0E, 0x33};

// A receiver at some baud rate: acknowledges CFG, follows CFG-PRT, keeps what it was told.
struct FakeReceiver {
  Status send(std::span<const std::uint8_t> bytes) {
    if (uart_baud != baud || deaf) return Status::ok;
    const std::uint8_t id = bytes[3];
    if (bytes[2] == 6 && (bytes[4] == 0 || bytes[4] == 2)) return on_poll(bytes);
    told.emplace_back(bytes.begin(), bytes.end());
    if (lose_answers > 0) {
      --lose_answers;
    } else if (id == 0x01 && (refuses || (is_six && told.back() == kPvt_on))) {
      answers.insert(answers.end(), kNak_msg.begin(), kNak_msg.end());
    } else {
      Bytes ack = {0xB5, 0x62, 0x05, 0x01, 0x02, 0x00, 0x06, id};
      std::uint8_t a = 0, b = 0;
      for (std::size_t i = 2; i < ack.size(); ++i) a = a + ack[i], b = b + a;
      ack.push_back(a);
      ack.push_back(b);
      if (id != 0x00 || baud == port_baud(bytes))
        answers.insert(answers.end(), ack.begin(), ack.end());
    }
    if (id == 0x00) baud = port_baud(bytes);
    return Status::ok;
  }
  // The setting, then its acknowledge.
  Status on_poll(std::span<const std::uint8_t> bytes) {
    polls.emplace_back(bytes.begin() + 3, bytes.end() - 2);
    if (deaf_to_polls) return Status::ok;
    Bytes setting(bytes[3] == 0x24 ? 36 : bytes[3] == 0x08 ? 6 : 8);
    if (bytes[3] == 0x24) setting[2] = model, setting[3] = fix_mode;
    if (bytes[3] == 0x08)
      setting[0] = period_ms & 0xFF, setting[1] = period_ms >> 8, setting[2] = 1;
    if (bytes[3] == 0x01) {
      setting[0] = bytes[6], setting[1] = bytes[7];
      setting[2] = setting[4] = 9;  // of ports that are not ours
      setting[3] = bytes[7] == quiet ? 0 : 1;
    }
    answer(bytes[3], setting);
    answers.insert(answers.end(), {0xB5, 0x62, 0x05, 0x01, 0x02, 0x00, 0x06, bytes[3]});
    std::uint8_t a = 0, b = 0;
    for (auto at = answers.end() - 6; at != answers.end(); ++at) a = a + *at, b = b + a;
    answers.insert(answers.end(), {a, b});
    return Status::ok;
  }
  void answer(std::uint8_t id, const Bytes& setting) {
    Bytes frame = {0xB5, 0x62, 0x06, id, static_cast<std::uint8_t>(setting.size()), 0};
    frame.insert(frame.end(), setting.begin(), setting.end());
    std::uint8_t a = 0, b = 0;
    for (std::size_t i = 2; i < frame.size(); ++i) a = a + frame[i], b = b + a;
    frame.insert(frame.end(), {a, b});
    answers.insert(answers.end(), frame.begin(), frame.end());
  }
  static std::uint32_t port_baud(std::span<const std::uint8_t> bytes) {
    return bytes[14] | bytes[15] << 8 | bytes[16] << 16;
  }
  void set_baud(std::uint32_t wanted) {
    uart_baud = wanted;
    bauds.push_back(wanted);
  }
  std::uint32_t baud = 9600, uart_baud = 0;
  bool deaf = false, refuses = false, is_six = true;
  int lose_answers = 0;
  std::deque<std::uint8_t> answers;
  std::vector<Bytes> told;
  std::vector<std::uint32_t> bauds;
  std::uint16_t period_ms = 200;
  std::uint8_t model = 6, fix_mode = 2, quiet = 0;  // quiet: a message that is off
  bool deaf_to_polls = false;
  std::vector<Bytes> polls;  // id, length, payload
};

struct Bench {
  FakeReceiver receiver;
  UbloxGps<FakeReceiver> gps{receiver};
  std::uint32_t now_us = 0xFFFF'0000;  // it wraps soon

  void run_ms(int ms) {
    for (int k = 0; k < ms; k += 5, now_us += 5000) {
      gps.tick(now_us);
      for (; !receiver.answers.empty(); receiver.answers.pop_front()) {
        gps.push(receiver.answers.front(), now_us);
      }
    }
  }
  void push(std::uint8_t id, Bytes payload) {
    Bytes bytes = {0xB5, 0x62, 0x01, id, static_cast<std::uint8_t>(payload.size()), 0x00};
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    std::uint8_t a = 0, b = 0;
    for (std::size_t i = 2; i < bytes.size(); ++i) a = a + bytes[i], b = b + a;
    bytes.push_back(a);
    bytes.push_back(b);
    for (const std::uint8_t byte : bytes) gps.push(byte, now_us += 174);  // 57600 baud
  }
};

inline void put(Bytes& payload, std::size_t at, std::int64_t value) {
  for (std::size_t i = 0; i < 4; ++i) payload[at + i] = static_cast<std::uint8_t>(value >> 8 * i);
}
inline Bytes posllh(std::uint32_t itow_ms) {
  Bytes p(28);
  put(p, 0, itow_ms), put(p, 4, 1491300000), put(p, 8, -352800000), put(p, 12, 600000);
  put(p, 16, 581000), put(p, 20, 3000), put(p, 24, 4500);
  return p;
}
inline Bytes velned(std::uint32_t itow_ms) {
  Bytes p(36);
  put(p, 0, itow_ms), put(p, 4, 123), put(p, 8, -45), put(p, 12, 6), put(p, 28, 12);
  return p;
}
inline Bytes sol(std::uint32_t itow_ms) {
  Bytes p(52);
  put(p, 0, itow_ms);
  p[10] = 3, p[11] = 0x0D, p[47] = 9;
  return p;
}

inline Bytes pvt(std::uint32_t itow_ms, std::size_t size) {
  Bytes p(size);
  put(p, 0, itow_ms), put(p, 24, 1491300000), put(p, 28, -352800000), put(p, 32, 600000);
  put(p, 36, 581000), put(p, 40, 3000), put(p, 44, 4500);
  put(p, 48, 1234), put(p, 52, -456), put(p, 56, 67), put(p, 60, 9999), put(p, 68, 123);
  p[20] = 3, p[21] = 0x01, p[23] = 9;
  return p;
}

// A solution five times a second, for `s` seconds.
inline void fly(Bench& bench, int s) {
  for (int k = 0; k < 5 * s; ++k) {
    const std::uint32_t itow_ms = bench.now_us / 1000;
    if (bench.receiver.is_six) {
      bench.push(0x02, posllh(itow_ms)), bench.push(0x12, velned(itow_ms)),
          bench.push(0x06, sol(itow_ms));
    } else {
      bench.push(0x07, pvt(itow_ms, 92));
    }
    bench.run_ms(175);
  }
}

}  // namespace fw::gps_rig
