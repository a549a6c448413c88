// Boards of the run, besides the first, whose parts sense what the vehicle does (pod_parts): they are given its
// motion, and their hosts answer questions, a line each. A motor's ESC is the first board's, or one that such a part
// plays: its state goes there, and what it was told counts as it comes from there.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::flight {

class FarParts {
 public:
  FarParts(std::vector<std::uint8_t> boards, std::map<int, std::uint8_t> escs)
      : boards_(std::move(boards)), escs_(std::move(escs)) {}

  bool hears(const io::Header& head) const;
  void on_message(const io::Reader& message);  // pre: hears()
  // What a receiver there has found is taken like that of the first board.
  bool finds(const io::Header& head) const;
  void send(std::int64_t t_ns, const io::BodyMotion& motion, io::Batch& sensed);
  void send_esc(std::int64_t t_ns, std::uint16_t motor, const io::EscState& state,
                io::Batch& sensed) const;
  // A set-point, told by who plays the motor's ESC.
  bool is_esc(const io::Header& head) const;

  // To the first of them. Errors  bad_input: there is none; the question before is not answered yet
  Result<Done> say(const std::string& line);
  const std::vector<std::string>& heard() const { return heard_; }

 private:
  std::uint8_t board_of(int motor) const;

  std::vector<std::uint8_t> boards_;
  std::map<int, std::uint8_t> escs_;  // by motor
  std::string to_send_, coming_;
  bool open_ = false;  // a question
  std::vector<std::string> heard_;
};

}  // namespace whirl::flight
