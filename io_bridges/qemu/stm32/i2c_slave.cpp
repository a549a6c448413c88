// I2C as a slave: called by the bus when an external master addresses us; see i2c.hpp.
#include "io_bridges/qemu/stm32/i2c.hpp"
#include "io_bridges/qemu/stm32/i2c_bits.hpp"

namespace whirl::stm32 {
using namespace i2c_bits;

bool I2c::answers(std::uint8_t address) const {
  if ((cr1_ & (PE | ACK)) != (PE | ACK) || master_ || phase_ != Phase::idle || !routed()) {
    return false;
  }
  if (address == 0) return (cr1_ & ENGC) != 0;
  const bool first = (oar1_ & 0x8000) == 0 && address == ((oar1_ >> 1) & 0x7F);
  return first || ((oar2_ & ENDUAL) != 0 && address == ((oar2_ >> 1) & 0x7F));
}

bool I2c::start(std::uint8_t address, bool read, Nanoseconds) {
  slave_ = read ? Slave::transmitter : Slave::receiver;
  transmitter_ = read;
  general_call_ = address == 0;
  second_address_ = address != 0 && address != ((oar1_ >> 1) & 0x7F);
  nacked_ = dr_full_ = false;
  if (read) shift_full_ = false;
  sr1_ = (sr1_ & ~(BTF | TXE)) | ADDR | (read ? TXE : 0);
  update_stretch();
  update();
  return true;
}

bool I2c::write(std::uint8_t byte, Nanoseconds) {
  const bool ack = (cr1_ & ACK) != 0;
  if ((sr1_ & RXNE) != 0 && (cr1_ & NOSTRETCH) != 0) {
    sr1_ |= OVR;  // the byte is lost
  } else {
    store_received(byte);
  }
  update_stretch();
  update();
  return ack;
}

void I2c::load_slave_shift() {
  shift_ = dr_;
  shift_full_ = true;
  dr_full_ = false;
  sr1_ = (sr1_ & ~BTF) | TXE;
}

std::uint8_t I2c::read(Nanoseconds) {
  if (!shift_full_) sr1_ |= OVR;  // NOSTRETCH and too late: the last byte goes out again
  shift_full_ = true;             // under way until acked()
  update();
  return shift_;
}

void I2c::acked(bool ack, Nanoseconds) {
  shift_full_ = false;
  if (!ack) {
    sr1_ |= AF;
    sr1_ &= ~TXE;
    nacked_ = true;  // what waits in DR is forgotten by the next start()
  } else if (dr_full_) {
    load_slave_shift();
  } else {
    sr1_ |= BTF;
  }
  update_stretch();
  update();
}

void I2c::abandoned(Nanoseconds now) {
  const bool sending = slave_ == Slave::transmitter && shift_full_;
  if (sending && shift_ != 0xFF) pins_.sda.drive(Drive::low, now);
}

// STOPF tells of a STOP after an acknowledged transfer; a NACK ended it already (AF).
void I2c::stop(Nanoseconds) {
  if (slave_ == Slave::none) return;
  if (!nacked_) sr1_ |= STOPF;
  slave_ = Slave::none;
  if (transmitter_) {
    shift_full_ = dr_full_ = false;
    sr1_ &= ~(TXE | BTF);
  }
  transmitter_ = general_call_ = second_address_ = false;
  update_stretch();
  update();
}

// SCL is held while ADDR stands, while a transmitter has nothing to send, while a receiver has both
// of its registers full.
void I2c::update_stretch() {
  bool hold = slave_ != Slave::none && (cr1_ & NOSTRETCH) == 0;
  hold = hold && ((sr1_ & ADDR) != 0 ||
                  (slave_ == Slave::transmitter ? !shift_full_ && !nacked_ : (sr1_ & BTF) != 0));
  const Drive drive = hold ? Drive::low : Drive::none;
  if (drive != pins_.scl.driven()) pins_.scl.drive(drive, chip_.events.now());
}

}  // namespace whirl::stm32
