#include "io_bridges/devices/ublox.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "base/check.hpp"
#include "io_bridges/devices/uart_sampling.hpp"
#include "io_bridges/devices/ublox_messages.hpp"
#include "io_bridges/devices/ublox_nmea.hpp"

namespace whirl::io {
namespace {

constexpr Nanoseconds kUblox_boot_ns = 300'000'000, kHotStart_ns = 1'000'000'000;
constexpr std::size_t kUblox_buffer = 1024;
constexpr double kSettling_s = 15.0, kCold_settling = 4.0, kHot_settling = 1.0;
constexpr double kHdop = 1.0, kVdop = 1.5, kTdop = 0.8;
constexpr double kUblox_baud_tolerance = 0.03;
constexpr int kFewest_satellites = 4;

}  // namespace

Ublox::Ublox(EventQueue& queue, const Params& params, Sense sense, FaultBook* faults,
             FindingSink findings)
    : queue_(queue),
      params_(params),
      sense_(std::move(sense)),
      faults_(faults),
      findings_(std::move(findings)),
      config_(params.model, params.baud, [this](const std::string& what) { report(what); }),
      transmitter_(queue, {.baud = static_cast<double>(params.baud)},
                   [this](const UartByte& byte, const UartFormat& format) { send(byte, format); }),
      ubx_([this](const UbxFrame& frame) { on_ubx(frame); }),
      nmea_([this](std::string_view body) { on_nmea(body); }),
      dropout_(params.seed, params.name + ".dropout"),
      started_ns_(queue.now()),
      fix_due_ns_(queue.now() + params.first_fix_ns),
      measure_(queue, [this] { measure(); }),
      out_(queue, [this] { put_out(); }),
      brown_out_(queue, [this] { brown_out(); }),
      forget_(queue, [this] { forget(); }) {
  WHIRL_CHECK(params.satellites >= kFewest_satellites && params.satellites <= 12,
              params.satellites);
  schedule();
  if (faults_ == nullptr) return;
  faults_->on_added([this](const Fault& added) {
    if (added.kind == FaultKind::gnss_brown_out) brown_out_.at(added.start_ns);
    if (added.kind == FaultKind::gnss_forgets) forget_.at(added.start_ns);
  });
}

void Ublox::brown_out() {
  if (fault(FaultKind::gnss_brown_out, queue_.now()) == nullptr) return;
  restart({.start = ublox::Start::hot, .reload = true});
  settings_changed();
}

void Ublox::forget() {
  if (fault(FaultKind::gnss_forgets, queue_.now()) == nullptr) return;
  config_.forget_navigation();
  settings_changed();
}

// ---- What comes in

void Ublox::receive(const UartByte& byte, const UartFormat& format, Nanoseconds now) {
  if (now < started_ns_ + kUblox_boot_ns) return;
  const bool fits = std::abs(format.baud / baud() - 1.0) <= kUblox_baud_tolerance &&
                    format.data_bits == 8 && format.parity == 'N' && !format.inverted;
  if (!fits && !mismatch_told_) {
    mismatch_told_ = true;
    report("sent to at " + std::to_string(std::lround(format.baud)) + " baud, " +
           std::to_string(format.data_bits) + format.parity + ", but it listens at " +
           std::to_string(std::lround(baud())) + " 8N1: it reads garbage (told once)");
  }
  const UartSample sample = sample_uart(byte, format, 8, baud());
  if (sample.stop_missing) return;
  const auto value = static_cast<std::uint8_t>(sample.bits);
  const std::uint16_t mask = config_.settings().port.in_mask;
  if ((mask & ublox::kUbxProtocol) != 0) ubx_.add(value);
  if ((mask & ublox::kNmeaProtocol) != 0) nmea_.add(value);
}

void Ublox::on_ubx(const UbxFrame& frame) {
  if (frame.message_class == ublox::kCfg) return on_config(frame);
  const bool poll = frame.payload.empty();
  const auto output = ublox::output_of(params_.model, ublox::key_of(frame.message_class, frame.id));
  if (poll && frame.message_class == ublox::kMon && frame.id == 0x04) {
    std::string hardware = ublox::hardware_version(params_.model);
    if (const Fault* wrong = fault(FaultKind::sensor_wrong_identity, queue_.now())) {
      char text[16];
      std::snprintf(text, sizeof text, "%08.0f", std::clamp(wrong->value, 0.0, 99999999.0));
      hardware = text;
    }
    return send_ubx(ublox::version_message(params_.model, hardware));
  }
  if (poll && frame.message_class == ublox::kNav && output == ublox::Output::modelled) {
    if (measured_) send_ubx(*ublox::nav_message(frame.id, epoch_));
    return;
  }
  char text[60];
  std::snprintf(text, sizeof text, "UBX %02X %02X is not understood: no answer",
                frame.message_class, frame.id);
  report(text);
}

void Ublox::on_config(const UbxFrame& frame) {
  const auto answer = config_.handle(frame);
  for (const UbxFrame& reply : answer.replies) send_ubx(reply);
  if (answer.kind != UbloxConfig::Answer::Kind::silence) {
    const bool ack = answer.kind == UbloxConfig::Answer::Kind::ack;
    send_ubx(
        {ublox::kAck, static_cast<std::uint8_t>(ack ? 1 : 0), {frame.message_class, frame.id}});
  }
  if (answer.restart) restart(*answer.restart);
  settings_changed();
}

void Ublox::on_nmea(std::string_view body) {
  const std::vector<std::string> fields = nmea_fields(body);
  if (fields.size() < 6 || fields[0] != "PUBX" || fields[1] != "41") return;
  const auto number = [&fields](std::size_t i, int base) {
    std::uint32_t value = 0;
    std::from_chars(fields[i].data(), fields[i].data() + fields[i].size(), value, base);
    return value;
  };
  if (number(2, 10) != 1) return;
  config_.set_port(static_cast<std::uint16_t>(number(3, 16)),
                   static_cast<std::uint16_t>(number(4, 16)), number(5, 10));
  settings_changed();
}

void Ublox::settings_changed() {
  const double baud_now = config_.settings().port.baud;
  transmitter_.change_format({.baud = baud_now});
  schedule();
}

void Ublox::restart(const ublox::Restart& restart) {
  const Nanoseconds now = queue_.now();
  if (restart.reload) config_.reload();
  started_ns_ = now;
  solutions_.clear();
  out_.cancel();
  const bool hot = restart.start == ublox::Start::hot;
  fix_due_ns_ = now + (hot ? kHotStart_ns : params_.first_fix_ns);
  fix_since_ns_ = kNever;
  settling_ = hot ? kHot_settling : kCold_settling;
  epoch_.first_fix_ms = 0;
  epoch_.time_known = epoch_.time_known && hot;
}

// ---- What it measures

void Ublox::schedule() {
  const ublox::Navigation& n = config_.settings().navigation;
  const Nanoseconds period = Nanoseconds{n.measure_ms} * n.cycles * 1'000'000;
  const Nanoseconds from = std::max(queue_.now() + 1, started_ns_ + kUblox_boot_ns);
  const Nanoseconds tow = params_.start.tow_ns;
  const Nanoseconds due = (tow + from + period - 1) / period * period - tow;
  if (measure_.pending() && measure_.due() <= queue_.now()) return;  // it measures in this instant
  if (!measure_.pending() || measure_.due() != due) measure_.at(due);
}

void Ublox::measure() {
  const Nanoseconds now = queue_.now();
  schedule();
  if (!locate(now)) return;
  Nanoseconds due = now + params_.latency_ns;
  if (const Fault* late = fault(FaultKind::sensor_late, now))
    due += std::llround(late->value * 1e9);
  solutions_.push_back({due, epoch_});
  if (!out_.pending()) out_.at(solutions_.front().due_ns);
}

bool Ublox::locate(Nanoseconds now) {
  const double luck = dropout_.uniform();  // drawn always: one that is lost shifts no other
  epoch_.time = later(params_.start, now);
  epoch_.utc = utc_of(epoch_.time, params_.leap_s);
  epoch_.running_ms = static_cast<std::uint32_t>((now - started_ns_) / 1'000'000);
  epoch_.fix = has_fix(now);
  double scale = 1.0;
  if (epoch_.fix) {
    const double since_s = static_cast<double>(now - fix_since_ns_) * 1e-9;
    const double unsettled = settling_ * std::exp(-since_s / kSettling_s);
    scale += unsettled;
    const double missing = (params_.satellites - kFewest_satellites) * unsettled / kCold_settling;
    epoch_.satellites = params_.satellites - static_cast<int>(std::lround(missing));
    if (epoch_.first_fix_ms == 0) epoch_.first_fix_ms = epoch_.running_ms;
    epoch_.time_known = true;
    if (fault(FaultKind::sensor_frozen, now) == nullptr) epoch_.at = fix_at(now);
  } else {
    epoch_.satellites = 0;
    epoch_.at.v_NED_mps = {};
    scale = 99.99;  // as large as the field of a dilution of precision
  }
  const auto dilution = [scale](double settled) { return std::min(settled * scale, 99.99); };
  epoch_.hdop = dilution(kHdop);
  epoch_.vdop = dilution(kVdop);
  epoch_.pdop = dilution(std::hypot(kHdop, kVdop));
  epoch_.tdop = epoch_.fix ? dilution(kTdop) : 99.99;
  measured_ = true;
  const Fault* dropout =
      faults_ == nullptr ? nullptr
                         : faults_->find(FaultKind::gnss_dropout, params_.bus, params_.device, now);
  if (dropout != nullptr && luck < dropout->value) {
    faults_->applied(*dropout, now);
    return false;
  }
  return luck >= params_.dropout_chance;
}

bool Ublox::has_fix(Nanoseconds now) {
  if (fault(FaultKind::gnss_jammed, now) != nullptr) {
    fix_due_ns_ = std::max(fix_due_ns_, now + kHotStart_ns);
    if (fix_since_ns_ != kNever) settling_ = kHot_settling;
    fix_since_ns_ = kNever;
  }
  if (now < fix_due_ns_) return false;
  if (fix_since_ns_ == kNever) fix_since_ns_ = now;
  return true;
}

GnssFix Ublox::fix_at(Nanoseconds now) {
  Query query{.now = now};
  query.error_scale =
      1.0 + settling_ * std::exp(-static_cast<double>(now - fix_since_ns_) * 1e-9 / kSettling_s);
  for (unsigned axis = 0; axis < 3; ++axis) {
    const int number = static_cast<int>(axis);
    if (const Fault* offset = fault(FaultKind::sensor_offset, now, number)) {
      query.offset_NED_m[axis] += offset->value;
    }
    if (const Fault* offset = fault(FaultKind::sensor_offset, now, number + 3)) {
      query.offset_NED_mps[axis] += offset->value;
    }
    if (const Fault* spoofed = fault(FaultKind::gnss_spoofed, now, number)) {
      const double since_s = static_cast<double>(now - spoofed->start_ns) * 1e-9;
      query.offset_NED_m[axis] += spoofed->value * since_s;
      query.offset_NED_mps[axis] += spoofed->value;
    }
  }
  return sense_(query);
}

// ---- What goes out

void Ublox::put_out() {
  const GnssEpoch epoch = solutions_.front().epoch;
  solutions_.pop_front();
  if (!solutions_.empty()) out_.at(std::max(queue_.now(), solutions_.front().due_ns));
  send_solution(epoch);
}

void Ublox::send_solution(const GnssEpoch& epoch) {
  ++number_;
  for (const auto& [key, rate] : config_.settings().rates) {
    if (rate == 0 || number_ % rate != 0) continue;
    const auto id = static_cast<std::uint8_t>(key & 0xFF);
    const int message_class = key >> 8;
    if (message_class == ublox::kNav) {
      if (const auto frame = ublox::nav_message(id, epoch)) send_ubx(*frame);
    } else if (message_class == ublox::kNmea &&
               (config_.settings().port.out_mask & ublox::kNmeaProtocol) != 0) {
      const auto text = ublox::nmea_message(id, epoch);
      if (text) send_bytes({reinterpret_cast<const std::uint8_t*>(text->data()), text->size()});
    }
  }
}

void Ublox::send_ubx(const UbxFrame& frame) {
  if ((config_.settings().port.out_mask & ublox::kUbxProtocol) != 0) send_bytes(encode(frame));
}

void Ublox::send_bytes(std::span<const std::uint8_t> bytes) {
  if (transmitter_.waiting() + bytes.size() > kUblox_buffer) {
    return report("its messages do not fit into " + std::to_string(std::lround(baud())) +
                  " baud: some are lost");
  }
  transmitter_.add(bytes);
}

}  // namespace whirl::io
