// I2C blocks as slaves of two addresses each.
//
//   Clock    stretched (NOSTRETCH 0): SCL is held after the address of a read until its first byte is
//            there, and after every byte that the master acknowledged until the next one is. So no byte
//            is fetched that the master does not clock out: a part may act on what is read
//   Parts    are called at kPriorityBus
//   Blocks   sensor_bus I2C1 (PB8, PB9), esc_bus_12 I2C2 (PB10, PB11), esc_bus_34 I2C3 (PA8, PC9)
#pragma once
#include <cstdint>

namespace fw::pod {

// What answers at an address. Nothing is pure here, for want of a handler.
class I2cPart {
 public:
  virtual bool start(bool /*read*/) { return false; }
  virtual void write(std::uint8_t /*byte*/) {}
  virtual std::uint8_t read() { return 0xFF; }
  virtual void stop() {}

 protected:
  ~I2cPart() = default;
};

template <typename Port>
class I2cSlave {
 public:
  void start(I2cPart& first, std::uint8_t first_address, I2cPart& second,
             std::uint8_t second_address);
  void event();  // from the block's interrupts
  void error();

 private:
  void addressed(std::uint32_t sr2);
  void end();

  I2cPart* parts_[2] = {};
  I2cPart* talking_ = nullptr;
  bool sending_ = false;
};

struct SensorPort;
struct EscPort12;
struct EscPort34;
extern I2cSlave<SensorPort> sensor_bus;
extern I2cSlave<EscPort12> esc_bus_12;
extern I2cSlave<EscPort34> esc_bus_34;

}  // namespace fw::pod
