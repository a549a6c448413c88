#include "io_bridges/devices/wire_faults.hpp"

#include <cmath>
#include <string>

namespace whirl::io {
namespace {

// value = 8 * byte + bit, as every flip fault counts.
std::uint8_t flipped(std::uint8_t value, const Fault& fault) {
  return static_cast<std::uint8_t>(value ^ 1u << (static_cast<unsigned>(fault.value) % 8));
}
bool hits_byte(const Fault& fault, int index) {
  return static_cast<int>(fault.value) / 8 == index;
}

}  // namespace

I2cWireFaults::I2cWireFaults(EventQueue& queue, FaultBook& book, I2cBus& bus, int number)
    : queue_(queue), book_(book), bus_(bus), number_(number) {
  bus_.set_faults(this);
  book_.on_added([this](const Fault& fault) { schedule(fault); });
  bus_.scl().watch([this](bool level, Nanoseconds now) {
    if (level) count_pulse(now);
  });
}

void I2cWireFaults::schedule(const Fault& fault) {
  const bool sda = fault.kind == FaultKind::i2c_stuck_sda;
  if (!sda && fault.kind != FaultKind::i2c_stuck_scl) return;
  if (fault.bus != kAnywhere && fault.bus != number_) return;
  Wire& wire = sda ? bus_.sda() : bus_.scl();
  events_.push_back(std::make_unique<Event>(queue_, [this, fault] { grip(fault); }));
  events_.back()->at(fault.start_ns);
  if (fault.end_ns == kNever) return;
  events_.push_back(std::make_unique<Event>(queue_, [this, &wire] { let_go(wire); }));
  events_.back()->at(fault.end_ns);
}

void I2cWireFaults::grip(const Fault& fault) {
  const bool sda = fault.kind == FaultKind::i2c_stuck_sda;
  if (sda) pulses_left_ = static_cast<int>(fault.value);
  (sda ? bus_.sda() : bus_.scl()).force(Drive::low, queue_.now());
  book_.apply(fault.kind, number_, kAnywhere, queue_.now());
}

void I2cWireFaults::let_go(Wire& wire) {
  wire.force(Drive::none, queue_.now());
  if (&wire == &bus_.sda()) pulses_left_ = 0;
}

void I2cWireFaults::count_pulse(Nanoseconds now) {
  if (pulses_left_ > 0 && --pulses_left_ == 0) bus_.sda().force(Drive::none, now);
}

bool I2cWireFaults::deaf(std::uint8_t address, Nanoseconds now) {
  return book_.apply(FaultKind::i2c_silence, number_, address, now) != nullptr;
}

bool I2cWireFaults::ack(std::uint8_t address, int index, Nanoseconds now) {
  const Fault* fault = book_.find(FaultKind::i2c_nack, number_, address, now);
  if (fault == nullptr) return true;
  if (fault->value > 0.0 && static_cast<int>(fault->value) != index + 1) return true;
  book_.applied(*fault, now);
  return false;
}

std::uint8_t I2cWireFaults::byte(std::uint8_t address, int index, std::uint8_t value,
                                 Nanoseconds now) {
  const Fault* fault = book_.find(FaultKind::i2c_flip_bit, number_, address, now);
  if (fault == nullptr || !hits_byte(*fault, index)) return value;
  book_.applied(*fault, now);
  return flipped(value, *fault);
}

Nanoseconds I2cWireFaults::stretch(std::uint8_t address, Nanoseconds now) {
  const Fault* fault = book_.apply(FaultKind::i2c_late, number_, address, now);
  return fault == nullptr ? 0 : std::llround(fault->value * 1e9);
}

void SpiWireFaults::select(bool selected, Nanoseconds now) {
  if (selected) {
    current_.clear();
    spoiled_ = false;
  } else if (!spoiled_ && !current_.empty()) {
    last_good_ = current_;
  }
  target_.select(selected, now);
}

std::uint8_t SpiWireFaults::transfer(std::uint8_t mosi, std::uint32_t sck_Hz, int mode,
                                     Nanoseconds now) {
  const std::size_t index = current_.size();
  if (book_.apply(FaultKind::spi_silent, bus_, device_, now) != nullptr) {
    spoiled_ = true;
    current_.push_back(0xFF);
    return 0xFF;  // the line's pull-up
  }
  std::uint8_t miso = target_.transfer(mosi, sck_Hz, mode, now);
  if (const Fault* frozen = book_.find(FaultKind::spi_frozen, bus_, device_, now)) {
    book_.applied(*frozen, now);
    spoiled_ = true;
    miso = index < last_good_.size() ? last_good_[index] : 0xFF;
  }
  const Fault* flip = book_.find(FaultKind::spi_flip, bus_, device_, now);
  if (flip != nullptr && hits_byte(*flip, static_cast<int>(index))) {
    book_.applied(*flip, now);
    spoiled_ = true;
    miso = flipped(miso, *flip);
  }
  current_.push_back(miso);
  return miso;
}

UartWireFaults::UartWireFaults(EventQueue& queue, FaultBook& book, UartPeer& far, int number,
                               std::uint64_t seed, Spoils spoils)
    : queue_(queue),
      book_(book),
      far_(far),
      early_(dynamic_cast<EarlyUartPeer*>(&far)),
      number_(number),
      random_(seed, "uart_faults." + std::to_string(number)),
      spoils_(spoils) {
  far_.join([this](const UartByte& byte, const UartFormat& format) {
    if (const auto left = passed(byte)) send(*left, format);
  });
}

void UartWireFaults::begin(const UartByte& byte, const UartFormat& format, Nanoseconds now,
                           Nanoseconds end) {
  leaving_ = spoils_ == Spoils::both_ways ? passed(byte) : byte;
  if (leaving_ && early_ != nullptr) early_->begin(*leaving_, format, now, end);
}

void UartWireFaults::receive(const UartByte& byte, const UartFormat& format, Nanoseconds now) {
  if (spoils_ == Spoils::towards_mcu) return far_.receive(byte, format, now);
  if (leaving_) far_.receive(*leaving_, format, now);
}

std::optional<UartByte> UartWireFaults::passed(UartByte byte) {
  const Nanoseconds now = queue_.now();
  if (book_.apply(FaultKind::uart_silence, number_, kAnywhere, now) != nullptr) return {};
  const Fault* loss = book_.find(FaultKind::uart_loss, number_, kAnywhere, now);
  if (loss != nullptr && random_.uniform() < loss->value) {
    book_.applied(*loss, now);
    return {};
  }
  const Fault* flip = book_.find(FaultKind::uart_flip, number_, kAnywhere, now);
  if (flip != nullptr && random_.uniform() < flip->value) {
    book_.applied(*flip, now);
    byte.value = static_cast<std::uint8_t>(byte.value ^ 1u << random_.bits() % 8);
  }
  return byte;
}

}  // namespace whirl::io
