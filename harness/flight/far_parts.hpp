// Boards of the run, besides the first, whose parts sense what the vehicle does (pod_parts): they are given its
// motion, and their hosts answer questions, a line each.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "io_bridges/messages/messages.hpp"

namespace whirl::flight {

class FarParts {
 public:
  explicit FarParts(std::vector<std::uint8_t> boards) : boards_(std::move(boards)) {}

  bool hears(const io::Header& head) const;
  void on_message(const io::Reader& message);  // pre: hears()
  // What a receiver there has found is taken like that of the first board.
  bool finds(const io::Header& head) const;
  void send(std::int64_t t_ns, const io::BodyMotion& motion, io::Batch& sensed);

  // To the first of them. Errors  bad_input: there is none; the question before is not answered yet
  Result<Done> say(const std::string& line);
  const std::vector<std::string>& heard() const { return heard_; }

 private:
  std::vector<std::uint8_t> boards_;
  std::string to_send_, coming_;
  bool open_ = false;  // a question
  std::vector<std::string> heard_;
};

}  // namespace whirl::flight
