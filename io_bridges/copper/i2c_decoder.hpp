// I2C from the edges of its two wires.
//
//   Reads    a bit at each rise of SCL; START and STOP are changes of SDA while SCL is high
//   Refuses  a frame whose clocks are no multiple of nine, or whose SDA changes within a high clock: an edge was lost
//            or added. It is told as unread, with its time, and none of its bytes is given
//   Cannot   tell nine lost clocks from a byte that was never sent, nor a whole frame that left no edge
//   Times    start: SDA falls; stop: SDA rises, or falls again (repeated START); a byte has passed with the fall of its
//            ninth clock
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace whirl::copper {

struct I2cFrame {
  std::int64_t start_ns = 0, stop_ns = 0;
  std::uint8_t address = 0;
  bool read = false;
  bool acked = true;  // every byte that wanted an acknowledge got one
  std::vector<std::uint8_t> bytes;
  std::vector<std::int64_t> passed_ns;
};

struct Unread {  // what was seen of a frame that cannot be read
  std::int64_t start_ns = 0, stop_ns = 0;
  std::string why;
};

class I2cDecoder {
 public:
  I2cDecoder(std::function<void(const I2cFrame&)> frame, std::function<void(const Unread&)> unread)
      : frame_(std::move(frame)), unread_(std::move(unread)) {}

  // In order of time; of one instant SCL first where it falls, last where it rises.
  void scl(bool level, std::int64_t t_ns);
  void sda(bool level, std::int64_t t_ns);

 private:
  void start(std::int64_t t_ns);
  void end(std::int64_t t_ns);
  void nine();

  std::function<void(const I2cFrame&)> frame_;
  std::function<void(const Unread&)> unread_;
  bool scl_ = true, sda_ = true;
  bool open_ = false;
  I2cFrame now_;
  int clocks_ = 0;          // since START
  std::uint32_t bits_ = 0;  // of this byte, acknowledge last
  bool addressed_ = false;
};

}  // namespace whirl::copper
