#include "io_bridges/devices/ublox_config.hpp"

#include <algorithm>
#include <cstdio>

namespace whirl::io {
namespace ublox {
namespace {

struct Known {
  std::uint8_t message_class, id;
  Output output;
  bool only_m8 = false;
};
constexpr Known kKnown[] = {
    {kNav, 0x02, Output::modelled},           // POSLLH
    {kNav, 0x03, Output::modelled},           // STATUS
    {kNav, 0x04, Output::modelled},           // DOP
    {kNav, 0x06, Output::modelled},           // SOL
    {kNav, 0x07, Output::modelled, true},     // PVT
    {kNav, 0x12, Output::modelled},           // VELNED
    {kNav, 0x21, Output::modelled},           // TIMEUTC
    {kNav, 0x01, Output::stored_only},        // POSECEF
    {kNav, 0x11, Output::stored_only},        // VELECEF
    {kNav, 0x20, Output::stored_only},        // TIMEGPS
    {kNav, 0x22, Output::stored_only},        // CLOCK
    {kNav, 0x30, Output::stored_only},        // SVINFO
    {kNav, 0x32, Output::stored_only},        // SBAS
    {kNav, 0x35, Output::stored_only, true},  // SAT
    {kMon, 0x09, Output::stored_only},        // HW
    {kMon, 0x0B, Output::stored_only},        // HW2
    {0x0B, 0x00, Output::stored_only},        // AID-REQ
    {0x0D, 0x01, Output::stored_only},        // TIM-TP
    {kNmea, 0x00, Output::modelled},          // GGA
    {kNmea, 0x01, Output::modelled},          // GLL
    {kNmea, 0x02, Output::modelled},          // GSA
    {kNmea, 0x03, Output::stored_only},       // GSV
    {kNmea, 0x04, Output::modelled},          // RMC
    {kNmea, 0x05, Output::modelled},          // VTG
    {kNmea, 0x06, Output::stored_only},       // GRS
    {kNmea, 0x07, Output::stored_only},       // GST
    {kNmea, 0x08, Output::stored_only},       // ZDA
};

}  // namespace

Output output_of(UbloxModel model, MessageKey message) {
  for (const Known& known : kKnown) {
    if (key_of(known.message_class, known.id) != message) continue;
    return known.only_m8 && model != UbloxModel::m8 ? Output::unknown : known.output;
  }
  return Output::unknown;
}

std::array<std::uint8_t, 36> Navigation::default_nav5() {
  std::array<std::uint8_t, 36> nav5{};
  nav5[0] = nav5[1] = 0xFF;        // mask, as a poll tells it
  nav5[3] = 3;                     // fixMode auto; dynModel 0 is portable
  nav5[8] = 0x10, nav5[9] = 0x27;  // fixedAltVar 1 m2
  nav5[12] = 5;                    // minElev, deg
  nav5[14] = nav5[16] = 250;       // pDop, tDop
  nav5[18] = 100;                  // pAcc, m
  nav5[20] = 0x2C, nav5[21] = 1;   // tAcc, 300 m
  nav5[23] = 60;                   // dgpsTimeOut, s
  return nav5;
}

Settings default_settings(std::uint32_t baud) {
  Settings settings;
  settings.port.baud = baud;
  for (const std::uint8_t id : {0, 1, 2, 3, 4, 5}) settings.rates[key_of(kNmea, id)] = 1;
  return settings;
}

}  // namespace ublox

namespace {

constexpr std::uint8_t kPrt = 0x00, kMsg = 0x01, kRst = 0x04, kRate = 0x08, kSave = 0x09,
                       kNav5 = 0x24;
constexpr std::uint8_t kUart1 = 1;
constexpr std::size_t kPortBlock = 20, kPorts = 6;
constexpr std::uint32_t kFormatBits = 0x3EC0, k8N1 = 0x08C0, kNoParityDontCare = 0x0200;

std::string name_of(const UbxFrame& frame) {
  char text[40];
  std::snprintf(text, sizeof text, "UBX %02X %02X with %zu bytes", frame.message_class, frame.id,
                frame.payload.size());
  return text;
}

}  // namespace

UbloxConfig::UbloxConfig(UbloxModel model, std::uint32_t baud, Report report)
    : model_(model),
      report_(std::move(report)),
      default_(ublox::default_settings(9600)),
      saved_(ublox::default_settings(baud)),
      settings_(saved_) {}

UbloxConfig::Answer UbloxConfig::refuse(const UbxFrame& frame, const std::string& why) {
  report_(name_of(frame) + ": " + why);
  return {Answer::Kind::nak};
}

UbloxConfig::Answer UbloxConfig::handle(const UbxFrame& frame) {
  switch (frame.id) {
    case kPrt:
      return on_port(frame);
    case kMsg:
      return on_message(frame);
    case kRst:
      return on_restart(frame);
    case kRate:
      return on_rate(frame);
    case kSave:
      return on_save(frame);
    case kNav5:
      return on_nav5(frame);
    default:
      return on_stored_only(frame);
  }
}

bool UbloxConfig::baud_exists(std::uint32_t baud) const {
  constexpr std::uint32_t kBauds[] = {4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800};
  const auto* end = model_ == UbloxModel::m8 ? std::end(kBauds) : std::end(kBauds) - 2;
  return std::find(std::begin(kBauds), end, baud) != end;
}

UbloxConfig::Answer UbloxConfig::on_port(const UbxFrame& frame) {
  const std::size_t size = frame.payload.size();
  if (size > 1) return set_ports(frame);
  if (size == 1 && frame.payload[0] != kUart1) return refuse(frame, "only UART1 has a wire");
  const ublox::Port& p = settings_.port;
  UbxPayload reply;
  reply.put(kUart1).zeros(1).put(p.tx_ready).put(p.mode).put(p.baud);
  reply.put(p.in_mask).put(p.out_mask).put(p.flags).zeros(2);
  return {Answer::Kind::ack, {{ublox::kCfg, kPrt, reply.take()}}};
}

// Several blocks may follow one another, one a port; those of other ports lead nowhere.
UbloxConfig::Answer UbloxConfig::set_ports(const UbxFrame& frame) {
  if (frame.payload.size() % kPortBlock != 0) return refuse(frame, "no such length");
  for (std::size_t at = 0; at < frame.payload.size(); at += kPortBlock) {
    if (frame.payload[at] != kUart1) continue;
    ublox::Port port;
    port.tx_ready = frame.get<std::uint16_t>(at + 2);
    port.mode = frame.get<std::uint32_t>(at + 4);
    port.baud = frame.get<std::uint32_t>(at + 8);
    port.in_mask = frame.get<std::uint16_t>(at + 12);
    port.out_mask = frame.get<std::uint16_t>(at + 14);
    port.flags = frame.get<std::uint16_t>(at + 16);
    if ((port.mode & kFormatBits & ~kNoParityDontCare) != k8N1) {
      return refuse(frame, "a format other than 8N1");
    }
    if (!baud_exists(port.baud)) {
      return refuse(frame, "no such baud rate: " + std::to_string(port.baud));
    }
    if (port.tx_ready != 0) report_("CFG-PRT txReady is stored, but no pin is wired to it");
    settings_.port = port;
  }
  return done();
}

void UbloxConfig::set_port(std::uint16_t in_mask, std::uint16_t out_mask, std::uint32_t baud) {
  if (!baud_exists(baud)) return report_("PUBX,41: no such baud rate: " + std::to_string(baud));
  settings_.port.in_mask = in_mask;
  settings_.port.out_mask = out_mask;
  settings_.port.baud = baud;
}

UbloxConfig::Answer UbloxConfig::on_message(const UbxFrame& frame) {
  const std::size_t size = frame.payload.size();
  if (size != 2 && size != 3 && size != 2 + kPorts) return refuse(frame, "no such length");
  const ublox::MessageKey key = ublox::key_of(frame.payload[0], frame.payload[1]);
  const ublox::Output output = ublox::output_of(model_, key);
  if (output == ublox::Output::unknown) return {Answer::Kind::nak};  // a driver's way to ask
  if (size == 2) {
    std::vector<std::uint8_t> reply = {frame.payload[0], frame.payload[1], 0, 0, 0, 0, 0, 0};
    reply[2 + kUart1] = settings_.rates[key];
    return {Answer::Kind::ack, {{ublox::kCfg, kMsg, reply}}};
  }
  const std::uint8_t rate = frame.payload[size == 3 ? 2 : 2 + kUart1];
  settings_.rates[key] = rate;
  if (output == ublox::Output::stored_only && rate != 0) {
    char text[80];
    std::snprintf(text, sizeof text,
                  "message %02X %02X is switched on, but not modelled: none come", frame.payload[0],
                  frame.payload[1]);
    report_(text);
  }
  return done();
}

UbloxConfig::Answer UbloxConfig::on_rate(const UbxFrame& frame) {
  ublox::Navigation& n = settings_.navigation;
  if (frame.payload.empty()) {
    UbxPayload reply;
    reply.put(n.measure_ms).put(n.cycles).put(n.time_reference);
    return {Answer::Kind::ack, {{ublox::kCfg, kRate, reply.take()}}};
  }
  if (frame.payload.size() != 6) return refuse(frame, "no such length");
  const auto measure_ms = frame.get<std::uint16_t>(0), cycles = frame.get<std::uint16_t>(2),
             reference = frame.get<std::uint16_t>(4);
  const int shortest_ms = model_ == UbloxModel::six ? 200 : 100;
  if (measure_ms < shortest_ms) {
    return refuse(frame, std::to_string(measure_ms) + " ms is faster than the part navigates: " +
                             std::to_string(shortest_ms) + " ms");
  }
  if (cycles == 0 || cycles > 127 || reference > 1) return refuse(frame, "a field out of range");
  n.measure_ms = measure_ms;
  n.cycles = model_ == UbloxModel::six ? std::uint16_t{1} : cycles;
  n.time_reference = reference;
  return done();
}

UbloxConfig::Answer UbloxConfig::on_nav5(const UbxFrame& frame) {
  auto& nav5 = settings_.navigation.nav5;
  if (frame.payload.empty()) {
    return {Answer::Kind::ack, {{ublox::kCfg, kNav5, {nav5.begin(), nav5.end()}}}};
  }
  if (frame.payload.size() != nav5.size()) return refuse(frame, "no such length");
  // Which bytes each bit of the mask takes over; the rest of the message has none and is kept.
  constexpr struct {
    unsigned bit, first, last;
  } kFields[] = {{0, 2, 2},   {1, 12, 12}, {2, 3, 3},   {3, 4, 11},
                 {4, 14, 21}, {5, 13, 13}, {6, 22, 22}, {7, 23, 23}};
  const auto mask = frame.get<std::uint16_t>(0);
  const std::uint8_t model = frame.payload[2], mode = frame.payload[3];
  if ((mask & 1) != 0 && (model == 1 || model > 8)) return refuse(frame, "no such dynModel");
  if ((mask & 4) != 0 && (mode == 0 || mode > 3)) return refuse(frame, "no such fixMode");
  for (const auto& field : kFields) {
    if ((mask >> field.bit & 1) == 0) continue;
    std::copy(frame.payload.begin() + field.first, frame.payload.begin() + field.last + 1,
              nav5.begin() + field.first);
  }
  return done();
}

// clear: the saved section becomes the default; save: it becomes what is in force; load: the other
// way round; in this order.
UbloxConfig::Answer UbloxConfig::on_save(const UbxFrame& frame) {
  const std::size_t size = frame.payload.size();
  if (size != 12 && size != 13) return refuse(frame, "no such length");
  const auto copy = [](std::uint32_t mask, const ublox::Settings& from, ublox::Settings& to) {
    if ((mask & 0x1) != 0) to.port = from.port;
    if ((mask & 0x2) != 0) to.rates = from.rates;
    if ((mask & 0x8) != 0) to.navigation = from.navigation;
  };
  copy(frame.get<std::uint32_t>(0), default_, saved_);
  copy(frame.get<std::uint32_t>(4), settings_, saved_);
  copy(frame.get<std::uint32_t>(8), saved_, settings_);
  return done();
}

UbloxConfig::Answer UbloxConfig::on_restart(const UbxFrame& frame) {
  if (frame.payload.size() != 4) return refuse(frame, "no such length");
  const auto forget = frame.get<std::uint16_t>(0);
  const std::uint8_t mode = frame.payload[2];
  if (mode > 2 && mode != 4)
    return refuse(frame, "stop and start of the receiver are not modelled");
  ublox::Restart restart;
  if (forget != 0) restart.start = forget == 1 ? ublox::Start::warm : ublox::Start::cold;
  restart.reload = mode != 2;  // 2: of the navigation only
  return {Answer::Kind::silence, {}, restart};
}

UbloxConfig::Answer UbloxConfig::on_stored_only(const UbxFrame& frame) {
  constexpr std::uint8_t kBoth[] = {0x02, 0x07, 0x11, 0x16, 0x23, 0x31};
  constexpr std::uint8_t kM8[] = {0x3E, 0x86};
  const auto among = [&frame](const auto& ids) {
    return std::find(std::begin(ids), std::end(ids), frame.id) != std::end(ids);
  };
  if (!among(kBoth) && !(model_ == UbloxModel::m8 && among(kM8))) {
    return {Answer::Kind::nak};  // a driver's way to ask what it talks to
  }
  const auto stored = stored_only_.find(frame.id);
  if (!frame.payload.empty()) {
    stored_only_[frame.id] = frame.payload;
    report_(name_of(frame) + ": stored, but the model does not act on it");
    return done();
  }
  if (stored == stored_only_.end()) return refuse(frame, "its default is not modelled");
  return {Answer::Kind::ack, {{ublox::kCfg, frame.id, stored->second}}};
}

}  // namespace whirl::io
